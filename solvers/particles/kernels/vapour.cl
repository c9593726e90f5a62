/* Boiling: depths of particles below the matter above them, and their rest densities. */

WEIR_FN void place_at(int i, int stride, __global const double* x, double* y) {
    for (int a = 0; a < 3; ++a) y[a] = a < WEIR_DIM ? x[(size_t)a * stride + i] : 0;
}

/* Counts particles by column and row, shifted by one entry: the scan from the top then gives the number above each row. */
__kernel void count_in_columns(int count, int stride, __constant VapourParams* p, __global const double* x, __global int* above) {
    const int i = get_global_id(0);
    if (i >= count) return;
    double y[3];
    place_at(i, stride, x, y);
    atomic_inc(above + vapour_column(y, p) + vapour_cell(vapour_below(y, p), p->cells[p->axis]) + 1);
}
__kernel void sum_columns(int columns, int rows, __global int* above) {
    const int column = get_global_id(0);
    if (column >= columns) return;
    __global int* own = above + (size_t)column * (rows + 1);
    for (int row = 0; row < rows; ++row) own[row + 1] += own[row];
}

__kernel void find_shifts(int count, int stride, __constant VapourParams* p, __global const double* x, __global const int* above,
                          __global double* shift) {
    const int i = get_global_id(0);
    if (i >= count) return;
    double y[3];
    place_at(i, stride, x, y);
    const double below = vapour_below(y, p);
    const int row = vapour_cell(below, p->cells[p->axis]), at = vapour_column(y, p) + row;
    shift[i] = vapour_shift(vapour_depth(below, row, above[at], above[at + 1] - above[at], p), p);
}

/* Rest densities of sorted particles, relative to the liquid's. */
__kernel void find_rests(int count, __constant VapourParams* p, __constant HeatStates* s, __global const int* order,
                         __global const double* enthalpy, __global const double* shift, __global float* rest) {
    const int k = get_global_id(0);
    if (k < count) rest[k] = (float)vapour_rest(enthalpy[order[k]], shift[order[k]], s, p);
}
