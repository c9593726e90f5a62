/* The passes of Position Based Fluids (Macklin & Mueller 2013): pbf_pair.inl over every particle's neighbours. Positions are float4 with
   lambda as their fourth number. The lambda pass reads A and writes B, the correction reads B and writes A. */

/* Rest density of a particle (pbf_passes.inl). */
#ifdef WEIR_RESTS
#define REST(k) rests[k]
#else
#define REST(k) 1.0f
#endif

#ifdef WEIR_KEEP
/* B = A with the initial values of the iterations; factor: the kept fraction times dt^2. */
__kernel void start_multipliers(int count, double factor, __global const int* order, __global const double* carried,
                                __global const float4* a, __global float4* b, __global float* multiplier) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const float before = (float)(factor * carried[order[k]]);
    multiplier[k] = before;
    float4 p = a[k];
    p.w = before;
    b[k] = p;
}
#endif

__kernel void lambda(int count, int stride, __constant PbfParams* p, __constant WallParams* walls, __global const float4* terms,
                     __global const float* rests, __global const float4* from, __global const int* neighbours, __global const int* list, __global float4* to,
                     __global float* density, __global float* multiplier) {
    const int i = get_global_id(0);
    if (i >= count) return;
    float4 me = from[i];
    float rho = p->self, neighbours2 = 0, gx = 0, gy = 0, gz = 0;
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const float4 d = APART(me, from[list[(size_t)k * stride + i]]);
        const float r2 = DISTANCE2(d, p);
        const float slope = pbf_slope(r2, p);
        rho = pbf_add_density(rho, r2, p);
        neighbours2 = FMA(slope * slope, r2, neighbours2);
        gx = FMA(slope, d.x, gx);
        gy = FMA(slope, d.y, gy);
        gz = FMA(slope, d.z, gz);
    }
    const float4 w = walls_at(me, walls, terms, i);
    const float rest = REST(i);
    rho += w.w * rest;
    gx += w.x * rest;
    gy += w.y * rest;
    gz += w.z * rest;
    const float own2 = dot3(gx, gy, gz, gx, gy, gz);
#ifdef WEIR_KEEP
    const float before = multiplier[i];
#else
    const float before = 0;
#endif
    const float sum = pbf_multiplier(before, rho + (1 - rest), neighbours2, own2, p);
#ifdef WEIR_KEEP
    multiplier[i] = sum;
#endif
    me.w = sum - before;
    to[i] = me;
    density[i] = rho;
}

__kernel void correct(int count, int stride, __constant StateParams* s, __constant PbfParams* p, __constant WallParams* walls,
                      __global const float4* terms, __global const float* rests, __global uint* corrections, __global const float4* from, __global const int* neighbours, __global const int* list, __global float4* to) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = from[i];
    float cx = 0, cy = 0, cz = 0;
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const float4 other = from[list[(size_t)k * stride + i]], d = APART(me, other);
#ifdef WEIR_PRESSURE
        const float factor = pbf_correction_with_pressure(DISTANCE2(d, p), me.w + other.w, p);
#else
        const float factor = pbf_correction(DISTANCE2(d, p), me.w + other.w, p);
#endif
        cx = FMA(factor, d.x, cx);
        cy = FMA(factor, d.y, cy);
        cz = FMA(factor, d.z, cz);
    }
    const float4 w = walls_at(me, walls, terms, i);
    const float push = me.w * REST(i);
    const float4 free = (float4)(me.x + FMA(push, w.x, cx), me.y + FMA(push, w.y, cy), me.z + FMA(push, w.z, cz), 0.0f);
    const float4 inside =
        (float4)(clamp(free.x, walls->keep_lo[0], walls->keep_hi[0]), clamp(free.y, walls->keep_lo[1], walls->keep_hi[1]),
                 clamp(free.z, walls->keep_lo[2], walls->keep_hi[2]), 0.0f);
    const float4 back = inside - free;
    count_correction(dot3(back.x, back.y, back.z, back.x, back.y, back.z), s, corrections);
    to[i] = inside;
}

/* Density relative to rest density of a liquid at the final positions. */
__kernel void densities(int count, int stride, __constant PbfParams* p, __constant WallParams* walls, __global const float4* terms,
                        __global const float* rests, __global const float4* at, __global const int* neighbours, __global const int* list, __global float* density) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i];
    float rho = p->self;
    const int n = neighbours[i];
    for (int k = 0; k < n; ++k) {
        const float4 d = APART(me, at[list[(size_t)k * stride + i]]);
        rho = pbf_add_density(rho, DISTANCE2(d, p), p);
    }
    density[i] = rho + walls_at(me, walls, terms, i).w * REST(i);
}

/* Compression of sorted particles, of each group (reduce_parts). */
__kernel void pbf_compressions(int count, __global const float* rests, __global const float* density, __global double* parts) {
    __local double largests[WEIR_GROUP], sums[WEIR_GROUP];
    double largest = 0, sum = 0;
    for (int k = get_global_id(0); k < count; k += get_global_size(0)) {
        const double excess = fmax((double)density[k] / REST(k) - 1, 0.0);
        largest = larger(excess, largest);
        sum += excess;
    }
    reduce_parts(largest, sum, largests, sums, parts);
}

/* v = (x* - x) / dt, x = x*; with dt = 0 only the latter. The move that the iterations made in single precision is added to the prediction in
   double precision, so that rounding does not depend on how far a particle is from the origin.                            lines 20-24
   slow: the longer of this step and the last; what the iterations moved becomes speed over that (solvers/pbf/solver.cpp). */
__kernel void update(int count, int stride, __constant StateParams* s, __global const SolidPose* poses, double dt, double slow, double rho0,
                     __global const int* order, __global const float4* now, __global const double* x_star, __global const float* density,
                     __global const float* multiplier, __global double* x, __global double* v, __global double* state_density,
                     __global double* carried) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = order[k];
    const float4 p = now[k];
    const float place[3] = {p.x, p.y, p.z};
    const double too_fast = dt > 0 ? 1 / dt - 1 / slow : 0;
    double y[3];
    for (int a = 0; a < WEIR_DIM; ++a) {
        const double start = x_star[(size_t)a * stride + i];
        y[a] = start + ((double)place[a] - (double)(float)(start - s->centre[a]));
    }
    keep(y, s, poses);
    for (int a = 0; a < WEIR_DIM; ++a) {
        const size_t at = (size_t)a * stride + i;
        if (dt > 0) v[at] = (y[a] - x[at]) / dt - too_fast * (y[a] - x_star[at]);
        x[at] = y[a];
    }
    state_density[i] = rho0 * (double)density[k];
#ifdef WEIR_KEEP
    if (dt > 0) carried[i] = (double)multiplier[k] / (slow * slow);
#endif
}
