/* What enthalpy means, in double precision on every backend. Plain C, compiled as C++ and as OpenCL C. State 0 is solid, 1 liquid, 2
 * vapour. */
typedef struct {
    double solid_end, liquid_begin, liquid_end, vapour_begin; /* between them a state turns into the next one [J/kg] */
    double per_c[3];                                          /* 1 / heat capacity [kg K/J] */
    double k_c[3];                                            /* conductivity over heat capacity [kg/(m s)] */
    double T;                                                 /* where the liquid begins [K] */
    double k[3], T_vapour; /* conductivity [W/(m K)]; that of the vapour from this temperature on, of a liquid that may boil [K] */
    double swells;         /* how much more room what is frozen takes: 0 or, where ice moves, 0.09 */
} HeatStates;
