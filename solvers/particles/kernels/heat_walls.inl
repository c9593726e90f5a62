/* Walls as heat meets them. See pair.inl for the language. */

/* Square of the distance to the image of j behind a plane, from that of j: both heights above the plane. */
WEIR_FN REAL heat_behind(REAL r2, REAL own, REAL other) { return FMA(own * other, (SCALAR)4, r2); }
/* What stands closer to the plane than `closest` is taken to stand there: Heat's closest_to_wall(). */
WEIR_FN REAL heat_above(REAL height, WEIR_PARAM HeatWalls* w) { return MAX0(height - w->closest) + w->closest; }
