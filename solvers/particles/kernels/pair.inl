/* What every particle method shares: kernels as functions of the squared distance, and walls.
   A C subset over REAL (a scalar or a vector of lanes) and SCALAR: no references, templates or overloads. A prelude defines WEIR_FN,
   REAL, SCALAR, WEIR_PARAM (where parameters live), MAX0(x) = max(0, x), RSQRT(x) = 1 / sqrt(x) and FMA(a, b, c) = a b + c and FNMA(a, b, c) = c - a b, rounded once.
   No compiler may contract anything else: lanes and devices then compute the same bits. Factors such as sigma m / rho0 stand in the
   parameters, so the functions here are the bare profiles. A slope s means: gradient of W at i = s (x_i - x_j), s <= 0. */

/* Square of the distance, and what keeps coincident particles finite: what the kernels here are functions of. */
WEIR_FN REAL distance2(REAL dx, REAL dy, REAL dz, SCALAR guard) { return FMA(dz, dz, FMA(dy, dy, FMA(dx, dx, guard))); }
/* Inner product of the vectors a and b */
WEIR_FN REAL dot3(REAL ax, REAL ay, REAL az, REAL bx, REAL by, REAL bz) { return FMA(az, bz, FMA(ay, by, ax * bx)); }

/* poly6: (h^2 - r^2)^3                                                                            Mueller et al. 2003, eq. 20 */
WEIR_FN REAL poly6(REAL r2, SCALAR h2) {
    REAL d = MAX0(h2 - r2);
    return d * d * d;
}

/* spiky, slope of (h - r)^3 without its factor -3: (h - r)^2 / r                                  Mueller et al. 2003, eq. 21 */
WEIR_FN REAL spiky_slope(REAL r2, SCALAR h) {
    REAL inv_r = RSQRT(r2);
    REAL d = MAX0(FNMA(r2, inv_r, h));
    return d * d * inv_r;
}

/* viscosity kernel: Laplacian h - r                                                               Mueller et al. 2003, eq. 22 */
WEIR_FN REAL linear_laplacian(REAL r2, SCALAR h) { return MAX0(FNMA(r2, RSQRT(r2), h)); }

/* cubic spline as truncated powers: (h - r)^3 - 4 (h/2 - r)^3, and its slope without -3. near is the second one's base times 4^(1/3). */
WEIR_FN REAL cubic(REAL r2, SCALAR h) {
    REAL inv_r = RSQRT(r2);
    REAL outer = MAX0(FNMA(r2, inv_r, h)), near = MAX0(FMA(outer, (SCALAR)1.5874010519681994, h * (SCALAR)-0.7937005259840998));
    return FNMA(near * near, near, outer * outer * outer);
}
WEIR_FN REAL cubic_slope(REAL r2, SCALAR h) {
    REAL inv_r = RSQRT(r2);
    REAL outer = MAX0(FNMA(r2, inv_r, h)), near = MAX0(FMA(outer, (SCALAR)1.5874010519681994, h * (SCALAR)-0.7937005259840998));
    return FNMA(near * near, (SCALAR)1.5874010519681994, outer * outer) * inv_r;
}

/* Wendland C2: (h - r)^4 (h + 4 r), and its slope without -20: (h - r)^3 */
WEIR_FN REAL wendland(REAL r2, SCALAR h) {
    REAL r = r2 * RSQRT(r2);
    REAL d = MAX0(h - r);
    return d * d * d * d * FMA(r, (SCALAR)4, h);
}
WEIR_FN REAL wendland_slope(REAL r2, SCALAR h) {
    REAL d = MAX0(FNMA(r2, RSQRT(r2), h));
    return d * d * d;
}

/* Penetration of the kernel into a wall at distance s, relative to its support; 0 beyond it. */
WEIR_FN REAL wall_depth(REAL s, SCALAR inv_h) { return MAX0(FNMA(s, inv_h, (SCALAR)1)); }

/* A function of the distance s to a wall that vanishes beyond the support: u^2 sum_k c_k T_k(2 u - 1), u = 1 - s / h (Clenshaw 1955). */
WEIR_FN REAL wall_series(REAL s, WEIR_PARAM SCALAR* c, SCALAR inv_h) {
    REAL u = wall_depth(s, inv_h);
    REAL t = (SCALAR)2 * u - (SCALAR)1;
    REAL b1 = t * (SCALAR)0, b2 = b1;
    int k;
    for (k = WEIR_WALL_TERMS - 1; k > 0; --k) {
        REAL b0 = FMA(t + t, b1, c[k] - b2);
        b2 = b1;
        b1 = b0;
    }
    return u * u * FMA(t, b1, c[0] - b2);
}

/* Along one axis: the part of the kernel behind the two walls, and the gradient of that part along the axis. It points to the wall, as
   the gradient of the density of real particles there would. */
WEIR_FN REAL wall_part(REAL x, WEIR_PARAM WallParams* w, int axis) {
    return wall_series(x - w->lo[axis], w->fraction, w->inv_h) + wall_series(w->hi[axis] - x, w->fraction, w->inv_h);
}
WEIR_FN REAL wall_pull(REAL x, WEIR_PARAM WallParams* w, int axis) {
    return wall_series(w->hi[axis] - x, w->slope, w->inv_h) - wall_series(x - w->lo[axis], w->slope, w->inv_h);
}

/* The difference of the two walls' parts, upper minus lower: its sign gives the closer wall. Zero where the orientation of solids is
   ignored. */
WEIR_FN REAL wall_lean(REAL x, WEIR_PARAM WallParams* w, int axis) {
    return (wall_series(w->hi[axis] - x, w->fraction, w->inv_h) - wall_series(x - w->lo[axis], w->fraction, w->inv_h)) * w->facing;
}
WEIR_FN REAL wall_steep(REAL x, WEIR_PARAM WallParams* w, int axis) {
    return (wall_series(w->hi[axis] - x, w->slope, w->inv_h) + wall_series(x - w->lo[axis], w->slope, w->inv_h)) * w->facing;
}

/* The fraction of a solid's part that the walls along one axis leave. Two half-spaces have a common part of the kernel. Relative to the
   product of their parts it is twice as large for equal orientation, equal at right angles, and zero for opposite orientation, as for a
   floor and a body close above it: 1 + cos of the angle between the normals. Exact for these three where the particle touches both.
   Without lean: the product, for any orientation.
   way: the direction into the solid along the axis. */
WEIR_FN REAL wall_leaves(REAL part, REAL lean, REAL way) { return MAX0((SCALAR)1 - part - way * lean); }
/* One over the length of a solid's gradient */
WEIR_FN REAL solid_way(const REAL* solid) {
    return RSQRT(dot3(solid[0], solid[1], solid[2], solid[0], solid[1], solid[2]) + (SCALAR)1e-30);
}
/* The fraction that all walls leave */
WEIR_FN REAL walls_leave(const REAL* part, const REAL* lean, const REAL* solid) {
    REAL way = solid_way(solid);
    return wall_leaves(part[0], lean[0], solid[0] * way) * wall_leaves(part[1], lean[1], solid[1] * way) *
           wall_leaves(part[2], lean[2], solid[2] * way);
}

/* Terms of walls and solids at one particle: out[3] is their part of the kernel, out[0..2] its gradient. The parts of several walls
   combine as 1 - product (1 - part): exact for one plane; at edges and corners exact for kernels that are products of their marginals.
   The fraction of a solid that walls leave is added.
   part, lean, pull, steep: of the walls along each axis. solid: gradient x, y, z and part of the solids. */
WEIR_FN void walls_combined(const REAL* part, const REAL* lean, const REAL* pull, const REAL* steep, const REAL* solid, REAL* out) {
    REAL open_x = (SCALAR)1 - part[0], open_y = (SCALAR)1 - part[1], open_z = (SCALAR)1 - part[2], open_solid = (SCALAR)1 - solid[3];
    REAL open = open_x * open_y * open_z;
    REAL way = solid_way(solid), x = solid[0] * way, y = solid[1] * way, z = solid[2] * way;
    REAL left_x = wall_leaves(part[0], lean[0], x), left_y = wall_leaves(part[1], lean[1], y), left_z = wall_leaves(part[2], lean[2], z);
    REAL left = left_x * left_y * left_z;
    /* the last term of each is 0 where a solid is perpendicular to the walls */
    out[0] = pull[0] * open_y * open_z * open_solid + left * solid[0] +
             solid[3] * (pull[0] * (open_y * open_z - left_y * left_z) - x * steep[0] * left_y * left_z);
    out[1] = open_x * pull[1] * open_z * open_solid + left * solid[1] +
             solid[3] * (pull[1] * (open_x * open_z - left_x * left_z) - y * steep[1] * left_x * left_z);
    out[2] = open_x * open_y * pull[2] * open_solid + left * solid[2] +
             solid[3] * (pull[2] * (open_x * open_y - left_x * left_y) - z * steep[2] * left_x * left_y);
    out[3] = (SCALAR)1 - open * open_solid + solid[3] * (left - open);
}
