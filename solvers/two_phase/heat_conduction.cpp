#include "two_phase/heat_conduction.hpp"

#include "mac/grid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {

constexpr real tolerance = 1e-10;  // of the first residual: what flows in a step is known to it
constexpr real round_off = 1e-15;  // of the heat content
constexpr int most_iterations = 5000;
/// A face does not see thinner layers, in cells: the divergence that the pressure left makes films of a fluid that may insulate.
constexpr real film = 1e-6;

}  // namespace

template <int D>
HeatConduction<D>::HeatConduction(const MacState<D>& state, const Densities& capacity, const Densities& conductivity,
                                  const Boundary<D>& temperature)
    : capacity_(capacity),
      conductivity_(conductivity),
      boundary_(temperature),
      homogeneous_(temperature.homogeneous()),
      h_(state.u.h),
      direction_(state.extent()),
      before_(state.extent()),
      residual_(state.extent()),
      inverse_(state.extent()),
      product_(state.extent()) {
    for (int a = 0; a < D; ++a) conductance_[static_cast<std::size_t>(a)] = Grid<real, D>(state.u[a].extent());
}

/// The sum of f(first, count) over the rows of cells.
template <int D>
template <class F>
real HeatConduction<D>::sum_of_rows(F&& f) const {
    return sum_over(rows_of<D>(residual_.extent()), [&](const Index<D>& first) { return f(first, residual_.extent()[0]); });
}

/// Of the face at the lower side of cell I along axis a; its volume has this liquid fraction.
template <int D>
real HeatConduction<D>::conductivity_of(int a, const Index<D>& I, real fraction) const {
    const Densities& k = conductivity_;
    if (fraction > 1 - film) return k.liquid;
    if (fraction < film) return k.gas;
    const Padded<D>& f = *f_;
    const Index<D> J = I - e<D>(a);
    real along = 0, all = 0;
    for (int b = 0; b < D; ++b) {
        const Index<D> by = e<D>(b);
        const real slope = (b == a ? f(I) - f(J) : 0.25 * ((f(I + by) - f(I - by)) + (f(J + by) - f(J - by)))) / h_[b];
        all += slope * slope;
        if (b == a) along = slope * slope;
    }
    const real across = all > 0 ? along / all : 1, series = (1 - fraction) * k.liquid + fraction * k.gas;
    return (series > 0 ? across * k.liquid * k.gas / series : 0) + (1 - across) * k.of(fraction);
}

template <int D>
real HeatConduction<D>::remaining_difference(real fraction, real dt) const {
    const Densities &k = conductivity_, &c = capacity_;
    const real series = (1 - fraction) * k.liquid + fraction * k.gas;
    if (!(series > 0)) return 1;
    real per_area = 0;  // mean of 1/h²: cells are nearly cubes
    for (int d = 0; d < D; ++d) per_area += 1 / (h_[d] * h_[d] * D);
    const real exchange = dt * 2 * per_area * k.liquid * k.gas / series;
    return 1 / (1 + exchange * (1 / (fraction * c.liquid) + 1 / ((1 - fraction) * c.gas)));
}

template <int D>
void HeatConduction<D>::find_conductances(const MacState<D>& state, const FaceFractions<D>& faces, real dt) {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const auto& ends = boundary_.end[at];
        const int n = residual_.extent()[a];
        const bool ring = ends[0].kind == EndRule::Kind::periodic;
        for_each_cell(faces[at].extent(), [&](Index<D> I) {
            real& conductance = conductance_[at](I);
            conductance = 0;
            if (ring && I[a] == n) I[a] = 0;
            if (!ring && I[a] == 0 && ends[0].kind != EndRule::Kind::dirichlet) return;
            if (!ring && I[a] == n && ends[1].kind != EndRule::Kind::dirichlet) return;
            const real open = state.solid.any() ? state.solid.open[at](I) : 1;
            conductance = open * dt / (h_[a] * h_[a]) * conductivity_of(a, I, faces[at](I));
        });
    }
    for_each_cell(inverse_.extent(), [&](const Index<D>& I) {
        real sum = capacity_.of((*f_)(I));
        for (int a = 0; a < D; ++a) {
            const auto& conductance = conductance_[static_cast<std::size_t>(a)];
            sum += conductance(I) + conductance(I + e<D>(a));
        }
        inverse_(I) = 1 / sum;
    });
}

/// dt ∇·(k ∇p) of a row of cells, p the direction.
template <int D>
void HeatConduction<D>::find_gains(const Index<D>& first, int count, real* gain) const {
    const real* p = direction_.at(first);
    std::fill_n(gain, count, 0.0);
    for (int a = 0; a < D; ++a) {
        const auto& conductance = conductance_[static_cast<std::size_t>(a)];
        const std::ptrdiff_t by = direction_.stride(a), up = conductance.stride(a);
        const real* w = &conductance(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) gain[i] += w[i + up] * (p[i + by] - p[i]) - w[i] * (p[i] - p[i - by]);
    }
}

/// r = dt ∇·(k ∇T). Returns its norm.
template <int D>
real HeatConduction<D>::start(real& norm_of_content) {
    fill(direction_, *T_, boundary_);
    for_each_cell(rows_of<D>(residual_.extent()), [&](const Index<D>& first) {
        std::copy_n(&(*T_)(first), residual_.extent()[0], &before_(first));
        find_gains(first, residual_.extent()[0], &residual_(first));
    });
    norm_of_content = std::sqrt(sum_of_rows([&](const Index<D>& first, int count) {
        const real *T = &before_(first), *f = f_->at(first), *inverse = &inverse_(first);
        real sum = 0;
        for (int i = 0; i < count; ++i) sum += capacity_.of(f[i]) * T[i] * capacity_.of(f[i]) * T[i] * inverse[i];
        return sum;
    }));
    return std::sqrt(precondition());
}

/// Adds a constant to T in cells with fluid, so that their content changes by what the fluxes of the solution bring: the sum of the
/// residuals over that of the capacities.
template <int D>
void HeatConduction<D>::finish(const MacState<D>& state) {
    fill(direction_, *T_, boundary_);
    const auto total = [&](auto&& of) {
        return sum_over(residual_.extent(), [&](const Index<D>& I) { return state.cells(I) == poisson::Cell::solid ? 0 : of(I); });
    };
    for_each_cell(rows_of<D>(residual_.extent()),
                  [&](const Index<D>& first) { find_gains(first, residual_.extent()[0], &residual_(first)); });
    const real missing = total([&](const Index<D>& I) { return residual_(I) - capacity_.of((*f_)(I)) * ((*T_)(I)-before_(I)); });
    const real shift = missing / total([&](const Index<D>& I) { return capacity_.of((*f_)(I)); });
    for_each_cell(residual_.extent(), [&](const Index<D>& I) {
        if (state.cells(I) != poisson::Cell::solid) (*T_)(I) += shift;
    });
}

/// Of the fluxes of the solution, times the volume of a cell [J/m³].
template <int D>
real HeatConduction<D>::through_sides() const {
    real sum = 0;
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto at = static_cast<std::size_t>(a);
            if (boundary_.end[at][static_cast<std::size_t>(end)].kind != EndRule::Kind::dirichlet) continue;
            Extent<D> plane = residual_.extent();
            plane[a] = 1;
            sum += sum_over(plane, [&](Index<D> I) {
                I[a] = end == 0 ? 0 : residual_.extent()[a];
                const Index<D> below = I - e<D>(a);
                const real upwards = conductance_[at](I) * (direction_(below) - direction_(I));
                return end == 0 ? upwards : -upwards;
            });
        }
    return sum;
}

template <int D>
real HeatConduction<D>::apply(const MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, real dt, Grid<real, D>& T) {
    f_ = &f, T_ = &T, iterations_ = 0;
    find_conductances(state, faces, dt);
    real content = 0;
    first_ = start(content);
    if (!(first_ > round_off * content)) {
        if (std::isnan(first_)) linear::fail("temperature", "conduction", {first_, false}, 0, tolerance);
        return 0;
    }
    linear::StopTest stop(std::max(tolerance, round_off * content / first_), most_iterations, iterations_);
    const linear::Outcome outcome = linear::conjugate_gradients(*this, stop, 1);
    if (!outcome.broke_down) linear::require_converged("temperature", "conduction", outcome, stop);
    finish(state);
    return state.u.cell_volume() * through_sides();
}

template <int D>
real HeatConduction<D>::precondition() {
    return sum_of_rows([&](const Index<D>& first, int count) {
        const real *r = &residual_(first), *inverse = &inverse_(first);
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < count; ++i) sum += r[i] * r[i] * inverse[i];
        return sum;
    });
}

template <int D>
void HeatConduction<D>::update_direction(real beta) {
    for_each_row(Index<D>{}, residual_.extent(), [&](const Index<D>& first, int count) {
        const real *r = &residual_(first), *inverse = &inverse_(first);
        real* p = direction_.at(first);
        if (beta == 0)
            for (int i = 0; i < count; ++i) p[i] = r[i] * inverse[i];
        else
#pragma omp simd
            for (int i = 0; i < count; ++i) p[i] = r[i] * inverse[i] + beta * p[i];
    });
    fill_ghosts(direction_, homogeneous_);
}

template <int D>
real HeatConduction<D>::multiply() {
    return sum_of_rows([&](const Index<D>& first, int count) {
        real* q = &product_(first);
        find_gains(first, count, q);
        const real *p = direction_.at(first), *f = f_->at(first);
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (int i = 0; i < count; ++i) {
            q[i] = capacity_.of(f[i]) * p[i] - q[i];
            sum += p[i] * q[i];
        }
        return sum;
    });
}

template <int D>
real HeatConduction<D>::advance(real alpha) {
    for_each_row(Index<D>{}, residual_.extent(), [&](const Index<D>& first, int count) {
        const real *p = direction_.at(first), *q = &product_(first);
        real *r = &residual_(first), *T = &(*T_)(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            T[i] += alpha * p[i];
            r[i] -= alpha * q[i];
        }
    });
    return std::sqrt(precondition()) / first_;
}

template <int D>
std::size_t HeatConduction<D>::bytes() const {
    std::size_t total = direction_.bytes() + before_.bytes() + residual_.bytes() + inverse_.bytes() + product_.bytes();
    for (const auto& conductance : conductance_) total += conductance.bytes();
    return total;
}

template class HeatConduction<2>;
template class HeatConduction<3>;

}  // namespace weir::two_phase
