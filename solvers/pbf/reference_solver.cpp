#include "pbf/reference_solver.hpp"

#include "pbf/bodies.hpp"

#include <algorithm>

namespace weir::pbf {

using particles::Fluid;
using particles::Point;

namespace {

const particles::ReferenceEffects& effects() {
    static const particles::ReferenceEffects list{{"gravity", "predict"}, {"artificial_pressure", "correct"}};
    return list;
}

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_the_reference_lacks(scene, effects());
    return first_fluid<D>(scene);
}

}  // namespace

template <int D>
ReferencePbfSolver<D>::ReferencePbfSolver(const scene::Scene& scene) : ReferencePbfSolver(Options(scene), start_of<D>(scene), &scene) {
    Fluid<D> unsettled = start_of<D>(scene);
    step_ = even_step(scene, unsettled);  // as on threads
}

template <int D>
ReferencePbfSolver<D>::ReferencePbfSolver(const Options& options, Fluid<D> start, const scene::Scene* scene)
    : Base(options, std::move(start)) {
    reference_.p = pbf_params<particles::plain::PbfParams, D>(options_, fluid_.domain.spacing);
    reference_.least_back = particles::least_correction * fluid_.domain.spacing;
    give_ = give_at_walls<D>(options_, fluid_.domain.spacing);
    if (scene) this->take(*scene, pbf::effects());
    this->settle();
}

/// The numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport ReferencePbfSolver<D>::step(real dt) {
    emitters_.apply(fluid_, dt);
    if (bodies_) start_bodies(dt);
    predict(dt);  // 1-7
    warm_start(dt);
    int iterations = 0;  //  8
    for (; iterations < this->most_iterations(); ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && compression().mean <= options_.tolerance) break;
        if (bodies_) carry_bodies(true);
        correct();  // 12-19
    }
    const real slow = std::max(dt, last_dt_);
    if (options_.warm_start > 0)
        for (std::size_t i = 0; i < multiplier_.size(); ++i) fluid_.carried[i] = multiplier_[i] / (slow * slow);
    update(dt, slow);  // 20-21, 23-24
    if (bodies_) bodies_->end(fluid_.domain, dt, slow), carried_dt_ = 0;
    this->stop_frozen_again();
    this->conduct(dt);  // only where the scene names a substance
    last_dt_ = dt;
    const real speed = speed_ = this->speed();
    const Compression c = compression();
    this->end_step();
    return this->report(dt, speed, iterations, c);
}

template <int D>
void ReferencePbfSolver<D>::iterate_afresh() {
    multiplier_.assign(x_star_.size(), 0);
    find_lambdas();
    correct();
}

/// v += dt g, x* = x + dt v, and the pairs there.
template <int D>
void ReferencePbfSolver<D>::predict(real dt) {
    {
        const auto timed = passes_.time("predict");
        fluid_.time += dt;
        fluid_.domain.solids.set_time(fluid_.time);
        for (int i = 0; i < fluid_.count(); ++i) Fluid<D>::put(fluid_.v, i, fluid_.velocity(i) + dt * fluid_.gravity);
        this->stop_frozen();  // frozen particles
        predicted_.clear(), x_star_.clear();
        for (int i = 0; i < fluid_.count(); ++i)
            predicted_.push_back(fluid_.domain.kept(fluid_.position(i) + dt * fluid_.velocity(i), fluid_.corrections));
        if (this->ice_moves()) {
            this->ice_->advance_free(dt);
            this->ice_->each_place([&](int i, const Vec<D>& place) { predicted_[static_cast<std::size_t>(i)] = place; });
        }
        if (carried_dt_ > 0) push_bodies_ahead();
        for (const Vec<D>& x : predicted_) x_star_.push_back(particles::point_of(x - fluid_.domain.centre()));
    }
    const auto timed = passes_.time("neighbours");
    reference_.find_neighbours(x_star_);
    this->expand();
}

/// Warm start from the multipliers of the previous step: see PbfSolver.
template <int D>
void ReferencePbfSolver<D>::warm_start(real dt) {
    if (options_.warm_start == 0) return;
    const auto timed = passes_.time("warm start");
    multiplier_.clear();
    for (const real before : fluid_.carried) multiplier_.push_back(options_.warm_start * dt * dt * before);
    add_solids(reference_, fluid_.domain, x_star_);
    lambda_ = multiplier_;
    if (carried_dt_ > 0) carry_bodies(false);
    correct();
}

/// lambda_i of eq. 11, from density and gradients, walls and solids in both.
template <int D>
void ReferencePbfSolver<D>::find_lambdas() {
    const auto timed = passes_.time("lambda");
    add_solids(reference_, fluid_.domain, x_star_);
    if (options_.tolerance > 0 || bodies_) density_ = reference_.densities(x_star_);
    lambda_ = reference_.lambdas(x_star_, options_.warm_start > 0 ? &multiplier_ : nullptr);
}

/// x* += Δp, eq. 12 and 14; moves particles out of walls and solids.
template <int D>
void ReferencePbfSolver<D>::correct() {
    const auto timed = passes_.time("correct");
    x_star_ = reference_.corrected(x_star_, lambda_, &fluid_.corrections);
    const Vec<D> centre = fluid_.domain.centre();
    if (carried_dt_ > 0)
        push_bodies();
    else if (!fluid_.domain.solids.empty())
        for (Point& x : x_star_) x = particles::point_of(fluid_.domain.kept(centre + particles::vec_of<D>(x), fluid_.corrections) - centre);
    for (std::size_t i = 0; i < x_star_.size(); ++i)
        if (this->held(static_cast<int>(i))) x_star_[i] = particles::point_of(predicted_[i] - centre);
    if (!this->ice_moves()) return;
    this->ice_->follow(
        [&](int i, const Vec<D>& from) { return centre + particles::vec_of<D>(x_star_[static_cast<std::size_t>(i)]) - from; });
    this->ice_->each_place([&](int i, const Vec<D>& to) { x_star_[static_cast<std::size_t>(i)] = particles::point_of(to - centre); });
}

/// Applies gravity to bodies and moves them with their velocities.
template <int D>
void ReferencePbfSolver<D>::start_bodies(real dt) {
    carried_dt_ = dt;
    bodies_->fall(fluid_.domain, fluid_.time, dt);
}

/// Particles whose predicted position is inside a body push it.
template <int D>
void ReferencePbfSolver<D>::push_bodies_ahead() {
    auto& meetings = bodies_->meetings();
    const real dt = carried_dt_;
    meetings.clear();
    for (int i = 0; i < fluid_.count(); ++i) bodies_->push_out(fluid_.domain, i, fluid_.position(i) + dt * fluid_.velocity(i), dt);
    if (meetings.empty()) return;
    bodies_->exchange(fluid_.domain, dt, false);
    bodies_->move(fluid_.domain, dt);
    for (const auto& m : meetings) predicted_[static_cast<std::size_t>(m.particle)] += dt * bodies_->back(m);
}

/// Moves bodies by the multipliers of this iteration: see PbfSolver.
template <int D>
void ReferencePbfSolver<D>::carry_bodies(bool iterates) {
    auto& meetings = bodies_->meetings();
    meet_bodies(reference_, fluid_.domain, x_star_, meetings);
    for (auto& m : meetings) {
        const auto i = static_cast<std::size_t>(m.particle);
        m.given = lambda_[i] / carried_dt_ * m.pull;
        const real excess = iterates ? density_[i] - (reference_.rest.empty() ? 1 : reference_.rest[i]) : 0;
        m.stiff = (options_.warm_start > 0 ? multiplier_[i] : lambda_[i]) < 0 ? stiffness(lambda_[i], excess, give_) : 0;
    }
    bodies_->exchange(fluid_.domain, carried_dt_, false);
    for (const auto& m : meetings) {
        const auto i = static_cast<std::size_t>(m.particle);
        const real change = carried_dt_ * m.stiff * bodies_->closing(m);
        lambda_[i] += change;
        if (options_.warm_start > 0) multiplier_[i] += change;
    }
}

/// Moves bodies, and particles out of them and out of solids.
template <int D>
void ReferencePbfSolver<D>::push_bodies() {
    auto& meetings = bodies_->meetings();
    const Vec<D> centre = fluid_.domain.centre();
    bodies_->move(fluid_.domain, carried_dt_);
    meetings.clear();
    for (std::size_t i = 0; i < x_star_.size(); ++i) {
        const Vec<D> free = centre + particles::vec_of<D>(x_star_[i]);
        bodies_->push_out(fluid_.domain, static_cast<int>(i), free, carried_dt_);
        x_star_[i] = particles::point_of(fluid_.domain.kept(free, fluid_.corrections) - centre);
    }
    if (meetings.empty()) return;
    bodies_->exchange(fluid_.domain, carried_dt_, false);
    bodies_->move(fluid_.domain, carried_dt_);
    for (const auto& m : meetings) {
        Point& x = x_star_[static_cast<std::size_t>(m.particle)];
        const Vec<D> back = carried_dt_ * bodies_->back(m);
        for (int a = 0; a < D; ++a) x[static_cast<std::size_t>(a)] += back[a];
    }
}

/// v = (x* - x) / dt, x = x*, and the density there; with dt = 0 only positions. slow: see PbfSolver.
template <int D>
void ReferencePbfSolver<D>::update(real dt, real slow) {
    const auto timed = passes_.time("update");
    add_solids(reference_, fluid_.domain, x_star_);
    density_ = reference_.densities(x_star_);
    const real too_fast = dt > 0 ? 1 / dt - 1 / slow : 0;
    for (int i = 0; i < fluid_.count(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Vec<D> x = fluid_.domain.kept(fluid_.domain.centre() + particles::vec_of<D>(x_star_[at]));
        if (dt > 0) Fluid<D>::put(fluid_.v, i, (x - fluid_.position(i)) / dt - too_fast * (x - predicted_[at]));
        Fluid<D>::put(fluid_.x, i, x);
        fluid_.density[at] = fluid_.rho0 * density_[at];
    }
    if (this->ice_moves() && dt > 0) this->ice_->finish_motion(fluid_, slow);
}

template <int D>
Compression ReferencePbfSolver<D>::compression() const {
    Compression c;
    for (std::size_t i = 0; i < density_.size(); ++i) {
        const double excess = density_[i] / (reference_.rest.empty() ? 1 : reference_.rest[i]) - 1;
        c.mean += std::max(0.0, excess) / static_cast<real>(density_.size());
        c.worst = std::max(c.worst, excess);
    }
    return c;
}

template <int D>
std::size_t ReferencePbfSolver<D>::own_bytes() const {
    return predicted_.capacity() * sizeof(Vec<D>) + x_star_.capacity() * sizeof(Point) +
           (density_.capacity() + lambda_.capacity() + multiplier_.capacity()) * sizeof(double);
}

template class ReferencePbfSolver<2>;
template class ReferencePbfSolver<3>;

}  // namespace weir::pbf
