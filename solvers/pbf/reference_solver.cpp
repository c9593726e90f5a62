#include "pbf/reference_solver.hpp"

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
    reference_.least_back = particles::least_clamp * fluid_.domain.spacing;
    if (scene) this->take(*scene, pbf::effects());
    this->settle();
}

/// Numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport ReferencePbfSolver<D>::step(real dt) {
    emitters_.apply(fluid_, dt);
    predict(dt);  // 1-7
    warm_start(dt);
    int iterations = 0;  //  8
    for (; iterations < this->most_iterations(); ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && compression().mean <= options_.tolerance) break;
        correct();  // 12-19
    }
    const real slow = std::max(dt, last_dt_);
    if (options_.warm_start > 0)
        for (std::size_t i = 0; i < multiplier_.size(); ++i) fluid_.carried[i] = multiplier_[i] / (slow * slow);
    update(dt, slow);  // 20-21, 23-24
    this->hold_again();
    this->conduct(dt);  // only where a substance is named
    last_dt_ = dt;
    const real speed = speed_ = fluid_.max_speed();
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
        this->hold();  // what is frozen
        predicted_.clear(), x_star_.clear();
        for (int i = 0; i < fluid_.count(); ++i)
            predicted_.push_back(fluid_.domain.kept(fluid_.position(i) + dt * fluid_.velocity(i), fluid_.clamps));
        if (this->ice_moves()) {
            this->ice_->fly(dt);
            this->ice_->each_place([&](int i, const Vec<D>& place) { predicted_[static_cast<std::size_t>(i)] = place; });
        }
        for (const Vec<D>& x : predicted_) x_star_.push_back(particles::point_of(x - fluid_.domain.centre()));
        this->set_rest();
    }
    const auto timed = passes_.time("neighbours");
    reference_.find_neighbours(x_star_);
}

/// Starts from the multipliers of the step before: see PbfSolver.
template <int D>
void ReferencePbfSolver<D>::warm_start(real dt) {
    if (options_.warm_start == 0) return;
    const auto timed = passes_.time("warm start");
    multiplier_.clear();
    for (const real before : fluid_.carried) multiplier_.push_back(options_.warm_start * dt * dt * before);
    add_solids(reference_, fluid_.domain, x_star_);
    lambda_ = multiplier_;
    correct();
}

/// lambda_i of eq. 11, from density and gradients, walls and solids in both.
template <int D>
void ReferencePbfSolver<D>::find_lambdas() {
    const auto timed = passes_.time("lambda");
    add_solids(reference_, fluid_.domain, x_star_);
    if (options_.tolerance > 0) density_ = reference_.densities(x_star_);
    lambda_ = reference_.lambdas(x_star_, options_.warm_start > 0 ? &multiplier_ : nullptr);
}

/// x* += Δp, eq. 12 and 14, and out of walls and solids.
template <int D>
void ReferencePbfSolver<D>::correct() {
    const auto timed = passes_.time("correct");
    x_star_ = reference_.corrected(x_star_, lambda_, &fluid_.clamps);
    const Vec<D> centre = fluid_.domain.centre();
    if (!fluid_.domain.solids.empty())
        for (Point& x : x_star_) x = particles::point_of(fluid_.domain.kept(centre + particles::vec_of<D>(x), fluid_.clamps) - centre);
    for (std::size_t i = 0; i < x_star_.size(); ++i)
        if (this->held(static_cast<int>(i))) x_star_[i] = particles::point_of(predicted_[i] - centre);
    if (!this->ice_moves()) return;
    this->ice_->follow(
        [&](int i, const Vec<D>& from) { return centre + particles::vec_of<D>(x_star_[static_cast<std::size_t>(i)]) - from; });
    this->ice_->each_place([&](int i, const Vec<D>& to) { x_star_[static_cast<std::size_t>(i)] = particles::point_of(to - centre); });
}

/// v = (x* - x) / dt, x = x*, and the density there; with dt = 0 positions alone. slow: see PbfSolver.
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
    if (this->ice_moves() && dt > 0) this->ice_->arrive(fluid_, slow);
}

template <int D>
Compression ReferencePbfSolver<D>::compression() const {
    Compression c;
    for (const double rho : density_) {
        c.mean += std::max(0.0, rho - 1) / static_cast<real>(density_.size());
        c.worst = std::max(c.worst, rho - 1);
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
