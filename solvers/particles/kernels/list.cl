/* Sorted positions in single precision relative to the centre of the domain, and every particle's neighbours: entry k of particle i is
   at k * stride + i, so that adjacent work items read adjacent entries. */

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

/* Appends the particles near `me` in the cells first .. last to the list of particle i, which has `found` entries. Writes at most
   `room`. */
WEIR_FN int append_near(int found, int i, float4 me, int4 first, int4 last, int stride, int room, float radius2, int4 cells,
                        __global const float4* sorted, __global const int* start, __global int* list) {
    first = max(first, (int4)(0));
    last = min(last, cells - 1);
    if (first.x > last.x) return found;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y) {
            const int row = (z * cells.y + y) * cells.x;
            const int end = start[row + last.x + 1];
            for (int j = start[row + first.x]; j < end; ++j) {
                const float4 d = me - sorted[j];
                if (j == i || !(SQUARE(d) < radius2)) continue;
                if (found < room) list[(size_t)found * stride + i] = j;
                ++found;
            }
        }
    return found;
}

/* Where a particle has more neighbours than the capacity, `needed` is their number. Along periodic axes the images of a particle also
   search for neighbours. grid: origin of the cells, 1 / size. */
__kernel void find_neighbours(int count, int stride, int room, float radius2, __constant StateParams* s, double4 grid, int4 cells,
                              __global const float4* sorted, __global const int* sorted_cell, __global const int* start,
                              __global int* neighbours, __global int* list, __global int* needed) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = sorted[i];
    const int c = sorted_cell[i];
    const int4 own = (int4)(c % cells.x, c / cells.x % cells.y, c / (cells.x * cells.y), 0);
    int found = append_near(0, i, me, own - 1, own + 1, stride, room, radius2, cells, sorted, start, list);
#ifdef WEIR_PERIOD
    const float4 period = (float4)(WEIR_PERIOD);
    const int4 repeats = (int4)(period.x > 0, period.y > 0, period.z > 0, 0);
    for (int z = -repeats.z; z <= repeats.z; ++z)
        for (int y = -repeats.y; y <= repeats.y; ++y)
            for (int x = -repeats.x; x <= repeats.x; ++x) {
                if (x == 0 && y == 0 && z == 0) continue;
                const float4 image = me + (float4)(x, y, z, 0) * period;
                /* in cells; 1.01: the image's place is rounded */
                const float4 at = (float4)((image.x + s->centre[0] - grid.x) * grid.w, (image.y + s->centre[1] - grid.y) * grid.w,
                                           WEIR_DIM == 3 ? (image.z + s->centre[2] - grid.z) * grid.w : 0, 0);
                found = append_near(found, i, image, convert_int4(floor(at - 1.01f)), convert_int4(floor(at + 1.01f)), stride, room,
                                    radius2, cells, sorted, start, list);
            }
#endif
    neighbours[i] = found;
    if (found > room) atomic_max(needed, found);
}

/* Walls and solids at sorted particle i (walls_combined): gradient, then part. Most particles have none near. */
WEIR_FN float4 walls_at(float4 at, __constant WallParams* w, __global const float4* terms, int i) {
    const float x[3] = {at.x, at.y, at.z};
    float part[3] = {0, 0, 0}, lean[3] = {0, 0, 0}, pull[3] = {0, 0, 0}, steep[3] = {0, 0, 0}, solid[4] = {0, 0, 0, 0}, out[4];
    int any = 0;
    for (int a = 0; a < WEIR_DIM; ++a) {
        const float above = x[a] - w->lo[a], below = w->hi[a] - x[a];
        if (wall_depth(above, w->inv_h) > 0) {
            const float covers = wall_series(above, w->fraction, w->inv_h), slope = wall_series(above, w->slope, w->inv_h);
            part[a] += covers, lean[a] -= covers * w->facing, pull[a] -= slope, steep[a] += slope * w->facing;
            any = 1;
        }
        if (wall_depth(below, w->inv_h) > 0) {
            const float covers = wall_series(below, w->fraction, w->inv_h), slope = wall_series(below, w->slope, w->inv_h);
            part[a] += covers, lean[a] += covers * w->facing, pull[a] += slope, steep[a] += slope * w->facing;
            any = 1;
        }
    }
#ifdef WEIR_SOLIDS
    const float4 body = terms[i];
    solid[0] = body.x, solid[1] = body.y, solid[2] = body.z, solid[3] = body.w;
    any = any || body.w != 0;
#endif
    if (!any) return (float4)(0.0f);
    walls_combined(part, lean, pull, steep, solid, out);
    return (float4)(out[0], out[1], out[2], out[3]);
}
