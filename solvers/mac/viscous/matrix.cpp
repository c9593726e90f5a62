// The matrix of a level, row by row, and the relaxations. Each cell and edge adds one square to the energy of the matrix, μ/h² (Σ ± x)²
// with n faces: 2 for a cell, 4 for an edge. By Cauchy's inequality it is at most n times its diagonal. The diagonal
//
//     d = m + 2 (cells of the diagonal) + 4 (edges of the diagonal)
//
// therefore bounds the matrix: the eigenvalues of d⁻¹ A are in (0, 1], whatever the jumps of mass and viscosity.
#include "mac/viscous/level.hpp"

namespace weir::mac::viscous {

template <int D>
void multiply_row(const Level<D>& level, const Faces<D>& x, int a, const Index<D>& first, int count, float* out) {
    const Vec<D>& h = level.h;
    const float *u = x[a].at(first), *mass = level.mass[a].at(first), *mu = level.mu[a].at(first);
    const std::ptrdiff_t s = level.stride(a);
    const auto along = static_cast<float>(2 / (h[a] * h[a]));
#pragma omp simd
    for (int i = 0; i < count; ++i) out[i] = mass[i] * u[i] - along * (mu[i] * (u[i + s] - u[i]) - mu[i - s] * (u[i] - u[i - s]));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const float *v = x[b].at(first), *shear = level.edge(a, b).at(first);
        const std::ptrdiff_t up = level.stride(b);
        const auto across = static_cast<float>(1 / (h[b] * h[b])), mixed = static_cast<float>(1 / (h[a] * h[b]));
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const float upper = across * (u[i + up] - u[i]) + mixed * (v[i + up] - v[i + up - s]);
            const float lower = across * (u[i] - u[i - up]) + mixed * (v[i] - v[i - s]);
            out[i] -= shear[i + up] * upper - shear[i] * lower;
        }
    }
}

template <int D>
void find_inverse(Level<D>& level) {
    for_each_block_of(level, [&](int a, const Index<D>& first, int count) {
        const Vec<D>& h = level.h;
        float* inverse = level.inverse[a].at(first);
        const float *mass = level.mass[a].at(first), *mu = level.mu[a].at(first);
        const std::ptrdiff_t s = level.stride(a);
        const auto along = static_cast<float>(4 / (h[a] * h[a]));
        for (int i = 0; i < count; ++i) inverse[i] = mass[i] + along * (mu[i] + mu[i - s]);
        for (int b = 0; b < D; ++b) {
            if (b == a) continue;
            const float* shear = level.edge(a, b).at(first);
            const std::ptrdiff_t up = level.stride(b);
            const auto across = static_cast<float>(4 / (h[b] * h[b]));
            for (int i = 0; i < count; ++i) inverse[i] += across * (shear[i] + shear[i + up]);
        }
        for (int i = 0; i < count; ++i) inverse[i] = mass[i] < 0 || inverse[i] == 0 ? 0 : 1 / inverse[i];
    });
}

template <int D>
void start(const Level<D>& level, float omega, Faces<D>& y) {
    for_each_block_of(level, [&](int a, const Index<D>& first, int count) {
        const float *b = level.b[a].at(first), *inverse = level.inverse[a].at(first);
        float* to = y[a].at(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = omega * inverse[i] * b[i];
    });
    relax_stiff_edges<D>(level, omega, nullptr, y);
}

template <int D>
void relax(const Level<D>& level, float omega, const Faces<D>& x, Faces<D>& y) {
    for_each_block_of(level, [&](int a, const Index<D>& first, int count) {
        std::array<float, row_block> product;
        multiply_row(level, x, a, first, count, product.data());
        const float *b = level.b[a].at(first), *inverse = level.inverse[a].at(first), *u = x[a].at(first);
        float* to = y[a].at(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = u[i] + omega * inverse[i] * (b[i] - product[static_cast<std::size_t>(i)]);
    });
    relax_stiff_edges(level, omega, &x, y);
}

template <int D>
void residual(const Level<D>& level, const Faces<D>& x, Faces<D>& r) {
    for_each_block_of(level, [&](int a, const Index<D>& first, int count) {
        std::array<float, row_block> product;
        multiply_row(level, x, a, first, count, product.data());
        const float *b = level.b[a].at(first), *inverse = level.inverse[a].at(first);
        float* to = r[a].at(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = inverse[i] == 0 ? 0 : b[i] - product[static_cast<std::size_t>(i)];
    });
}

#define WEIR_INSTANTIATE(D)                                                                          \
    template void multiply_row(const Level<D>&, const Faces<D>&, int, const Index<D>&, int, float*); \
    template void find_inverse(Level<D>&);                                                           \
    template void start(const Level<D>&, float, Faces<D>&);                                          \
    template void relax(const Level<D>&, float, const Faces<D>&, Faces<D>&);                         \
    template void residual(const Level<D>&, const Faces<D>&, Faces<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac::viscous
