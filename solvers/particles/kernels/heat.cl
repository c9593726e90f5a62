/* The passes of heat: heat_pair.inl over every particle's neighbours, terms in single precision and sums in double. */

/* theta as the fourth number of sorted positions. */
__kernel void load_theta(int count, __constant HeatStates* s, __global const int* order, __global const double* enthalpy,
                         __global const double* shift, __global float4* at) {
    const int k = get_global_id(0);
    if (k >= count) return;
#ifdef WEIR_VAPOUR
    at[k].w = (float)heat_theta_at(heat_temperature(enthalpy[order[k]], shift[order[k]], s), s);
#else
    at[k].w = (float)heat_theta(enthalpy[order[k]], 0, s);
#endif
}

WEIR_FN float heat_height(const float* x, int plane, __constant HeatWalls* w) {
    const int axis = plane / 2;
    return heat_above(plane % 2 ? w->hi[axis] - x[axis] : x[axis] - w->lo[axis], w);
}

/* dh/dt of every particle. Beyond a wall lies the liquid's image: with equal theta at an insulated wall, mirrored about theta of a wall
   of fixed temperature. Image m lies behind the planes named by the base-3 digits of m, one per axis. */
__kernel void conduct(int count, int stride, __constant HeatParams* p, __constant HeatWalls* walls, __global const float4* at,
                      __global const int* neighbours, __global const int* list, __global double* to, __global double* by_walls) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i];
    const float x[3] = {me.x, me.y, me.z};
    float height[6], theta[26];
    int near[26], held[26], images = 0;
    for (int plane = 0; plane < 6; ++plane) height[plane] = heat_height(x, plane, walls);
    for (int m = 1; m < 27; ++m) {
        int rest = m, within = 1, odd = 0;
        float held_at = 0;
        for (int a = 0; a < 3; ++a, rest /= 3) {
            if (rest % 3 == 0) continue;
            const int upper = rest % 3 == 2, one = upper ? walls->hi_held[a] : walls->lo_held[a];
            within = within && height[2 * a + upper] < p->h;
            if (one && !odd) held_at = upper ? walls->hi_theta[a] : walls->lo_theta[a];
            odd = odd != one;
        }
        if (within) near[images] = m, held[images] = odd, theta[images++] = held_at;
    }
    double sum = 0, of_walls = 0;
    for (int m = 0; m < images; ++m) {
        if (!held[m]) continue;
        float r2 = p->guard; /* from a particle to its own image */
        for (int a = 0, rest = near[m]; a < 3; ++a, rest /= 3)
            if (rest % 3) r2 = heat_behind(r2, height[2 * a + rest % 3 - 1], height[2 * a + rest % 3 - 1]);
        of_walls += (double)heat_flow(r2, 2 * (theta[m] - me.w), p);
    }
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const float4 other = at[list[(size_t)k * stride + i]], d = APART(me, other);
        const float y[3] = {other.x, other.y, other.z};
        const float r2 = DISTANCE2(d, p), rise = other.w - me.w;
        float flow = heat_flow(r2, rise, p); /* antisymmetric, also for images, since each image has its counterpart */
        for (int m = 0; m < images; ++m) {
            float behind = r2;
            for (int a = 0, rest = near[m]; a < 3; ++a, rest /= 3)
                if (rest % 3) behind = heat_behind(behind, height[2 * a + rest % 3 - 1], heat_height(y, 2 * a + rest % 3 - 1, walls));
            if (held[m])
                of_walls += (double)heat_flow(behind, 2 * theta[m] - (other.w + me.w), p);
            else
                flow += heat_flow(behind, rise, p);
        }
        sum += (double)flow;
    }
    to[i] = sum + of_walls;
    by_walls[i] = of_walls;
}

__kernel void warm(int count, double dt, __global const int* order, __global const double* warming, __global double* enthalpy) {
    const int k = get_global_id(0);
    if (k < count) enthalpy[order[k]] += dt * warming[k];
}

WEIR_FN int is_frozen(double h, __constant HeatStates* s) { return heat_melted(h, s) < 0.5; }

__kernel void count_frozen(int count, __constant HeatStates* s, __global const double* enthalpy, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double sum = 0;
    for (int i = get_global_id(0); i < count; i += get_global_size(0)) sum += is_frozen(enthalpy[i], s);
    reduce_parts(0, sum, largests, sums, parts);
}

/* Frozen particles do not move. */
__kernel void stop_frozen(int count, int stride, __constant HeatStates* s, __global const double* enthalpy, __global double* v) {
    const int i = get_global_id(0);
    if (i >= count || !is_frozen(enthalpy[i], s)) return;
    for (int a = 0; a < WEIR_DIM; ++a) v[(size_t)a * stride + i] = 0;
}
__kernel void keep_frozen_prediction(int count, int stride, __constant HeatStates* s, __global const double* enthalpy, __global const double* x,
                              __global double* x_star) {
    const int i = get_global_id(0);
    if (i >= count || !is_frozen(enthalpy[i], s)) return;
    for (int a = 0; a < WEIR_DIM; ++a) x_star[(size_t)a * stride + i] = x[(size_t)a * stride + i];
}
__kernel void keep_frozen_positions(int count, int stride, __constant StateParams* p, __constant HeatStates* s, __global const int* order,
                          __global const double* enthalpy, __global const double* x, __global float4* at) {
    const int k = get_global_id(0);
    if (k >= count || !is_frozen(enthalpy[order[k]], s)) return;
    const int i = order[k];
    at[k].x = (float)(x[i] - p->centre[0]);
    at[k].y = (float)(x[(size_t)stride + i] - p->centre[1]);
#if WEIR_DIM == 3
    at[k].z = (float)(x[(size_t)2 * stride + i] - p->centre[2]);
#endif
}

/* Largest and sum. */
__kernel void sum_numbers(int count, __global const double* numbers, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double largest = -INFINITY, sum = 0;
    for (int k = get_global_id(0); k < count; k += get_global_size(0)) {
        largest = larger(numbers[k], largest);
        sum += numbers[k];
    }
    reduce_parts(largest, sum, largests, sums, parts);
}

#ifdef WEIR_HEATERS
WEIR_FN double4 place_of(int i, int stride, __global const double* x) {
    return (double4)(x[i], x[(size_t)stride + i], WEIR_DIM == 3 ? x[(size_t)(WEIR_DIM - 1) * stride + i] : 0, 0);
}
__kernel void count_in_heater(int count, int stride, int which, __global const double* x, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double sum = 0;
    for (int i = get_global_id(0); i < count; i += get_global_size(0)) sum += in_heater(which, place_of(i, stride, x));
    reduce_parts(0, sum, largests, sums, parts);
}
__kernel void feed_heater(int count, int stride, int which, double each, __global const double* x, __global double* enthalpy) {
    const int i = get_global_id(0);
    if (i < count && in_heater(which, place_of(i, stride, x))) enthalpy[i] += each;
}
#endif

/* A particle's share of the flux through an area, over its volume: over a distance of two spacings (Heat::weight). */
WEIR_FN double flux_weight(double x, double plane, double sign, double spacing) {
    const double part = 1 - sign * (x - plane) / (2 * spacing);
    return part > 0 ? part / spacing : 0;
}
__kernel void count_at_wall(int count, int stride, int axis, double plane, double sign, double spacing, __global const double* x,
                            __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double sum = 0;
    for (int i = get_global_id(0); i < count; i += get_global_size(0))
        sum += flux_weight(x[(size_t)axis * stride + i], plane, sign, spacing);
    reduce_parts(0, sum, largests, sums, parts);
}
__kernel void feed_wall(int count, int stride, int axis, double plane, double sign, double spacing, double each, __global const double* x,
                        __global double* enthalpy) {
    const int i = get_global_id(0);
    if (i < count) enthalpy[i] += each * flux_weight(x[(size_t)axis * stride + i], plane, sign, spacing);
}

/* Heat from outside through a wall (Heat::exchange), and its amount for each particle [J/kg]. */
__kernel void exchange_at_wall(int count, int stride, __constant HeatStates* s, int axis, double plane, double sign, double spacing,
                               double coefficient, double outside, double part, __global const double* x, __global const double* shift,
                               __global double* enthalpy, __global double* given) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const double at = x[(size_t)axis * stride + i], share = flux_weight(at, plane, sign, spacing);
    given[i] = 0;
    if (share == 0) return;
#ifdef WEIR_VAPOUR
    const double deeper = shift[i];
#else
    const double deeper = 0;
#endif
    given[i] = part * share * heat_exchanged(enthalpy[i], deeper, sign * (at - plane), outside, coefficient, spacing, s);
    enthalpy[i] += given[i];
}

/* Rest densities of sorted particles relative to the liquid's, with moving ice. */
__kernel void rests_of_ice(int count, __constant HeatStates* s, __global const int* order, __global const double* enthalpy,
                           __global float* rests) {
    const int k = get_global_id(0);
    if (k < count) rests[k] = (float)heat_rest(enthalpy[order[k]], s);
}
