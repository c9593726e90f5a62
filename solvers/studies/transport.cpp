#include "studies/transport.hpp"

#include "mac/grid/diagnostics.hpp"
#include "mac/grid/initial.hpp"

namespace weir::studies {

namespace {

FieldPlan carried(const scene::Scene& scene) {
    FieldPlan plan;
    for (const auto& name : initial_fields(scene)) plan.advected(name);
    if (plan.advected_fields().empty()) scene.refuse("initial", "there is no field to advect", "add one, such as initial.tracer");
    return plan;
}

}  // namespace

template <int D>
TransportSolver<D>::TransportSolver(const scene::Scene& scene)
    : flow_(scene.root().table("flow")),
      state_(scene, carried(scene)),
      options_(scene.root().table("scheme")),
      characteristics_(options_),
      trace_(flow_, state_.u, state_.sides, options_.trace),
      blend_(state_.fields.size()),
      cfl_(scene.number("time.cfl")) {
    state_.before = PaddedVelocity<D>(state_.u);
    for (auto& field : state_.fields) {
        field.before = Padded<D>(state_.extent());
        set_initial_field(field.values, state_.u, scene, field.name);
    }
    set_velocity(0);
}

template <int D>
StepReport TransportSolver<D>::step(real dt) {
    trace_.set_step(state_.time, dt);
    real t = state_.time;
    for (const Substep& stage : substeps(options_.scheme)) {
        set_velocity(t);
        const auto timed = passes_.time("advect fields");
        for (std::size_t i = 0; i < state_.fields.size(); ++i) {
            auto& field = state_.fields[i];
            fill(field.before, field.values, field.boundary);
            if (options_.scheme == Scheme::conservative) {
                add_field_flux(field.before, state_.before, state_.solid, state_.u.h, options_.flux, dt, field.values);
                blend_[i].blend(stage, field.before, field.values);
            } else {
                characteristics_.advect(field.before, field.boundary, all_cells<D>(state_.extent()), trace_, dt, field.values);
            }
        }
        t += stage.fraction() * dt;
    }
    state_.time += dt;
    set_velocity(state_.time);
    fastest_ = max_rate(state_.u);
    return {.dt = dt, .cfl = dt * fastest_};
}

/// The face velocities at time t, for the fluxes and the output.
template <int D>
void TransportSolver<D>::set_velocity(real t) {
    for (int a = 0; a < D; ++a) {
        for_each_cell(state_.u[a].extent(), [&](const Index<D>& I) { state_.u[a](I) = flow_(state_.u.face_centre(a, I), t)[a]; });
        fill(state_.before[a], state_.u[a], state_.boundary[static_cast<std::size_t>(a)]);
    }
}

template <int D>
real TransportSolver<D>::advised_dt() const {
    const real rate = max_rate(state_.u);
    return rate > 0 ? cfl_ / rate : infinity;
}

template <int D>
StepLimit TransportSolver<D>::stable_dt() const {
    if (options_.scheme != Scheme::conservative) return {};
    const real fastest = std::isnan(fastest_) ? max_rate(state_.u) : fastest_;
    return {fastest > 0 ? runge_kutta_limit / fastest : infinity, runge_kutta_limit_why};
}

template <int D>
FieldSet TransportSolver<D>::fields() const {
    FieldSet set = field_set(state_);
    std::erase_if(set.fields, [](const FieldView& view) { return view.name == "pressure"; });
    return set;
}

template <int D>
std::vector<Integral> TransportSolver<D>::integrals() const {
    std::vector<Integral> list;
    for (const auto& field : state_.fields) list.push_back({"total_" + field.name, D == 2 ? "m^2" : "m^3", integral(state_, field.values)});
    return list;
}

template <int D>
void TransportSolver<D>::restore(const Checkpoint& from) {
    state_.restore(from);
    fastest_ = not_applicable;
    set_velocity(state_.time);
}

template class TransportSolver<2>;
template class TransportSolver<3>;

}  // namespace weir::studies
