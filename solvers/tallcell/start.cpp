// Initial state of a scene with tall cells, and its unsupported combinations.
#include "free_surface/start.hpp"
#include "geometry/brush.hpp"
#include "mac/grid/effects.hpp"
#include "mac/grid/initial.hpp"
#include "scene/names.hpp"
#include "tallcell/kind.hpp"
#include "tallcell/solver.hpp"

namespace weir::tallcell {

namespace {

/// Depth of the velocity's halo: the motion of a step plus the interpolation stencil.
template <int D>
const Slab* slab_of_columns(const scene::Scene& scene, const Partition& cut, real cfl) {
    const int ghost_planes = static_cast<int>(std::ceil(cfl)) + 3;
    return slab_of(cut, holds_own_planes(scene, cut) ? ghost_planes : 0, geometry::Sides<D>(scene).periodic(D - 1));
}

}  // namespace

template <int D>
TallCells<D>::TallCells(const scene::Scene& scene, const Partition& partition)
    : options_(scene),
      state_(scene, FieldPlan{}, slab_of_columns<D>(scene, partition, options_.cfl)),
      frame_(state_.u, state_.sides),
      solids_(solids_of<D>(scene), state_),
      effects_(make_effects<D>(body_forces(), scene, {Stage::force})),
      gravity_(gravity_of<D>(scene)),
      up_(up_axis<D>(gravity_)),
      pressure_(frame_, up_, options_.poisson),
      brush_forcing_(geometry::make_brush(scene, geometry::moving_kinds)) {
    if (brush_forcing_) effects_.add("hand", brush_effect<D>(brush_forcing_, Stage::force));
    refuse_what_it_cannot(scene);
    const int reach = static_cast<int>(std::ceil(options_.cfl));
    surface_ = LevelSet<D>(frame_, reach);
    transport_ = Transport<D>(frame_, state_.u, options_.maccormack, reach);
    extrapolate_ = Extrapolation<D>(frame_, norm(gravity_));
    leapfrog_ = Leapfrog<D>(state_.u);
    for (int a = 0; a < D; ++a) known_[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(state_.u[a].extent());
    tall_ = Grid<real, D>(frame_.cells);
    if (options_.volume_control) effects_.declare({.name = "volume_control", .pass = effect_pass("volume_control")});
    if (solids_.any()) {
        closed_ = Grid<std::uint8_t, D>(frame_.cells);
        place_solids(0);
    }
    fill_with_liquid(scene);
    set_initial_velocity(state_, scene);
    set_fixed_faces();
    extend_velocity();
    whole_ = !own().distributed();
}

template <int D>
void TallCells<D>::refuse_what_it_cannot(const scene::Scene& scene) const {
    refuse_flat_cells(scene, frame_);
    const char* axis_name[] = {"x", "y", "z"};
    constexpr real nothing = 1e-9;  // [m/s²]: no noticeable motion in any run
    if (gravity_[up_] > nothing)
        scene.refuse("effects.gravity.g",
                     std::string("gravity acts mostly towards ") + axis_name[up_] + "_max: tall cells require the floor at " +
                         axis_name[up_] + "_min, below the regular cells",
                     "set gravity in the negative direction of its main axis, as g = [0, -9.81], or use solver \"mac_water\"");
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto kind = state_.sides.side(a, end).kind;
            const std::string side = std::string("sides.") + axis_name[a] + (end == 0 ? "_min" : "_max");
            if (kind == geometry::SideKind::moving_wall)
                scene.refuse(side, "tall cells have no friction: walls cannot drag the liquid",
                             "solver \"mac_water\" has the effect viscosity");
            if (kind == geometry::SideKind::inflow)
                scene.refuse(side, "tall cells do not support inflow", "solver \"mac_water\" has sides through which liquid flows in");
            if (kind == geometry::SideKind::outflow && (a != up_ || end == 0))
                scene.refuse(side, "only the side above may be open: the pressure beside a tall cell is not 0 over its height",
                             "solver \"mac_water\" has open sides everywhere");
        }
    if (frame_.periodic(up_)) scene.refuse("grid.periodic", "the axis of gravity, along which cells are tall, has a bottom");
}

template <int D>
void TallCells<D>::fill_with_liquid(const scene::Scene& scene) {
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    if (shapes.empty()) scene.refuse("liquid", "a scene of water needs liquid: at least one shape");
    const auto liquid = geometry::unite<D>(shapes);
    start_level_set<D>(*liquid, solids_.solids(), frame_, surface_);
    volume_ = LiquidVolume<D>(frame_);
    volume_.start(surface_, state_);
    volume_target_ = solids_.moving() ? volume_.volume() : surface_.volume();
    if (volume_target_ == 0) refuse_no_volume<D>(scene, *liquid, frame_);
    remesh();
    passes_.reset();
}

template TallCells<2>::TallCells(const scene::Scene&, const Partition&);
template TallCells<3>::TallCells(const scene::Scene&, const Partition&);

}  // namespace weir::tallcell
