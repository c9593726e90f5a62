/* Passes over the state: double precision, one array per axis (axis a of particle i is at a * stride + i). The cell of a particle is the
   same as on the processor's path. */

/* The closest point inside the walls; NaN is kept and detected later. */
WEIR_FN double kept_inside(double x, __constant StateParams* s, int axis) {
    double above = x < s->keep_lo[axis] ? s->keep_lo[axis] : x;
    return s->keep_hi[axis] < above ? s->keep_hi[axis] : above;
}

/* The closest point inside the walls and outside the solids. */
WEIR_FN void keep(double* x, __constant StateParams* s, __global const SolidPose* poses) {
#ifdef WEIR_SOLIDS
    const double4 y = pushed_out((double4)(x[0], x[1], WEIR_DIM == 3 ? x[2] : 0, 0), s->margin, s->feel, poses);
    x[0] = y.x, x[1] = y.y, x[2] = y.z;
#endif
    for (int a = 0; a < WEIR_DIM; ++a) x[a] = kept_inside(x[a], s, a);
}

/* The same; corrections: number of boundary corrections larger than rounding, and the largest distance [m] as the bits of a float, which are
   ordered like nonnegative floats. */
WEIR_FN void count_correction(double by2, __constant StateParams* s, __global uint* corrections) {
    if (!(by2 > s->least_back * s->least_back)) return;
    atomic_inc(corrections);
    atomic_max(corrections + 1, as_uint((float)sqrt(by2)));
}
WEIR_FN void keep_and_count(double* x, __constant StateParams* s, __global const SolidPose* poses, __global uint* corrections) {
    const double before[3] = {x[0], x[1], WEIR_DIM == 3 ? x[2] : 0};
    keep(x, s, poses);
    double by2 = 0;
    for (int a = 0; a < WEIR_DIM; ++a) by2 += (x[a] - before[a]) * (x[a] - before[a]);
    count_correction(by2, s, corrections);
}

/* The forces of the scene: v + dt f. pull: dt omega^2 */
WEIR_FN double forced(double u, double x, double dt, double pull, __constant StateParams* s, int axis) {
#ifdef WEIR_GRAVITY
    u += dt * s->gravity[axis];
#endif
#ifdef WEIR_CENTRAL_FORCE
    u = u - pull * (x - s->field_centre[axis]);
#endif
    return u;
}

/* v += dt f, x* = x + dt v                                                    Macklin & Mueller 2013, algorithm 1, lines 1-4 */
__kernel void predict(int count, int stride, __constant StateParams* s, __global const SolidPose* poses, double dt, double pull,
                      __global uint* corrections, __global const double* x, __global double* v, __global double* x_star) {
    const int i = get_global_id(0);
    if (i >= count) return;
    double y[3];
    for (int a = 0; a < WEIR_DIM; ++a) {
        const size_t at = (size_t)a * stride + i;
        v[at] = forced(v[at], x[at], dt, pull, s, a);
        y[a] = x[at] + dt * v[at];
    }
    keep_and_count(y, s, poses, corrections);
    for (int a = 0; a < WEIR_DIM; ++a) x_star[(size_t)a * stride + i] = y[a];
}

/* The box of all particles: per group, lo and hi of every axis. A coordinate that is not finite makes its axis infinite. */
__kernel void range(int count, int stride, __global const double* x, __global double* parts) {
    __local double lo[WEIR_GROUP], hi[WEIR_GROUP];
    const int l = get_local_id(0);
    for (int a = 0; a < WEIR_DIM; ++a) {
        double low = INFINITY, high = -INFINITY;
        for (int i = get_global_id(0); i < count; i += get_global_size(0)) {
            const double here = x[(size_t)a * stride + i];
            low = isfinite(here) ? fmin(low, here) : -INFINITY;
            high = isfinite(here) ? fmax(high, here) : INFINITY;
            if (!isfinite(here)) break;
        }
        lo[l] = low;
        hi[l] = high;
        for (int span = WEIR_GROUP / 2; span > 0; span /= 2) {
            barrier(CLK_LOCAL_MEM_FENCE);
            if (l < span) {
                lo[l] = fmin(lo[l], lo[l + span]);
                hi[l] = fmax(hi[l], hi[l + span]);
            }
        }
        if (l == 0) {
            parts[get_group_id(0) * 2 * WEIR_DIM + 2 * a] = lo[0];
            parts[get_group_id(0) * 2 * WEIR_DIM + 2 * a + 1] = hi[0];
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

/* NaN is kept. */
WEIR_FN double larger(double a, double b) { return a > b || isnan(a) ? a : b; }

/* Per group: the largest value and the sum. Every item adds its own particles in the same order each time: sums are bitwise repeatable. */
WEIR_FN void reduce_parts(double largest, double sum, __local double* largests, __local double* sums, __global double* parts) {
    const int l = get_local_id(0);
    largests[l] = largest;
    sums[l] = sum;
    for (int span = WEIR_GROUP / 2; span > 0; span /= 2) {
        barrier(CLK_LOCAL_MEM_FENCE);
        if (l < span) {
            largests[l] = larger(largests[l], largests[l + span]);
            sums[l] += sums[l + span];
        }
    }
    if (l == 0) {
        parts[2 * get_group_id(0)] = largests[0];
        parts[2 * get_group_id(0) + 1] = sums[0];
    }
}

/* Squared speeds. 0 x turns a position that is not finite into a NaN speed: one pass finds both. */
__kernel void speeds(int count, int stride, __global const double* x, __global const double* v, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double largest = 0;
    for (int i = get_global_id(0); i < count; i += get_global_size(0)) {
        double square = 0;
        for (int a = 0; a < WEIR_DIM; ++a) {
            const size_t at = (size_t)a * stride + i;
            square += v[at] * v[at] + 0 * (v[at] * x[at]);
        }
        largest = larger(square, largest);
    }
    reduce_parts(largest, 0, largests, sums, parts);
}

/* Compression max(0, rho / rest - 1) of the state's densities. */
__kernel void compressions(int count, double rest, __global const int* order, __global const float* rests, __global const double* density,
                           __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double largest = 0, sum = 0;
    for (int k = get_global_id(0); k < count; k += get_global_size(0)) {
#ifdef WEIR_RESTS
        const double ratio = density[order[k]] / (rest * rests[k]) - 1, excess = ratio > 0 ? ratio : 0;
#else
        const double ratio = density[k] / rest - 1, excess = ratio > 0 ? ratio : 0;
#endif
        largest = larger(excess, largest);
        sum += excess;
    }
    reduce_parts(largest, sum, largests, sums, parts);
}

#ifdef WEIR_PERIOD
/* Wraps into the period. */
__kernel void wrap(int count, int stride, __constant StateParams* s, __global double* x) {
    const int i = get_global_id(0);
    if (i >= count) return;
    for (int a = 0; a < WEIR_DIM; ++a) {
        if (s->period[a] == 0) continue;
        const size_t at = (size_t)a * stride + i;
        x[at] -= s->period[a] * floor((x[at] - s->lo[a]) / s->period[a]);
    }
}
#endif

#ifdef WEIR_OPEN
/* 1 for remaining particles: those not beyond an open side. */
__kernel void find_what_stays(int count, int stride, __constant StateParams* s, __global const double* x, __global int* stays) {
    const int i = get_global_id(0);
    if (i >= count) return;
    int stay = 1;
    for (int a = 0; a < WEIR_DIM; ++a) {
        const double here = x[(size_t)a * stride + i];
        if (here < s->exit_lo[a] || here > s->exit_hi[a]) stay = 0;
    }
    stays[i] = stay;
}
#endif

#ifdef WEIR_SINKS
/* 1 for particles outside sinks. */
__kernel void find_what_is_in_no_sink(int count, int stride, __constant StateParams* s, __global const double* x, __global int* stays) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const double4 at = (double4)(x[i], x[(size_t)stride + i], WEIR_DIM == 3 ? x[(size_t)(WEIR_DIM - 1) * stride + i] : 0, 0);
    stays[i] = !in_a_sink(at);
}
#endif

#if defined(WEIR_OPEN) || defined(WEIR_SINKS)
/* Compacts the remaining particles, in their order; `before`: number of remaining particles before each one. */
__kernel void list_stayers(int count, __global const int* stays, __global const int* before, __global int* order) {
    const int i = get_global_id(0);
    if (i < count && stays[i]) order[before[i]] = i;
}
#endif

/* Rearranges the state: particle k is the former order[k]. */
__kernel void gather_numbers(int count, int stride, int axes, __global const int* order, __global const double* from, __global double* to) {
    const int k = get_global_id(0);
    if (k >= count) return;
    for (int a = 0; a < axes; ++a) to[(size_t)a * stride + k] = from[(size_t)a * stride + order[k]];
}
__kernel void gather_names(int count, __global const int* order, __global const int* from, __global int* to) {
    const int k = get_global_id(0);
    if (k < count) to[k] = from[order[k]];
}
