/* Terms of solids at nearby particles (density maps, Koschier & Bender 2017; particles/boundaries/solid_terms.cpp): for each sorted particle the
   gradient and the part of the kernel inside them. Only particles that start the step near a solid are processed again. */
WEIR_FN double4 world_of(float4 at, __constant StateParams* s) {
    return (double4)(at.x + s->centre[0], at.y + s->centre[1], WEIR_DIM == 3 ? at.z + s->centre[2] : 0, 0);
}

/* wall_series of pair.inl in double precision: bitwise equal to the threads. */
WEIR_FN double solid_series(double s, __constant double* c, double inv_h) {
    const double u = fmax(1 - s * inv_h, 0.0), t = 2 * u - 1;
    double b1 = 0, b2 = 0;
    for (int k = WEIR_WALL_TERMS - 1; k > 0; --k) {
        const double b0 = (t + t) * b1 + (c[k] - b2);
        b2 = b1;
        b1 = b0;
    }
    return u * u * (t * b1 + (c[0] - b2));
}

WEIR_FN float4 term_of_solids(double4 x, __constant StateParams* s, __constant SolidSeries* series, __global const SolidPose* poses) {
    const double phi = fmax(0.0, solids_distance(x, poses));
    if (phi * series->inv_h >= 1) return (float4)(0);
    const double4 n = solids_normal(x, s->feel, poses);
    const double pull = solid_series(phi, series->slope, series->inv_h);
    float4 term = (float4)((float)(-pull * n.x), (float)(-pull * n.y), 0.0f, (float)solid_series(phi, series->fraction, series->inv_h));
#if WEIR_DIM == 3
    term.z = (float)(-pull * n.z);
#endif
    return term;
}

__kernel void meet_solids(int count, __constant StateParams* s, __constant SolidSeries* series, __global const SolidPose* poses,
                          __global const float4* at, __global uchar* near_solid, __global float4* terms) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const double4 x = world_of(at[k], s);
    const int close = solids_distance(x, poses) < s->reach;
    near_solid[k] = close;
    terms[k] = close ? term_of_solids(x, s, series, poses) : (float4)(0);
}

/* After a correction: moves particles out of solids and computes the terms there. */
__kernel void leave_solids(int count, __constant StateParams* s, __constant SolidSeries* series, __global const SolidPose* poses,
                           __global uint* corrections, __global float4* at, __global const uchar* near_solid, __global float4* terms) {
    const int k = get_global_id(0);
    if (k >= count || !near_solid[k]) return;
    double4 x = world_of(at[k], s);
    if (solids_distance(x, poses) < s->margin) {
        double y[3] = {x.x, x.y, x.z};
        keep_and_count(y, s, poses, corrections);
        float4 here = at[k];
        here.x = (float)(y[0] - s->centre[0]);
        here.y = (float)(y[1] - s->centre[1]);
#if WEIR_DIM == 3
        here.z = (float)(y[2] - s->centre[2]);
#endif
        at[k] = here;
        x = world_of(here, s);
    }
    terms[k] = term_of_solids(x, s, series, poses);
}

/* After solids or some particles have moved again. */
__kernel void renew_terms(int count, __constant StateParams* s, __constant SolidSeries* series, __global const SolidPose* poses,
                          __global const float4* at, __global const uchar* near_solid, __global float4* terms) {
    const int k = get_global_id(0);
    if (k < count && near_solid[k]) terms[k] = term_of_solids(world_of(at[k], s), s, series, poses);
}
