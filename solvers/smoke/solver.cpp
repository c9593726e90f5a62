#include "smoke/solver.hpp"

#include "core/error.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/diagnostics.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "parallel/load_balance.hpp"
#include "scene/names.hpp"
#include "smoke/emitters.hpp"

#include <algorithm>
#include <limits>

namespace weir::smoke {

/// One step of the basic fluid algorithm (Bridson 2015, ch. 2), in one stage (semi-Lagrangian) or in the three stages of a Runge-Kutta
/// scheme. Before and after it, ∇·u = 0 to the projection's tolerance.
template <int D>
StepReport FlowSolver<D>::step(real dt) {
    whole_ = !own().distributed();
    real t = state_.time;
    apply(Stage::source, dt);  // emitters
    for (const Substep& stage : substeps(options_.scheme)) {
        const real part = stage.fraction() * dt;
        remember(dt);  // uⁿ, qⁿ with their ghosts
        if (walls_ && !walls_->found()) meet_walls(t, t);
        explicit_terms_before_advection(dt);  // u += dt f(uⁿ, qⁿ): all of it in flux form, half of it for MacCormack
        advect_fields(dt);                    // Dq/Dt = 0    only fields requested by an effect
        advect_velocity(dt);                  // Du/Dt = 0
        blend(stage);                         // γ and ζ of a Runge-Kutta stage
        apply(Stage::carried, part);          // (I − dt κ∇²) q = ...
        conduct(part);                        // ρ dH/dt = ∇·(k ∇T) + q     only where a substance is named
        explicit_terms_after_advection(dt);   // u += the rest of dt f(u, q)
        if (state_.no_slip_walls) move_no_slip_bodies(t + part, part);
        if (walls_ && solids_.moving()) meet_walls(t + part, t);
        apply(Stage::implicit, part);  // (I − dt ν∇²) u = ...
        if (walls_) walls_->enforce_no_slip(state_, part / state_.rho);
        move_solids(t += part, part);  // u·n = u_solid·n
        project(part);                 // ∇·u = 0
        enforce_sources();             // values prescribed by emitters and solids
    }
    apply(Stage::finish, dt);
    if (solids_.moving()) clear_solids();
    state_.time += dt;
    return report(dt);
}

template <int D>
FieldPlan field_plan(const Effects<MacState<D>>& effects, const scene::Scene& scene) {
    FieldPlan plan = effects.plan();
    if (Heat<D>::named(scene)) Heat<D>::needs(plan);
    Emitters<D>::needs(scene, plan);
    for (const auto& name : initial_fields(scene)) plan.advected(name);
    return plan;
}

int planes_reached(real cells, int planes) {
    if (!(cells < planes)) return planes;
    return std::min(planes, static_cast<int>(std::ceil(cells)) + ghost_layers);
}

namespace {

/// Ghost planes of arrays without a larger requirement: the width of two nested differences.
constexpr int planes_beside = 2;

/// Fastest crossing of a cell along a moving wall or through an inflow [1/s].
template <int D>
real fastest_side(const MacState<D>& s) {
    real rate = 0;
    for (int axis = 0; axis < D; ++axis)
        for (int end = 0; end < 2; ++end)
            for (int a = 0; a < D; ++a) rate = std::max(rate, std::abs(s.sides.side(axis, end).velocity[a]) / s.u.h[a]);
    return rate;
}

/// Initial temperature where the scene gives none: the ambient temperature of buoyancy or of cooling.
real ambient_temperature(const scene::Scene& scene) {
    for (const char* effect : {"buoyancy", "cooling"})
        if (const auto* table = scene.effect(effect)) return table->number("ambient");
    return 0;
}

/// Evaluates f() on the rank that owns one end of the partitioned axis and broadcasts the result.
template <class F>
auto of_rank_at(const OwnPlanes& planes, int end, F&& f) -> decltype(f()) {
    if (!planes.distributed()) return f();
    const int owner = end == 0 ? 0 : communicator().ranks() - 1;
    decltype(f()) own{};
    if (communicator().rank() == owner) own = f();
    return of_ranks(own)[static_cast<std::size_t>(owner)];
}

/// Inflow must be balanced: by an open side, or by equal outflow through other inflow sides, up to rounding of the sums.
template <int D>
void refuse_closed_box(const scene::Scene& scene, const MacState<D>& s) {
    real net = 0, gross = 0, faces = 0;
    std::string first;
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            if (s.sides.open(a, end)) return;
            if (s.sides.side(a, end).kind != geometry::SideKind::inflow) continue;
            if (first.empty()) first = std::string("sides.") + "xyz"[a] + (end == 0 ? "_min" : "_max");
            real area = 1;
            for (int b = 0; b < D; ++b) area *= b == a ? 1 : s.u.h[b];
            const auto& open = s.solid.open[static_cast<std::size_t>(a)];
            const auto flux = [&](Index<D> I) {
                I[a] = end == 0 ? 0 : s.u.cells[a];
                return (end == 0 ? 1 : -1) * area * (open.empty() ? 1 : open(I)) * s.u[a](I);
            };
            Extent<D> side = a == D - 1 ? replicated<D>(s.u.cells) : s.u.cells;
            side[a] = 1;
            const auto sums = [&] {
                return std::array<real, 2>{sum_over(side, flux), sum_over(side, [&](const Index<D>& I) { return std::abs(flux(I)); })};
            };
            const auto [through, either_way] = a == D - 1 ? of_rank_at(s.own(), end, sums) : sums();
            net += through, gross += either_way, faces += static_cast<real>(product(side));
        }
    if (!(std::abs(net) > faces * std::numeric_limits<real>::epsilon() * gross)) return;
    scene.refuse(first,
                 "the domain is closed: " + scene::number_text(net) + (D == 2 ? " m^2/s" : " m^3/s") + " flow in, but there is no outflow",
                 "add a side of kind \"outflow\", or an inflow with outward velocity and the same flow rate");
}

/// Number of times at which solids are tested before the run, chosen to be cheap compared with its steps.
int moments_of(std::size_t cells) { return static_cast<int>(std::clamp<std::size_t>(4'000'000 / std::max<std::size_t>(cells, 1), 1, 16)); }

/// Rejects moving solids that change the volume of enclosed fluid. Tested from t = 0 to the end; afterwards the solids are at t = 0 again.
template <int D>
void refuse_squeezing(const scene::Scene& scene, MacState<D>& s, SolidPlacement<D>& solids) {
    if (s.own().distributed()) return;  // the step tests it there
    const int moments = moments_of(s.cells.size());
    const real end = scene.number("time.end");
    for (int k = 0; k <= moments; ++k) {
        const real t = k == 0 ? 0 : end * (k - 0.5) / moments;
        solids.place(s, t);
        const Squeezed<D> region = find_squeezed(s, solids.solids());
        if (!region.any()) continue;
        const std::string path = "solids[" + std::to_string(region.solid) + "]";
        scene.refuse(
            path + ".motion",
            path + " moves so that at t = " + scene::number_text(t) + " s " + text_of(region) + ": an incompressible fluid has no outflow",
            "add a side of kind \"outflow\" in that region, or a second solid that displaces the same volume in the opposite direction");
    }
    solids.place(s, 0);
}

bool lists(const scene::Scene& scene, const std::string& field) {
    const auto& names = scene.root().texts("output.fields");
    return std::find(names.begin(), names.end(), field) != names.end();
}

}  // namespace

template <int D>
FlowSolver<D>::FlowSolver(const scene::Scene& scene, const Partition& partition)
    : effects_(make_effects<D>(effect_kinds(), scene, all_stages)),
      state_(scene, field_plan(effects_, scene), slab_of<D>(scene, partition, planes_beside)),
      bodies_(BodiesInFlow<D>::make(scene)),
      solids_(BodiesInFlow<D>::solids(scene, bodies_.get()), state_),
      walls_(solids_.any() && scene.effect("viscosity") ? std::make_unique<SolidWalls<D>>() : nullptr),
      heat_(Heat<D>::named(scene) ? std::make_unique<Heat<D>>(scene, state_) : nullptr),
      options_(scene.root().table("scheme")),
      characteristics_(options_),
      trace_(state_.before, state_.u, state_.sides, options_.trace),
      field_blend_(state_.fields.size()),
      projection_(PoissonChoice(scene.root().table("scheme.poisson")), state_),
      cfl_(scene.number("time.cfl")),
      side_rate_(fastest_side(state_)),
      wants_vorticity_(lists(scene, "vorticity")),
      wants_divergence_(lists(scene, "divergence")),
      brush_forcing_(geometry::make_brush(scene, kinds_of_brush(scene))) {
    if (brush_forcing_) effects_.add("hand", brush_effect<D>(brush_forcing_, Stage::implicit));
    if (max_over(state_.extent(), [&](const Index<D>& I) { return state_.cells(I) == poisson::Cell::fluid ? 1.0 : 0.0; }) == 0)
        scene.refuse("solids", "solids cover all cells of the domain");
    if (Emitters<D>::any(scene)) effects_.add("emitters", std::make_unique<Emitters<D>>(scene, state_));
    state_.before = PaddedVelocity<D>(state_.u);
    state_.walls = walls_.get();
    if (options_.scheme == Scheme::maccormack) carried_ = PaddedVelocity<D>(state_.u);
    set_initial_velocity(state_, scene);
    for (auto& field : state_.fields) {
        field.before = Padded<D>(state_.extent());
        if (field.name == "temperature") field.values.fill(ambient_temperature(scene));
        set_initial_field(field.values, state_.u, scene, field.name);
    }
    if (heat_) {
        if (solids_.moving()) scene.refuse("solids", "moving solids cannot be combined with a melting substance");
        heat_->start(state_, scene);
        if (brush_forcing_) heat_->follow(brush_forcing_, state_);
    }
    if (bodies_) {
        if (options_.scheme == Scheme::conservative)
            scene.refuse("bodies", "scheme.advection = \"conservative\" does not support bodies",
                         "scheme.advection: semi_lagrangian, maccormack");
        bodies_->start(state_, solids_);
        const auto& all = bodies_->bodies().all();
        if (scene.effect("viscosity") && std::any_of(all.begin(), all.end(), [](const auto& body) { return body.no_slip; }))
            bodies_->couple_friction(state_, false);
        if (brush_forcing_) bodies_->follow(brush_forcing_, scene);
    }
    for (auto& field : state_.fields) {
        if (field.derived) continue;
        carried_fields_.push_back({&field.before, &field.boundary, &field.values});
        remembered_fields_.push_back({&field.before, &field.boundary});
    }
    for (int a = 0; a < D; ++a) {
        remembered_.push_back({&state_.before[a], &state_.boundary[static_cast<std::size_t>(a)]});
        carried_velocity_.push_back({&carried_[a], &state_.boundary[static_cast<std::size_t>(a)]});
    }
    remembered_.insert(remembered_.end(), remembered_fields_.begin(), remembered_fields_.end());
    solids_.set_faces(state_);
    refuse_closed_box(scene, state_);
    if (move_as_prescribed(solids_.solids())) refuse_squeezing(scene, state_, solids_);
    clear_solids();
    smoke_removed_ = 0;  // smoke placed inside a solid by the scene does not count
    if (solids_.moving() && state_.find("smoke")) {
        was_solid_ = Grid<std::uint8_t, D>(state_.extent());
        remember_solids();
    }
    apply(Stage::source, 0);  // values emitted from the start exist at the start: the first step has its forces
    passes_.reset();
    whole_ = !own().distributed();
}

template <int D>
void FlowSolver<D>::apply(Stage stage, real dt) {
    effects_.apply(stage, state_, dt, passes_);
}

template <int D>
void FlowSolver<D>::remember(real dt) {
    const auto timed = passes_.time("ghosts");
    real fluid = 0;  // max |u|/h
    for (int a = 0; a < D; ++a)
        fluid = larger_or_nan(
            fluid, fill_planes_and_measure(state_.before[a], state_.u[a], state_.boundary[static_cast<std::size_t>(a)]) / state_.u.h[a]);
    const real fastest = rate(fluid);
    trace_.set_max_rate(fastest);
    state_.reach = planes_reached(dt * fastest, state_.extent()[D - 1]);
    characteristics_.set_reach(state_.reach);
    fill_field_planes();
    fill_end_planes(remembered_, planes_to_extend());
    solids_.fill_ghosts(state_, state_.reach + 3);
    solids_.extend_velocity(state_);
    extend_fields();
}

/// In parallel: ghost planes needed so that the extrapolation into solids is complete to the depth that the step reads. It depends on
/// neighbours' values and on other extrapolated ones.
template <int D>
int FlowSolver<D>::planes_to_extend() const {
    return solids_.any() ? state_.reach + 2 : state_.reach;
}

template <int D>
void FlowSolver<D>::fill_field_planes() {
    for (auto& field : state_.fields)
        if (!field.derived) fill_planes(field.before, field.values, field.boundary);
}

template <int D>
void FlowSolver<D>::extend_fields() {
    if (!solids_.any()) return;
    const bool ring = state_.sides.periodic(D - 1);
    for (auto& field : state_.fields)
        if (!field.derived) solids_.extend_field(state_, field.before, ring ? 0 : state_.reach);
    if (ring) refresh(remembered_fields_, state_.reach);
}

/// Forces on a face depend on the cells on both sides.
template <int D>
void FlowSolver<D>::refresh_fields() {
    if (!own().distributed() || state_.fields.empty()) return;
    shared_.clear();
    for (auto& field : state_.fields) shared_.push_back(planes_of(field.values));
    communicator().refresh(own().partition(), shared_, 1, state_.sides.periodic(D - 1));
}

/// Bodies move before friction, which uses their new position.
template <int D>
void FlowSolver<D>::move_no_slip_bodies(real t, real dt) {
    bodies_->leave(state_, dt);
    place_solids(t, dt);
    const auto timed = passes_.time("solids");
    bodies_->set_no_slip_walls(state_, solids_, dt);
}

/// In flux form all explicit rates use the fields before the step. The trapezoidal rule along trajectories applies half of each term at the
/// departure point: advected fields contain it.
template <int D>
void FlowSolver<D>::explicit_terms_before_advection(real dt) {
    refresh_fields();
    if (options_.scheme == Scheme::conservative) {
        apply_buoyancy(dt);
        return apply(Stage::force, dt);
    }
    if (options_.scheme != Scheme::maccormack) return;
    for (const Stage stage : {Stage::implicit, Stage::force, Stage::carried})
        effects_.apply_before_advection(stage, state_, 0.5 * dt, passes_);
    apply_buoyancy(0.5 * dt);
    if (!effects_.empty(Stage::implicit) || !effects_.empty(Stage::force) || (heat_ && heat_->has_buoyancy())) {
        sync_periodic(state_.u, state_.sides);
        solids_.set_faces(state_);  // forces do not change the velocity of solids
    }
    if (effects_.empty(Stage::carried)) return;
    const auto timed = passes_.time("ghosts");
    for (auto& field : state_.fields) field.enforce_sources();
    fill_field_planes();
    fill_end_planes(remembered_fields_, planes_to_extend());
    extend_fields();
}

/// Advected fields are final here: forces use the temperature at the end of the step.
template <int D>
void FlowSolver<D>::explicit_terms_after_advection(real dt) {
    if (options_.scheme == Scheme::conservative) return;
    const real part = options_.scheme == Scheme::maccormack ? 0.5 * dt : dt;
    refresh_fields();
    apply_buoyancy(part);
    apply(Stage::force, part);
    sync_periodic(state_.u, state_.sides);
}

template <int D>
void FlowSolver<D>::advect_fields(real dt) {
    if (state_.fields.empty()) return;
    const auto timed = passes_.time("advect fields");
    if (options_.scheme != Scheme::conservative) return characteristics_.advect(carried_fields_, all_cells<D>(state_.extent()), trace_, dt);
    for (auto& field : state_.fields) {
        if (field.derived) continue;
        if (solids_.moving())  // a cell that a body uncovers starts with extrapolated values
            for_each_cell(state_.extent(), [&](const Index<D>& I) {
                if (state_.cells(I) == poisson::Cell::solid) field.values(I) = field.before(I);
            });
        add_field_flux(field.before, state_.before, state_.solid, state_.u.h, options_.flux, dt, field.values);
        if (solids_.moving()) keep_uniform_at_solids(field.before, state_.before, state_.solid, state_.u.h, dt, field.values);
    }
}

/// MacCormack advects the velocity minus half of the old pressure gradient and adds that half on arrival: the trapezoidal rule along the
/// trajectory. Without it a step is first order in dt (equivalent to the reflection of Narain, Zehnder & Thomaszewski 2019).
template <int D>
void FlowSolver<D>::advect_velocity(real dt) {
    const auto timed = passes_.time("advect velocity");
    const bool second_order = options_.scheme == Scheme::maccormack;
    if (options_.scheme == Scheme::conservative && solids_.any() && (solids_.moving() || !cuts_.found())) cuts_.find(state_);
    const PressurePush<D> taken(state_, -0.5 * dt / state_.rho), given_back(state_, 0.5 * dt / state_.rho);
    if (second_order) {
        for (int a = 0; a < D; ++a)
            for_each_plane(carried_[a].extent(), [&](int plane) {
                fill_plane(carried_[a], state_.boundary[static_cast<std::size_t>(a)], plane,
                           [&](const Index<D>& first, int count, real* row) {
                               std::copy_n(&state_.u[a](first), count, row);
                               taken.add(a, first, count, row);
                           });
            });
        fill_end_planes(carried_velocity_, state_.reach);
    }
    for (int a = 0; a < D; ++a) {
        const auto& boundary = state_.boundary[static_cast<std::size_t>(a)];
        const auto faces = free_faces(state_.u, state_.sides, a);
        if (options_.scheme == Scheme::conservative) {
            if (solids_.any())
                cuts_.add_momentum_flux(state_, a, dt, state_.u[a]);
            else
                add_momentum_flux(state_.before, state_.u.h, faces, dt, state_.u[a]);
            continue;
        }
        if (!second_order) {
            characteristics_.advect(state_.before[a], boundary, faces, trace_, dt, state_.u[a]);
            continue;
        }
        characteristics_.advect(carried_[a], boundary, faces, trace_, dt, state_.u[a], &given_back);
    }
    sync_periodic(state_.u, state_.sides);
}

template <int D>
void FlowSolver<D>::blend(const Substep& stage) {
    if (options_.scheme != Scheme::conservative) return;
    const auto timed = passes_.time("blend");
    for (int a = 0; a < D; ++a) velocity_blend_[static_cast<std::size_t>(a)].blend(stage, state_.before[a], state_.u[a]);
    for (std::size_t i = 0; i < state_.fields.size(); ++i)
        if (!state_.fields[i].derived) field_blend_[i].blend(stage, state_.fields[i].before, state_.fields[i].values);
}

/// Viscosity acts before solids move, with walls at their new position.
template <int D>
void FlowSolver<D>::meet_walls(real now, real last) {
    const auto timed = passes_.time("solids");
    solids_.solids().set_time(now);
    walls_->find(state_, solids_, now, last);
    const bool found = state_.no_slip_walls && !state_.no_slip_walls->takes_part[0].empty();  // once bodies have been found
    for (int a = 0; found && a < D; ++a)
        for (const HeldFace<D>& f : walls_->held(a)) state_.no_slip_walls->takes_part[static_cast<std::size_t>(a)](f.face) = 0;
}

/// Friction force on no-slip solids. In parallel, the stress at a subdomain boundary needs the values of both sides.
template <int D>
Vec<D> FlowSolver<D>::friction() {
    if (!walls_ || !walls_->no_slip() || state_.nu == 0) return {};
    for (int a = 0; a + 1 < D; ++a) refresh(state_.u[a], state_.sides.periodic(D - 1));
    return walls_->friction(state_).force;
}

template <int D>
void FlowSolver<D>::move_solids(real t, real dt) {
    if (!state_.no_slip_walls) place_solids(t, dt);
    if (walls_ && solids_.moving()) meet_walls(t, t);  // the faces that are open now
    solids_.set_faces(state_);
}

template <int D>
void FlowSolver<D>::place_solids(real t, real dt) {
    if (!solids_.any()) return;
    const auto timed = passes_.time("solids");
    if (bodies_) bodies_->advance_free(solids_, dt);
    if (!solids_.moving()) return;
    solids_.place(state_, t);
    projection_.set_matrix(state_);
}

template <int D>
void FlowSolver<D>::conduct(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("heat");
    heat_->conduct(state_, dt);
}

template <int D>
void FlowSolver<D>::apply_buoyancy(real dt) {
    if (heat_) heat_->apply_buoyancy(state_, dt);
}

/// Drag of ice reduces the response to pressure: sets the face coefficients of the matrix.
template <int D>
void FlowSolver<D>::apply_ice_drag(real dt) {
    if (!heat_) return;
    const auto timed = passes_.time("ice");
    if (heat_->apply_ice_drag(state_, dt)) projection_.set_matrix(state_);
}

template <int D>
void FlowSolver<D>::project(real dt) {
    apply_ice_drag(dt);
    const auto timed = passes_.time("project");
    report_ = &explained_by_room(state_, solids_,
                                 [&]() -> const poisson::Report& { return projection_.project(state_, dt, bodies_.get(), &solids_); });
    if (bodies_) solids_.see_velocities(state_);
    impulse_ += dt * (pressure_force(state_) + friction());
}

/// Emitted values are prescribed after each (sub)step: the next inflow from there does not depend on its length. Smoke is removed from
/// solids. For moving solids this is recorded once, at the end of the step.
template <int D>
void FlowSolver<D>::enforce_sources() {
    for (auto& field : state_.fields) field.enforce_sources();
    if (!solids_.moving()) clear_solids();
}

/// Removes smoke from solids. Recorded: smoke in cells that a body has covered since the last step, and gains in cells that it has
/// uncovered. Other solid cells contain only extrapolated values.
template <int D>
void FlowSolver<D>::clear_solids() {
    auto* smoke = state_.find("smoke");
    if (!solids_.any() || !smoke) return;
    const auto sum = [&](auto&& counts) {
        return state_.u.cell_volume() * sum_over(state_.extent(), [&](const Index<D>& I) { return counts(I) ? (*smoke)(I) : 0; });
    };
    const auto solid = [&](const Index<D>& I) { return state_.cells(I) == poisson::Cell::solid; };
    if (!was_solid_.empty()) {
        smoke_removed_ += sum([&](const Index<D>& I) { return solid(I) && !was_solid_(I); });
        smoke_continued_ += sum([&](const Index<D>& I) { return !solid(I) && was_solid_(I); });
    }
    remember_solids();
    for_each_cell(state_.extent(), [&](const Index<D>& I) {
        if (state_.cells(I) == poisson::Cell::solid) (*smoke)(I) = 0;
    });
}

template <int D>
void FlowSolver<D>::remember_solids() {
    if (was_solid_.empty()) return;
    for_each_cell(state_.extent(), [&](const Index<D>& I) { was_solid_(I) = state_.cells(I) == poisson::Cell::solid; });
}

/// Maximum number of cells crossed per second, where `fluid` is the fluid's.
template <int D>
real FlowSolver<D>::rate(real fluid) const {
    const real h = *std::min_element(state_.u.h.begin(), state_.u.h.end());
    return std::isnan(fluid) ? fluid : std::max({fluid, side_rate_, solids_.max_rate(state_), bodies_ ? bodies_->bodies().max_rate(h) : 0});
}

/// The same after the last step, whose fastest flow is known.
template <int D>
real FlowSolver<D>::last_rate() const {
    return rate(std::isnan(fastest_) ? max_rate(state_.u) : fastest_);
}

template <int D>
StepReport FlowSolver<D>::report(real dt) {
    const real fastest = fastest_ = max_rate(state_.u);
    if (!std::isfinite(fastest)) throw NumericalFailure("velocity", "the velocity is not finite");
    if (own().distributed()) check_own_planes();
    const real divergence = max_divergence(state_);
    require_room(state_, solids_, divergence);
    return {.dt = dt,
            .cfl = dt * fastest,
            .max_divergence = divergence,
            .iterations = report_->iterations,
            .residual_before = report_->residual_before,
            .residual_after = report_->residual_after,
            .residual_max = report_->residual_max / (state_.u.h[0] * state_.u.h[0])};
}

/// Checks that one process would make on whole fields after each step.
template <int D>
void FlowSolver<D>::check_own_planes() const {
    const auto check = [](const Grid<real, D>& q, const std::string& name) {
        if (!std::isfinite(max_magnitude(q))) throw NumericalFailure(name, name + " is no longer finite");
    };
    check(state_.p, "pressure");
    for (const auto& field : state_.fields) check(field.values, field.name);
}

template <int D>
void FlowSolver<D>::synchronize() {
    if (walls_ && state_.nu > 0 && !walls_->found()) walls_->find(state_, solids_, state_.time, state_.time);
    exchange_fields();
}

/// Ghost planes, or the planes of all ranks where whole fields are read.
template <int D>
void FlowSolver<D>::exchange_fields() {
    if (whole_) return;
    std::vector<Grid<real, D>*> shown;
    for (int a = 0; a < D; ++a) shown.push_back(&state_.u[a]);
    shown.push_back(&state_.p);
    for (auto& field : state_.fields) shown.push_back(&field.values);
    if (own().distributed_storage()) {
        shared_.clear();
        for (auto* grid : shown) shared_.push_back(planes_of(*grid));
        communicator().refresh(own().partition(), shared_, planes_beside, state_.sides.periodic(D - 1));
    } else {
        for (auto* grid : shown) gather(*grid);
    }
    whole_ = true;
}

template <int D>
real FlowSolver<D>::advised_dt() const {
    const real fastest = last_rate();
    return std::min({fastest > 0 ? cfl_ / fastest : infinity, effects_.max_dt(state_), heat_ ? heat_->max_dt(state_) : infinity});
}

/// Central fluxes are stable up to √3 cells per step; semi-Lagrangian schemes have no such limit.
template <int D>
StepLimit FlowSolver<D>::stable_dt() const {
    if (const real most = heat_ ? heat_->stable_dt(state_) : infinity; most < infinity)
        return {most, "explicit conduction of heat is stable up to it"};
    if (options_.scheme != Scheme::conservative) return {};
    const real fastest = last_rate();
    return {fastest > 0 ? runge_kutta_limit / fastest : infinity, runge_kutta_limit_why};
}

template <int D>
FieldSet FlowSolver<D>::fields() const {
    const Extent<D> shown = own().distributed_storage() ? state_.extent() : replicated<D>(state_.extent());
    FieldSet set = field_set(state_);
    if (own().distributed_storage()) set.cut = &own().partition();
    if (heat_) set.fields.push_back({"liquid", "", Where::cell, "", {heat_->liquid().values()}});
    if (wants_vorticity_) {
        vorticity(state_, shown, vorticity_);
        FieldView view{"vorticity", "1/s", Where::cell, "", {}};
        for (const auto& component : vorticity_) view.data.push_back(component.values());
        set.fields.push_back(std::move(view));
    }
    if (wants_divergence_) {
        if (divergence_.empty()) divergence_ = Grid<real, D>(state_.extent());
        for_each_cell(
            shown, [&](const Index<D>& I) { divergence_(I) = state_.cells(I) == poisson::Cell::fluid ? flux_divergence(state_, I) : 0; });
        set.fields.push_back({"divergence", "1/s", Where::cell, "", {divergence_.values()}});
    }
    if (bodies_) bodies_->bodies().show(set);
    return set;
}

template <int D>
std::vector<Integral> FlowSolver<D>::integrals() const {
    auto list = smoke::integrals(state_);
    if (heat_)
        for (auto& integral : heat_->integrals(state_)) list.push_back(std::move(integral));
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, D, list);
    if (!solids_.any()) return list;
    if (bodies_)
        for (auto& integral : bodies_->bodies().integrals(bodies_->gravity())) list.push_back(std::move(integral));
    if (state_.find("smoke")) {
        list.push_back({"smoke_removed", D == 2 ? "m^2" : "m^3", smoke_removed_});
        list.push_back({"smoke_continued", D == 2 ? "m^2" : "m^3", smoke_continued_});
    }
    add_loads(list);
    return list;
}

/// Force on the solids and torque about the origin, with their pressure and friction parts.
template <int D>
void FlowSolver<D>::add_loads(std::vector<Integral>& list) const {
    const SolidLoad<D> pressure = pressure_load(state_);
    SolidLoad<D> friction;
    if (walls_ && state_.nu > 0) {
        friction = walls_->friction(state_);
    }
    const std::string force_unit = D == 2 ? "N/m" : "N", torque_unit = D == 2 ? "N" : "N m";
    const auto add = [&](const std::string& quantity, const std::string& letter, const std::string& unit, real by_pressure,
                         real by_friction) {
        list.push_back({"solid_" + quantity + letter, unit, by_pressure + by_friction});
        list.push_back({"solid_pressure_" + quantity + letter, unit, by_pressure});
        list.push_back({"solid_friction_" + quantity + letter, unit, by_friction});
    };
    for (int a = 0; a < D; ++a) {
        const std::string letter(1, "xyz"[a]);
        add("force_", letter, force_unit, pressure.force[a], friction.force[a]);
        list.push_back({"solid_impulse_" + letter, D == 2 ? "N s/m" : "N s", impulse_[a]});
    }
    for (std::size_t k = 0; k < pressure.torque.size(); ++k)
        add("torque_", D == 2 ? "z" : std::string(1, "xyz"[k]), torque_unit, pressure.torque[k], friction.torque[k]);
}

template <int D>
void FlowSolver<D>::save(Checkpoint& to) const {
    state_.save(to);
    if (bodies_) bodies_->save(to);
    to.put_value("impulse", impulse_);
    if (heat_) heat_->save(to);
    if (brush_forcing_) brush_forcing_->save(to);
    to.put_value("smoke_in_solids", std::array<real, 2>{smoke_removed_, smoke_continued_});
}

template <int D>
void FlowSolver<D>::restore(const Checkpoint& from) {
    state_.restore(from);
    if (bodies_) bodies_->restore(from, solids_);
    if (heat_) heat_->restore(from, state_);
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    whole_ = !own().distributed();
    if (walls_) walls_->forget();
    exchange_fields();
    fastest_ = not_applicable;
    impulse_ = from.template get_value<Vec<D>>("impulse");
    if (from.has("smoke_in_solids")) {
        const auto smoke = from.template get_value<std::array<real, 2>>("smoke_in_solids");
        smoke_removed_ = smoke[0], smoke_continued_ = smoke[1];
    }
    if (!solids_.moving()) return;
    solids_.place(state_, state_.time);
    projection_.set_matrix(state_);
    remember_solids();
}

template <int D>
std::size_t FlowSolver<D>::bytes() const {
    std::size_t total = state_.bytes() + characteristics_.bytes() + projection_.bytes() + solids_.bytes() + effects_.bytes();
    for (const auto& blend : velocity_blend_) total += blend.bytes();
    for (const auto& blend : field_blend_) total += blend.bytes();
    for (const auto& component : carried_.face) total += component.bytes();
    total += cuts_.bytes() + (walls_ ? walls_->bytes() : 0) + was_solid_.bytes() + (bodies_ ? bodies_->bytes() : 0);
    if (heat_) total += heat_->bytes();
    return total;
}

template FieldPlan field_plan(const Effects<MacState<2>>&, const scene::Scene&);
template FieldPlan field_plan(const Effects<MacState<3>>&, const scene::Scene&);
template class FlowSolver<2>;
template class FlowSolver<3>;

}  // namespace weir::smoke
