/* 1 / sqrt(x) of positive, normal x in single precision, the same bits on every machine: no instruction's estimate, of which each processor has
   its own. The bits of x, halved and taken from a constant, are an estimate to some per cent (Blinn 1997). Two Newton steps
   y (3 - x y^2) / 2 follow; their factors 1/2 stand in the constants, y being a cube root of 1/2 (and of 1/4) times too small on the way. The
   constants make the largest error least: 1.3e-6, in r less than what rounds coordinates where a domain is 40 supports wide. A prelude defines
   BITS(x) and FROM_BITS(i), and FNMA as in pair.inl. */
WEIR_FN REAL inverse_root(REAL x) {
    REAL y = FROM_BITS(0x5eff0000 - (BITS(x) >> 1));
    y = y * FNMA(x * y, y, (SCALAR)1.6215);
    return y * FNMA(x * y, y, (SCALAR)1.8898832);
}
