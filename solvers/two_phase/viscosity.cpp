#include "two_phase/viscosity.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {
constexpr real tolerance = 1e-10;
constexpr int most_iterations = 2000;
}  // namespace

template <int D>
Viscosity<D>::Viscosity(const MacState<D>& state, real mu_liquid, real mu_gas)
    : mu_liquid_(mu_liquid),
      mu_gas_(mu_gas),
      cell_mu_(state.extent()),
      boundary_(state.boundary),
      direction_(state.u),
      residual_(state.u.cells, state.u.h, state.u.origin),
      product_(residual_),
      diagonal_(residual_) {
    for (int a = 0; a < D; ++a) homogeneous_[static_cast<std::size_t>(a)] = boundary_[static_cast<std::size_t>(a)].homogeneous();
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) edge(a, b) = Grid<real, D>(Extent<D>(state.u.cells + e<D>(a) + e<D>(b)));
}

template <int D>
template <class F>
void Viscosity<D>::for_each_unknown(F&& f) const {
    for (int a = 0; a < D; ++a) for_each_free_face(residual_, state_->sides, a, [&](const Index<D>& I) { f(a, I); });
}

/// The sum of f(a, I) over all unknowns.
template <int D>
template <class F>
real Viscosity<D>::sum(F&& f) const {
    real total = 0;
    for (int a = 0; a < D; ++a) {
        const Nodes<D> faces = free_faces(residual_, state_->sides, a);
        const Extent<D> extent(faces.hi - faces.lo);
        total += sum_over(extent, [&](const Index<D>& I) { return f(a, I + faces.lo); });
    }
    return total;
}

/// Returns whether the edge at the lower corner of cell I across axes a and b is inside the domain, or on a wall without slip.
template <int D>
bool Viscosity<D>::bears_shear(int a, int b, const Index<D>& I) const {
    for (const int axis : {a, b}) {
        const int n = residual_.cells[axis];
        if (state_->sides.periodic(axis) || (I[axis] > 0 && I[axis] < n)) continue;
        const auto& side = state_->sides.side(axis, I[axis] == 0 ? 0 : 1);
        if (side.kind == geometry::SideKind::outflow || !(side.no_slip || side.kind == geometry::SideKind::moving_wall)) return false;
    }
    return true;
}

template <int D>
void Viscosity<D>::find_viscosities(const Padded<D>& f) {
    const auto mu = [&](const Index<D>& I) { return mu_gas_ + (mu_liquid_ - mu_gas_) * std::clamp(f(I), 0.0, 1.0); };
    for_each_cell(cell_mu_.extent(), [&](const Index<D>& I) { cell_mu_(I) = mu(I); });
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a)
            for_each_cell(edge(a, b).extent(), [&](const Index<D>& I) {
                const Index<D> J = I - e<D>(a), K = I - e<D>(b);
                edge(a, b)(I) = bears_shear(a, b, I) ? 0.25 * ((mu(I) + mu(J - e<D>(b))) + (mu(J) + mu(K))) : 0;
            });
}

/// 2μD_ab at the lower side along b of the volume of face I of component a; for a = b at the middle of cell I − e_a.
template <int D>
real Viscosity<D>::stress(const PaddedVelocity<D>& u, int a, int b, const Index<D>& I) const {
    const Vec<D>& h = residual_.h;
    const Index<D> below = I - e<D>(b);
    if (a != b) return edge(a, b)(I) * ((u[a](I) - u[a](below)) / h[b] + (u[b](I) - u[b](I - e<D>(a))) / h[a]);
    const int n = residual_.cells[a];
    Index<D> cell = below;
    if (cell[a] < 0) cell[a] = state_->sides.periodic(a) ? n - 1 : 0;
    if (cell[a] >= n) cell[a] = state_->sides.periodic(a) ? 0 : n - 1;
    return 2 * cell_mu_(cell) * (u[a](I) - u[a](below)) / h[a];
}

/// ((ρ − dt ∇·2μD) u)_a at face I
template <int D>
real Viscosity<D>::image(const PaddedVelocity<D>& u, int a, const Index<D>& I) const {
    real divergence = 0;
    for (int b = 0; b < D; ++b) divergence += (stress(u, a, b, I + e<D>(b)) - stress(u, a, b, I)) / residual_.h[b];
    return rho_.of((*faces_)[static_cast<std::size_t>(a)](I)) * u[a](I) - dt_ * divergence;
}

template <int D>
real Viscosity<D>::diagonal(int a, const Index<D>& I) const {
    const Vec<D>& h = residual_.h;
    const int n = residual_.cells[a];
    const int upper = state_->sides.periodic(a) ? I[a] % n : std::min(I[a], n - 1);
    const int lower = I[a] > 0 ? I[a] - 1 : state_->sides.periodic(a) ? n - 1 : 0;
    Index<D> up = I, down = I;
    up[a] = upper, down[a] = lower;
    real sum = 2 * (cell_mu_(up) + cell_mu_(down)) / (h[a] * h[a]);
    for (int b = 0; b < D; ++b)
        if (b != a) sum += (edge(a, b)(I) + edge(a, b)(I + e<D>(b))) / (h[b] * h[b]);
    return rho_.of((*faces_)[static_cast<std::size_t>(a)](I)) + dt_ * sum;
}

/// Walls hold the faces on them, which are no unknowns, at zero change.
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
    const auto guess = [&](int a, const Index<D>& I) { return rho_.of((*faces_)[static_cast<std::size_t>(a)](I)) * state_->u[a](I); };
    for (int a = 0; a < D; ++a) fill(direction_[a], state_->u[a], boundary_[static_cast<std::size_t>(a)]);
    for_each_unknown([&](int a, const Index<D>& I) {
        diagonal_[a](I) = diagonal(a, I);
        residual_[a](I) = guess(a, I) - image(direction_, a, I);
    });
    clear_walls();
    norm_of_b_ = std::sqrt(sum([&](int a, const Index<D>& I) { return guess(a, I) * guess(a, I) / diagonal_[a](I); }));
    const real rz = sum([&](int a, const Index<D>& I) { return residual_[a](I) * residual_[a](I) / diagonal_[a](I); });
    if (norm_of_b_ == 0) norm_of_b_ = std::sqrt(rz);  // fluid at rest beside a moving wall
    return rz == 0 ? 0 : std::sqrt(rz) / norm_of_b_;
}

template <int D>
void Viscosity<D>::apply(MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, const Densities& rho, real dt) {
    state_ = &state, faces_ = &faces, rho_ = rho, dt_ = dt;
    find_viscosities(f);
    iterations_ = 0;
    const real first = start();
    linear::StopTest stop(tolerance, most_iterations, iterations_);
    const linear::Outcome outcome = linear::conjugate_gradients(*this, stop, first);
    if (!outcome.broke_down) linear::require_converged("velocity", "viscosity", outcome, stop);
    sync_periodic(state.u, state.sides);
}

template <int D>
real Viscosity<D>::precondition() {
    return sum([&](int a, const Index<D>& I) { return residual_[a](I) * residual_[a](I) / diagonal_[a](I); });
}

template <int D>
void Viscosity<D>::update_direction(real beta) {
    for_each_unknown([&](int a, const Index<D>& I) {
        real& p = direction_[a](I);
        p = residual_[a](I) / diagonal_[a](I) + (beta == 0 ? 0 : beta * p);
    });
    for (int a = 0; a < D; ++a) fill_ghosts(direction_[a], homogeneous_[static_cast<std::size_t>(a)]);
}

template <int D>
real Viscosity<D>::multiply() {
    for_each_unknown([&](int a, const Index<D>& I) { product_[a](I) = image(direction_, a, I); });
    return sum([&](int a, const Index<D>& I) { return direction_[a](I) * product_[a](I); });
}

template <int D>
real Viscosity<D>::advance(real alpha) {
    for_each_unknown([&](int a, const Index<D>& I) {
        state_->u[a](I) += alpha * direction_[a](I);
        residual_[a](I) -= alpha * product_[a](I);
    });
    return std::sqrt(precondition()) / norm_of_b_;
}

template <int D>
std::size_t Viscosity<D>::bytes() const {
    std::size_t total = cell_mu_.bytes() + residual_.bytes() + product_.bytes() + diagonal_.bytes();
    for (const auto& mu : edge_mu_) total += mu.bytes();
    for (const auto& component : direction_.face) total += component.bytes();
    return total;
}

template class Viscosity<2>;
template class Viscosity<3>;

}  // namespace weir::two_phase
