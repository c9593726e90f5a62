#include "staggered/bodies_in_flow.hpp"

#include <algorithm>
#include <cmath>

namespace weir::staggered {

using poisson::Cell;
using rigid::Body;
using rigid::Twist;

namespace {

/// A body without mass, where nothing else resists either, falls and turns as one of this part of the fluid's mass would: nothing lighter
/// is told apart from it, as its added mass is some tenths at least; of turning, which free slip may leave without any, somewhat more.
constexpr real least_mass = 1e-9, least_inertia = 1e-4;

/// f(I) in [lo, hi) one after another: lists are made in one order, whatever the threads.
template <int D, class F>
void in_order(const Index<D>& lo, const Index<D>& hi, F&& f) {
    for (Index<D> I = lo; I[D - 1] < hi[D - 1];) {
        f(I);
        for (int a = 0; a < D; ++a) {
            if (++I[a] < hi[a] || a == D - 1) break;
            I[a] = lo[a];
        }
    }
}

}  // namespace

template <int D>
std::unique_ptr<BodiesInFlow<D>> BodiesInFlow<D>::make(const scene::Scene& scene) {
    return scene.has("bodies") && !scene.root().tables("bodies").empty() ? std::make_unique<BodiesInFlow>(scene) : nullptr;
}

template <int D>
geometry::Solids<D> BodiesInFlow<D>::solids(const scene::Scene& scene, BodiesInFlow* in) {
    geometry::Solids<D> solids = scene.has("solids") ? geometry::Solids<D>(scene.root().tables("solids")) : geometry::Solids<D>();
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
    rhs_ = phi_ = Grid<real, D>(lattice.cells);
    free_.resize(n * bodies_.count());
    velocity_.resize(free_.size());
    for (std::size_t b = 0; b < bodies_.count(); ++b)
        for (std::size_t k = 0; k < n; ++k) free_[b * n + k] = !bodies_[b].held[k];
}

template <int D>
void BodiesInFlow<D>::start(const MacState<D>& s, const SolidPlacement<D>& solids) {
    find_cuts(s, solids);
    for (std::size_t i = 0; i < bodies_.count(); ++i) bodies_[i].wet = wet_part(s, i);
    rigid::Surroundings<D> around = bodies_.surroundings(solids.solids());
    around.reach = 1e-3 * norm(h_);
    contacts_.find(bodies_.all(), around);
    contacts_.mark(bodies_.all());  // what stands on something does not fall to begin with
}

template <int D>
void BodiesInFlow<D>::fly(SolidPlacement<D>& solids, real dt) {
    for (auto& body : bodies_.all()) body.fly(dt, gravity_);
    bodies_.place(solids.solids());
}

template <int D>
void BodiesInFlow<D>::restore(const Checkpoint& from, SolidPlacement<D>& solids) {
    bodies_.restore(from);
    bodies_.place(solids.solids());
}

/// What bodies close of the grid as they stand.
template <int D>
void BodiesInFlow<D>::find_cuts(const MacState<D>& s, const SolidPlacement<D>& solids) {
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        find_faces(s, solids.solids(), b);
        const Body<D>& body = bodies_[b];
        const geometry::Pose<D> pose = body.pose();
        for (Cut& c : cuts_[b]) {
            phi_[c.cell] = 0;  // it was the cell's place in the list
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

/// The cell's entry, found again by its place in the list, which phi_ keeps meanwhile.
template <int D>
typename BodiesInFlow<D>::Cut& BodiesInFlow<D>::cut(std::size_t cell, std::size_t body) {
    auto& list = cuts_[body];
    if (phi_[cell] == 0) {
        list.push_back({cell, {}});
        phi_[cell] = static_cast<real>(list.size());
    }
    return list[static_cast<std::size_t>(phi_[cell]) - 1];
}

/// The faces whose velocity is that of a body, in the order of the grid, and the cells that they belong to.
template <int D>
void BodiesInFlow<D>::find_faces(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t b) {
    const std::size_t own = solids.count() - bodies_.count() + b;
    const Body<D>& body = bodies_[b];
    faces_[b].clear(), cuts_[b].clear();
    for (int a = 0; a < D; ++a) {
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        Index<D> lo, hi;
        for (int d = 0; d < D; ++d) {
            lo[d] = std::max(0, static_cast<int>(std::floor((body.at[d] - body.radius - s.u.origin[d]) / h_[d])) - 1);
            hi[d] = std::min(open.extent()[d], static_cast<int>(std::ceil((body.at[d] + body.radius - s.u.origin[d]) / h_[d])) + 2);
            if (lo[d] >= hi[d]) return;  // outside the domain
        }
        const real area = cell_ / h_[a];
        in_order(lo, hi, [&](const Index<D>& I) {
            if (open(I) == 1) return;
            const Vec<D> x = s.u.face_centre(a, I), r = x - body.at;
            if (solids.nearest(x) != own) return;
            Face f{a, open.linear(I), {}};
            f.moves[static_cast<std::size_t>(a)] = 1;
            if constexpr (D == 2)
                f.moves[2] = a == 0 ? -r[1] : r[0];
            else  // (e × r)_a
                for (int k = 0; k < 3; ++k)
                    if (k != a) f.moves[static_cast<std::size_t>(3 + k)] = (k + 1) % 3 == a ? -r[3 - a - k] : r[3 - a - k];
            faces_[b].push_back(f);
            const real closed = (1 - open(I)) * area;
            const auto count = [&](const Index<D>& cell, real flux) {
                if (s.cells(cell) == Cell::solid) return;
                Cut& c = cut(s.cells.linear(cell), b);
                for (std::size_t k = 0; k < n; ++k) c.out[k] += flux * f.moves[k];
            };
            if (I[a] > 0) count(I - e<D>(a), closed);
            if (I[a] < s.u.cells[a]) count(I, -closed);
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

/// Adds scale Σ D_k V_k of a body.
template <int D>
void BodiesInFlow<D>::scatter(std::size_t body, const Twist<D>& velocity, real scale, Grid<real, D>& to) const {
    for (const Cut& c : cuts_[body]) {
        real out = 0;
        for (std::size_t k = 0; k < n; ++k) out += c.out[k] * velocity[k];
        to[c.cell] += scale / cell_ * out;
    }
}

/// ΔV Σ p D_k of a pressure that is zero outside the fluid.
template <int D>
Twist<D> BodiesInFlow<D>::push(std::size_t body, const Grid<real, D>& p) const {
    Twist<D> sum{};
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; k < n; ++k) sum[k] += c.out[k] * p[c.cell];
    return sum;
}

/// The fluid's force and torque: its pressure at the wall.
template <int D>
Twist<D> BodiesInFlow<D>::force(const MacState<D>& s, std::size_t body) const {
    Twist<D> sum = push(body, s.p);
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; s.cells[c.cell] == Cell::fluid && k < n; ++k) sum[k] += c.out[k] * s.rho * c.below;
    return sum;
}

/// Of the body's surface as the cells see it: what of Σ |D| stands in fluid.
template <int D>
real BodiesInFlow<D>::wet_part(const MacState<D>& s, std::size_t body) const {
    real all = 0, wet = 0;
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; k < D; ++k) {
            all += std::abs(c.out[k]);
            if (s.cells[c.cell] == Cell::fluid) wet += std::abs(c.out[k]);
        }
    return all > 0 ? wet / all : 0;
}

/// What fluid of the body's density would push the body up by on this grid, and turn it: a body as dense as the fluid is balanced exactly.
/// In the air a body has its own weight.
template <int D>
Twist<D> BodiesInFlow<D>::weight(std::size_t b) const {
    const Body<D>& body = bodies_[b];
    const Vec<D> r = body.pose().to_world(body.moments.centre) - body.at, own = body.mass * gravity_;
    Twist<D> sum{}, even{};  // even: of the same density throughout, exact
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
std::array<Twist<D>, BodiesInFlow<D>::n> BodiesInFlow<D>::mass_of(std::size_t b) const {
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

/// m_kl = ρ ΔV D_k·φ_l, A φ_l = h² D_l.
template <int D>
void BodiesInFlow<D>::add_mass(const MacState<D>& s, poisson::Solver<D>* solver) {
    added_.resize(n * bodies_.count());
    if (!solver) return;
    for (std::size_t b = 0; b < bodies_.count(); ++b)
        for (std::size_t k = 0; k < n && bodies_[b].wet > 0; ++k) {
            if (!free_[b * n + k]) continue;
            Twist<D> unit{};
            unit[k] = 1;
            rhs_.fill(0);
            scatter(b, unit, h2_, rhs_);
            phi_.fill(0);
            solver->solve(phi_, rhs_);
            for (std::size_t o = 0; o < bodies_.count(); ++o) {
                const Twist<D> column = push(o, phi_);
                for (std::size_t l = 0; l < n; ++l) added_(o * n + l, b * n + k) = s.rho * column[l];
            }
        }
    rhs_.fill(0), phi_.fill(0);
    for (std::size_t i = 0; i < added_.size; ++i)  // what the solver's tolerance leaves
        for (std::size_t j = 0; j < i; ++j) added_(i, j) = added_(j, i) = 0.5 * (added_(i, j) + added_(j, i));
}

template <int D>
void BodiesInFlow<D>::follow(std::shared_ptr<Hand> hand, const scene::Scene& scene) {
    hand_ = std::move(hand);
    for (std::size_t i = 0; i < hand_->keys.size(); ++i)
        if (hand_->keys[i].kind == HandKind::grab && hand_->keys[i].body >= static_cast<int>(bodies_.count()))
            scene.refuse("effects.hand.keyframes[" + std::to_string(i) + "].body", "there is no such body",
                         "numbers of the list bodies, from 0 to " + std::to_string(bodies_.count() - 1));
}

/// dv/dt = rate (target − v) of the mass of the body and of the water in its place, v at the end of the step: stable for any step.
template <int D>
void BodiesInFlow<D>::be_held(const MacState<D>& s, real dt, std::vector<real>& impulse) {
    const auto brush = hand_->at<D>(s.time);
    if (brush.kind != HandKind::grab) return;
    const auto b = static_cast<std::size_t>(brush.body);
    const real c = dt * hand_->rate * held_mass(b);
    for (int a = 0; a < D; ++a) {
        const std::size_t i = b * n + static_cast<std::size_t>(a);
        total_(i, i) += c;
        impulse[i] += c * (held_target(brush, s, dt)[a] - bodies_[b].velocity[static_cast<std::size_t>(a)]);
    }
}

template <int D>
void BodiesInFlow<D>::tell_hand(const MacState<D>& s, real dt) {
    const auto brush = hand_->at<D>(s.time);
    if (brush.kind != HandKind::grab) return;
    const auto b = static_cast<std::size_t>(brush.body);
    for (int a = 0; a < D; ++a)
        if (const std::size_t i = b * n + static_cast<std::size_t>(a); free_[i])
            hand_->impulse[a] += dt * hand_->rate * held_mass(b) * (held_target(brush, s, dt)[a] - velocity_[i]);
}

template <int D>
real BodiesInFlow<D>::held_mass(std::size_t b) const {
    return bodies_[b].mass + bodies_[b].wet * rho_ * bodies_[b].moments.volume;
}

template <int D>
Vec<D> BodiesInFlow<D>::held_target(const Brush<D>& brush, const MacState<D>& s, real dt) const {
    const Body<D>& body = bodies_[static_cast<std::size_t>(brush.body)];
    Vec<D> target = 0.25 * hand_->rate * (brush.centre - body.at);
    for (int a = 0; a < D; ++a) target[a] = std::clamp(target[a], -s.u.h[a] / dt, s.u.h[a] / dt);
    return target;
}

/// (M + m)(V − V_before) = dt (G + F).
template <int D>
void BodiesInFlow<D>::move_under_forces(const MacState<D>& s, real dt) {
    total_ = added_;
    std::vector<real>& impulse = before_;
    impulse.assign(free_.size(), 0.0);
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        const auto m = mass_of(b);
        const Twist<D> pushed = force(s, b), heavy = weight(b);
        for (std::size_t k = 0; k < n; ++k) {
            for (std::size_t l = 0; l < n; ++l) total_(b * n + k, b * n + l) += m[k][l];
            impulse[b * n + k] = dt * (pushed[k] + heavy[k]);
            if (k < D) impulse[b * n + k] += dt * (m[k][k] - bodies_[b].mass) * gravity_[k];
        }
    }
    if (hand_) be_held(s, dt, impulse);
    rigid::invert(total_, free_, mobility_);
    for (std::size_t i = 0; i < velocity_.size(); ++i) {
        velocity_[i] = bodies_[i / n].velocity[i % n];
        for (std::size_t j = 0; j < velocity_.size(); ++j) velocity_[i] += mobility_(i, j) * impulse[j];
    }
    if (hand_) tell_hand(s, dt);
}

template <int D>
void BodiesInFlow<D>::touch(const geometry::Solids<D>& solids, real dt) {
    rigid::Surroundings<D> around = bodies_.surroundings(solids);
    real fastest = 0;
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        real speed = 0, turning = 0;
        for (std::size_t k = 0; k < n; ++k) (k < D ? speed : turning) += std::abs(velocity_[b * n + k]);
        fastest = std::max(fastest, speed + turning * bodies_[b].radius);
    }
    around.reach = 2 * dt * fastest + 1e-2 * norm(h_);
    contacts_.find(bodies_.all(), around);
    for (auto& body : bodies_.all()) body.touches = false;
    if (!contacts_.empty()) contacts_.resolve(bodies_.all(), mobility_, velocity_, dt, norm(gravity_));
}

template <int D>
void BodiesInFlow<D>::react(MacState<D>& s, SolidPlacement<D>& placement, real dt, poisson::Solver<D>* solver, Grid<real, D>* b) {
    find_cuts(s, placement);
    for (std::size_t i = 0; i < bodies_.count(); ++i) bodies_[i].wet = solver ? wet_part(s, i) : 0;
    add_mass(s, solver);
    move_under_forces(s, dt);
    touch(placement.solids(), dt);
    bool changed = false;
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        Twist<D> change{};
        for (std::size_t k = 0; k < n; ++k) {
            change[k] = velocity_[i * n + k] - body.velocity[k];
            body.velocity[k] = velocity_[i * n + k];
            changed = changed || (change[k] != 0 && body.wet > 0);
        }
        if (b) scatter(i, change, -h2_ * s.rho / dt, *b);
    }
    if (solver && changed) solver->solve(s.p, *b);
    for (std::size_t i = 0; i < bodies_.count(); ++i) bodies_[i].force = force(s, i);
    bodies_.place(placement.solids());
    set_velocities(s);
}

template <int D>
std::size_t BodiesInFlow<D>::bytes() const {
    std::size_t total = bodies_.bytes() + (rhs_.size() + phi_.size()) * sizeof(real);
    for (const auto& faces : faces_) total += faces.capacity() * sizeof(Face);
    for (const auto& cuts : cuts_) total += cuts.capacity() * sizeof(Cut);
    for (const auto* m : {&added_, &total_, &mobility_}) total += m->entries.capacity() * sizeof(real);
    return total + free_.size() + (velocity_.capacity() + before_.capacity()) * sizeof(real);
}

template class BodiesInFlow<2>;
template class BodiesInFlow<3>;

}  // namespace weir::staggered
