/* Compiles the pair physics for plain C++ doubles: the reference. Include inside a namespace, after params.h with SCALAR double. */
#define WEIR_FN static inline
#define REAL double
#define WEIR_PARAM const
#define MAX0(x) weir_max0(x)
#define RSQRT(x) (1.0 / std::sqrt(x))
#define FMA(a, b, c) ((a) * (b) + (c))
#define FNMA(a, b, c) ((c) - (a) * (b))
static inline double weir_max0(double x) { return x > 0 ? x : 0; }
