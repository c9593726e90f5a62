#include "mac/water_pressure.hpp"

namespace weir::mac {

using poisson::Cell;

template <int D>
SurfacePressure<D>::SurfacePressure(const Frame<D>& frame, const MacState<D>& state, const PoissonChoice& choice)
    : frame_(frame),
      b_(frame.cells),
      r_(frame.cells),
      solver_(poisson::make_solver<D>(choice.method, choice.options)),
      h2_(frame.h[0] * frame.h[0]) {
    A_.cells = Grid<Cell, D>(frame.cells, Cell::air);
    for (int a = 0; a < D; ++a) {
        A_.weight[static_cast<std::size_t>(a)] = Grid<real, D>(state.u[a].extent());
        A_.axis_weight[a] = h2_ / (frame.h[a] * frame.h[a]);
        A_.periodic[static_cast<std::size_t>(a)] = frame.periodic(a);
    }
    nothing_to_do_.converged = true;
}

template <int D>
void SurfacePressure<D>::set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, MacState<D>& state) {
    const real thin = -thinnest * frame_.h_min();
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        A_.cells(I) = !closed.empty() && closed(I) ? Cell::solid : surface.phi(I) < thin ? Cell::fluid : Cell::air;
    });
    state.cells = A_.cells;
    liquid_cells_ = static_cast<std::size_t>(sum_over(frame_.cells, [&](const Index<D>& I) { return A_.cells(I) == Cell::fluid; }));
    for (int a = 0; a < D; ++a) {
        auto& weight = A_.weight[static_cast<std::size_t>(a)];
        for_each_line(weight.extent(), [&](const Index<D>& first, std::size_t at) {
            Index<D> I = first;
            if (a > 0 && !frame_.periodic(a) && I[a] > 0 && I[a] < frame_.cells[a] && !state.solid.any()) {  // the common line
                const Cell* above = &A_.cells(I);
                const Cell* below = above - A_.cells.stride(a);
                for (int i = 0; i < frame_.cells[0]; ++i) {
                    const bool one = below[i] == Cell::fluid, other = above[i] == Cell::fluid;
                    I[0] = i;
                    weight[at + static_cast<std::size_t>(i)] = one != other ? face_weight(surface, state, a, I) : one ? 1 : 0;
                }
                return;
            }
            for (; I[0] < weight.extent()[0]; ++I[0]) weight[at + static_cast<std::size_t>(I[0])] = face_weight(surface, state, a, I);
        });
    }
}

template <int D>
real SurfacePressure<D>::face_weight(const LevelSet<D>& surface, const MacState<D>& state, int a, const Index<D>& I) const {
    const int n = frame_.cells[a];
    Index<D> lower = I, upper = I;
    --lower[a];
    if (I[a] == 0 || I[a] == n) {
        if (!frame_.periodic(a)) {
            const bool low = I[a] == 0;
            const bool liquid = A_.cells(low ? upper : lower) == Cell::fluid;
            return liquid && state.sides.open(a, low ? 0 : 1) ? 2 : 0;  // p = 0 on the side itself, half a cell away
        }
        lower[a] = n - 1, upper[a] = 0;
    }
    const Cell below = A_.cells(lower), above = A_.cells(upper);
    if (below != Cell::fluid && above != Cell::fluid) return 0;
    const real open = state.solid.any() ? state.solid.open[static_cast<std::size_t>(a)](I) : 1;
    if (below == above) return open;
    if (below == Cell::solid || above == Cell::solid) return 0;
    const real liquid = surface.phi(below == Cell::fluid ? lower : upper), air = surface.phi(below == Cell::fluid ? upper : lower);
    return open * std::min(1 - air / liquid, 1 + 1 / thinnest);  // 1/θ
}

/// σ κ where the surface cuts the line between the two cells.
template <int D>
real SurfacePressure<D>::surface_pressure(const LevelSet<D>& surface, const Index<D>& liquid, const Index<D>& air, real sigma,
                                          const Grid<real, D>& curvature) const {
    const real theta = std::clamp(surface.phi(liquid) / (surface.phi(liquid) - surface.phi(air)), 0.0, 1.0);
    return sigma * ((1 - theta) * curvature(liquid) + theta * curvature(air));
}

/// The last pressure, unless it is further from the answer than zero is: liquid that has just left the ground has none, and a residual
/// relative to a right-hand side of round-off cannot be reached from a large guess.
template <int D>
void SurfacePressure<D>::choose_guess(Grid<real, D>& p) {
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        if (A_.cells(I) != Cell::fluid) p(I) = 0;
    });
    poisson::residual(A_, p, b_, r_);
    const auto norm2 = [&](const Grid<real, D>& q) { return sum_over(frame_.cells, [&](const Index<D>& I) { return q(I) * q(I); }); };
    if (norm2(r_) > norm2(b_)) p.fill(0);
}

template <int D>
const poisson::Report& SurfacePressure<D>::project(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                                   const Grid<real, D>* curvature) {
    if (liquid_cells_ == 0) return nothing_to_do_;  // every drop has left or is thinner than a cell: nothing is under pressure
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        b_(I) = 0;
        if (A_.cells(I) != Cell::fluid) return;
        b_(I) = -h2_ * state.rho / dt * flux_divergence(state, I);
        if (curvature == nullptr) return;
        for (int a = 0; a < D; ++a)
            for (const int by : {-1, 1}) {
                Index<D> J = I;
                if (!frame_.step(J, a, by) || A_.cells(J) != Cell::air) continue;
                const Index<D> face = by < 0 ? I : I + e<D>(a);
                b_(I) +=
                    A_.axis_weight[a] * A_.weight[static_cast<std::size_t>(a)](face) * surface_pressure(surface, I, J, sigma, *curvature);
            }
    });
    choose_guess(state.p);
    solver_->setup(A_);
    const poisson::Report& report = solver_->solve(state.p, b_);
    subtract_gradient(state, surface, dt, sigma, curvature);
    return report;
}

template <int D>
void SurfacePressure<D>::subtract_gradient(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                           const Grid<real, D>* curvature) const {
    for (int a = 0; a < D; ++a) {
        const auto& weight = A_.weight[static_cast<std::size_t>(a)];
        const real scale = dt / state.rho * frame_.inv_h[a];
        const auto subtract = [&](const Index<D>& I) {
            Index<D> lower = I, upper = I;
            bool has_lower = frame_.step(lower, a, -1), has_upper = I[a] < frame_.cells[a];
            if (frame_.periodic(a) && !has_upper) has_upper = true, upper[a] = 0;
            const real p_lower = has_lower ? state.p(lower) : 0, p_upper = has_upper ? state.p(upper) : 0;
            if (!has_lower || !has_upper) {
                state.u[a](I) -= scale * 2 * (p_upper - p_lower);
                return;
            }
            const bool below = A_.cells(lower) == Cell::fluid, above = A_.cells(upper) == Cell::fluid;
            real difference = p_upper - p_lower;
            if (below != above) {
                const Index<D>&liquid = below ? lower : upper, &air = below ? upper : lower;
                const real p_surface = curvature ? surface_pressure(surface, liquid, air, sigma, *curvature) : 0;
                const real inv_theta = std::min(1 - surface.phi(air) / surface.phi(liquid), 1 + 1 / thinnest);
                difference = (below ? p_surface - p_lower : p_upper - p_surface) * inv_theta;
            }
            state.u[a](I) -= scale * difference;
        };
        for_each_line(weight.extent(), [&](Index<D> I, std::size_t at) {
            for (; I[0] < weight.extent()[0]; ++I[0], ++at)
                if (weight[at] != 0) subtract(I);
        });
    }
}

template <int D>
real SurfacePressure<D>::max_divergence(const MacState<D>& state) const {
    return max_over(frame_.cells,
                    [&](const Index<D>& I) { return A_.cells(I) == Cell::fluid ? std::abs(flux_divergence(state, I)) : 0.0; });
}

template <int D>
std::size_t SurfacePressure<D>::bytes() const {
    std::size_t total = A_.cells.size() + 2 * b_.size() * sizeof(real) + solver_->bytes();
    for (const auto& weight : A_.weight) total += weight.size() * sizeof(real);
    return total;
}

template class SurfacePressure<2>;
template class SurfacePressure<3>;

}  // namespace weir::mac
