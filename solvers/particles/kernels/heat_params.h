/* What enthalpy means, in double precision on every backend. Plain C, compiled as C++ and as OpenCL C. State 0 is solid, 1 liquid, 2
 * vapour. */
typedef struct {
    double solid_end, liquid_begin, liquid_end, vapour_begin; /* limits of the states; phase changes lie between them [J/kg] */
    double per_c[3];                                          /* 1 / heat capacity [kg K/J] */
    double k_c[3];                                            /* conductivity over heat capacity [kg/(m s)] */
    double T;                                                 /* temperature at which the liquid begins [K] */
    double k[3], T_vapour; /* conductivity [W/(m K)]; from T_vapour on that of the vapour, for a liquid that may boil [K] */
    double swells;         /* volume increase of frozen particles: 0 or, with moving ice, 0.09 */
} HeatStates;
