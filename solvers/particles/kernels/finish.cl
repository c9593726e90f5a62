/* Passes over velocities after the positions are final (Macklin & Mueller 2013, line 22): compiled only for effects of the scene. */
#if defined(WEIR_XSPH) || defined(WEIR_VORTICITY)

__kernel void load_velocities(int count, int stride, __global const double* v, __global const int* order, __global float4* velocities) {
    const int k = get_global_id(0);
    if (k >= count) return;
    const int i = order[k];
    float4 u = (float4)(0.0f);
    u.x = (float)v[i];
    u.y = (float)v[(size_t)stride + i];
#if WEIR_DIM == 3
    u.z = (float)v[(size_t)2 * stride + i];
#endif
    velocities[k] = u;
}
#endif

#if defined(WEIR_XSPH) || defined(WEIR_VORTICITY) || defined(WEIR_TENSION)
/* v += factor * change, of sorted particle k. */
WEIR_FN void add_change(int k, int stride, double factor, float4 change, __global const int* order, __global double* v) {
    const int i = order[k];
    v[i] += factor * (double)change.x;
    v[(size_t)stride + i] += factor * (double)change.y;
#if WEIR_DIM == 3
    v[(size_t)2 * stride + i] += factor * (double)change.z;
#endif
}
#endif

#ifdef WEIR_XSPH
/* v_i += c sum_j (m / rho0) W (v_j - v_i)                                                                              eq. 17 */
__kernel void smooth(int count, int stride, __constant PbfParams* p, double c, __global const float4* at, __global const float4* velocities,
                     __global const int* neighbours, __global const int* list, __global const int* order, __global double* v) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], u = velocities[i];
    float4 sum = (float4)(0.0f);
    for (int k = 0; k < neighbours[i]; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 d = APART(me, at[j]);
        const float4 other = velocities[j] - u;
        const float f = xsph_factor(DISTANCE2(d, p), p);
        sum.x = FMA(f, other.x, sum.x);
        sum.y = FMA(f, other.y, sum.y);
        sum.z = FMA(f, other.z, sum.z);
    }
    add_change(i, stride, c, sum, order, v);
}
#endif

#ifdef WEIR_VORTICITY
/* Vorticity and its length                                                                                              eq. 15 */
__kernel void curl(int count, int stride, __constant PbfParams* p, __global const float4* at, __global const float4* velocities,
                   __global const int* neighbours, __global const int* list, __global float4* omega) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], own = velocities[i];
    float4 sum = (float4)(0.0f);
    for (int k = 0; k < neighbours[i]; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 d = APART(me, at[j]), u = velocities[j] - own;
        const float f = curl_factor(DISTANCE2(d, p), p);
        sum.x += f * (u.y * d.z - u.z * d.y);
        sum.y += f * (u.z * d.x - u.x * d.z);
        sum.z += f * (u.x * d.y - u.y * d.x);
    }
    const float length2 = dot3(sum.x, sum.y, sum.z, sum.x, sum.y, sum.z);
    sum.w = length2 * RSQRT(length2 + 1e-20f);
    omega[i] = sum;
}

/* v += dt epsilon N x omega, N = eta / |eta|                                                                            eq. 16 */
__kernel void confine(int count, int stride, __constant PbfParams* p, double strength, __global const float4* at,
                      __global const float4* omega, __global const int* neighbours, __global const int* list, __global const int* order,
                      __global double* v) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = at[i], w = omega[i];
    float4 eta = (float4)(0.0f);
    for (int k = 0; k < neighbours[i]; ++k) {
        const int j = list[(size_t)k * stride + i];
        const float4 d = APART(me, at[j]);
        const float f = pbf_slope(DISTANCE2(d, p), p) * omega[j].w;
        eta.x = FMA(f, d.x, eta.x);
        eta.y = FMA(f, d.y, eta.y);
        eta.z = FMA(f, d.z, eta.z);
    }
    const float4 n = RSQRT(dot3(eta.x, eta.y, eta.z, eta.x, eta.y, eta.z) + 1e-20f) * eta;
    add_change(i, stride, strength, (float4)(n.y * w.z - n.z * w.y, n.z * w.x - n.x * w.z, n.x * w.y - n.y * w.x, 0.0f), order, v);
}
#endif
