// The flow at t = 0: fields that the scene requests, their initial values, solids and bodies; scenes without a solution are rejected.
#include "geometry/brush.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "parallel/load_balance.hpp"
#include "scene/names.hpp"
#include "smoke/emitters.hpp"
#include "smoke/solver.hpp"

#include <algorithm>
#include <limits>

namespace weir::smoke {

namespace {

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
FieldPlan field_plan(const Effects<MacState<D>>& effects, const scene::Scene& scene) {
    FieldPlan plan = effects.plan();
    if (Heat<D>::named(scene)) Heat<D>::needs(plan);
    Emitters<D>::needs(scene, plan);
    for (const auto& name : initial_fields(scene)) plan.advected(name);
    return plan;
}

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
    if (heat_) start_heat(scene);
    if (bodies_) start_bodies(scene);
    list_advected();
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
void FlowSolver<D>::start_heat(const scene::Scene& scene) {
    if (solids_.moving()) scene.refuse("solids", "moving solids cannot be combined with a melting substance");
    heat_->start(state_, scene);
    if (brush_forcing_) heat_->follow(brush_forcing_, state_);
}

template <int D>
void FlowSolver<D>::start_bodies(const scene::Scene& scene) {
    if (options_.scheme == Scheme::conservative)
        scene.refuse("bodies", "scheme.advection = \"conservative\" does not support bodies",
                     "scheme.advection: semi_lagrangian, maccormack");
    bodies_->start(state_, solids_);
    const auto& all = bodies_->bodies().all();
    if (scene.effect("viscosity") && std::any_of(all.begin(), all.end(), [](const auto& body) { return body.no_slip; }))
        bodies_->couple_friction(state_, false);
    if (brush_forcing_) bodies_->follow(brush_forcing_, scene);
}

/// The arrays that a step stores and advects, with their boundary values.
template <int D>
void FlowSolver<D>::list_advected() {
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
}

#define WEIR_INSTANTIATE(D)                                                                        \
    template FieldPlan field_plan(const Effects<MacState<D>>& effects, const scene::Scene& scene); \
    template FlowSolver<D>::FlowSolver(const scene::Scene& scene, const Partition& partition);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::smoke
