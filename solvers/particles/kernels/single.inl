/* 1 / sqrt(x) of positive, normal x in single precision, bitwise equal on every machine: hardware estimates differ between processors.
   The bits of x, halved and subtracted from a constant, are an estimate to some per cent (Blinn 1997). Two Newton steps y (3 - x y^2) /
   2 follow. Their factors 1/2 are included in the constants: intermediate y are too small by a cube root of 1/2 (and of 1/4). The
   constants minimize the largest error: 1.3e-6, in r less than the rounding of coordinates in a domain of 40 supports. A prelude defines
   BITS(x) and FROM_BITS(i), and FNMA as in pair.inl. */
WEIR_FN REAL inverse_root(REAL x) {
    REAL y = FROM_BITS(0x5eff0000 - (BITS(x) >> 1));
    y = y * FNMA(x * y, y, (SCALAR)1.6215);
    return y * FNMA(x * y, y, (SCALAR)1.8898832);
}
