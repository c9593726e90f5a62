/* Particles sorted by cell: hash, counting sort, cell starts (Green 2010, section 5). Linear cell order, x fastest. Atomics place the
   particles of a cell in any order; sort_cells restores it, so the order is always that of the processor's stable sort. */

/* Cells as (origin, 1 / size) and their numbers along the axes. */
__kernel void find_cells(int count, int stride, double4 grid, int4 cells, __global const double* x, __global int* cell,
                         __global int* members) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const double origin[3] = {grid.x, grid.y, grid.z};
    const int n[3] = {cells.x, cells.y, cells.z};
    int c = 0;
    for (int a = WEIR_DIM - 1; a >= 0; --a) c = c * n[a] + min((int)((x[(size_t)a * stride + i] - origin[a]) * grid.w), n[a] - 1);
    cell[i] = c;
    atomic_inc(&members[c]);
}

#define SCAN_ITEMS 8

/* Inclusive scan of `mine` within the group. */
WEIR_FN int scan_group(int mine, __local int* sums) {
    const int l = get_local_id(0);
    sums[l] = mine;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int step = 1; step < WEIR_GROUP; step *= 2) {
        const int before = l >= step ? sums[l - step] : 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        sums[l] += before;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    return sums[l];
}

/* Exclusive scan of all entries, in three passes: within blocks, of the blocks, both together. */
__kernel void scan_blocks(int count, __global const int* in, __global int* out, __global int* blocks) {
    __local int sums[WEIR_GROUP];
    const int first = get_global_id(0) * SCAN_ITEMS;
    int mine = 0;
    for (int k = first; k < min(first + SCAN_ITEMS, count); ++k) mine += in[k];
    const int up_to_here = scan_group(mine, sums);
    int before = up_to_here - mine;
    for (int k = first; k < min(first + SCAN_ITEMS, count); ++k) {
        out[k] = before;
        before += in[k];
    }
    if (get_local_id(0) == WEIR_GROUP - 1) blocks[get_group_id(0)] = up_to_here;
}
/* A single group. */
__kernel void scan_sums(int count, __global int* blocks) {
    __local int sums[WEIR_GROUP];
    const int l = get_local_id(0);
    int before = 0;
    for (int first = 0; first < count; first += WEIR_GROUP) {
        const int mine = first + l < count ? blocks[first + l] : 0;
        const int up_to_here = scan_group(mine, sums);
        if (first + l < count) blocks[first + l] = before + up_to_here - mine;
        before += sums[WEIR_GROUP - 1];
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
__kernel void scan_add(int count, __global int* out, __global const int* blocks) {
    const int k = get_global_id(0);
    if (k < count) out[k] += blocks[k / (WEIR_GROUP * SCAN_ITEMS)];
}

/* Moves particles to their cells; leaves the counters at zero. */
__kernel void scatter(int count, __global const int* cell, __global const int* start, __global int* members, __global int* order) {
    const int i = get_global_id(0);
    if (i >= count) return;
    order[start[cell[i]] + atomic_dec(&members[cell[i]]) - 1] = i;
}

/* Heap sort (Williams 1964): n log n for any number of particles in a cell. */
WEIR_FN void sift_down(__global int* list, int root, int count) {
    const int value = list[root];
    for (int child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && list[child + 1] > list[child]) ++child;
        if (list[child] <= value) break;
        list[root] = list[child];
        root = child;
    }
    list[root] = value;
}
__kernel void sort_cells(int cells, __global const int* start, __global int* order) {
    const int c = get_global_id(0);
    if (c >= cells) return;
    const int count = start[c + 1] - start[c];
    __global int* list = order + start[c];
    if (count <= 32) {
        for (int k = 1; k < count; ++k) {
            const int value = list[k];
            int to = k;
            for (; to > 0 && list[to - 1] > value; --to) list[to] = list[to - 1];
            list[to] = value;
        }
        return;
    }
    for (int root = count / 2 - 1; root >= 0; --root) sift_down(list, root, count);
    for (int last = count - 1; last > 0; --last) {
        const int largest = list[0];
        list[0] = list[last];
        list[last] = largest;
        sift_down(list, 0, last);
    }
}
