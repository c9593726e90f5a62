#include "staggered/bodies_in_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::staggered {

using poisson::Cell;
using rigid::Body;
using rigid::Twist;

namespace {

/// Lower bounds of mass and inertia, relative to those of the displaced fluid: a massless body without other resistance moves as one of
/// this mass. Its added mass is some tenths at least, so lighter bodies do not differ. The bound of the inertia is larger: with free slip
/// the added inertia may be zero.
constexpr real least_mass = 1e-9, least_inertia = 1e-4;

/// Limits of the partitioned coupling iterations: before the added mass is measured (one solve per degree of freedom) instead of estimated,
/// and after that.
constexpr int most_iterations = 12, most_iterations_measured = 6;

/// Stop tolerance of the pressure solve in one coupling iteration, relative to the right-hand side and to the last change of the
/// velocities.
constexpr real first_tolerance = 1e-2, of_change = 1e-2;

/// A change updates the estimate of the added mass if it exceeds the previous residual by this factor.
constexpr real differs = 5;

/// Part of the tolerance for the pressure solve where the system is monolithic: the following change of the velocities is then round-off.
constexpr real monolithic_part = 0.9;

/// Largest ratio of added mass to mass for bodies in the pressure matrix, whose condition number grows with it. Lighter bodies are coupled
/// by partitioned iterations.
constexpr real most_added = 60;

/// In cells: largest penetration of a body into liquid before the first pressure solve that includes it.
constexpr real unfelt = 0.1;

}  // namespace

void refuse_explicit_friction(const scene::Table& viscosity, const scene::Scene& scene) {
    for (const auto& body : scene.root().tables("bodies"))
        if (viscosity.text("scheme") != "implicit" && body.text("slip") == "no")
            scene.refuse(
                "effects.viscosity.scheme",
                "effects.viscosity.scheme = \"" + viscosity.text("scheme") + "\" evaluates friction at the body positions before the step",
                "a body with slip = \"no\" requires scheme = \"implicit\"");
}

template <int D>
std::unique_ptr<BodiesInFlow<D>> BodiesInFlow<D>::make(const scene::Scene& scene) {
    return scene.has("bodies") && !scene.root().tables("bodies").empty() ? std::make_unique<BodiesInFlow>(scene) : nullptr;
}

template <int D>
geometry::Solids<D> BodiesInFlow<D>::solids(const scene::Scene& scene, BodiesInFlow* in) {
    geometry::Solids<D> solids(scene);
    if (in) in->bodies_.join(solids);
    return solids;
}

template <int D>
BodiesInFlow<D>::BodiesInFlow(const scene::Scene& scene)
    : bodies_(scene), rho_(scene.number("fluid.density")), faces_(bodies_.count()), cuts_(bodies_.count()) {
    if (const auto* gravity = scene.effect("gravity")) gravity_ = gravity->template vec<D>("g");
    const Lattice<D> lattice(scene);
    h_ = lattice.h, h2_ = h_[0] * h_[0], cell_ = 1;
    for (int a = 0; a < D; ++a) cell_ *= h_[a];
    phi_ = Grid<real, D>(lattice.cells);
    added_.resize(bodies_.count());
    masses_.resize(bodies_.count());
    free_.resize(n * bodies_.count());
    for_each_list(*this, [&](std::vector<real>& list) { list.resize(free_.size()); });
    joined_.resize(bodies_.count()), inverse_.resize(bodies_.count());
    for (std::size_t b = 0; b < bodies_.count(); ++b)
        for (std::size_t k = 0; k < n; ++k) free_[b * n + k] = !bodies_[b].held[k];
}

template <int D>
void BodiesInFlow<D>::start(const MacState<D>& s, const SolidPlacement<D>& solids) {
    find_cuts(s, solids);
    for (std::size_t i = 0; i < bodies_.count(); ++i) bodies_[i].wet = liquid_fraction(s, i);
    rigid::Surroundings<D> around = bodies_.surroundings(solids.solids());
    around.reach = 1e-3 * norm(h_);
    contacts_.find(bodies_.all(), around);
    contacts_.mark(bodies_.all());  // bodies at rest on a support do not start with the velocity of free fall
}

template <int D>
void BodiesInFlow<D>::couple_friction(MacState<D>& s, bool holds_closed) {
    no_slip_walls_ = std::make_unique<NoSlipWalls<D>>();
    no_slip_walls_->holds_closed = holds_closed;
    no_slip_walls_->bodies.resize(bodies_.count());
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        bodies_[i].has_viscous = no_slip_walls_->bodies[i].coupled = bodies_[i].no_slip;
        no_slip_walls_->bodies[i].held = bodies_[i].held;
    }
    s.no_slip_walls = no_slip_walls_.get();
    // friction precedes the pressure solve and uses the previous pressure: initially the hydrostatic one
    for_each_cell(s.extent(), [&](const Index<D>& I) {
        if (s.cells(I) == Cell::fluid) s.p(I) = s.rho * dot(gravity_, s.u.cell_centre(I));
    });
}

/// Sets body velocities in the cells they cover: the previous pressure includes the weight there, so that velocity must include free fall.
template <int D>
void BodiesInFlow<D>::leave(MacState<D>& s, real dt) const {
    for (int a = 0; a < D; ++a) {
        const auto &open = s.solid.open[static_cast<std::size_t>(a)], &velocity = s.solid.velocity[static_cast<std::size_t>(a)];
        for_each_free_face(s.u, s.sides, a, [&](const Index<D>& I) {
            if (open(I) == 0) s.u[a](I) = velocity(I) + dt * gravity_[a];
        });
    }
    continue_pressure(s);
}

template <int D>
void BodiesInFlow<D>::continue_pressure(MacState<D>& s) const {
    for_each_cell(s.extent(), [&](const Index<D>& I) {
        if (s.cells(I) != Cell::solid) return;
        real sum = 0;
        int known = 0;
        for (int b = 0; b < D; ++b)
            for (const int way : {-1, 1}) {
                const Index<D> N = way < 0 ? I - e<D>(b) : I + e<D>(b);
                if (!s.cells.contains(N) || s.cells(N) != Cell::fluid) continue;
                sum += s.p(N) - way * s.rho * gravity_[b] * h_[b], ++known;
            }
        if (known > 0) s.p(I) = sum / known;
    });
}

/// The friction step precedes the pressure solve, weights and contacts; it estimates their impulses by those of the last step. A body in
/// steady motion then has the correct friction (van Kan 1986 uses the old pressure of the fluid likewise). Contacts are excluded, because
/// impacts do not repeat. Torques are excluded: round bodies get none from pressure, and light bodies of other shapes have so little
/// inertia that errors of the estimate are unstable.
template <int D>
void BodiesInFlow<D>::set_no_slip_walls(const MacState<D>& s, const SolidPlacement<D>& solids, real dt) {
    if (!no_slip_walls_) return;
    find_cuts(s, solids);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        NoSlipBody<D>& no_slip_body = no_slip_walls_->bodies[i];
        if (!no_slip_body.coupled) continue;
        const Body<D>& body = bodies_[i];
        const rigid::Block<D> own = mass_of(i), added = mass_of_wet_surface(s, i);
        no_slip_body.velocity = body.velocity;
        no_slip_body.turning = 2 * s.rho * s.nu * body.moments.volume;
        for (std::size_t k = 0; k < n; ++k) {
            no_slip_body.drive[k] = k < D ? -dt * body.viscous[k] : 0;
            for (std::size_t l = 0; l < n; ++l) {
                no_slip_body.mass[k][l] = own[k][l] + (k < D && l < D ? added[k][l] : 0);
                if (k < D && l < D && !body.touches) no_slip_body.drive[k] += dt * no_slip_body.mass[k][l] * gained_[i * n + l];
            }
        }
    }
    find_no_slip_walls(s, solids, *no_slip_walls_);
}

template <int D>
void BodiesInFlow<D>::advance_free(SolidPlacement<D>& solids, real dt) {
    for (auto& body : bodies_.all()) body.advance_free(dt, gravity_);
    bodies_.place(solids.solids());
}

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

template <int D>
void BodiesInFlow<D>::save(Checkpoint& to) const {
    bodies_.save(to);
    added_.save(to, "bodies.added");
    to.put("bodies.gained", gained_);
}

template <int D>
void BodiesInFlow<D>::restore(const Checkpoint& from, SolidPlacement<D>& solids) {
    bodies_.restore(from);
    added_.restore(from, "bodies.added");
    from.get("bodies.gained", std::span<real>(gained_));
    bodies_.place(solids.solids());
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
    faces_[b].clear(), cuts_[b].clear();
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
            const auto count = [&](const Index<D>& cell, real flux) {
                if (s.cells(cell) == Cell::solid) return;
                Cut& c = cut(s.cells.linear(cell), b);
                for (std::size_t k = 0; k < n; ++k) c.out[k] += flux * f.moves[k];
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
        for (std::size_t k = 0; s.cells[c.cell] == Cell::fluid && k < n; ++k) sum[k] += c.out[k] * s.rho * c.below;
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

/// Weight minus the discrete buoyancy of fluid with the body's density, as force and torque: a body as dense as the fluid is balanced
/// exactly. In air a body has its full weight.
template <int D>
Twist<D> BodiesInFlow<D>::weight(std::size_t b) const {
    const Body<D>& body = bodies_[b];
    const Vec<D> r = body.pose().to_world(body.moments.centre) - body.at, own = body.mass * gravity_;
    Twist<D> sum{}, even{};  // even: for uniform density, exact
    for (std::size_t a = 0; a < D; ++a) sum[a] = even[a] = own[a];
    if (body.wet == 0) return sum;
    if constexpr (D == 2)
        even[2] = r[0] * own[1] - r[1] * own[0];
    else
        for (int a = 0; a < 3; ++a)
            even[static_cast<std::size_t>(3 + a)] = r[(a + 1) % 3] * own[(a + 2) % 3] - r[(a + 2) % 3] * own[(a + 1) % 3];
    for (std::size_t k = 0; k < n; ++k) {
        real seen = 0;
        for (const Cut& c : cuts_[b]) seen -= body.density() * c.out[k] * c.deep;
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
    const real layer = s.rho * bodies_[body].radius * (D == 2 ? 1 : 0.5);
    for (const Cut& c : cuts_[body]) {
        if (s.cells[c.cell] != Cell::fluid) continue;
        real area = 0;
        for (std::size_t k = 0; k < D; ++k) area += c.out[k] * c.out[k];
        if (area == 0) continue;
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) m[k][l] += layer / std::sqrt(area) * c.out[k] * c.out[l];
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

/// Initializes the bodies' masses, forces and velocities; the next velocities are extrapolated with the last step's acceleration.
template <int D>
void BodiesInFlow<D>::begin(const MacState<D>& s, bool wet, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        body.wet = wet ? liquid_fraction(s, i) : 0;
        masses_[i] = mass_of(i);
        added_.see(i, body.wet > 0 ? mass_of_wet_surface(s, i) : rigid::Block<D>{});
        const Twist<D> heavy = weight(i);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t at = i * n + k;
            before_[at] = velocity_[at] = base_[at] = body.velocity[k];
            next_[at] = before_[at] + (body.wet > 0 && !body.touches ? dt * gained_[at] : 0);
            heavy_[at] = dt * heavy[k];
            if (k < D) heavy_[at] += dt * (masses_[i][k][k] - body.mass) * gravity_[k];
            if (no_slip_walls_) heavy_[at] += no_slip_walls_->bodies[i].impulse[k];
        }
    }
    if (brush_forcing_) apply_grab(s, dt);
    added_.begin(masses_, free_, mobility_);
}

template <int D>
void BodiesInFlow<D>::follow(std::shared_ptr<BrushForcing> forcing, const scene::Scene& scene) {
    brush_forcing_ = std::move(forcing);
    for (std::size_t i = 0; i < brush_forcing_->keys.size(); ++i)
        if (brush_forcing_->keys[i].kind == BrushKind::grab && brush_forcing_->keys[i].body >= static_cast<int>(bodies_.count()))
            scene.refuse("effects.hand.keyframes[" + std::to_string(i) + "].body", "there is no such body",
                         "numbers of the list bodies, from 0 to " + std::to_string(bodies_.count() - 1));
}

/// Interactive forcing: dv/dt = rate (target − v) for the mass of the body and of the displaced liquid, implicit in v, so stable for any
/// step. The factor of v is added to the mass.
template <int D>
void BodiesInFlow<D>::apply_grab(const MacState<D>& s, real dt) {
    const auto brush = brush_forcing_->at<D>(s.time);
    grab_.body = brush.kind == BrushKind::grab ? brush.body : -1;
    if (grab_.body < 0) return;
    const auto b = static_cast<std::size_t>(grab_.body);
    const Body<D>& body = bodies_[b];
    grab_.weight = dt * brush_forcing_->rate * (body.mass + body.wet * rho_ * body.moments.volume);
    grab_.target = 0.25 * brush_forcing_->rate * (brush.centre - body.at);
    for (std::size_t a = 0; a < D; ++a) {
        real& target = grab_.target[static_cast<int>(a)];
        target = std::clamp(target, -h_[static_cast<int>(a)] / dt, h_[static_cast<int>(a)] / dt);
        masses_[b][a][a] += grab_.weight;
        heavy_[b * n + a] += grab_.weight * (target - before_[b * n + a]);
    }
}

template <int D>
void BodiesInFlow<D>::record_brush_impulse() {
    for (int a = 0; a < D && grab_.body >= 0; ++a)
        if (const std::size_t i = static_cast<std::size_t>(grab_.body) * n + static_cast<std::size_t>(a); free_[i])
            brush_forcing_->impulse[a] += grab_.weight * (grab_.target[a] - velocity_[i]);
}

/// The impulses of the pressure in a time dt.
template <int D>
void BodiesInFlow<D>::pushed(const MacState<D>& s, std::vector<real>& impulse, real dt) const {
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        const Twist<D> f = bodies_[b].wet > 0 ? force(s, b) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) impulse[b * n + k] = dt * f[k];
    }
}

/// V += (M + m)⁻¹ (dt (G + F) − M (V − V_before)): Newton's step, as F falls by m V/dt.
template <int D>
void BodiesInFlow<D>::move_under_forces() {
    for (std::size_t i = 0; i < missing_.size(); ++i) {
        missing_[i] = met_[i] + heavy_[i];
        for (std::size_t l = 0, at = i / n * n; l < n; ++l) missing_[i] -= masses_[i / n][i % n][l] * (velocity_[at + l] - before_[at + l]);
    }
    next_ = velocity_;
    for (std::size_t i = 0; i < next_.size(); ++i)
        for (std::size_t j = 0; j < next_.size(); ++j) next_[i] += mobility_(i, j) * missing_[j];
}

template <int D>
void BodiesInFlow<D>::find_contacts(const geometry::Solids<D>& solids, real dt) {
    rigid::Surroundings<D> around = bodies_.surroundings(solids);
    real fastest = 0;
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        real speed = 0, turning = 0;
        for (std::size_t k = 0; k < n; ++k) (k < D ? speed : turning) += std::abs(next_[b * n + k]);
        fastest = std::max(fastest, speed + turning * bodies_[b].radius);
    }
    // a light body's first velocity may be many times the converged one: obstacles within that range are included
    around.reach = 2 * dt * fastest + 1e-2 * norm(h_);
    contacts_.find(bodies_.all(), around);
}

template <int D>
void BodiesInFlow<D>::touch(const geometry::Solids<D>& solids, real dt, bool anew) {
    if (anew) find_contacts(solids, dt);
    for (auto& body : bodies_.all()) body.touches = false;
    std::fill(others_.begin(), others_.end(), 0.0);
    if (contacts_.empty()) return;
    contacts_.resolve(bodies_.all(), mobility_, next_, dt, norm(gravity_));
    contacts_.add_impulses(others_);
}

/// Adds bodies to the pressure matrix where their added mass is not too large. With V = base + dt M⁻¹ (pressure impulse), where `base`
/// contains all other impulses, A p = b − h² ρ/dt Σ D_k V_k becomes (A + U C Uᵀ) p = b − h² ρ/dt Σ D_k base_k with U = ΔV D and C = h² ρ/ΔV
/// M⁻¹.
template <int D>
bool BodiesInFlow<D>::join_matrix(const MacState<D>& s) {
    matrix_.clear();
    const real scale = h2_ * s.rho / cell_;
    bool any = false;
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        joined_[i] = bodies_[i].wet > 0;
        for (std::size_t k = 0; k < n; ++k)
            if (free_[i * n + k] && added_.of(i)[k][k] > most_added * masses_[i][k][k]) joined_[i] = 0;
        if (!joined_[i]) continue;
        any = true;
        inverse_[i] = rigid::inverse_of<D>(masses_[i], free_.data() + i * n);
        const std::size_t begin = matrix_.entries.size();
        for (const Cut& c : cuts_[i]) {
            if (s.cells[c.cell] != Cell::fluid) continue;
            matrix_.entries.push_back({c.cell, {}});
            std::copy(c.out.begin(), c.out.end(), matrix_.entries.back().u.begin());
        }
        matrix_.blocks.push_back({begin, matrix_.entries.size(), {}});
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) matrix_.blocks.back().C[k][l] = scale * inverse_[i][k][l];
    }
    return any;
}

/// All impulses except the part of the pressure that depends on p.
template <int D>
Twist<D> BodiesInFlow<D>::impulse_without_pressure(const MacState<D>& s, std::size_t body, real dt) const {
    Twist<D> sum{};
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; s.cells[c.cell] == Cell::fluid && k < n; ++k) sum[k] += c.out[k] * c.below;
    for (std::size_t k = 0; k < n; ++k) sum[k] = dt * s.rho * sum[k] + heavy_[body * n + k] + others_[body * n + k];
    return sum;
}

/// Estimates the contact impulses: where a body had contact in the last step, the impulse that keeps its velocity.
template <int D>
void BodiesInFlow<D>::expect_others(const MacState<D>& s, real dt) {
    std::fill(others_.begin(), others_.end(), 0.0);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        if (!bodies_[i].touches) continue;
        const Twist<D> f = force(s, i);
        for (std::size_t k = 0; k < n; ++k) others_[i * n + k] = -heavy_[i * n + k] - dt * f[k];
    }
}

/// Updates the right-hand side: with the velocity without pressure for bodies in the matrix, with the next velocity for others. Returns the
/// norm of its change, ‖δb‖₂.
template <int D>
real BodiesInFlow<D>::adopt(const MacState<D>& s, real dt, Grid<real, D>* b) {
    real sum = 0, squares = 0;
    const real scale = h2_ * s.rho / (dt * cell_);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Twist<D> change{};
        const Twist<D> impulse = joined_[i] ? impulse_without_pressure(s, i, dt) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) {
            real base = next_[i * n + k];
            if (joined_[i]) base = before_[i * n + k];
            for (std::size_t l = 0; joined_[i] && l < n; ++l) base += inverse_[i][k][l] * impulse[l];
            change[k] = base - base_[i * n + k];
            base_[i * n + k] = base;
        }
        if (!b || bodies_[i].wet == 0) continue;
        for (const Cut& c : cuts_[i]) {
            if (s.cells[c.cell] != Cell::fluid) continue;
            real out = 0;
            for (std::size_t k = 0; k < n; ++k) out += c.out[k] * change[k];
            real& at = (*b)[c.cell];
            squares -= at * at;
            at -= scale * out;
            squares += at * at;
            sum += scale * out * (scale * out);
        }
    }
    b_squared_ += squares;
    return std::sqrt(sum);
}

/// Computes the velocities of the new pressure and their change.
template <int D>
void BodiesInFlow<D>::follow_pressure(const MacState<D>& s, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        const Twist<D> f = joined_[i] ? push(i, s.p) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) {
            real v = base_[i * n + k];
            for (std::size_t l = 0; joined_[i] && l < n; ++l) v += dt * inverse_[i][k][l] * f[l];
            change_[i * n + k] = v - velocity_[i * n + k];
            velocity_[i * n + k] = v;
        }
    }
}

template <int D>
void BodiesInFlow<D>::learn() {
    for (std::size_t i = 0; i < last_.size(); ++i) last_[i] -= met_[i];
    added_.learn(change_, last_, masses_, free_, mobility_);
}

/// ‖b‖₂² over the fluid.
template <int D>
real BodiesInFlow<D>::square_of(const MacState<D>& s, const Grid<real, D>& b) const {
    const std::size_t plane = b.size() / static_cast<std::size_t>(s.extent()[D - 1]);
    return plane_sum(s.extent()[D - 1], [&](int k) {
        const std::size_t first = static_cast<std::size_t>(k) * plane;
        const Cell* cell = s.cells.data() + first;
        const real* value = b.data() + first;
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (std::size_t i = 0; i < plane; ++i) sum += cell[i] == Cell::fluid ? value[i] * value[i] : 0;
        return sum;
    });
}

/// One pressure solve to `tolerance`, relative to ‖b‖ of the extrapolated velocities. If the solve with bodies in the matrix fails, they
/// switch to partitioned coupling.
template <int D>
void BodiesInFlow<D>::coupling_iteration(MacState<D>& s, poisson::Solver<D>& solver, real tolerance, real dt, Grid<real, D>& b) {
    const poisson::Report* report = nullptr;
    if (!matrix_.blocks.empty()) {
        solver.set_tolerance(tolerance * std::min(1.0, whole_ / std::sqrt(std::max(b_squared_, whole_ * whole_ * 1e-4))));
        report = solver.solve(s.p, b, matrix_);
        if (!report) {
            leave_matrix();
            adopt(s, dt, &b);
        }
    }
    if (!report) {
        solver.set_tolerance(tolerance);
        report = &solver.solve(s.p, b);
    }
    const int iterations = report_.iterations + report->iterations;
    const real first = report_.iterations == 0 ? report->residual_before : report_.residual_before;
    report_ = *report;
    report_.iterations = iterations, report_.residual_before = first;
    ++coupling_iterations_;
}

template <int D>
void BodiesInFlow<D>::leave_matrix() {
    matrix_.clear();
    std::fill(joined_.begin(), joined_.end(), 0);
}

/// Returns whether the system is monolithic: all wet bodies are in the matrix and no body has a contact.
template <int D>
bool BodiesInFlow<D>::fluid_decides(const geometry::Solids<D>& solids, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i)
        if (bodies_[i].touches || (bodies_[i].wet > 0 && !joined_[i])) return false;
    find_contacts(solids, dt);
    return contacts_.empty();
}

/// Stores the converged velocities in the bodies.
template <int D>
void BodiesInFlow<D>::take_velocities(MacState<D>& s, SolidPlacement<D>& placement, real dt) {
    velocity_ = next_;
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        for (std::size_t k = 0; k < n; ++k) {
            body.velocity[k] = velocity_[i * n + k];
            gained_[i * n + k] = (velocity_[i * n + k] - before_[i * n + k]) / dt;
        }
        body.force = force(s, i);
        for (std::size_t k = 0; no_slip_walls_ && k < n; ++k) {
            body.viscous[k] = no_slip_walls_->bodies[i].impulse[k] / dt;
            body.force[k] += body.viscous[k];
        }
    }
    if (brush_forcing_) record_brush_impulse();
    bodies_.place(placement.solids());
    set_velocities(s);
}

template <int D>
const poisson::Report& BodiesInFlow<D>::solve(MacState<D>& s, SolidPlacement<D>& placement, real dt, poisson::Solver<D>* solver,
                                              real tolerance, Grid<real, D>* b) {
    find_cuts(s, placement);
    begin(s, solver != nullptr, dt);
    const bool coupled = std::any_of(bodies_.all().begin(), bodies_.all().end(), [](const Body<D>& body) { return body.wet > 0; });
    coupling_iterations_ = report_.iterations = 0;
    leave_matrix();
    adopt(s, dt, b);
    b_squared_ = coupled ? square_of(s, *b) : 0, whole_ = std::sqrt(b_squared_);
    const real enough = coupled ? 0.5 * tolerance : tolerance;
    real solve_tolerance = coupled ? std::max(enough, first_tolerance) : enough, left = 0,
         change = 0;  // left: residual before the last change
    if (coupled && join_matrix(s)) {
        if (fluid_decides(placement.solids(), dt)) solve_tolerance = monolithic_part * tolerance;
        expect_others(s, dt);
        adopt(s, dt, b);
    }
    bool measured = false, again = false;
    for (int count = 0, last = most_iterations;; ++count) {
        if (solver) coupling_iteration(s, *solver, solve_tolerance, dt, *b);
        follow_pressure(s, dt);
        std::swap(met_, last_);
        pushed(s, met_, dt);
        if (count > 0 && !again && change > differs * left) learn();
        const real changed = change;
        move_under_forces();
        touch(placement.solids(), dt, count == 0);
        const real added = adopt(s, dt, b);
        left = solve_tolerance, change = added == 0 ? 0 : added / whole_;
        if (!coupled || solve_tolerance + change <= tolerance) break;
        again = !measured && count > 0 && change > std::max(changed, 1.0);  // the estimate is so poor that the iteration diverges
        if (again) {
            next_ = before_;
            std::fill(others_.begin(), others_.end(), 0.0);
            change = std::max(adopt(s, dt, b) / whole_, enough);
        }
        if (!measured && (again || count == last)) measured = true, last = count + most_iterations_measured, measure_added_mass(s, *solver);
        if (measured && count == last) break;
        solve_tolerance = std::max(enough, of_change * std::min(change, 1.0));
    }
    take_velocities(s, placement, dt);
    if (solver) solver->set_tolerance(tolerance);
    return report_;
}

template <int D>
std::size_t BodiesInFlow<D>::bytes() const {
    std::size_t total =
        (no_slip_walls_ ? no_slip_walls_->bytes() : 0) + bodies_.bytes() + (rhs_.size() + phi_.size()) * sizeof(real) + added_.bytes();
    for (const auto& faces : faces_) total += faces.capacity() * sizeof(Face);
    for (const auto& cuts : cuts_) total += cuts.capacity() * sizeof(Cut);
    total += mobility_.entries.capacity() * sizeof(real) + masses_.capacity() * sizeof(rigid::Block<D>) + free_.size();
    for_each_list(*this, [&](const std::vector<real>& list) { total += list.capacity() * sizeof(real); });
    total += matrix_.bytes() + joined_.capacity() + inverse_.capacity() * sizeof(inverse_[0]) + near_.capacity() * sizeof(near_[0]);
    return total;
}

template class BodiesInFlow<2>;
template class BodiesInFlow<3>;

}  // namespace weir::staggered
