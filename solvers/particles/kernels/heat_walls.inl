/* Walls in the conduction of heat. See pair.inl for the language. */

/* Squared distance to the image of j behind a plane, from that to j: uses both heights above the plane. */
WEIR_FN REAL heat_behind(REAL r2, REAL own, REAL other) { return FMA(own * other, (SCALAR)4, r2); }
/* Heights above the plane are at least `closest`: Heat's closest_to_wall(). */
WEIR_FN REAL heat_above(REAL height, WEIR_PARAM HeatWalls* w) { return MAX0(height - w->closest) + w->closest; }
