#include "water/pressure.hpp"

#include "free_surface/marker_lanes.hpp"
#include "mac/grid/closed_volume.hpp"

#include <algorithm>

namespace weir::water {

using poisson::Cell;

/// A weight without its factor, the open fraction.
static real per_open(real weight, real open) { return open > 0 ? weight / open : 0; }

template <int D>
static Extent<D> lines_of(Extent<D> cells) {
    cells[0] = 1;
    return cells;
}

template <int D>
SurfacePressure<D>::SurfacePressure(const Frame<D>& frame, const MacState<D>& state, const PoissonChoice& choice)
    : frame_(frame),
      b_(frame.cells),
      liquid_(lines_of(frame.cells)),
      solver_(poisson::make_solver<D>(choice.method, choice.options)),
      tolerance_(choice.options.tolerance),
      h2_(frame.h[0] * frame.h[0]),
      largest_cut_(1 + frame.h_max() / frame.h_min() / thinnest) {
    A_.cells = Grid<Cell, D>(frame.cells, Cell::air);
    for (int a = 0; a < D; ++a) {
        A_.weight[static_cast<std::size_t>(a)] = Grid<real, D>(state.u[a].extent());
        A_.axis_weight[a] = h2_ / (frame.h[a] * frame.h[a]);
        A_.periodic[static_cast<std::size_t>(a)] = frame.periodic(a);
    }
    shares_planes_ = poisson::shares_planes(poisson::method_named(choice.method), A_);
    nothing_to_do_.converged = true;
}

template <int D>
void SurfacePressure<D>::set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, MacState<D>& state) {
    find_liquid(surface, closed);
    refresh_liquid();
    state.cells = A_.cells;
    if (pockets_) add_pockets(state);
    for (int a = 0; a < D; ++a) set_weights(surface, state, a);
    refresh(A_.weight[D - 1], frame_.periodic(D - 1));  // those above the last cells
}

/// In parallel, exchanges the flags of liquid cells at the subdomain boundaries.
template <int D>
void SurfacePressure<D>::refresh_liquid() {
    if (!frame_.own().distributed()) return;
    const std::array<Planes, 2> both{planes_of(A_.cells), planes_of(liquid_)};
    communicator().refresh(frame_.own().partition(), both, 2, frame_.periodic(D - 1));
}

/// Sets the cell flags and the extent of liquid on each line; all loops below are limited to that extent.
template <int D>
void SurfacePressure<D>::find_liquid(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed) {
    const real thin = -thinnest * frame_.h_min();
    const int n = frame_.cells[0];
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        const real* phi = surface.phi.data() + at;
        Cell* cell = A_.cells.data() + at;
        int first = 0;
        for (; first + marker_lanes <= n; first += marker_lanes) {
            const auto below = __builtin_convertvector(simd::load<Lanes>(phi + first) < Lanes{} + thin, LaneBytes);
            const LaneBytes kind =
                below ? LaneBytes{} + static_cast<std::int8_t>(Cell::fluid) : LaneBytes{} + static_cast<std::int8_t>(Cell::air);
            std::memcpy(cell + first, &kind, sizeof kind);
        }
        for (int i = first; i < n; ++i) cell[i] = phi[i] < thin ? Cell::fluid : Cell::air;
        for (int i = 0; !closed.empty() && i < n; ++i) cell[i] = closed[at + static_cast<std::size_t>(i)] ? Cell::solid : cell[i];
        Segment extent{static_cast<int>(std::find(cell, cell + n, Cell::fluid) - cell), n};
        while (extent.end > 0 && cell[extent.end - 1] != Cell::fluid) --extent.end;
        liquid_[at / static_cast<std::size_t>(n)] = extent;
    });
    const int lines = static_cast<int>(liquid_.stride(D - 1)), planes = frame_.cells[D - 1];
    const int begin = frame_.own().lower(0), end = frame_.own().upper(planes);
    has_liquid_ = sum_of_ranks(frame_.own(), std::any_of(liquid_.data() + begin * lines, liquid_.data() + end * lines,
                                                         [](const Segment& extent) { return extent.begin < extent.end; })) > 0;
}

/// Face weights: the open fraction between liquid cells, times 1/θ where the surface cuts the line between the centres, or times the weight
/// of enclosed air on both sides.
template <int D>
void SurfacePressure<D>::set_weights(const LevelSet<D>& surface, const MacState<D>& state, int a) {
    real* weight = A_.weight[static_cast<std::size_t>(a)].data();
    const real* open = state.solid.any() ? state.solid.open[static_cast<std::size_t>(a)].data() : nullptr;
    const auto stride = static_cast<std::size_t>(A_.cells.stride(a));
    for_faces_of_liquid(
        a,
        [&](std::size_t face, std::size_t cell, int count) {
            for (std::size_t end = face + static_cast<std::size_t>(count); face < end; ++face, ++cell) {
                weight[face] = inner_weight(surface, state, cell - stride, cell);
                if (open) weight[face] *= open[face];
            }
        },
        [&](const Index<D>& I, std::size_t face) { weight[face] = side_weight(surface, state, a, I); });
}

/// 1 between liquid cells, 1/θ between a liquid cell and one without liquid, 0 if that one is solid.
template <int D>
real SurfacePressure<D>::inner_weight(const LevelSet<D>& surface, const MacState<D>& state, std::size_t lower, std::size_t upper) const {
    const bool below = state.cells[lower] == Cell::fluid, above = state.cells[upper] == Cell::fluid;
    if (below && above) return 1;
    if (!below && !above) return A_.cells[lower] == Cell::fluid && A_.cells[upper] == Cell::fluid ? gas_weight_ : 0;
    if (!below) std::swap(lower, upper);
    return state.cells[upper] == Cell::solid ? 0 : std::min(1 - surface.phi[upper] / surface.phi[lower], largest_cut_);
}

/// On a side: closed, or p = 0 on the side itself, half a cell away. On a periodic boundary: as inside.
template <int D>
real SurfacePressure<D>::side_weight(const LevelSet<D>& surface, const MacState<D>& state, int a, const Index<D>& I) const {
    const int end = I[a] == 0 ? 0 : 1;
    if (!frame_.periodic(a) && !state.sides.open(a, end)) return 0;
    const std::size_t lower = A_.cells.linear(frame_.near(I, a, -1)), upper = A_.cells.linear(frame_.near(I, a, 0));
    if (!frame_.periodic(a)) return A_.cells[lower] == Cell::fluid ? 2 : 0;
    const real open = state.solid.any() ? state.solid.open[static_cast<std::size_t>(a)](I) : 1;
    return open * inner_weight(surface, state, lower, upper);
}

/// σ κ where the surface cuts the line between two cells.
template <int D>
real SurfacePressure<D>::surface_pressure(const LevelSet<D>& surface, std::size_t liquid, std::size_t air, real sigma,
                                          const Grid<real, D>& curvature) const {
    const real theta = std::clamp(surface.phi[liquid] / (surface.phi[liquid] - surface.phi[air]), 0.0, 1.0);
    return sigma * ((1 - theta) * curvature[liquid] + theta * curvature[air]);
}

/// The contribution of the jump σ κ on the surface to the right-hand side of a liquid cell, or of a cell of enclosed air.
template <int D>
real SurfacePressure<D>::surface_tension(const MacState<D>& state, const LevelSet<D>& surface, real sigma, const Grid<real, D>& curvature,
                                         const Index<D>& I) const {
    const bool liquid = state.cells(I) == Cell::fluid;
    real sum = 0;
    for (int a = 0; a < D; ++a)
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            if (!frame_.step(J, a, by) || state.cells(J) != (liquid ? Cell::air : Cell::fluid)) continue;
            const Index<D> face = by < 0 ? I : I + e<D>(a);
            const std::size_t inside = A_.cells.linear(liquid ? I : J), outside = A_.cells.linear(liquid ? J : I);
            sum += A_.axis_weight[a] * A_.weight[static_cast<std::size_t>(a)](face) *
                   surface_pressure(surface, inside, outside, sigma, curvature);
        }
    return liquid ? sum : -sum;
}

template <int D>
void SurfacePressure<D>::set_rhs(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                 const Grid<real, D>* curvature) {
    const real scale = -h2_ * state.rho / dt;
    for_each_line(frame_.cells, [&](Index<D> I, std::size_t at) {
        const Segment& extent = liquid_[at / static_cast<std::size_t>(frame_.cells[0])];
        if (extent.begin >= extent.end) return;
        I[0] = extent.begin;
        real* b = b_.data() + at;
        flux_divergence_row(state, I, extent.end - extent.begin, b + extent.begin);
        for (int i = extent.begin; i < extent.end; ++i) b[i] *= scale;
        for (; curvature && I[0] < extent.end; ++I[0])
            if (A_.cells(I) == Cell::fluid) b[I[0]] += surface_tension(state, surface, sigma, *curvature, I);
    });
    add_gas_sources(state.rho, dt);
}

template <int D>
void SurfacePressure<D>::apply_drag(const MacState<D>& state) {
    for (int a = 0; a < D; ++a) {
        real* weight = A_.weight[static_cast<std::size_t>(a)].data();
        const real* beta = state.mobility[static_cast<std::size_t>(a)].data();
        for_faces_of_liquid(
            a,
            [&](std::size_t face, std::size_t, int count) {
                for (std::size_t i = face; i < face + static_cast<std::size_t>(count); ++i) weight[i] *= beta[i];
            },
            [&](const Index<D>&, std::size_t face) { weight[face] *= beta[face]; });
    }
}

/// In parallel: distributed where the method supports it, otherwise replicated on each rank.
template <int D>
const poisson::Report& SurfacePressure<D>::solve(MacState<D>& state) {
    if (!frame_.own().distributed()) return solver_->solve(state.p, b_);
    if (solver_->shares_planes()) {
        const poisson::Report& report = solver_->solve(state.p, b_);
        refresh(state.p, frame_.periodic(D - 1));
        return report;
    }
    gather(b_);
    gather(state.p);
    return solver_->solve(state.p, b_);
}

/// Where solids change the volume of liquid and incompressible air without outflow, no pressure can balance it
/// (mac/grid/closed_volume.hpp). `cells`: those of the state, with pockets of air as fluid.
template <int D>
static void require_room(MacState<D>& state, Grid<Cell, D>& cells, const SolidPlacement<D>& solids, real divergence, real dt) {
    std::swap(state.cells, cells);
    try {
        mac::require_room(state, solids, divergence, dt);
    } catch (...) {
        std::swap(state.cells, cells);
        throw;
    }
    std::swap(state.cells, cells);
}

template <int D>
const poisson::Report& SurfacePressure<D>::project(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                                   const Grid<real, D>* curvature, BodiesInFlow<D>* bodies, SolidPlacement<D>* solids) {
    if (!has_liquid_) {  // every drop has left or is thinner than a cell: zero pressure
        if (bodies) bodies->solve(state, *solids, dt, nullptr, tolerance_, nullptr);
        return nothing_to_do_;
    }
    set_gas_velocity(state);
    couple_gas(state.rho, dt);
    set_rhs(state, surface, dt, sigma, curvature);
    if (frame_.own().distributed() && !shares_planes_) {
        gather(A_.cells);
        for (auto& weight : A_.weight) gather(weight);
    }
    solver_->setup(A_);
    const poisson::Report& report =  // the last pressure is the initial guess
        bodies ? bodies->solve(state, *solids, dt, solver_.get(), tolerance_, &b_) : solve(state);
    set_pressure_level(state);
    subtract(state, surface, dt, sigma, curvature, state.u.face);
    if (pockets_ && !pockets_->law() && solids) require_room(state, A_.cells, *solids, max_divergence(state), dt);
    return report;
}

template <int D>
const poisson::Report& SurfacePressure<D>::project_again(MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                                         const Grid<real, D>* curvature) {
    if (!has_liquid_) return nothing_to_do_;
    set_gas_velocity(state);
    set_rhs(state, surface, dt, sigma, curvature);
    const poisson::Report& report = solve(state);
    set_pressure_level(state);
    subtract(state, surface, dt, sigma, curvature, state.u.face);
    return report;
}

template <int D>
void SurfacePressure<D>::subtract(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma, const Grid<real, D>* curvature,
                                  std::array<Grid<real, D>, D>& u) const {
    subtract_gradient(state, dt, u);
    if (curvature) subtract_surface_gradient(state, surface, dt, sigma, *curvature, u);
}

/// u −= (dt/ρ) ∇p on every open face of liquid. p is zero outside the liquid; where the surface cuts the line between two centres the
/// weight 1/θ makes the difference of p the gradient.
template <int D>
void SurfacePressure<D>::subtract_gradient(const MacState<D>& state, real dt, std::array<Grid<real, D>, D>& of) const {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a), stride = static_cast<std::size_t>(A_.cells.stride(a));
        const real scale = dt / state.rho * frame_.inv_h[a];
        for_faces_of_liquid(
            a,
            [&](std::size_t face, std::size_t cell, int count) {
                real* u = of[at].data() + face;
                const real *above = state.p.data() + cell, *below = above - stride, *w = A_.weight[at].data() + face;
                if (state.solid.any()) {
                    const real* open = state.solid.open[at].data() + face;
                    for (int i = 0; i < count; ++i) u[i] -= scale * per_open(w[i], open[i]) * (above[i] - below[i]);
                } else {
#pragma omp simd
                    for (int i = 0; i < count; ++i) u[i] -= scale * w[i] * (above[i] - below[i]);
                }
            },
            [&](const Index<D>& I, std::size_t face) {
                real w = A_.weight[at][face];
                if (w == 0) return;
                const bool joins = frame_.periodic(a);
                if (joins && state.solid.any()) w = per_open(w, state.solid.open[at][face]);
                const real above = joins || I[a] == 0 ? state.p(frame_.near(I, a, 0)) : 0;
                const real below = joins || I[a] > 0 ? state.p(frame_.near(I, a, -1)) : 0;
                of[at][face] -= scale * w * (above - below);
            });
    }
}

/// The contribution of p = σ κ on the surface.
template <int D>
void SurfacePressure<D>::subtract_surface_gradient(const MacState<D>& state, const LevelSet<D>& surface, real dt, real sigma,
                                                   const Grid<real, D>& curvature, std::array<Grid<real, D>, D>& u) const {
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a), stride = static_cast<std::size_t>(A_.cells.stride(a));
        const real scale = dt / state.rho * frame_.inv_h[a];
        const auto subtract = [&](std::size_t face, std::size_t lower, std::size_t upper) {
            const bool below = state.cells[lower] == Cell::fluid, above = state.cells[upper] == Cell::fluid;
            if (below == above || A_.weight[at][face] == 0) return;
            const real w = state.solid.any() ? per_open(A_.weight[at][face], state.solid.open[at][face]) : A_.weight[at][face];
            const real p = surface_pressure(surface, below ? lower : upper, below ? upper : lower, sigma, curvature);
            u[at][face] -= scale * w * (below ? p : -p);
        };
        for_faces_of_liquid(
            a,
            [&](std::size_t face, std::size_t cell, int count) {
                for (const std::size_t end = face + static_cast<std::size_t>(count); face < end; ++face, ++cell)
                    subtract(face, cell - stride, cell);
            },
            [&](const Index<D>& I, std::size_t face) {
                if (frame_.periodic(a)) subtract(face, A_.cells.linear(frame_.near(I, a, -1)), A_.cells.linear(frame_.near(I, a, 0)));
            });
    }
}

template <int D>
real SurfacePressure<D>::max_divergence(const MacState<D>& state) const {
    const int n = frame_.cells[0], planes = frame_.cells[D - 1], lines = static_cast<int>(liquid_.stride(D - 1));
    const auto of_line = [&](int line) {
        const auto [begin, end] = liquid_[static_cast<std::size_t>(line)];
        std::array<real, row_block> divergence;
        real largest = 0;
        for (int first = begin; first < end; first += row_block) {
            const std::size_t at = static_cast<std::size_t>(line) * static_cast<std::size_t>(n) + static_cast<std::size_t>(first);
            const int count = std::min(row_block, end - first);
            flux_divergence_row(state, frame_.index_of(at), count, divergence.data());
            for (int i = 0; i < count; ++i) {
                const real d = std::abs(divergence[static_cast<std::size_t>(i)]);
                if (state.cells[at + static_cast<std::size_t>(i)] == Cell::fluid && !(d <= largest)) largest = d;
            }
            if (std::isnan(largest)) break;
        }
        return largest;
    };
    return plane_max(frame_.own(), planes, [&](int plane) {
        real largest = 0;
        for (int line = plane * lines; line < (plane + 1) * lines; ++line) largest = larger_or_nan(largest, of_line(line));
        return largest;
    });
}

template <int D>
std::size_t SurfacePressure<D>::bytes() const {
    std::size_t total = A_.cells.bytes() + b_.bytes() + liquid_.bytes() + solver_->bytes() + pocket_bytes();
    for (const auto& weight : A_.weight) total += weight.bytes();
    return total;
}

template class SurfacePressure<2>;
template class SurfacePressure<3>;

}  // namespace weir::water
