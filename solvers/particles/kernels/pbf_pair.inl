/* Position Based Fluids (Macklin & Mueller 2013): what one pair, and one particle, contribute. See pair.inl for the language.
   The constraint of particle i is C_i = rho_i / rho0 - 1 <= 0 (Macklin et al. 2014: a liquid resists compression, not separation). */

/* m W(r) / rho0 of one neighbour                                                                                      eq. 2 */
WEIR_FN REAL pbf_density(REAL r2, WEIR_PARAM PbfParams* p) { return p->density * WEIR_DENSITY(r2, p); }
/* The same added to a sum */
WEIR_FN REAL pbf_add_density(REAL sum, REAL r2, WEIR_PARAM PbfParams* p) { return FMA(WEIR_DENSITY(r2, p), p->density, sum); }

/* s with (m / rho0) grad W = s (x_i - x_j)                                                                            eq. 8 */
WEIR_FN REAL pbf_slope(REAL r2, WEIR_PARAM PbfParams* p) { return p->gradient * WEIR_SLOPE(r2, p); }

/* lambda_i = -C_i / (sum_k |grad_k C_i|^2 + epsilon); the sum over k has the neighbours' part and |own|^2             eq. 11
   `before` is what this step's iterations have already given. A liquid is pushed, never pulled: the sum stays <= 0. With before = 0 in
   every iteration this is lambda of the paper for C > 0 and 0 elsewhere; kept, it is the multiplier of the constraint
   (Macklin, Mueller & Chentanez 2016), which the next step can start from. Returns the sum. */
WEIR_FN REAL pbf_multiplier(REAL before, REAL density, REAL neighbours2, REAL own2, WEIR_PARAM PbfParams* p) {
    return -MAX0(p->relaxation * (density - (SCALAR)1) / (neighbours2 + own2 + p->cfm) - before);
}

/* s_corr = -k (W(r) / W(dq))^4                                                                                        eq. 13 */
WEIR_FN REAL pbf_artificial_pressure(REAL r2, WEIR_PARAM PbfParams* p) {
    REAL ratio = WEIR_DENSITY(r2, p) * p->corr_inv_wq;
    REAL square = ratio * ratio;
    return p->corr_k * square * square;
}

/* (lambda_i + lambda_j + s_corr) (m / rho0) grad W = factor (x_i - x_j)                                                eq. 14 */
WEIR_FN REAL pbf_correction(REAL r2, REAL lambdas, WEIR_PARAM PbfParams* p) { return lambdas * pbf_slope(r2, p); }
WEIR_FN REAL pbf_correction_with_pressure(REAL r2, REAL lambdas, WEIR_PARAM PbfParams* p) {
    return (lambdas - pbf_artificial_pressure(r2, p)) * pbf_slope(r2, p);
}

/* Velocity smoothing: (m / rho0) W (v_j - v_i) = factor (v_j - v_i)                                                   eq. 17 */
WEIR_FN REAL xsph_factor(REAL r2, WEIR_PARAM PbfParams* p) { return pbf_density(r2, p); }

/* Vorticity: (m / rho0) (v_j - v_i) x grad_j W = factor (v_j - v_i) x (x_i - x_j)                                      eq. 15 */
WEIR_FN REAL curl_factor(REAL r2, WEIR_PARAM PbfParams* p) { return -pbf_slope(r2, p); }
