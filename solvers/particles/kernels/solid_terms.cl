/* What solids add at the particles near them (density maps, Koschier & Bender 2017; particles/solid_terms.cpp): of each sorted particle the
   gradient and the part of the kernel inside them. Only particles that start the step near a solid are looked at again. */
WEIR_FN double4 world_of(float4 at, __constant StateParams* s) {
    return (double4)(at.x + s->centre[0], at.y + s->centre[1], WEIR_DIM == 3 ? at.z + s->centre[2] : 0, 0);
}

WEIR_FN float4 term_of_solids(double4 x, __constant StateParams* s, __constant WallParams* walls, __global const SolidPose* poses) {
    const float phi = (float)fmax(0.0, solids_distance(x, poses));
    if (phi * walls->inv_h >= 1) return (float4)(0);
    const float pull = wall_series(phi, walls->slope, walls->inv_h), part = wall_series(phi, walls->fraction, walls->inv_h);
    const double4 n = solids_normal(x, s->feel, poses);
    return (float4)(-pull * (float)n.x, -pull * (float)n.y, -pull * (float)n.z, part);
}

__kernel void meet_solids(int count, __constant StateParams* s, __constant WallParams* walls, __global const SolidPose* poses,
                          __global const float4* at, __global uchar* near_solid, __global float4* terms) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const double4 x = world_of(at[k], s);
    const int close = solids_distance(x, poses) < s->reach;
    near_solid[k] = close;
    terms[k] = close ? term_of_solids(x, s, walls, poses) : (float4)(0);
}

/* After a correction: out of solids, and the terms there. */
__kernel void leave_solids(int count, __constant StateParams* s, __constant WallParams* walls, __global const SolidPose* poses,
                           __global uint* clamps, __global float4* at, __global const uchar* near_solid, __global float4* terms) {
    const int k = get_global_id(0);
    if (k >= count || !near_solid[k]) return;
    double4 x = world_of(at[k], s);
    if (solids_distance(x, poses) < s->margin) {
        double y[3] = {x.x, x.y, x.z};
        keep_and_count(y, s, poses, clamps);
        float4 here = at[k];
        here.x = (float)(y[0] - s->centre[0]);
        here.y = (float)(y[1] - s->centre[1]);
#if WEIR_DIM == 3
        here.z = (float)(y[2] - s->centre[2]);
#endif
        at[k] = here;
        x = world_of(here, s);
    }
    terms[k] = term_of_solids(x, s, walls, poses);
}
