// The system of conjugate gradients for viscosity, and its preconditioners.
#include "two_phase/viscosity.hpp"

#include <cmath>

namespace weir::two_phase {

/// ((ρ − dt ∇·2μD) p)_a on a row of faces, p the direction. 2μD_ab is at the sides of a face's volume: in cells for b = a, else at edges.
template <int D>
void Viscosity<D>::multiply_row(int a, const Index<D>& first, int count, real* result) const {
    const Vec<D>& h = residual_.h;
    const real *u = direction_[a].at(first), *rho = &mass_[a](first), *mu = cell_mu_.at(first);
    const std::ptrdiff_t s = direction_[a].stride(a), m = cell_mu_.stride(a);
    const real along = 2 * dt_ / (h[a] * h[a]);
#pragma omp simd
    for (int i = 0; i < count; ++i) result[i] = rho[i] * u[i] - along * (mu[i] * (u[i + s] - u[i]) - mu[i - m] * (u[i] - u[i - s]));
    for (int b = 0; b < D; ++b) {
        if (b == a) continue;
        const real *v = direction_[b].at(first), *shear = &edge(a, b)(first);
        const std::ptrdiff_t up = direction_[a].stride(b), v_up = direction_[b].stride(b), v_by = direction_[b].stride(a),
                             e_up = edge(a, b).stride(b);
        const real across = dt_ / (h[b] * h[b]), mixed = dt_ / (h[a] * h[b]);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real upper = across * (u[i + up] - u[i]) + mixed * (v[i + v_up] - v[i + v_up - v_by]);
            const real lower = across * (u[i] - u[i - up]) + mixed * (v[i] - v[i - v_by]);
            result[i] -= shear[i + e_up] * upper - shear[i] * lower;
        }
    }
}

/// The finest level of the multigrid: this matrix, with the viscosities times dt.
template <int D>
void Viscosity<D>::build_multigrid() {
    mac::viscous::Level<D>& finest = multigrid_.finest();
    finest.has_closed_faces = state_->solid.any();
    for_each_row([&](int a, const Index<D>& first, int count) {
        const real *rho = &mass_[a](first), *inverse = &inverse_[a](first);
        float* mass = finest.mass[a].at(first);
        for (int i = 0; i < count; ++i) mass[i] = inverse[i] == 0 ? -1 : static_cast<float>(rho[i]);
    });
    for_each_cell(cell_mu_.extent(), [&](const Index<D>& I) {
        for (int a = 0; a < D; ++a) finest.mu[a](I) = static_cast<float>(dt_ * cell_mu_(I));
    });
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a)
            for_each_cell(edge(a, b).extent(), [&](const Index<D>& I) { finest.edge(a, b)(I) = static_cast<float>(dt_ * edge(a, b)(I)); });
    multigrid_.build();
}

/// z = M r by a V-cycle in single precision, of r scaled to the norm of b.
template <int D>
real Viscosity<D>::precondition_by_cycle() {
    mac::viscous::Level<D>& finest = multigrid_.finest();
    const real scale = 1 / (norm_of_b_ * relative_);
    for_each_row([&](int a, const Index<D>& first, int count) {
        const real* r = &residual_[a](first);
        float* b = finest.b[a].at(first);
        for (int i = 0; i < count; ++i) b[i] = static_cast<float>(scale * r[i]);
    });
    multigrid_.cycle();
    return sum_of_rows([&](int a, const Index<D>& first, int count) {
        const real* r = &residual_[a](first);
        const float* x = finest.other[a].at(first);
        real *z = &cycled_[a](first), sum = 0;
        const real back = norm_of_b_ * relative_;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < count; ++i) {
            z[i] = back * x[i];
            sum += r[i] * z[i];
        }
        return sum;
    });
}

template <int D>
real Viscosity<D>::precondition() {
    if (cycles_) return precondition_by_cycle();
    return sum_of_rows([&](int a, const Index<D>& first, int count) {
        const real *r = &residual_[a](first), *inverse = &inverse_[a](first);
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < count; ++i) sum += r[i] * r[i] * inverse[i];
        return sum;
    });
}

template <int D>
void Viscosity<D>::update_direction(real beta) {
    for_each_row([&](int a, const Index<D>& first, int count) {
        const real *r = &residual_[a](first), *inverse = &inverse_[a](first);
        real* p = direction_[a].at(first);
        const real* z = &cycled_[a](first);
        if (cycles_)
#pragma omp simd
            for (int i = 0; i < count; ++i) p[i] = beta == 0 ? z[i] : z[i] + beta * p[i];
        else if (beta == 0)
            for (int i = 0; i < count; ++i) p[i] = r[i] * inverse[i];
        else
#pragma omp simd
            for (int i = 0; i < count; ++i) p[i] = r[i] * inverse[i] + beta * p[i];
    });
    for (int a = 0; a < D; ++a) fill_ghosts(direction_[a], homogeneous_[static_cast<std::size_t>(a)]);
}

template <int D>
real Viscosity<D>::multiply() {
    return sum_of_rows([&](int a, const Index<D>& first, int count) {
        real* q = &product_[a](first);
        multiply_row(a, first, count, q);
        const real* p = direction_[a].at(first);
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < count; ++i) sum += p[i] * q[i];
        return sum;
    });
}

template <int D>
real Viscosity<D>::advance(real alpha) {
    return relative_ = std::sqrt(sum_of_rows([&](int a, const Index<D>& first, int count) {
                           const real *p = direction_[a].at(first), *q = &product_[a](first), *inverse = &inverse_[a](first);
                           real *r = &residual_[a](first), *u = &state_->u[a](first), sum = 0;
#pragma omp simd reduction(+ : sum)
                           for (int i = 0; i < count; ++i) {
                               u[i] += alpha * p[i];
                               r[i] -= alpha * q[i];
                               sum += r[i] * r[i] * inverse[i];
                           }
                           return sum;
                       })) /
                       norm_of_b_;
}

#define WEIR_INSTANTIATE(D)                                                           \
    template void Viscosity<D>::multiply_row(int, const Index<D>&, int, real*) const; \
    template void Viscosity<D>::build_multigrid();                                    \
    template real Viscosity<D>::precondition();                                       \
    template void Viscosity<D>::update_direction(real);                               \
    template real Viscosity<D>::multiply();                                           \
    template real Viscosity<D>::advance(real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
