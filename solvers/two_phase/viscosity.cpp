#include "two_phase/viscosity.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {
constexpr real tolerance = 1e-10;
constexpr int most_iterations = 2000;
/// A V-cycle takes as long as 3 to 6 iterations by the diagonal, and a solve 7 to 10 of them: they break even at 25 to 40 iterations, where
/// the mean square, which counts the faces at the surface less than they weigh, gives about 20.
constexpr real most_by_diagonal = 20;

template <int D>
std::array<Boundary<D>, D> homogeneous(std::array<Boundary<D>, D> boundary) {
    for (auto& of : boundary) of = of.homogeneous();
    return boundary;
}
}  // namespace

template <int D>
Viscosity<D>::Viscosity(const MacState<D>& state, const SolidPlacement<D>& solids, real mu_liquid, real mu_gas)
    : mu_liquid_(mu_liquid),
      mu_gas_(mu_gas),
      cell_mu_(state.extent()),
      boundary_(state.boundary),
      homogeneous_(homogeneous<D>(state.boundary)),
      direction_(state.u),
      residual_(state.u.cells, state.u.h, state.u.origin),
      product_(residual_),
      mass_(residual_),
      inverse_(residual_),
      cycled_(residual_),
      multigrid_(state.extent(), state.u.h, homogeneous<D>(state.boundary)) {
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) edge(a, b) = Grid<real, D>(Extent<D>(state.u.cells + e<D>(a) + e<D>(b)));
    if (solids.any()) see_solids(state, solids);
}

template <int D>
void Viscosity<D>::see_solids(const MacState<D>& state, const SolidPlacement<D>& solids) {
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            solid_edges_[edge_number(a, b)].clear();
            find_solid_edges(state, solids, a, b);
        }
}

template <int D>
void Viscosity<D>::find_solid_edges(const MacState<D>& state, const SolidPlacement<D>& solids, int a, int b) {
    const auto is_closed = [&](int axis, const Index<D>& F) {
        const auto& open = state.solid.open[static_cast<std::size_t>(axis)];
        return open.contains(F) && open(F) == 0;
    };
    const Grid<real, D>& edges = edge(a, b);
    for (std::size_t at = 0; at < edges.size(); ++at) {
        const Index<D> I = index_of<D>(edges.extent(), at);
        if (!is_closed(a, I) && !is_closed(a, I - e<D>(b)) && !is_closed(b, I) && !is_closed(b, I - e<D>(a))) continue;
        Vec<D> x = state.u.face_centre(a, I);
        x[b] = state.u.origin[b] + state.u.h[b] * I[b];
        const auto& all = solids.solids();
        solid_edges_[edge_number(a, b)].push_back({at, all[all.nearest(x)].no_slip ? 2.0 : 0.0});
    }
}

/// Returns whether the edge at the lower corner of cell I across axes a and b is inside the domain, or on a wall without slip.
template <int D>
bool Viscosity<D>::bears_shear(int a, int b, const Index<D>& I) const {
    for (const int axis : {a, b}) {
        const int n = residual_.cells[axis];
        if (state_->sides.periodic(axis) || (I[axis] > 0 && I[axis] < n)) continue;
        const auto& side = state_->sides.side(axis, I[axis] == 0 ? 0 : 1);
        if (!(side.kind == geometry::SideKind::moving_wall || (side.kind == geometry::SideKind::wall && side.no_slip))) return false;
    }
    return true;
}

template <int D>
void Viscosity<D>::find_viscosities(const Padded<D>& f) {
    const auto mu = [&](const Index<D>& I) { return mu_gas_ + (mu_liquid_ - mu_gas_) * std::clamp(f(I), 0.0, 1.0); };
    const Index<D> one = Index<D>::constant(1);
    for_each_cell(Extent<D>(cell_mu_.extent() + one + one), [&](const Index<D>& I) { cell_mu_(I - one) = mu(I - one); });
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            for_each_cell(edge(a, b).extent(), [&](const Index<D>& I) {
                const Index<D> J = I - e<D>(a), K = I - e<D>(b);
                edge(a, b)(I) = bears_shear(a, b, I) ? 0.25 * ((mu(I) + mu(J - e<D>(b))) + (mu(J) + mu(K))) : 0;
            });
            for (const SolidEdge& beside : solid_edges_[edge_number(a, b)]) edge(a, b)[beside.edge] *= beside.factor;
        }
}

/// The diagonal of the matrix. Beside sides it is that of the interior: close enough to precondition. Its inverse is 0 on closed faces,
/// which keep their velocity.
template <int D>
void Viscosity<D>::find_coefficients() {
    const Vec<D>& h = residual_.h;
    const auto is_closed = [&](int a, const Index<D>& I) {
        return state_->solid.any() && state_->solid.open[static_cast<std::size_t>(a)](I) == 0;
    };
    for_each_row([&](int a, const Index<D>& first, int count) {
        Index<D> I = first;
        for (int i = 0; i < count; ++i, ++I[0]) {
            real sum = 2 * (cell_mu_(I) + cell_mu_(I - e<D>(a))) / (h[a] * h[a]);
            for (int b = 0; b < D; ++b)
                if (b != a) sum += (edge(a, b)(I) + edge(a, b)(I + e<D>(b))) / (h[b] * h[b]);
            inverse_[a](I) = is_closed(a, I) ? 0 : 1 / (mass_[a](I) + dt_ * sum);
        }
    });
}

/// Faces on walls are no unknowns: the direction is 0 there.
template <int D>
void Viscosity<D>::clear_walls() {
    for (int a = 0; a < D; ++a) {
        if (state_->sides.periodic(a)) continue;
        for (const int end : {0, 1}) {
            if (state_->sides.open(a, end)) continue;
            Index<D> lo{};
            Extent<D> hi = residual_[a].extent();
            lo[a] = end == 0 ? 0 : residual_.cells[a];
            hi[a] = lo[a] + 1;
            for_each_in(lo, hi, [&](const Index<D>& I) { direction_[a](I) = 0; });
        }
    }
}

/// r = ρ u* − A u*. Returns the norm of r relative to that of ρ u*.
template <int D>
real Viscosity<D>::start() {
    for (int a = 0; a < D; ++a) fill(direction_[a], state_->u[a], boundary_[static_cast<std::size_t>(a)]);
    for_each_row([&](int a, const Index<D>& first, int count) {
        real* r = &residual_[a](first);
        multiply_row(a, first, count, r);
        const real *rho = &mass_[a](first), *u = &state_->u[a](first);
        for (int i = 0; i < count; ++i) r[i] = rho[i] * u[i] - r[i];
    });
    clear_walls();
    norm_of_b_ = std::sqrt(sum_of_rows([&](int a, const Index<D>& first, int count) {
        const real *rho = &mass_[a](first), *u = &state_->u[a](first), *inverse = &inverse_[a](first);
        real sum = 0;
        for (int i = 0; i < count; ++i) sum += rho[i] * u[i] * rho[i] * u[i] * inverse[i];
        return sum;
    }));
    cycles_ = false;
    const real rz = precondition();
    if (norm_of_b_ == 0) norm_of_b_ = std::sqrt(rz);  // fluid at rest beside a moving wall
    return relative_ = rz == 0 ? 0 : std::sqrt(rz) / norm_of_b_;
}

template <int D>
void Viscosity<D>::apply(MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, const Densities& rho, real dt) {
    state_ = &state, dt_ = dt;
    find_viscosities(f);
    for (int a = 0; a < D; ++a)
        for_each_cell(mass_[a].extent(), [&](const Index<D>& I) { mass_[a](I) = rho.of(faces[static_cast<std::size_t>(a)](I)); });
    find_coefficients();
    iterations_ = 0;
    const real first = start();
    linear::StopTest stop(tolerance, most_iterations, iterations_);
    cycles_ =
        multigrid_.has_coarse_grid() && (preconditioner_ == Preconditioner::multigrid ||
                                         (preconditioner_ == Preconditioner::cheaper && expected_iterations(first) > most_by_diagonal));
    if (cycles_) build_multigrid();
    linear::Outcome outcome = linear::conjugate_gradients(*this, stop, first);
    if (cycles_ && outcome.broke_down && stop.wants_more(outcome.relative_residual)) {  // round-off of single precision
        cycles_ = false;
        outcome = linear::conjugate_gradients(*this, stop, outcome.relative_residual);
    }
    if (!outcome.broke_down) linear::require_converged("velocity", "viscosity", outcome, stop);
    sync_periodic(state.u, state.sides);
}

/// ½ √κ ln(2 ε₀/ε), the bound of conjugate gradients (Saad 2003, equation 6.128), with the diagonal: its κ is at most 4 (1 + q) for q = dt
/// viscosity over mass of the stiffest face. The few faces at the surface with far larger ones are outliers of the spectrum, so q is the
/// root mean square of all faces.
template <int D>
real Viscosity<D>::expected_iterations(real first) const {
    real faces = 0;
    for (int a = 0; a < D; ++a) faces += static_cast<real>(product(mac::free_faces(residual_, state_->sides, a).hi));
    const real squares = sum_of_rows([&](int a, const Index<D>& at, int count) {
        const real *rho = &mass_[a](at), *inverse = &inverse_[a](at);
        real sum = 0;
        for (int i = 0; i < count; ++i) {
            const real ratio = inverse[i] == 0 ? 0 : 1 / (rho[i] * inverse[i]) - 1;
            sum += ratio * ratio;
        }
        return sum;
    });
    return 0.5 * std::sqrt(1 + std::sqrt(squares / faces)) * std::log(std::max(2 * first / tolerance, 1.0));
}

template <int D>
std::size_t Viscosity<D>::bytes() const {
    std::size_t total =
        cell_mu_.bytes() + residual_.bytes() + cycled_.bytes() + multigrid_.bytes() + product_.bytes() + mass_.bytes() + inverse_.bytes();
    for (const auto& mu : edge_mu_) total += mu.bytes();
    for (const auto& component : direction_.face) total += component.bytes();
    return total;
}

template class Viscosity<2>;
template class Viscosity<3>;

}  // namespace weir::two_phase
