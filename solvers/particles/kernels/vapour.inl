/* Where a particle stands in its column, what boiling takes there, and what density it then is to have. Plain C; WEIR_FN and WEIR_PARAM as in
   pair.inl. What is not a number counts as the first cell. */

WEIR_FN double vapour_place(double x, int axis, WEIR_PARAM VapourParams* p) {
    double at = (x - p->lo[axis]) * p->per_cell[axis], end = p->cells[axis];
    return at > 0 ? (at < end ? at : end) : 0;
}
WEIR_FN int vapour_cell(double place, int cells) { return (int)place < cells ? (int)place : cells - 1; }

/* Depth in rows, from the top. */
WEIR_FN double vapour_below(const double* x, WEIR_PARAM VapourParams* p) {
    double at = vapour_place(x[p->axis], p->axis, p);
    return p->falls ? at : p->cells[p->axis] - at;
}
/* First entry of the rows of a particle's column; each column has one entry more than rows. */
WEIR_FN int vapour_column(const double* x, WEIR_PARAM VapourParams* p) {
    int a, column = 0;
    for (a = 0; a < 3; ++a)
        if (a != p->axis) column = column * p->cells[a] + vapour_cell(vapour_place(x[a], a, p), p->cells[a]);
    return column * (p->cells[p->axis] + 1);
}

/* before: particles in the rows above the particle's; own: in its row. */
WEIR_FN double vapour_depth(double below, int row, int before, int own, WEIR_PARAM VapourParams* p) {
    return p->depth_of_one * (before + (below - row) * own);
}
WEIR_FN double vapour_shift(double depth, WEIR_PARAM VapourParams* p) {
    double at = depth * p->pieces_per_depth;
    int i = at < WEIR_SHIFT_PIECES ? (int)at : WEIR_SHIFT_PIECES - 1;
    return at < WEIR_SHIFT_PIECES ? p->shift[i] + (at - i) * (p->shift[i + 1] - p->shift[i]) : p->shift[WEIR_SHIFT_PIECES];
}

/* Mean density of liquid and vapour, by their volumes, relative to the liquid's. */
WEIR_FN double vapour_rest(double h, double shift, WEIR_PARAM HeatStates* s, WEIR_PARAM VapourParams* p) {
    return 1 / (1 + heat_vapour(h, shift, s) * (p->expansion - 1));
}
