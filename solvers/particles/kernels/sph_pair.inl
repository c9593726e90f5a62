/* Smoothed particle hydrodynamics (Mueller, Charypar & Gross 2003): the contribution of one pair. See pair.inl for the language. All
   pair terms are antisymmetric in i and j, so momentum is conserved to round-off. */

/* sum + m W(r)                                                                                          Mueller et al. 2003, eq. 3 */
WEIR_FN REAL sph_add_density(REAL sum, REAL r2, WEIR_PARAM SphParams* p) { return FMA(WEIR_DENSITY(r2, p), p->density, sum); }

/* Continuity: the rate of rho_i over rho_i, m / rho_j (v_i - v_j).grad W                           Colagrossi & Landrini 2003, eq. 10
   approach: (v_i - v_j).(x_i - x_j); volume: 1 / rho_j */
WEIR_FN REAL sph_rate(REAL r2, REAL approach, REAL volume, WEIR_PARAM SphParams* p) {
    return p->gradient * WEIR_SLOPE(r2, p) * approach * volume;
}

/* Diffusion of density (delta-SPH): 2 delta h c (rho_j - rho_i) (x_j - x_i).grad W / r^2 m / rho_j  Molteni & Colagrossi 2009, eq. 18
   excess: rho_j - rho_i less the difference that the liquid has at rest, so that rest is left alone    Fourtakas et al. 2019, eq. 21 */
WEIR_FN REAL sph_diffusion(REAL r2, REAL excess, REAL volume, WEIR_PARAM SphParams* p) {
    return -p->diffusion * p->gradient * WEIR_SLOPE(r2, p) * excess * volume;
}

/* Difference of the hydrostatic densities at j and i */
WEIR_FN REAL sph_layers(REAL dx, REAL dy, REAL dz, WEIR_PARAM SphParams* p) {
    return FMA(dz, p->layers[2], FMA(dy, p->layers[1], dx * p->layers[0]));
}

/* Acceleration along x_i - x_j: -m ((p_i + p_j) / (rho_i rho_j) + Pi) s, grad W = s (x_i - x_j)              eq. 10 over rho_i
   without the 1/2 of eq. 10, under which a linear pressure would have half its gradient (Colagrossi & Landrini 2003, eq. 12)
   Pi = -alpha c h mu / rho, mu = v.x / (r^2 + eta^2) for approaching pairs                     artificial viscosity, Monaghan 1992
   pressures: (p_i + p_j) / (rho_i rho_j), or of a density that is summed p_i / rho_i^2 + p_j / rho_j^2, and Pi where the scene names it;
   approach: (v_i - v_j).(x_i - x_j); volume: the mean of 1 / rho */
WEIR_FN REAL sph_add_artificial(REAL pressures, REAL r2, REAL approach, REAL volume, WEIR_PARAM SphParams* p) {
    REAL closing = MAX0(-approach) / (r2 + p->soften);
    return FMA(p->artificial * closing, volume, pressures);
}
WEIR_FN REAL sph_push(REAL r2, REAL pressures, WEIR_PARAM SphParams* p) { return -pressures * p->gradient * WEIR_SLOPE(r2, p); }

/* Acceleration along v_j - v_i: mu m lap W / (rho_i rho_j)                                                  eq. 14 over rho_i
   For the cubic and the Wendland kernel the Laplacian is -2 times the slope (Morris, Fox & Zhu 1997, eq. 22). */
WEIR_FN REAL sph_drag(REAL r2, REAL volumes, WEIR_PARAM SphParams* p) {
    return p->viscosity * volumes * p->laplacian * WEIR_LAPLACIAN(r2, p);
}

/* Gradient of the colour, which is 1 in liquid and 0 outside: m / rho_j grad W = factor (x_i - x_j)          Mueller et al. 2003, eq. 15 */
WEIR_FN REAL sph_colour(REAL r2, REAL volume, WEIR_PARAM SphParams* p) { return p->gradient * WEIR_SLOPE(r2, p) * volume; }

/* Surface tension as the stress sigma k (|n| 1 - n n / |n|) of the colour gradient n (Lafaurie et al. 1994, in SPH Hu & Adams 2006):
   unlike sigma kappa n it is a pair force, equal and opposite. Tensile stress makes particles clump where the attraction decreases with
   distance (Swegle, Hicks & Attaway 1995). The pair sum therefore uses a slope of its own, 1 - (r/h)^4, whose force increases up to r =
   0.67 h. k (sph/options.cpp) compensates the part of n and of that slope that a surface cuts off. The normal is stored as q = n / sqrt
   |n|, so the stress on x is sigma k (q.q x - q q.x). */
WEIR_FN REAL sph_normal(REAL length2, WEIR_PARAM SphParams* p) {
    REAL per_length = RSQRT(length2 + p->noise * p->noise * (SCALAR)1e-6);
    REAL length = length2 * per_length;
    REAL seen = MAX0(length - p->noise * p->noise * per_length);
    return seen * RSQRT(length * seen * length + p->noise * p->noise * p->noise * (SCALAR)1e-9);
}
WEIR_FN REAL sph_tension(REAL r2, REAL volumes, WEIR_PARAM SphParams* p) { return -p->tension * volumes * MAX0(p->h2 - r2) * (p->h2 + r2); }

/* Acceleration by walls besides the particle's own pressure (which has no gradient through them):
    - the pressure behind a wall is extrapolated as p_i + rho0 g.(x - x_i) (Adami, Hu & Adams 2012, eq. 27); the first moment of grad W
      over the region behind a plane at distance s is its part along the plane, part + s plane across. The term vanishes where the liquid
      is less than one spacing deep, so that a drop on a wall falls;
    - drag of a no-slip wall, 2 nu plane / s (v_wall - v_i): the velocity is extrapolated linearly behind it (Morris et al. 1997, sec. 3.2).
   part: of the kernel behind all walls. */
WEIR_FN void sph_wall_force(const REAL* x, const REAL* v, REAL pressure, REAL part, WEIR_PARAM WallParams* w, WEIR_PARAM SphParams* p,
                            REAL* out) {
    REAL faded = (SCALAR)1 - MAX0((SCALAR)1 - MAX0(pressure) * p->per_depth);
    int a, b, end;
    for (a = 0; a < 3; ++a) out[a] = -p->gravity[a] * part * faded;
    for (a = 0; a < 3; ++a)
        for (end = 0; end < 2; ++end) {
            REAL s = end ? w->hi[a] - x[a] : x[a] - w->lo[a];
            REAL plane = wall_series(s, w->slope, w->inv_h);
            REAL drag = p->stick[2 * a + end] * plane / (s + MAX0(p->closest - s));
            out[a] -= p->gravity[a] * s * plane * faded;
            for (b = 0; b < 3; ++b)
                if (b != a) out[b] += drag * (p->slide[3 * (2 * a + end) + b] - v[b]);
        }
}
