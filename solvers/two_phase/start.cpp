// The initial state of a scene with liquid and gas.
#include "free_surface/start.hpp"
#include "core/error.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/closed_volume.hpp"
#include "mac/grid/effects.hpp"
#include "mac/grid/inflow.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "scene/names.hpp"
#include "two_phase/effects.hpp"
#include "two_phase/solver.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::two_phase {

Options::Options(const scene::Scene& scene) : poisson(scene.root().table("scheme").table("poisson")) {
    rho = {scene.number("fluid.density"), scene.number("gas.density")};
    if (scene.effect("viscosity")) nu_liquid = scene.number("fluid.viscosity"), nu_gas = scene.number("gas.viscosity");
    if (const auto* tension = scene.effect("surface_tension")) sigma = tension->number("sigma");
    cfl = scene.number("time.cfl");
}

namespace {

FieldPlan fields(const scene::Scene& scene) {
    FieldPlan plan;
    plan.advected(fraction_name);
    if (scene.effect("heat")) plan.advected("temperature");
    return plan;
}

/// The same sides without friction at walls.
template <int D>
geometry::Sides<D> frictionless(geometry::Sides<D> sides) {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            auto& side = sides.side(a, end);
            if (side.kind == geometry::SideKind::moving_wall) side.kind = geometry::SideKind::wall;
            side.no_slip = false;
            side.velocity = {};
        }
    return sides;
}

/// The fractions of what enters through sides of one kind.
template <int D>
EnteringFractions<D> entering_fractions(const scene::Scene& scene, const geometry::Sides<D>& sides, geometry::SideKind kind) {
    EnteringFractions<D> entering;
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1})
            if (sides.side(a, end).kind == kind)
                entering[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)] =
                    scene.root().table(scene::side_key(a, end)).text("fluid") == "liquid" ? 1 : 0;
    return entering;
}

}  // namespace

template <int D>
TwoPhase<D>::TwoPhase(const scene::Scene& scene, const Partition& partition, const Experiment& experiment)
    : options_(scene),
      experiment_(experiment),
      state_(scene, two_phase::fields(scene), slab_of<D>(scene, partition, planes_beside)),
      bodies_(BodiesInFlow<D>::make(scene)),
      solids_(BodiesInFlow<D>::solids(scene, bodies_.get()), state_),
      entering_(entering_fractions<D>(scene, state_.sides, geometry::SideKind::inflow)),
      ghosts_of_fraction_(state_.sides, -1, entering_),
      around_(state_.sides, state_.u.cells),
      effects_(make_effects<D>(body_forces(), scene, {Stage::force})),
      brush_forcing_(bodies_ ? geometry::make_brush(scene, {BrushKind::push, BrushKind::pull, BrushKind::grab})
                             : geometry::make_brush(scene, {BrushKind::push, BrushKind::pull})),
      gravity_(free_surface::gravity_of<D>(scene)),
      up_(free_surface::up_axis<D>(gravity_)),
      transport_(state_, entering_, entering_fractions<D>(scene, state_.sides, geometry::SideKind::outflow)),
      fraction_ghosts_(state_.extent()),
      projection_(options_.poisson, state_) {
    refuse_sides(scene);
    if (brush_forcing_)
        effects_.add("hand", brush_effect<D>(brush_forcing_, Stage::force, [this](int a, const Index<D>& I) {
                         return options_.rho.of(faces_[static_cast<std::size_t>(a)](I));
                     }));
    place_solids(scene);
    free_surface::refuse_flat_cells(scene, free_surface::Frame<D>(state_.u, state_.sides));
    options_.gravity = norm(gravity_);
    state_.rho = options_.rho.lightest();
    state_.before = PaddedVelocity<D>(state_.u);
    const geometry::Sides<D> slip = frictionless(state_.sides);
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        mirrored_[at] = velocity_boundary(slip, state_.u, a, 0);
        faces_[at] = state_.mobility[at] = Grid<real, D>(state_.u[a].extent());
    }
    if (options_.sigma > 0) {
        curvature_ = {Grid<real, D>(state_.extent(), no_curvature), Grid<real, D>(state_.extent(), no_curvature)};
        effects_.declare({.name = "surface_tension", .pass = effect_pass("surface_tension"), .bytes = curvature_.bytes()});
    }
    if (scene.effect("viscosity")) {
        viscosity_ =
            std::make_unique<Viscosity<D>>(state_, solids_, options_.rho.liquid * options_.nu_liquid, options_.rho.gas * options_.nu_gas);
        effects_.declare({.name = "viscosity", .pass = effect_pass("viscosity"), .bytes = viscosity_->bytes() + sizeof(*viscosity_)});
    }
    whole_ = !own().distributed();
    start_liquid(scene);
    if (bodies_) start_bodies(scene);
    place_heat(scene);
    start_velocity(scene);
    find_rate();
}

template <int D>
bool TwoPhase<D>::has_open_sides() const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1})
            if (state_.sides.open(a, end)) return true;
    return false;
}

template <int D>
void TwoPhase<D>::refuse_sides(const scene::Scene& scene) const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1})
            if (state_.sides.side(a, end).kind == geometry::SideKind::inflow && !has_open_sides())
                scene.refuse(scene::side_key(a, end),
                             "the inflow needs an open side: both fluids are incompressible, and what enters cannot leave",
                             "add a side of kind \"outflow\" (p = 0)");
}

template <int D>
void TwoPhase<D>::place_solids(const scene::Scene& scene) {
    if (!solids_.any()) return;
    if (scene.effect("surface_tension"))
        scene.refuse("effects.surface_tension",
                     "solver \"two_phase\" has no contact angle at solids, so it does not support surface tension together with them",
                     "without solids, or without surface tension");
    open_flow_ = PaddedVelocity<D>(state_.u);
    if (bodies_ && scene.effect("viscosity"))
        for (const auto& body : bodies_->bodies().all())
            if (body.no_slip)
                scene.refuse(
                    "effects.viscosity",
                    "solver \"two_phase\" has no friction on bodies, so it does not support viscosity together with slip = \"no\" on them",
                    "without viscosity, or with slip = \"free\" on all bodies");
    see_solids();
    if (solids_.moving() && !bodies_) require_room(scene);  // bodies yield to solids: each step tells
}

template <int D>
void TwoPhase<D>::place_heat(const scene::Scene& scene) {
    if (!scene.effect("heat")) return;
    if (solids_.moving())
        scene.refuse("effects.heat", "solver \"two_phase\" does not support heat together with moving solids or bodies",
                     "without heat, or with solids at rest");
    heat_ = std::make_unique<Heat<D>>(scene, state_, options_.rho);
    heat_->start(scene, state_);
    effects_.declare({.name = "heat", .pass = effect_pass("heat"), .fields = {"temperature"}, .bytes = heat_->bytes() + sizeof(*heat_)});
}

template <int D>
void TwoPhase<D>::require_room(const scene::Scene& scene) const {
    const Squeezed<D> region = find_squeezed(state_, solids_.solids());
    if (region.any())
        scene.refuse(fmt::format("solids[{}].motion", region.solid), text_of(region) + ": both fluids are incompressible",
                     "add a side of kind \"outflow\" (p = 0)");
}

template <int D>
void TwoPhase<D>::start_liquid(const scene::Scene& scene) {
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    if (shapes.empty()) scene.refuse("liquid", "a scene of liquid and gas needs liquid: at least one shape");
    const auto liquid = geometry::unite<D>(shapes);
    start_fractions<D>(*liquid, state_.u, state_.fields[0].values);
    if (sum_over(state_.extent(), [&](const Index<D>& I) { return is_open(state_, I) ? fraction()(I) : 0; }) == 0)
        scene.refuse("liquid", "there is no liquid in the domain");
    if (solids_.moving()) visible_.start(*liquid, solids_, state_, state_.fields[0].values);
    find_face_densities();
}

/// The fractions of cells must be known.
template <int D>
void TwoPhase<D>::start_bodies(const scene::Scene& scene) {
    bodies_->set_density([this](std::size_t cell) { return options_.rho.of(fraction()[cell]); });
    bodies_->start(state_, solids_);
    if (brush_forcing_) bodies_->follow(brush_forcing_, scene);
}

/// A given velocity is made divergence-free; the pressure of that projection is not one of the flow.
template <int D>
void TwoPhase<D>::start_velocity(const scene::Scene& scene) {
    set_initial_velocity(state_, scene);
    const bool liquid_moves = scene.has("initial.liquid_velocity");
    if (liquid_moves) {
        const Vec<D> u = scene.root().vec<D>("initial.liquid_velocity");
        for (int a = 0; a < D; ++a)
            for_each_free_face(state_.u, state_.sides, a, [&](const Index<D>& I) {
                if (fraction_ghosts_(I - e<D>(a)) + fraction_ghosts_(I) > 0) state_.u[a](I) = u[a];
            });
        sync_periodic(state_.u, state_.sides);
    }
    const bool enters = std::any_of(entering_.begin(), entering_.end(), [](const auto& ends) { return ends[0] || ends[1]; });
    if (!liquid_moves && !enters && !solids_.moving() && scene.root().text_or("initial.velocity.name", "rest") == "rest") return;
    project(1, nullptr);
    state_.p.fill(0);
}

template TwoPhase<2>::TwoPhase(const scene::Scene&, const Partition&, const Experiment&);
template TwoPhase<3>::TwoPhase(const scene::Scene&, const Partition&, const Experiment&);
template bool TwoPhase<2>::has_open_sides() const;
template bool TwoPhase<3>::has_open_sides() const;
template void TwoPhase<2>::refuse_sides(const scene::Scene&) const;
template void TwoPhase<3>::refuse_sides(const scene::Scene&) const;
template void TwoPhase<2>::place_solids(const scene::Scene&);
template void TwoPhase<3>::place_solids(const scene::Scene&);
template void TwoPhase<2>::place_heat(const scene::Scene&);
template void TwoPhase<3>::place_heat(const scene::Scene&);
template void TwoPhase<2>::require_room(const scene::Scene&) const;
template void TwoPhase<3>::require_room(const scene::Scene&) const;
template void TwoPhase<2>::start_liquid(const scene::Scene&);
template void TwoPhase<3>::start_liquid(const scene::Scene&);
template void TwoPhase<2>::start_bodies(const scene::Scene&);
template void TwoPhase<3>::start_bodies(const scene::Scene&);
template void TwoPhase<2>::start_velocity(const scene::Scene&);
template void TwoPhase<3>::start_velocity(const scene::Scene&);

}  // namespace weir::two_phase
