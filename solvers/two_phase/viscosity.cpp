#include "two_phase/viscosity.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

namespace {
constexpr real tolerance = 1e-10;
constexpr int most_iterations = 2000;
}  // namespace

template <int D>
Viscosity<D>::Viscosity(const MacState<D>& state, const SolidPlacement<D>& solids, real mu_liquid, real mu_gas)
    : mu_liquid_(mu_liquid),
      mu_gas_(mu_gas),
      cell_mu_(state.extent()),
      boundary_(state.boundary),
      direction_(state.u),
      residual_(state.u.cells, state.u.h, state.u.origin),
      product_(residual_),
      mass_(residual_),
      inverse_(residual_) {
    for (int a = 0; a < D; ++a) homogeneous_[static_cast<std::size_t>(a)] = boundary_[static_cast<std::size_t>(a)].homogeneous();
    for (int b = 1; b < D; ++b)
        for (int a = 0; a < b; ++a) {
            edge(a, b) = Grid<real, D>(Extent<D>(state.u.cells + e<D>(a) + e<D>(b)));
            if (solids.any()) find_solid_edges(state, solids, a, b);
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

/// f(a, first, count) on the rows of unknowns of every component.
template <int D>
template <class F>
void Viscosity<D>::for_each_row(F&& f) const {
    for (int a = 0; a < D; ++a) {
        const Nodes<D> faces = free_faces(residual_, state_->sides, a);
        Extent<D> rows = faces.hi;
        rows[0] = faces.lo[0] + 1;
        for_each_in(faces.lo, rows, [&](const Index<D>& first) { f(a, first, faces.hi[0] - faces.lo[0]); });
    }
}

/// The sum of f(a, first, count) over the rows of unknowns.
template <int D>
template <class F>
real Viscosity<D>::sum_of_rows(F&& f) const {
    real total = 0;
    for (int a = 0; a < D; ++a) {
        const Nodes<D> faces = free_faces(residual_, state_->sides, a);
        Extent<D> rows(faces.hi - faces.lo);
        rows[0] = 1;
        total += sum_over(rows, [&](const Index<D>& row) { return f(a, row + faces.lo, faces.hi[0] - faces.lo[0]); });
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
    const real rz = precondition();
    if (norm_of_b_ == 0) norm_of_b_ = std::sqrt(rz);  // fluid at rest beside a moving wall
    return rz == 0 ? 0 : std::sqrt(rz) / norm_of_b_;
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
    const linear::Outcome outcome = linear::conjugate_gradients(*this, stop, first);
    if (!outcome.broke_down) linear::require_converged("velocity", "viscosity", outcome, stop);
    sync_periodic(state.u, state.sides);
}

template <int D>
real Viscosity<D>::precondition() {
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
        if (beta == 0)
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
    return std::sqrt(sum_of_rows([&](int a, const Index<D>& first, int count) {
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

template <int D>
std::size_t Viscosity<D>::bytes() const {
    std::size_t total = cell_mu_.bytes() + residual_.bytes() + product_.bytes() + mass_.bytes() + inverse_.bytes();
    for (const auto& mu : edge_mu_) total += mu.bytes();
    for (const auto& component : direction_.face) total += component.bytes();
    return total;
}

template class Viscosity<2>;
template class Viscosity<3>;

}  // namespace weir::two_phase
