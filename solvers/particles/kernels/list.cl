/* Sorted positions in single precision around the centre of the domain, and every particle's neighbours: entry k of particle i stands at
   k * stride + i, so that consecutive work items read consecutive entries. */

__kernel void load_sorted(int count, int stride, __constant StateParams* s, __global const double* x, __global const int* order,
                          __global const int* cell, __global float4* sorted, __global int* sorted_cell) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = order[k];
    float4 p = (float4)(0.0f);
    p.x = (float)(x[i] - s->centre[0]);
    p.y = (float)(x[(size_t)stride + i] - s->centre[1]);
#if WEIR_DIM == 3
    p.z = (float)(x[(size_t)2 * stride + i] - s->centre[2]);
#endif
    sorted[k] = p;
    sorted_cell[k] = cell[i];
}

/* Where a particle has more neighbours than there is room for, `needed` says how many, and nothing is written beyond. */
__kernel void find_neighbours(int count, int stride, int room, float radius2, int4 cells, __global const float4* sorted,
                              __global const int* sorted_cell, __global const int* start, __global int* neighbours, __global int* list,
                              __global int* needed) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = sorted[i];
    const int c = sorted_cell[i], cx = c % cells.x, cy = c / cells.x % cells.y, cz = c / (cells.x * cells.y);
    const int x0 = max(cx - 1, 0), x1 = min(cx + 1, cells.x - 1);
    int found = 0;
    for (int z = max(cz - 1, 0); z <= min(cz + 1, cells.z - 1); ++z)
        for (int y = max(cy - 1, 0); y <= min(cy + 1, cells.y - 1); ++y) {
            const int row = (z * cells.y + y) * cells.x;
            const int end = start[row + x1 + 1];
            for (int j = start[row + x0]; j < end; ++j) {
                const float4 d = me - sorted[j];
                if (j == i || !(SQUARE(d) < radius2)) continue;
                if (found < room) list[(size_t)found * stride + i] = j;
                ++found;
            }
        }
    neighbours[i] = found;
    if (found > room) atomic_max(needed, found);
}

/* Walls at one particle (walls_combined): gradient, then part. Most particles have none near. */
WEIR_FN float4 walls_at(float4 at, __constant WallParams* w) {
    const float x[3] = {at.x, at.y, at.z};
    float part[3] = {0, 0, 0}, pull[3] = {0, 0, 0}, solid[4] = {0, 0, 0, 0}, out[4];
    int any = 0;
    for (int a = 0; a < WEIR_DIM; ++a) {
        const float above = x[a] - w->lo[a], below = w->hi[a] - x[a];
        if (above < w->reach) {
            part[a] += wall_series(above, w->fraction, w->inv_h);
            pull[a] -= wall_series(above, w->slope, w->inv_h);
            any = 1;
        }
        if (below < w->reach) {
            part[a] += wall_series(below, w->fraction, w->inv_h);
            pull[a] += wall_series(below, w->slope, w->inv_h);
            any = 1;
        }
    }
    if (!any) return (float4)(0.0f);
    walls_combined(part, pull, solid, out);
    return (float4)(out[0], out[1], out[2], out[3]);
}
