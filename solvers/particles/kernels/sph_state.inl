/* What continuity does to a density in one step, in double precision on every backend. Plain C; WEIR_FN as in pair.inl. */

/* Far beyond what any equation of state here means; where particles are thrown faster than sound, densities must not run away. */
#define WEIR_MOST_COMPRESSION 8.0

/* exp(x) to second order, always positive: growth(x) growth(-x) = 1, so that what expands and shrinks again is what it was.
   A step in which density would change by more than a factor e is not resolved: it is held back, and stays finite. */
WEIR_FN double density_growth(double x) {
    double u = x < 0 ? -x : x, grown;
    u = u < 1 ? u : 1;
    grown = 1 + u + 0.5 * u * u;
    return x >= 0 ? grown : 1 / grown;
}
WEIR_FN double density_kept(double rho, double rho0) {
    double lo = rho0 / WEIR_MOST_COMPRESSION, hi = rho0 * WEIR_MOST_COMPRESSION;
    return rho < lo ? lo : hi < rho ? hi : rho;
}
