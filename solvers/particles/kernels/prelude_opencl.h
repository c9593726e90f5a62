/* Compiles the pair physics as OpenCL C 1.2, one particle per work item. Defines from the host: WEIR_DIM, WEIR_KERNEL (0: Mueller's, 1:
   cubic, 2: Wendland), WEIR_GROUP (work items of a group in reductions and scans), WEIR_FMA (hardware FMA), and one for each effect of
   the scene. */
#pragma OPENCL FP_CONTRACT OFF
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#define SCALAR float
#define REAL float
#define WEIR_FN static inline
#define WEIR_PARAM __constant
#define MAX0(x) weir_max0(x)
#define RSQRT(x) inverse_root(x)
#define BITS(x) as_int(x)
#define FROM_BITS(i) as_float(i)
#ifdef WEIR_FMA
#define FMA(a, b, c) fma((a), (b), (c))
#define FNMA(a, b, c) fma(-(a), (b), (c))
#else /* without hardware FMA: correct, but not bitwise equal to the processor's results */
#define FMA(a, b, c) ((a) * (b) + (c))
#define FNMA(a, b, c) ((c) - (a) * (b))
#endif
static inline float weir_max0(float x) { return x > 0.0f ? x : 0.0f; }

#if WEIR_KERNEL == 0
#define WEIR_DENSITY(r2, p) poly6(r2, (p)->h2)
#define WEIR_SLOPE(r2, p) spiky_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) linear_laplacian(r2, (p)->h)
#elif WEIR_KERNEL == 1
#define WEIR_DENSITY(r2, p) cubic(r2, (p)->h)
#define WEIR_SLOPE(r2, p) cubic_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) cubic_slope(r2, (p)->h)
#else
#define WEIR_DENSITY(r2, p) wendland(r2, (p)->h)
#define WEIR_SLOPE(r2, p) wendland_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) wendland_slope(r2, (p)->h)
#endif

/* Vector from b to a; along periodic axes (WEIR_PERIOD, as four numbers) to the nearest image. */
#ifdef WEIR_PERIOD
WEIR_FN float4 apart(float4 a, float4 b) {
    const float4 d = a - b;
    return d - (float4)(WEIR_PERIOD) * rint(d * (float4)(WEIR_PER_PERIOD));
}
#define APART(a, b) apart(a, b)
#else
#define APART(a, b) ((a) - (b))
#endif

#if WEIR_DIM == 3
#define SQUARE(d) FMA(d.z, d.z, FMA(d.y, d.y, d.x * d.x))
#define DISTANCE2(d, p) distance2(d.x, d.y, d.z, (p)->guard)
#else
#define SQUARE(d) FMA(d.y, d.y, d.x * d.x)
#define DISTANCE2(d, p) FMA(d.y, d.y, FMA(d.x, d.x, (p)->guard))
#endif
