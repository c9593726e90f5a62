/* Conduction of heat: what one pair contributes. See pair.inl for the language.
   After Cleary & Monaghan 1999, dh_i/dt = (1/rho0) sum_j V 2 k_ij (T_j - T_i) (-s), grad W = s (x_i - x_j); here k_ij (T_j - T_i) is the
   integral of k over the temperatures between i and j, theta_j - theta_i: of one substance, whose conductivity is a function of its
   temperature, that is the exact flow along a line, wherever between the two the front stands. Divided by the moment that a lattice gives
   the sum in place of 1. The same bits with the other sign at j, so that sums which do not round keep heat. */
WEIR_FN REAL heat_flow(REAL r2, REAL rise, WEIR_PARAM HeatParams* p) { return p->conduct * WEIR_SLOPE(r2, p) * rise; }
