#include "mac/bodies/bodies_in_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;
using rigid::Body;

/// A body in gas falls nearly freely where its acceleration differs from that of gravity by less than this part.
static constexpr real nearly = 0.05;

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
    phi_ = Grid<real, D>(replicated(lattice.cells));
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
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        bodies_[i].wet = liquid_fraction(s, i);
        const bool falls = density_of_cell_ && density_around(s, i) < nearly * bodies_[i].density();
        for (std::size_t a = 0; a < D && falls; ++a) gained_[i * n + a] = gravity_[static_cast<int>(a)];
    }
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

/// Returns whether a body in gas fell nearly freely in the last step: its path is that of a constant acceleration. (Where the force depends
/// on the position this would damp.)
template <int D>
bool BodiesInFlow<D>::falls(std::size_t i) const {
    if (!density_of_cell_ || bodies_[i].wet == 0 || bodies_[i].touches) return false;
    Vec<D> missing = gravity_;
    for (int a = 0; a < D; ++a) missing[a] -= gained_[i * n + static_cast<std::size_t>(a)];
    return norm(missing) < nearly * norm(gravity_);
}

template <int D>
void BodiesInFlow<D>::advance_free(SolidPlacement<D>& solids, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        body.advance_free(dt, gravity_);
        for (int a = 0; a < D && falls(i); ++a)
            if (!body.held[static_cast<std::size_t>(a)]) body.at[a] += 0.5 * dt * dt * gravity_[a];
    }
    bodies_.place(solids.solids());
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

}  // namespace weir::mac
