#include "pbf/reference_solver.hpp"

#include "particles/flow.hpp"

#include <algorithm>

namespace weir::pbf {

using particles::Fluid;
using particles::Point;

namespace {

template <int D>
Fluid<D> start_of(const scene::Scene& scene) {
    particles::refuse_what_the_reference_lacks(scene, {"gravity", "artificial_pressure"});
    auto fluid = particles::initial_fluid<D>(scene);
    particles::refuse_idle_walls(scene, fluid.domain, false, instead_of_sticking);
    return fluid;
}

/// Advised for the scene's liquid as it is before it settles, as on threads.
template <int D>
real step_of(const scene::Scene& scene) {
    Fluid<D> fluid = start_of<D>(scene);
    return even_step(scene, fluid);
}

}  // namespace

template <int D>
ReferencePbfSolver<D>::ReferencePbfSolver(const scene::Scene& scene) : ReferencePbfSolver(Options(scene), start_of<D>(scene)) {
    emitters_ = particles::Emitters<D>(scene, fluid_.domain);
    step_ = step_of<D>(scene);
    for (const auto& [name, pass] : {std::pair{"gravity", "predict"}, {"artificial_pressure", "correct"}})
        if (scene.effect(name)) plans_.push_back({.name = name, .inside = pass});
}

template <int D>
ReferencePbfSolver<D>::ReferencePbfSolver(const Options& options, Fluid<D> start) : options_(options), fluid_(std::move(start)) {
    const auto& domain = fluid_.domain;
    reference_.p = pbf_params<particles::plain::PbfParams, D>(options_, domain.spacing);
    reference_.walls = domain.template walls<particles::plain::WallParams>(density_kernel<D>(options_, domain.spacing),
                                                                           gradient_kernel<D>(options_, domain.spacing));
    reference_.kernel = static_cast<int>(options_.smoothing);
    reference_.period = domain.frame().period;
    settle();
}

/// Numbers at the right are the lines of Algorithm 1.
template <int D>
StepReport ReferencePbfSolver<D>::step(real dt) {
    emitters_.apply(fluid_, dt);
    predict(dt);  // 1-7
    warm_start(dt);
    int iterations = 0;  //  8
    const int most = options_.tolerance > 0 ? options_.max_iterations : options_.iterations;
    for (; iterations < most; ++iterations) {
        find_lambdas();  //  9-11
        if (options_.tolerance > 0 && compression().mean <= options_.tolerance) break;
        correct();  // 12-19
    }
    const real slow = std::max(dt, last_dt_);
    if (options_.warm_start > 0)
        for (std::size_t i = 0; i < multiplier_.size(); ++i) fluid_.carried[i] = multiplier_[i] / (slow * slow);
    update(dt, slow);  // 20-21, 23-24
    last_dt_ = dt;
    const real speed = speed_ = fluid_.max_speed();
    const Compression c = compression();
    ++fluid_.steps;
    fluid_.cross_sides();
    return {.dt = dt,
            .cfl = dt * speed / fluid_.domain.spacing,
            .iterations = iterations,
            .density_error = c.mean,
            .max_density_error = c.worst};
}

/// Takes the density error of the initial lattice out of the positions alone, as PbfSolver does.
template <int D>
void ReferencePbfSolver<D>::settle() {
    for (int i = 0; i < options_.settle; ++i) {
        if (i % settle_between_lists == 0) {
            if (i > 0 && compression().worst <= settle_good_enough) break;
            predict(0);
        }
        multiplier_.assign(x_star_.size(), 0);
        find_lambdas();
        correct();
        if ((i + 1) % settle_between_lists == 0 || i + 1 == options_.settle) update(0, 0);
    }
}

/// v += dt g, x* = x + dt v, and the pairs there.
template <int D>
void ReferencePbfSolver<D>::predict(real dt) {
    {
        const auto timed = passes_.time("predict");
        fluid_.time += dt;
        fluid_.domain.solids.set_time(fluid_.time);
        predicted_.clear(), x_star_.clear();
        for (int i = 0; i < fluid_.count(); ++i) {
            Fluid<D>::put(fluid_.v, i, fluid_.velocity(i) + dt * fluid_.gravity);
            predicted_.push_back(fluid_.domain.kept(fluid_.position(i) + dt * fluid_.velocity(i)));
            x_star_.push_back(particles::point_of(predicted_.back() - fluid_.domain.centre()));
        }
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
    x_star_ = reference_.corrected(x_star_, lambda_);
    const Vec<D> centre = fluid_.domain.centre();
    if (!fluid_.domain.solids.empty())
        for (Point& x : x_star_) x = particles::point_of(fluid_.domain.kept(centre + particles::vec_of<D>(x)) - centre);
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
}

template <int D>
typename ReferencePbfSolver<D>::Compression ReferencePbfSolver<D>::compression() const {
    Compression c;
    for (const double rho : density_) {
        c.mean += std::max(0.0, rho - 1) / static_cast<real>(density_.size());
        c.worst = std::max(c.worst, rho - 1);
    }
    return c;
}

template <int D>
FieldSet ReferencePbfSolver<D>::fields() const {
    FieldSet set;
    fluid_.show(set);
    return set;
}

template <int D>
std::vector<Integral> ReferencePbfSolver<D>::integrals() const {
    auto list = fluid_.integrals();
    particles::add_neighbour_counts(reference_.neighbours, list);
    const Compression c = compression();
    list.push_back({"mean_compression", "1", c.mean});
    list.push_back({"max_compression", "1", c.worst});
    return list;
}

template <int D>
void ReferencePbfSolver<D>::save(Checkpoint& to) const {
    fluid_.save(to);
    emitters_.save(to);
    to.put_value("pbf.last_dt", last_dt_);
    to.put_value("pbf.speed", speed_);
}
template <int D>
void ReferencePbfSolver<D>::restore(const Checkpoint& from) {
    fluid_.restore(from);
    emitters_.restore(from);
    last_dt_ = from.get_value<real>("pbf.last_dt");
    speed_ = from.has("pbf.speed") ? from.get_value<real>("pbf.speed") : not_applicable;  // the device does not keep it
}

template <int D>
std::size_t ReferencePbfSolver<D>::bytes() const {
    return fluid_.bytes() + predicted_.capacity() * sizeof(Vec<D>) + x_star_.capacity() * sizeof(Point) +
           (density_.capacity() + lambda_.capacity() + multiplier_.capacity()) * sizeof(double) +
           particles::bytes_of(reference_.neighbours);
}

template class ReferencePbfSolver<2>;
template class ReferencePbfSolver<3>;

}  // namespace weir::pbf
