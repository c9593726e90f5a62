/* Temperature and related functions of the specific enthalpy h, in double precision on every backend. Plain C; WEIR_FN and WEIR_PARAM as
   in pair.inl. shift: increase of the boiling enthalpy relative to the curve's pressure [J/kg]. */

WEIR_FN double heat_low(double a, double b) { return a < b ? a : b; }
WEIR_FN double heat_high(double a, double b) { return a < b ? b : a; }

/* A function that increases with h by one factor per state and is constant during phase changes; 0 where the liquid begins. */
WEIR_FN double heat_rise(double h, double shift, double solid, double liquid, double vapour, WEIR_PARAM HeatStates* s) {
    double end = s->liquid_end + shift, begin = s->vapour_begin + shift;
    return solid * (heat_low(h, s->solid_end) - s->solid_end) + liquid * (heat_low(heat_high(h, s->liquid_begin), end) - s->liquid_begin) +
           vapour * (heat_high(h, begin) - begin);
}

/* [K] */
WEIR_FN double heat_temperature(double h, double shift, WEIR_PARAM HeatStates* s) {
    return s->T + heat_rise(h, shift, s->per_c[0], s->per_c[1], s->per_c[2], s);
}

/* The integral of the conductivity over the temperature, from where the liquid begins (Kirchhoff 1894) [W/m] */
WEIR_FN double heat_theta(double h, double shift, WEIR_PARAM HeatStates* s) {
    return heat_rise(h, shift, s->k_c[0], s->k_c[1], s->k_c[2], s);
}

/* The same for a liquid that may boil, at varying pressure: a function of temperature alone, so that there is no flux at equal
   temperatures. The vapour's conductivity begins at the boiling temperature of the deepest point. */
WEIR_FN double heat_theta_at(double T, WEIR_PARAM HeatStates* s) {
    return s->k[0] * heat_low(T - s->T, 0) + s->k[1] * (heat_low(heat_high(T, s->T), s->T_vapour) - s->T) +
           s->k[2] * heat_high(T - s->T_vapour, 0);
}

/* Mass fractions that are not solid, and that are vapour. */
WEIR_FN double heat_share(double h, double begin, double end) { return h >= end ? 1 : h <= begin ? 0 : (h - begin) / (end - begin); }
WEIR_FN double heat_melted(double h, WEIR_PARAM HeatStates* s) { return heat_share(h, s->solid_end, s->liquid_begin); }
WEIR_FN double heat_vapour(double h, double shift, WEIR_PARAM HeatStates* s) {
    return heat_share(h, s->liquid_end + shift, s->vapour_begin + shift);
}

/* The rest density relative to the liquid's: the volumes of solid and melt add up. */
WEIR_FN double heat_rest(double h, WEIR_PARAM HeatStates* s) { return 1 / (1 + s->swells * (1 - heat_melted(h, s))); }

/* Mean of the states by their fractions [W/(m K)]. */
WEIR_FN double heat_conductivity(double h, double shift, WEIR_PARAM HeatStates* s) {
    double melted = heat_melted(h, s), vapour = heat_vapour(h, shift, s);
    return s->k[0] * (1 - melted) + s->k[1] * (melted - vapour) + s->k[2] * vapour;
}

/* Flux from outside to a height above a wall, through wall and liquid in series [W/m^2]. The height is at least a quarter of a spacing:
   a particle has finite size. */
WEIR_FN double heat_exchanged(double h, double shift, double height, double outside, double coefficient, double spacing,
                              WEIR_PARAM HeatStates* s) {
    double between = heat_high(height, 0.25 * spacing) / heat_conductivity(h, shift, s);
    return (outside - heat_temperature(h, shift, s)) / (1 / coefficient + between);
}
