/* Density update by the continuity equation, in double precision on every backend. Plain C; WEIR_FN as in pair.inl. */

/* Far beyond the range of any equation of state used here: bounds densities where particles are faster than sound. */
#define WEIR_MOST_COMPRESSION 8.0

/* exp(x) to second order, always positive: growth(x) growth(-x) = 1, so expansion and compression are reversible. A step in which
   density would change by more than a factor e is not resolved: the change is limited, and stays finite. */
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
