/* Smoothed particle hydrodynamics (Mueller, Charypar & Gross 2003): what one pair contributes. See pair.inl for the language.
   All pair terms are antisymmetric in i and j, so momentum is kept to round-off. */

/* m W(r)                                                                                          Mueller et al. 2003, eq. 3 */
WEIR_FN REAL sph_density(REAL r2, WEIR_PARAM SphParams* p) { return p->density * WEIR_DENSITY(r2, p); }

/* Acceleration along x_i - x_j: -m ((p_i + p_j) / (2 rho_i rho_j) + Pi) s, grad W = s (x_i - x_j)           eq. 10 over rho_i
   Pi = -alpha c h mu / rho, mu = v.x / (r^2 + eta^2) for approaching pairs                     artificial viscosity, Monaghan 1992
   pressures: (p_i + p_j) / (2 rho_i rho_j); approach: (v_i - v_j).(x_i - x_j); volume: the mean of 1 / rho */
WEIR_FN REAL sph_push(REAL r2, REAL approach, REAL pressures, REAL volume, WEIR_PARAM SphParams* p) {
    REAL closing = MAX0(-approach) / (r2 + p->soften);
    return -(pressures + p->artificial * closing * volume) * p->gradient * WEIR_SLOPE(r2, p);
}

/* Acceleration along v_j - v_i: mu m lap W / (rho_i rho_j)                                                  eq. 14 over rho_i */
WEIR_FN REAL sph_drag(REAL r2, REAL volumes, WEIR_PARAM SphParams* p) {
    return p->viscosity * volumes * p->laplacian * WEIR_LAPLACIAN(r2, p);
}
