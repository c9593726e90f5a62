#include "particles/boundaries/bodies_in_liquid.hpp"
#include "rigid/inside.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {

/// Minimum density of a body, relative to the liquid: lighter bodies are treated as having it. Particles push but do not pull, so a
/// massless body would get the speed of the first particle that hits it, and nothing would return it.
constexpr real least_density = 0.01;

}  // namespace

template <int D>
std::unique_ptr<BodiesInLiquid<D>> BodiesInLiquid<D>::make(const Fluid<D>& fluid) {
    return fluid.domain.bodies ? std::make_unique<BodiesInLiquid>(fluid) : nullptr;
}

template <int D>
BodiesInLiquid<D>::BodiesInLiquid(const Fluid<D>& fluid)
    : bodies_(fluid.domain.bodies), gravity_(fluid.gravity), mass_(fluid.mass), spacing_(fluid.domain.spacing), rho0_(fluid.rho0) {
    const std::size_t count = bodies_->count();
    start_ = bodies_->all();
    for (auto& body : start_) {
        const real least = least_density * fluid.rho0 * body.moments.volume;
        if (body.mass < least) body.weigh(least, body.centre);
    }
    dry_.resize(count), wet_.resize(count);
    impulse_.resize(count), force_.resize(count), gained_.resize(count), matrix_.resize(count);
    free_.resize(n), velocity_.resize(n * count), before_.resize(n * count), change_.resize(n * count);
    mobility_.resize(n * count), own_.resize(n);
    rigid::Surroundings<D> around = bodies_->surroundings(fluid.domain.solids);
    around.reach = 1e-3 * spacing_;
    contacts_.find(bodies_->all(), around);
    contacts_.mark(bodies_->all());  // bodies at rest on a support do not start with the velocity of free fall
}

template <int D>
void BodiesInLiquid<D>::begin(const Domain<D>& domain, real time, real dt) {
    real fastest = 0;
    for (std::size_t b = 0; b < bodies_->count(); ++b) {
        rigid::Body<D>& body = (*bodies_)[b];
        dry_[b] = body.wet == 0 && !body.touches;
        wet_[b] = 0, body.touches = false;
        start_[b].at = body.at, start_[b].orientation = body.orientation, start_[b].velocity = body.velocity;
        start_[b].touches = false;
        std::copy(body.velocity.begin(), body.velocity.end(), velocity_.begin() + static_cast<std::ptrdiff_t>(n * b));
        force_[b] = gained_[b] = Twist{};
    }
    fastest = speed();
    rigid::Surroundings<D> around = bodies_->surroundings(domain.solids);
    around.reach = 2 * dt * (fastest + dt * norm(gravity_)) + spacing_;  // a particle may push a body this far
    contacts_.find(start_, around);
    meetings_.clear();
    if (brush_forcing_) apply_grab(time, dt);
}

template <int D>
void BodiesInLiquid<D>::follow(std::shared_ptr<BrushForcing> forcing, const scene::Scene& scene) {
    brush_forcing_ = std::move(forcing);
    for (std::size_t i = 0; i < brush_forcing_->keys.size(); ++i)
        if (brush_forcing_->keys[i].kind == BrushKind::grab && brush_forcing_->keys[i].body >= static_cast<int>(bodies_->count()))
            scene.refuse("effects.hand.keyframes[" + std::to_string(i) + "].body", "there is no such body",
                         "numbers of the list bodies, from 0 to " + std::to_string(bodies_->count() - 1));
}

/// Interactive forcing: dV/dt = rate (target - V) for the mass of the body and of the displaced liquid, implicit in V, so stable for any
/// step. The factor of V is added to the mass (as in mac/bodies/bodies_in_flow.cpp on a grid).
template <int D>
void BodiesInLiquid<D>::apply_grab(real time, real dt) {
    const auto brush = brush_forcing_->at<D>(time);
    grab_.body = brush.kind == BrushKind::grab ? brush.body : -1;
    if (grab_.body < 0) return;
    const rigid::Body<D>& body = start_[static_cast<std::size_t>(grab_.body)];
    const real water = (*bodies_)[static_cast<std::size_t>(grab_.body)].wet > 0 ? rho0_ * body.moments.volume : 0;
    grab_.weight = dt * brush_forcing_->rate * (body.mass + water);
    grab_.target = 0.25 * brush_forcing_->rate * (brush.centre - body.at);
    const real most = spacing_ / dt;
    for (int a = 0; a < D; ++a) grab_.target[a] = std::clamp(grab_.target[a], -most, most);
}

/// Records the impulse of the interactive forcing: in the first exchange of a step the whole pull, in later ones its change with the
/// velocity.
template <int D>
void BodiesInLiquid<D>::record_brush_impulse(bool heavy) {
    for (std::size_t a = 0; a < D && grab_.body >= 0; ++a) {
        const std::size_t at = static_cast<std::size_t>(grab_.body) * n + a;
        if ((*bodies_)[static_cast<std::size_t>(grab_.body)].held[a]) continue;
        brush_forcing_->impulse[static_cast<int>(a)] +=
            grab_.weight * (heavy ? grab_.target[static_cast<int>(a)] - velocity_[at] : -change_[at]);
    }
}

template <int D>
typename BodiesInLiquid<D>::Twist BodiesInLiquid<D>::seen(std::size_t b, const Vec<D>& x, const Vec<D>& along) const {
    Twist t{};
    const Vec<D> r = x - (*bodies_)[b].at;
    for (std::size_t a = 0; a < D; ++a) t[a] = along[a];
    if constexpr (D == 2)
        t[2] = r[0] * along[1] - r[1] * along[0];
    else
        for (int a = 0; a < 3; ++a)
            t[static_cast<std::size_t>(3 + a)] = r[(a + 1) % 3] * along[(a + 2) % 3] - r[(a + 2) % 3] * along[(a + 1) % 3];
    return t;
}

template <int D>
Vec<D> BodiesInLiquid<D>::change_at(const Meeting<D>& m) const {
    const auto b = static_cast<std::size_t>(m.body);
    Vec<D> u;
    for (int a = 0; a < D; ++a) {
        const Twist t = seen(b, m.at, Vec<D>::unit(a));
        u[a] = 0;
        for (std::size_t k = 0; k < n; ++k) u[a] += t[k] * change_[n * b + k];
    }
    return u;
}

template <int D>
Vec<D> BodiesInLiquid<D>::across(const Meeting<D>& m) const {
    if (m.friction == 0) return {};
    const Vec<D> u = change_at(m);
    return u - dot(u, m.pull) / dot(m.pull, m.pull) * m.pull;
}

/// P and M + K, summed over the pairs in order.
template <int D>
void BodiesInLiquid<D>::sum_up() {
    for (std::size_t b = 0; b < bodies_->count(); ++b) impulse_[b] = Twist{}, matrix_[b] = start_[b].mass_matrix();
    const auto resist = [&](Matrix& to, const Twist& t, real by) {
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) to[k][l] += by * t[k] * t[l];
    };
    for (const Meeting<D>& m : meetings_) {
        if (m.body < 0) continue;
        const auto b = static_cast<std::size_t>(m.body);
        wet_[b] = 1;
        const Twist push = seen(b, m.at, m.given), w = seen(b, m.at, m.pull);
        for (std::size_t k = 0; k < n; ++k) impulse_[b][k] -= mass_ * push[k];
        const real length2 = dot(m.pull, m.pull);
        if (m.stiff > 0 || m.friction > 0) resist(matrix_[b], w, mass_ * (m.stiff - (m.friction > 0 ? m.friction / length2 : 0)));
        for (int a = 0; a < D && m.friction > 0; ++a) resist(matrix_[b], seen(b, m.at, Vec<D>::unit(a)), mass_ * m.friction);
    }
}

template <int D>
void BodiesInLiquid<D>::solve_for_velocities(real dt, bool heavy) {
    const std::size_t count = bodies_->count();
    std::fill(mobility_.entries.begin(), mobility_.entries.end(), 0.0);
    before_ = velocity_;
    for (std::size_t b = 0; b < count; ++b) {
        const rigid::Body<D>& body = (*bodies_)[b];
        for (std::size_t a = 0; a < D && grab_.body == static_cast<int>(b); ++a) {
            matrix_[b][a][a] += grab_.weight;
            if (heavy) impulse_[b][a] += grab_.weight * (grab_.target[static_cast<int>(a)] - velocity_[n * b + a]);
        }
        for (std::size_t k = 0; k < n; ++k) {
            free_[k] = !body.held[k];
            for (std::size_t l = 0; l < n; ++l) own_(k, l) = matrix_[b][k][l];
            if (heavy && k < D) impulse_[b][k] += dt * start_[b].mass * gravity_[k];
        }
        rigid::invert(own_, free_, inverse_);
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) {
                mobility_(n * b + k, n * b + l) = inverse_(k, l);
                velocity_[n * b + k] += inverse_(k, l) * impulse_[b][l];
            }
    }
    if (!contacts_.empty()) {
        contacts_.resolve(start_, mobility_, velocity_, dt, norm(gravity_));
        contacts_.carry_on();
        for (std::size_t b = 0; b < count; ++b) (*bodies_)[b].touches = start_[b].touches;
    }
    for (std::size_t i = 0; i < velocity_.size(); ++i) change_[i] = velocity_[i] - before_[i];
}

/// The impulse of the fluid on a body is the opposite of that on its particles.
template <int D>
void BodiesInLiquid<D>::count_forces() {
    for (Meeting<D>& m : meetings_) {
        if (m.body < 0) continue;
        const auto b = static_cast<std::size_t>(m.body);
        m.given += back(m);
        const Twist push = seen(b, m.at, m.given);
        for (std::size_t k = 0; k < n; ++k) force_[b][k] -= mass_ * push[k];
    }
}

template <int D>
void BodiesInLiquid<D>::fall(Domain<D>& domain, real time, real dt) {
    begin(domain, time, dt);
    exchange(domain, dt, true);
    domain.solids.set_time(time + dt);
    move(domain, dt);
}

template <int D>
void BodiesInLiquid<D>::exchange(Domain<D>& domain, real dt, bool heavy) {
    sum_up();
    solve_for_velocities(dt, heavy);
    count_forces();
    record_brush_impulse(heavy);
    for (std::size_t b = 0; b < bodies_->count(); ++b)
        for (std::size_t k = 0; k < n; ++k) {
            (*bodies_)[b].velocity[k] += change_[n * b + k];
            if (!heavy) gained_[b][k] += change_[n * b + k];
        }
    bodies_->place(domain.solids);
}

template <int D>
void BodiesInLiquid<D>::move(Domain<D>& domain, real dt) {
    for (std::size_t b = 0; b < bodies_->count(); ++b) {
        rigid::Body<D>& body = (*bodies_)[b];
        body.at = start_[b].at, body.orientation = start_[b].orientation;
        for (std::size_t k = 0; k < n; ++k) body.velocity[k] = velocity_[n * b + k];
        body.advance_free(dt, dry_[b] ? -1.0 * gravity_ : Vec<D>{});  // the velocity already includes gravity in this step
    }
    bodies_->place(domain.solids);
}

template <int D>
void BodiesInLiquid<D>::push_out(const Domain<D>& domain, int particle, const Vec<D>& free, real dt) {
    const auto& solids = domain.solids;
    if (solids.distance(free) >= domain.margin) return;
    const std::size_t solid = solids.nearest(free);
    if (!solids[solid].free) return;
    const Vec<D> out = solids.push_out(free, domain.margin, 1e-3 * domain.spacing), by = out - free;
    const real length = norm(by);
    if (length == 0) return;
    Meeting<D> m;
    m.particle = particle, m.body = static_cast<std::ptrdiff_t>(solid - domain.first_body()), m.at = out;
    m.pull = by / length, m.given = by / dt, m.stiff = 1;
    meetings_.push_back(m);
}

template <int D>
void BodiesInLiquid<D>::end(Domain<D>& domain, real dt, real slow) {
    for (std::size_t b = 0; b < bodies_->count(); ++b) {
        rigid::Body<D>& body = (*bodies_)[b];
        body.wet = wet_[b];
        for (std::size_t k = 0; k < n; ++k) {
            body.velocity[k] -= (1 - dt / slow) * gained_[b][k];
            body.force[k] = force_[b][k] / dt;
        }
    }
    bodies_->place(domain.solids);
    rigid::require_inside(bodies_->all(), bodies_->surroundings(domain.solids));
    last_dt_ = dt;
}

template <int D>
void BodiesInLiquid<D>::save(Checkpoint& to) const {
    bodies_->save(to);
    to.put_value("bodies.last_dt", last_dt_);
}

template <int D>
void BodiesInLiquid<D>::restore(const Checkpoint& from, Domain<D>& domain) {
    last_dt_ = from.get_value<real>("bodies.last_dt");
    bodies_->restore(from);
    bodies_->place(domain.solids);
}

template <int D>
std::size_t BodiesInLiquid<D>::bytes() const {
    std::size_t total = bodies_->bytes() + meetings_.capacity() * sizeof(Meeting<D>) + start_.capacity() * sizeof(rigid::Body<D>);
    total += (impulse_.capacity() + force_.capacity() + gained_.capacity()) * sizeof(Twist) + matrix_.capacity() * sizeof(Matrix);
    for (const auto* m : {&own_, &inverse_, &mobility_}) total += m->entries.capacity() * sizeof(real);
    return total + (velocity_.capacity() + before_.capacity() + change_.capacity()) * sizeof(real) + dry_.capacity() + wet_.capacity();
}

template class BodiesInLiquid<2>;
template class BodiesInLiquid<3>;

}  // namespace weir::particles
