/* Conduction of heat: the contribution of one pair. See pair.inl for the language. After Cleary & Monaghan 1999, dh_i/dt = (1/rho0)
   sum_j V 2 k_ij (T_j - T_i) (-s), grad W = s (x_i - x_j). Here k_ij (T_j - T_i) is the integral of k over the temperatures between i
   and j, theta_j - theta_i. For one substance, whose conductivity is a function of temperature, this is the exact flux along a line, for
   any position of the front between the two. The sum is divided by its moment on a lattice, which replaces 1. Antisymmetric to the last
   bit, so exact sums conserve heat. */
WEIR_FN REAL heat_flow(REAL r2, REAL rise, WEIR_PARAM HeatParams* p) { return p->conduct * WEIR_SLOPE(r2, p) * rise; }
