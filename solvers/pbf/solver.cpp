#include "pbf/solver.hpp"

#include "pbf/bodies.hpp"

#include <algorithm>
#include <cmath>

namespace weir::pbf {

using particles::ListChunk;
using particles::PbfPass;

template <int D>
PbfSolver<D>::PbfSolver(const scene::Scene& scene) : Base(Options(scene), scene, first_fluid<D>(scene)) {
    kernels_ = pbf_params<particles::single::PbfParams, D>(options_, fluid_.domain.spacing);
    step_ = even_step(scene, fluid_);
    give_ = give_at_walls<D>(options_, fluid_.domain.spacing);
    if (scene.effect("artificial_pressure")) effects_.declare({.name = "artificial_pressure", .inside = "correct"});
    this->settle();
}

/// The numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport PbfSolver<D>::step(real dt) {
    this->apply_sources_and_sinks(dt);
    effects_.apply(Stage::force, flow_, dt, passes_);
    this->stop_frozen();  // frozen particles
    if (bodies_) start_bodies(dt);
    predict(dt);        //  1-4
    find_neighbours();  //  5-7
    warm_start(dt);
    int iterations = 0;  //  8
    for (; iterations < this->most_iterations(); ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && compression().mean <= options_.tolerance) break;
        if (bodies_) carry_bodies(density_.data());
        correct();  // 12-15
        collide();  // 16-19
    }
    const real slow = std::max(dt, last_dt_);
    keep_multipliers(slow);
    update(dt, slow);  // 20-21, 23-24
    if (bodies_) end_bodies(dt, slow);
    effects_.apply(Stage::finish, flow_, dt, passes_);  // 22
    this->drop_ghosts();
    this->stop_frozen_again();
    this->conduct(dt);  // only where the scene names a substance
    last_dt_ = dt;
    const auto end = this->end_step(excess(), 0);
    speed_ = end.speed;
    return this->report(dt, end.speed, iterations, end.compression);
}

template <int D>
void PbfSolver<D>::predict_at_rest() {
    this->stop_frozen(), predict(0), find_neighbours(), pairs_.fit(multiplier_, 1);
}

template <int D>
void PbfSolver<D>::iterate_afresh() {
    std::fill(multiplier_.begin(), multiplier_.end(), 0.0f);
    find_lambdas();
    correct();
    collide();
}

template <int D>
void PbfSolver<D>::predict(real dt) {
    const auto timed = passes_.time("predict");
    fluid_.time += dt;
    if (!fluid_.domain.solids.empty()) fluid_.domain.solids.set_time(fluid_.time);
    for (auto& axis : x_star_) axis.resize(fluid_.id.size());
    parallel_for(0, fluid_.count(), [&](int i) {
        particles::Fluid<D>::put(x_star_, i, fluid_.domain.kept(fluid_.position(i) + dt * fluid_.velocity(i), fluid_.corrections));
    });
    if (carried_dt_ > 0) push_bodies_ahead();
    if (!this->ice_moves()) return;
    this->ice_->advance_free(dt);
    this->ice_->each_place([&](int i, const Vec<D>& place) { particles::Fluid<D>::put(x_star_, i, place); });
}

template <int D>
void PbfSolver<D>::find_neighbours() {
    const auto timed = passes_.time("neighbours");
    const real radius = options_.support * fluid_.domain.spacing;
    if (options_.warm_start > 0)
        this->find_pairs(x_star_, radius, {&fluid_.carried});
    else
        this->find_pairs(x_star_, radius, {});
    pairs_.fit(density_, 1);
    solids_.mark(pairs_);
    this->expand();
    if (!this->ice_) return;
    sorted_.resize(fluid_.id.size());
    pairs_.each([&](int k) {
        if (!pairs_.is_image(k)) sorted_[static_cast<std::size_t>(pairs_.owner(k))] = k;
    });
}

template <int D>
PbfPass PbfSolver<D>::pass(const float* from, float* to, const float* solid) {
    PbfPass a;
    a.p = &kernels_;
    a.walls = &walls_;
    a.count = pairs_.size();
    a.from = from;
    a.to = to;
    a.solid = solid;
    a.rest = this->rest();
    a.density = density_.data();
    a.multiplier = options_.warm_start > 0 ? multiplier_.data() : nullptr;
    a.first = pairs_.list().first();
    a.rows = pairs_.list().rows();
    return a;
}

/// Warm start from the multipliers of the previous step (scaled by dt^2, since they represent a pressure): the weight of the liquid above
/// needs many iterations to reach the bottom, and hardly changes between steps.
template <int D>
void PbfSolver<D>::warm_start(real dt) {
    if (options_.warm_start == 0) return;
    const auto timed = passes_.time("warm start");
    pairs_.fit(multiplier_, 1);
    float* x = pairs_.b();
    const float* from = pairs_.a();
    pairs_.each_read([&](int k) {
        const auto before = static_cast<float>(options_.warm_start * dt * dt * fluid_.carried[static_cast<std::size_t>(pairs_.owner(k))]);
        multiplier_[static_cast<std::size_t>(k)] = before;
        for (int a = 0; a < 3; ++a) x[4 * k + a] = from[4 * k + a];
        x[4 * k + 3] = before;
    });
    solids_.at(pairs_, x);
    if (carried_dt_ > 0) carry_bodies(nullptr);
    correct();
    collide();
}

template <int D>
void PbfSolver<D>::keep_multipliers(real dt) {
    if (options_.warm_start == 0) return;
    pairs_.each([&](int k) {
        if (!pairs_.is_image(k))
            fluid_.carried[static_cast<std::size_t>(pairs_.owner(k))] =
                static_cast<real>(multiplier_[static_cast<std::size_t>(k)]) / (dt * dt);
    });
}

/// lambda_i of eq. 11, from density and gradients, walls and solids in both.
template <int D>
void PbfSolver<D>::find_lambdas() {
    const auto timed = passes_.time("lambda");
    const auto& table = pairs_.table().pbf[static_cast<int>(options_.smoothing)];
    const PbfPass job = pass(pairs_.a(), pairs_.b(), solids_.at(pairs_, pairs_.a()));
    pairs_.list().each_chunk([&](const ListChunk& chunk) { table.lambda(job, chunk); });
    pairs_.refresh(pairs_.b(), true);
}

/// x* += Δp, eq. 12 and 14, with the walls of the domain.
template <int D>
void PbfSolver<D>::correct() {
    const auto timed = passes_.time("correct");
    const auto& table = pairs_.table().pbf[static_cast<int>(options_.smoothing)];
    const auto run = options_.pressure_k > 0 ? table.correct_with_pressure : table.correct;
    particles::CorrectionTally tally{.least2 = static_cast<float>(std::pow(particles::least_correction * fluid_.domain.spacing, 2))};
    PbfPass job = pass(pairs_.b(), pairs_.a(), solids_.there());  // b has the values of a
    job.corrections = &tally;
    job.order = pairs_.cells().order().data();
    job.particles = pairs_.particles();
    job.own_begin = pairs_.shares().own().begin, job.own_end = pairs_.shares().own().end;
    pairs_.list().each_chunk([&](const ListChunk& chunk) { run(job, chunk); });
    if (tally.count > 0) fluid_.corrections.add(tally.count, std::sqrt(static_cast<real>(tally.farthest2)));
}

/// Frozen particles keep their position of the neighbour search, or move with their piece.
template <int D>
void PbfSolver<D>::keep_frozen_positions() {
    if (!this->heat_ || this->heat_->frozen() == 0) return;
    float* x = pairs_.a();
    pairs_.each([&](int k) {
        if (this->held(pairs_.owner(k)))
            for (int a = 0; a < 3; ++a) x[4 * k + a] = pairs_.found_at(k, a);
    });
    if (!this->ice_moves()) return;
    const auto at = [&](int i) { return x + 4 * sorted_[static_cast<std::size_t>(i)]; };
    this->ice_->follow([&](int i, const Vec<D>& from) {
        Vec<D> by;
        for (int a = 0; a < D; ++a) by[a] = static_cast<real>(at(i)[a]) - static_cast<real>(pairs_.local(from[a], a));
        return by;
    });
    this->ice_->each_place([&](int i, const Vec<D>& to) {
        for (int a = 0; a < D; ++a) at(i)[a] = pairs_.local(to[a], a);
    });
}

template <int D>
void PbfSolver<D>::collide() {
    if (carried_dt_ > 0)
        push_bodies();
    else
        solids_.push_out(pairs_, pairs_.a(), fluid_.corrections);
    keep_frozen_positions();
    pairs_.refresh(pairs_.a(), true);
}

/// Applies gravity to bodies and moves them with their velocities.
template <int D>
void PbfSolver<D>::start_bodies(real dt) {
    const auto timed = passes_.time("bodies");
    carried_dt_ = dt;
    bodies_->fall(fluid_.domain, fluid_.time, dt);
}

template <int D>
void PbfSolver<D>::push_bodies_ahead() {
    const auto timed = passes_.time("bodies");
    push_ahead(*bodies_, fluid_, x_star_, carried_dt_);
}

template <int D>
void PbfSolver<D>::carry_bodies(const float* density) {
    const auto timed = passes_.time("bodies");
    solids_.meet(pairs_.b(), bodies_->meetings());
    carry(*bodies_, fluid_.domain, {pairs_.b(), options_.warm_start > 0 ? multiplier_.data() : nullptr, density, this->rest()}, give_,
          carried_dt_);
}

/// Moves bodies, and particles out of them; these particles push the bodies.
template <int D>
void PbfSolver<D>::push_bodies() {
    const auto timed = passes_.time("bodies");
    bodies_->move(fluid_.domain, carried_dt_);
    float* x = pairs_.a();
    before_push_.clear();
    for (const int k : solids_.near()) before_push_.insert(before_push_.end(), x + 4 * k, x + 4 * k + D);
    solids_.push_out(pairs_, x, fluid_.corrections);
    push_on(*bodies_, fluid_.domain, solids_.near(), before_push_.data(), x, carried_dt_);
}

template <int D>
void PbfSolver<D>::end_bodies(real dt, real slow) {
    bodies_->end(fluid_.domain, dt, slow);
    carried_dt_ = 0;
}

/// v = (x* - x) / dt, x = x*; with dt = 0 only the latter. The displacement by the iterations, in single precision, is added to the
/// double-precision prediction, so that rounding does not depend on the distance from the origin. slow: the longer of this step and the
/// last, by which that displacement is divided. The compression left by the last step is proportional to its dt^2; a shorter step, for a
/// frame, must not convert it to velocity over its own dt.
template <int D>
void PbfSolver<D>::update(real dt, real slow) {
    const auto timed = passes_.time("update");
    const auto& table = pairs_.table().pbf[static_cast<int>(options_.smoothing)];
    const PbfPass job = pass(pairs_.a(), nullptr, solids_.at(pairs_, pairs_.a()));
    if (dt > 0 && this->conducts_alone())
        this->find_density_and_heat(job);
    else
        pairs_.list().each_chunk([&](const ListChunk& chunk) { table.density(job, chunk); });
    const float* now = pairs_.a();
    const real too_fast = dt > 0 ? 1 / dt - 1 / slow : 0;
    pairs_.each([&](int k) {
        if (pairs_.is_image(k)) return;
        const int i = pairs_.owner(k);
        const Vec<D> predicted = particles::Fluid<D>::get(x_star_, i);
        Vec<D> x = predicted;
        for (int a = 0; a < D; ++a) x[a] += static_cast<real>(now[4 * k + a]) - static_cast<real>(pairs_.found_at(k, a));
        x = fluid_.domain.kept(x);
        if (dt > 0) particles::Fluid<D>::put(fluid_.v, i, (x - fluid_.position(i)) / dt - too_fast * (x - predicted));
        particles::Fluid<D>::put(fluid_.x, i, x);
        fluid_.density[static_cast<std::size_t>(i)] = fluid_.rho0 * static_cast<real>(density_[static_cast<std::size_t>(k)]);
    });
    if (this->ice_moves() && dt > 0) this->ice_->finish_motion(fluid_, slow);
    if (dt > 0) return;
    this->drop_ghosts();  // the last use of ghost particles
    this->sum_up_corrections();
}

/// Over this rank's own particles.
template <int D>
particles::SumAndMost PbfSolver<D>::excess() const {
    const float* rest = this->rest();
    const particles::Entries own = pairs_.shares().own();
    return particles::whole_sum_and_max(own.count(), [&](int at) {
        const int k = own.begin + at;
        if (pairs_.is_image(k)) return real(0);
        const real density = static_cast<real>(density_[static_cast<std::size_t>(k)]);
        return std::max<real>(0, (rest ? density / static_cast<real>(rest[k]) : density) - 1);
    });
}

template <int D>
Compression PbfSolver<D>::compression() const {
    particles::SumAndMost all = excess();
    if (fluid_.shared) {
        const std::vector<particles::SumAndMost> ranks = of_ranks(all);
        all = {};
        for (const auto& rank : ranks) all.add(rank);
    }
    return particles::compression_of(all, pairs_.total());
}

template <int D>
std::size_t PbfSolver<D>::own_bytes() const {
    return D * x_star_[0].capacity() * sizeof(real) + (density_.capacity() + multiplier_.capacity()) * sizeof(float) +
           sorted_.capacity() * sizeof(int);
}

template class PbfSolver<2>;
template class PbfSolver<3>;

}  // namespace weir::pbf
