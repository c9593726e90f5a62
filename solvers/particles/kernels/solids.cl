/* The solids of a scene as in geometry/solids.cpp: solid_at_rest(k, x), the distance to solid k at its initial position, is generated
   from the scene; WEIR_SOLIDS is their number, and their poses give their present positions. */
WEIR_FN double4 place_in_rest(double4 world, __global const SolidPose* p) {
    const double4 centre = (double4)(p->centre[0], p->centre[1], p->centre[2], 0);
    const double4 y = world - (double4)(p->offset[0], p->offset[1], p->offset[2], 0) - centre;
    double4 x = centre + y.x * (double4)(p->rotation[0], p->rotation[1], p->rotation[2], 0);
    x += y.y * (double4)(p->rotation[3], p->rotation[4], p->rotation[5], 0);
#if WEIR_DIM == 3
    x += y.z * (double4)(p->rotation[6], p->rotation[7], p->rotation[8], 0);
#endif
    return x;
}

WEIR_FN double solids_distance(double4 x, __global const SolidPose* poses) {
    double d = INFINITY;
    for (int k = 0; k < WEIR_SOLIDS; ++k) d = fmin(d, solid_at_rest(k, place_in_rest(x, poses + k)));
    return d;
}
WEIR_FN int nearest_solid(double4 x, __global const SolidPose* poses) {
    double d = INFINITY;
    int best = 0;
    for (int k = 0; k < WEIR_SOLIDS; ++k) {
        const double here = solid_at_rest(k, place_in_rest(x, poses + k));
        best = here < d ? k : best;
        d = fmin(d, here);
    }
    return best;
}

/* Normal by central differences over +- eps. */
WEIR_FN double4 solids_normal(double4 x, double eps, __global const SolidPose* poses) {
    const double4 dx = (double4)(eps, 0, 0, 0), dy = (double4)(0, eps, 0, 0);
    double4 n = (double4)(0);
    n.x = solids_distance(x + dx, poses) - solids_distance(x - dx, poses);
    n.y = solids_distance(x + dy, poses) - solids_distance(x - dy, poses);
#if WEIR_DIM == 3
    const double4 dz = (double4)(0, 0, eps, 0);
    n.z = solids_distance(x + dz, poses) - solids_distance(x - dz, poses);
    const double4 none = dz / eps;
#else
    const double4 none = dy / eps;
#endif
    const double length_of = norm_of(n);
    return length_of > 0 ? n / length_of : none;
}

/* x, or the closest point at distance `margin` outside when x is closer than that. */
WEIR_FN double4 pushed_out(double4 x, double margin, double eps, __global const SolidPose* poses) {
    for (int newton = 0; newton < 2; ++newton) {
        const double d = solids_distance(x, poses);
        if (d >= margin) break;
        x += (margin - d) * solids_normal(x, eps, poses);
    }
    return x;
}

WEIR_FN double4 solid_velocity(double4 world, __global const SolidPose* p) {
    const double4 y = world - (double4)(p->centre[0], p->centre[1], p->centre[2], 0) - (double4)(p->offset[0], p->offset[1], p->offset[2], 0);
    double4 v = (double4)(p->velocity[0], p->velocity[1], p->velocity[2], 0);
#if WEIR_DIM == 3
    v.x += p->spin[1] * y.z - p->spin[2] * y.y;
    v.y += p->spin[2] * y.x - p->spin[0] * y.z;
    v.z += p->spin[0] * y.y - p->spin[1] * y.x;
#else
    v.x -= p->spin[2] * y.y;
    v.y += p->spin[2] * y.x;
#endif
    return v;
}
