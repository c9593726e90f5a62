// Bodies on the grid: the faces and cells that a body closes, the pressure's force on it, its weight, and its added mass.
#include "mac/bodies/bodies_in_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;
using rigid::Body;
using rigid::Twist;

namespace {

/// Lower bounds of mass and inertia, relative to those of the displaced fluid: a massless body without other resistance moves as one of
/// this mass. Its added mass is some tenths at least, so lighter bodies do not differ. The bound of the inertia is larger: with free slip
/// the added inertia may be zero.
constexpr real least_mass = 1e-9, least_inertia = 1e-4;

/// In cells: largest penetration of a body into liquid before the first pressure solve that includes it.
constexpr real unfelt = 0.1;

}  // namespace

/// Distance between a dry body and the liquid: minimum over points beside the body of the sum of both distances.
template <int D>
real BodiesInFlow<D>::gap(const MacState<D>& s, const Grid<real, D>& phi, real cap, const Body<D>& body) const {
    const geometry::Pose<D> pose = body.pose();
    const real beside = norm(h_);
    CellBox<D> box;
    for (int d = 0; d < D; ++d) {
        const auto cell = [&](real x) { return std::clamp(static_cast<int>(std::floor((x - s.u.origin[d]) / h_[d])), -1, s.u.cells[d]); };
        box.lo[d] = std::max(0, cell(body.at[d] - body.radius - beside));
        box.hi[d] = std::min(s.u.cells[d], cell(body.at[d] + body.radius + beside) + 1);
    }
    real least = infinity;
    box.in_order([&](const Index<D>& I) {
        const real away = phi(I);
        if (away >= std::min(cap, least) || s.cells(I) == Cell::solid) return;
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = s.u.origin[d] + h_[d] * (I[d] + 0.5);
        least = std::min(least, std::max(0.0, body.shape->distance(pose.to_rest(x))) + away);
    });
    return least;
}

template <int D>
real BodiesInFlow<D>::time_to_land(const MacState<D>& s, const Grid<real, D>& phi, real cap, real speed, real dt) const {
    const real least = unfelt * *std::min_element(h_.begin(), h_.end());
    for (const Body<D>& body : bodies_.all()) {
        if (body.wet > 0) continue;
        const real closing = body.max_speed() + norm(gravity_) * dt;
        if (closing * dt <= least) continue;
        dt = std::min(dt, std::max(least / closing, gap(s, phi, cap, body) / (closing + speed)));
    }
    return dt;
}

/// Finds the faces and cells that the bodies close in their present position.
template <int D>
void BodiesInFlow<D>::find_cuts(const MacState<D>& s, const SolidPlacement<D>& solids) {
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        find_faces(s, solids.solids(), b);
        const Body<D>& body = bodies_[b];
        const geometry::Pose<D> pose = body.pose();
        for (Cut& c : cuts_[b]) {
            phi_[c.cell] = 0;  // it held the cell's index in the list
            Vec<D> middle;
            const Index<D> I = index_of<D>(s.extent(), c.cell);
            for (int a = 0; a < D; ++a) middle[a] = s.u.origin[a] + h_[a] * (I[a] + 0.5);
            const Vec<D> rest = pose.to_rest(middle);
            Vec<D> slope;
            for (int a = 0; a < D; ++a) {
                const Vec<D> step = 1e-3 * h_[a] * Vec<D>::unit(a);
                slope[a] = body.shape->distance(rest + step) - body.shape->distance(rest - step);
            }
            const real length = norm(slope);
            const Vec<D> wall = length > 0 ? pose.to_world(rest - (body.shape->distance(rest) / length) * slope) : middle;
            c.below = dot(gravity_, wall - middle), c.deep = dot(gravity_, wall - body.at);
        }
    }
}

/// The cell's entry; phi_ holds its index in the list meanwhile.
template <int D>
typename BodiesInFlow<D>::Cut& BodiesInFlow<D>::cut(std::size_t cell, std::size_t body) {
    auto& list = cuts_[body];
    if (phi_[cell] == 0) {
        list.push_back({cell, {}});
        phi_[cell] = static_cast<real>(list.size());
    }
    return list[static_cast<std::size_t>(phi_[cell]) - 1];
}

/// Finds the faces with the body's velocity, in the order of the grid, and the cells on both sides.
template <int D>
void BodiesInFlow<D>::find_faces(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t b) {
    const std::size_t own = solids.count() - bodies_.count() + b;
    const Body<D>& body = bodies_[b];
    faces_[b].clear(), cuts_[b].clear(), sealed_.clear();
    near_.reserve(solids.count());
    const Vec<D> reach = Vec<D>::constant(body.radius) + 3.0 * h_;          // of the faces that are searched
    solids.find_near({body.at - reach, body.at + reach}, norm(h_), near_);  // every solid that cuts such a face is within this distance
    for (int a = 0; a < D; ++a) {
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        Index<D> lo, hi;
        for (int d = 0; d < D; ++d) {
            lo[d] = std::max(0, static_cast<int>(std::floor((body.at[d] - body.radius - s.u.origin[d]) / h_[d])) - 1);
            hi[d] = std::min(open.extent()[d], static_cast<int>(std::ceil((body.at[d] + body.radius - s.u.origin[d]) / h_[d])) + 2);
            if (lo[d] >= hi[d]) return;  // outside the domain
        }
        const real area = cell_ / h_[a];
        const auto see = [&](const Index<D>& I) {
            const Vec<D> x = s.u.face_centre(a, I), r = x - body.at;
            if (solids.nearest(x, near_) != own) return;
            const Face f{a, open.linear(I), moves_at<D>(a, r)};
            faces_[b].push_back(f);
            const real closed = (1 - open(I)) * area;
            const bool on_wall = (I[a] == 0 && !s.sides.open(a, 0)) || (I[a] == s.u.cells[a] && !s.sides.open(a, 1));
            const auto count = [&](const Index<D>& cell, real flux) {
                const bool shut = s.cells(cell) == Cell::solid;
                if (shut && (on_wall || !density_of_cell_ || !is_sealed(s, solids, own, cell))) return;
                rigid::Twist<D>& out = shut ? sealed_.emplace_back(Sealed{s.cells.linear(cell), {}}).out : cut(s.cells.linear(cell), b).out;
                for (std::size_t k = 0; k < n; ++k) out[k] += flux * f.moves[k];
            };
            if (I[a] > 0) count(I - e<D>(a), closed);
            if (I[a] < s.u.cells[a]) count(I, -closed);
        };
        CellBox<D>{lo, hi}.rows([&](Index<D> I, int count) {
            const real* part = &open(I);
            for (int i = 0; i < count; ++i, ++I[0])
                if (part[i] != 1) see(I);
        });
    }
    if (!sealed_.empty()) open_films(s, solids, b);
}

template <int D>
void BodiesInFlow<D>::set_velocities(MacState<D>& s) const {
    for (std::size_t b = 0; b < bodies_.count(); ++b)
        for (const Face& f : faces_[b]) {
            real v = 0;
            for (std::size_t k = 0; k < n; ++k) v += f.moves[k] * bodies_[b].velocity[k];
            s.solid.velocity[static_cast<std::size_t>(f.axis)][f.face] = v;
        }
}

/// Adds scale Σ D_k V_k of one body.
template <int D>
void BodiesInFlow<D>::scatter(std::size_t body, const Twist<D>& velocity, real scale, Grid<real, D>& to) const {
    for (const Cut& c : cuts_[body]) {
        real out = 0;
        for (std::size_t k = 0; k < n; ++k) out += c.out[k] * velocity[k];
        to[c.cell] += scale / cell_ * out;
    }
}

/// ΔV Σ p D_k for a pressure that is zero outside the fluid.
template <int D>
Twist<D> BodiesInFlow<D>::push(std::size_t body, const Grid<real, D>& p) const {
    Twist<D> sum{};
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; k < n; ++k) sum[k] += c.out[k] * p[c.cell];
    return sum;
}

/// The force and torque of the fluid's pressure on the body's surface.
template <int D>
Twist<D> BodiesInFlow<D>::force(const MacState<D>& s, std::size_t body) const {
    Twist<D> sum = push(body, s.p);
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; s.cells[c.cell] == Cell::fluid && k < n; ++k) sum[k] += c.out[k] * density(s, c.cell) * c.below;
    return sum;
}

/// The liquid volume fraction of the body's surface as resolved by the cells: the part of Σ |D| in fluid cells.
template <int D>
real BodiesInFlow<D>::liquid_fraction(const MacState<D>& s, std::size_t body) const {
    real all = 0, wet = 0;
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; k < D; ++k) {
            all += std::abs(c.out[k]);
            if (s.cells[c.cell] == Cell::fluid) wet += std::abs(c.out[k]);
        }
    return all > 0 ? wet / all : 0;
}

/// The mean over the body's surface, as resolved by the cells.
template <int D>
real BodiesInFlow<D>::density_around(const MacState<D>& s, std::size_t body) const {
    real all = 0, sum = 0;
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; k < D; ++k) all += std::abs(c.out[k]), sum += std::abs(c.out[k]) * density(s, c.cell);
    return all > 0 ? sum / all : 0;
}

/// Weight, and the error of the discrete buoyancy: that of fluid with the body's density (in lighter fluid: with the density
/// around it), less the exact one. A body as dense as the fluid is balanced exactly. In air a body has its full weight.
template <int D>
Twist<D> BodiesInFlow<D>::weight(const MacState<D>& s, std::size_t b) const {
    const Body<D>& body = bodies_[b];
    const Vec<D> r = body.pose().to_world(body.moments.centre) - body.at, weight = body.mass * gravity_;
    const real density = density_of_cell_ ? std::min(body.density(), density_around(s, b)) : body.density();
    const Vec<D> own = density_of_cell_ ? density * body.moments.volume * gravity_ : weight;
    Twist<D> sum{}, even{};  // even: for uniform density, exact
    for (std::size_t a = 0; a < D; ++a) sum[a] = weight[a], even[a] = own[a];
    if (body.wet == 0) return sum;
    if constexpr (D == 2)
        even[2] = r[0] * own[1] - r[1] * own[0];
    else
        for (int a = 0; a < 3; ++a)
            even[static_cast<std::size_t>(3 + a)] = r[(a + 1) % 3] * own[(a + 2) % 3] - r[(a + 2) % 3] * own[(a + 1) % 3];
    for (std::size_t k = 0; k < n; ++k) {
        real seen = 0;
        for (const Cut& c : cuts_[b]) seen -= density * c.out[k] * c.deep;
        sum[k] += body.wet * (seen - even[k]);
    }
    return sum;
}

template <int D>
rigid::Block<D> BodiesInFlow<D>::mass_of(std::size_t b) const {
    const Body<D>& body = bodies_[b];
    auto m = body.mass_matrix();
    const real displaced = rho_ * body.moments.volume;
    const real least = least_inertia * displaced * body.radius * body.radius;
    const real smallest = D == 2 ? body.principal[2] : std::min({body.principal[0], body.principal[1], body.principal[2]});
    for (std::size_t k = 0; k < n; ++k) {
        if (k < D) m[k][k] = std::max(m[k][k], least_mass * displaced);
        if (k >= D && smallest < least) m[k][k] += least - smallest;
    }
    return m;
}

/// ρ ℓ ∫ (n, r × n)(n, r × n)ᵀ dS over the wet surface. For ℓ of half the radius (ball) or the radius (disc) it equals the added mass in
/// unbounded fluid.
template <int D>
rigid::Block<D> BodiesInFlow<D>::mass_of_wet_surface(const MacState<D>& s, std::size_t body) const {
    rigid::Block<D> m{};
    const real layer = bodies_[body].radius * (D == 2 ? 1 : 0.5);
    for (const Cut& c : cuts_[body]) {
        if (s.cells[c.cell] != Cell::fluid) continue;
        real area = 0;
        for (std::size_t k = 0; k < D; ++k) area += c.out[k] * c.out[k];
        if (area == 0) continue;
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) m[k][l] += density(s, c.cell) * layer / std::sqrt(area) * c.out[k] * c.out[l];
    }
    return m;
}

/// m_kl = ρ ΔV D_k·φ_l, A φ_l = h² D_l, and the corresponding mobility.
template <int D>
void BodiesInFlow<D>::measure_added_mass(const MacState<D>& s, poisson::Solver<D>& solver) {
    rigid::Mobility added;
    added.resize(n * bodies_.count());
    if (rhs_.empty()) rhs_ = Grid<real, D>(s.extent());
    for (std::size_t b = 0; b < bodies_.count(); ++b)
        for (std::size_t k = 0; k < n && bodies_[b].wet > 0; ++k) {
            if (!free_[b * n + k]) continue;
            Twist<D> unit{};
            unit[k] = 1;
            rhs_.fill(0);
            scatter(b, unit, h2_, rhs_);
            phi_.fill(0);
            solver.solve(phi_, rhs_);
            for (std::size_t o = 0; o < bodies_.count(); ++o) {
                const Twist<D> column = push(o, phi_);
                for (std::size_t l = 0; l < n; ++l) added(o * n + l, b * n + k) = s.rho * column[l];
            }
        }
    phi_.fill(0);
    for (std::size_t i = 0; i < added.size; ++i)  // symmetrizes the error of the solver's tolerance
        for (std::size_t j = 0; j < i; ++j) added(i, j) = added(j, i) = 0.5 * (added(i, j) + added(j, i));
    added_.learn(added);
    for (std::size_t i = 0; i < added.size; ++i)
        for (std::size_t l = 0; l < n; ++l) added(i, i / n * n + l) += masses_[i / n][i % n][l];
    rigid::invert(added, free_, mobility_);
}

template class BodiesInFlow<2>;
template class BodiesInFlow<3>;

}  // namespace weir::mac
