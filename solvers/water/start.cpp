// Initial state of a scene with liquid: the level set of its shapes, its markers, its velocity.
#include "geometry/brush.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/own_planes.hpp"
#include "parallel/load_balance.hpp"
#include "scene/names.hpp"
#include "water/effects.hpp"
#include "water/solver.hpp"

namespace weir::water {

namespace {

template <int D>
bool all_stick(const geometry::Solids<D>& solids) {
    for (std::size_t i = 0; i < solids.count(); ++i)
        if (!solids[i].no_slip) return false;
    return true;
}

}  // namespace

template <int D>
Water<D>::Water(const scene::Scene& scene, const Partition& partition)
    : options_(scene),
      state_(scene, FieldPlan{}, mac::slab_of<D>(scene, partition, static_cast<int>(std::ceil(options_.cfl)) + 3)),
      frame_(state_.u, state_.sides),
      bodies_(BodiesInFlow<D>::make(scene)),
      solids_(BodiesInFlow<D>::solids(scene, bodies_.get()), state_),
      effects_(make_effects<D>(body_forces(), scene, {Stage::force})),
      gravity_(gravity_of<D>(scene)),
      up_(up_axis<D>(gravity_)),
      brush_forcing_(geometry::make_brush(scene, kinds_of_brush(scene))) {
    if (brush_forcing_) effects_.add("hand", brush_effect<D>(brush_forcing_, Stage::force));
    refuse_flat_cells(scene, frame_);
    refuse_enclosed_air(scene);
    markers_ = all_markers_ = Markers<D>(options_.transfer != Transfer::grid, options_.transfer == Transfer::apic);
    surface_ = LevelSet<D>(frame_, static_cast<int>(std::ceil(options_.cfl)));
    volume_ = LiquidVolume<D>(frame_);
    pressure_ = SurfacePressure<D>(frame_, state_, options_.poisson);
    extrapolate_ = Extrapolation<D>(frame_, wave_acceleration());
    sums_ = FaceSums<D>(frame_.cells);
    for (int a = 0; a < D; ++a) known_[static_cast<std::size_t>(a)] = Grid<std::uint8_t, D>(state_.u[a].extent());
    before_ = state_.u;
    leapfrog_ = Leapfrog<D>(state_.u);
    if (options_.sigma > 0) {
        curvature_ = Grid<real, D>(frame_.cells);
        effects_.declare({.name = "surface_tension", .pass = effect_pass("surface_tension"), .bytes = curvature_.bytes()});
    }
    if (options_.viscosity > 0 && state_.nu > 0) {
        viscosity_ = std::make_unique<SurfaceViscosity<D>>(frame_, state_, options_.viscosity, all_stick(solids_.solids()));
        friction_ = std::make_unique<StepOfFriction<D>>(state_);
        effects_.declare({.name = "viscosity",
                          .pass = effect_pass("viscosity"),
                          .bytes = viscosity_->bytes() + friction_->bytes() + sizeof(*viscosity_) + sizeof(*friction_)});
    }
    if (options_.volume_control) effects_.declare({.name = "volume_control", .pass = effect_pass("volume_control")});
    read_emitters(scene);
    if (solids_.any()) {
        closed_ = near_solid_ = Grid<std::uint8_t, D>(frame_.cells);
        place_solids(0);
        refuse_buried_emitters(scene);
    }
    fill_with_liquid(scene);
    if (bodies_) bodies_->start(state_, solids_);
    if (viscosity_ && bodies_) couple_friction(scene);
    if (bodies_ && brush_forcing_) bodies_->follow(brush_forcing_, scene);
    if (LiquidHeat<D>::named(scene)) heat_ = std::make_unique<LiquidHeat<D>>(scene, state_, frame_, volume_target_);
    if (heat_ && brush_forcing_) heat_->follow(brush_forcing_);
    set_initial_velocity(state_, scene);
    set_fixed_faces();
    extend_velocity(0);
    seed_markers();
    whole_ = !own().distributed();
}

/// Gravity and surface tension in a wave of ten cells, σ k²/ρ [m/s²].
template <int D>
real Water<D>::wave_acceleration() const {
    const real h = frame_.h_min(), capillary = 0.4 * options_.sigma / (state_.rho * h * h);
    return norm(gravity_) + capillary;
}

/// The initial pressure for friction: hydrostatic, zero in the highest liquid cell.
template <int D>
void Water<D>::couple_friction(const scene::Scene& scene) {
    refuse_explicit_friction(*scene.effect("viscosity"), scene);
    const auto& all = bodies_->bodies().all();
    if (std::none_of(all.begin(), all.end(), [](const auto& body) { return body.no_slip; })) return;
    bodies_->couple_friction(state_, true);
    const auto is_liquid = [&](const Index<D>& I) { return state_.cells(I) == poisson::Cell::fluid; };
    const real least = -max_over(state_.extent(), [&](const Index<D>& I) { return is_liquid(I) ? -state_.p(I) : -infinity; });
    for_each_cell(state_.extent(), [&](const Index<D>& I) {
        if (is_liquid(I)) state_.p(I) -= least;
    });
    viscosity_->enforce_bodies(state_);
}

/// Emitters, including inflow sides, which are emitters of one layer of cells.
template <int D>
void Water<D>::read_emitters(const scene::Scene& scene) {
    if (scene.has("emitters"))
        for (const auto& table : scene.root().tables("emitters")) {
            Emitter<D> emitter;
            emitter.shape = geometry::make_shape<D>(table);
            if (table.has("velocity")) emitter.velocity = table.vec<D>("velocity");
            emitter.start = table.number_or("start", 0);
            emitter.end = table.number_or("end", infinity);
            emitters_.push_back(std::move(emitter));
        }
    const std::size_t scene_emitters = emitters_.size();
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto& side = state_.sides.side(a, end);
            if (side.kind != geometry::SideKind::inflow) continue;
            Vec<D> lo = frame_.origin, hi = frame_.origin;
            for (int d = 0; d < D; ++d) lo[d] -= frame_.h[d], hi[d] += frame_.h[d] * (frame_.cells[d] + 1);
            (end == 0 ? hi : lo)[a] = frame_.origin[a] + frame_.h[a] * (end == 0 ? 1 : frame_.cells[a] - 1);
            Emitter<D> emitter;
            emitter.shape = geometry::box<D>(lo, hi);
            emitter.velocity = side.velocity;
            emitters_.push_back(std::move(emitter));
        }
    for (std::size_t i = 0; i < emitters_.size(); ++i) {
        emitters_[i].place(frame_);
        if (emitters_[i].cells.empty() && i < scene_emitters)
            scene.refuse("emitters[" + std::to_string(i) + "]", "the emitter lies outside the domain: nothing can leave it");
    }
    if (!emitters_.empty()) not_solved_for_ = Grid<std::uint8_t, D>(frame_.cells);
}

/// Rejects emitters wholly covered by solids.
template <int D>
void Water<D>::refuse_buried_emitters(const scene::Scene& scene) const {
    const std::size_t named = scene.has("emitters") ? scene.root().tables("emitters").size() : 0;
    for (std::size_t i = 0; i < named && !closed_.empty(); ++i) {
        const auto& cells = emitters_[i].cells;
        const auto is_open = [&](std::size_t cell) { return own().contains(frame_.index_of(cell)[D - 1]) && closed_[cell] == 0; };
        if (sum_of_ranks(own(), std::any_of(cells.begin(), cells.end(), is_open)) == 0)
            scene.refuse("emitters[" + std::to_string(i) + "]", "the emitter lies inside solids: nothing can leave it");
    }
}

/// Rejects models of air that this solver does not have, and what enclosed air does not support.
template <int D>
void Water<D>::refuse_enclosed_air(const scene::Scene& scene) const {
    if (scene.root().text_or("air", "empty") == "flow")
        scene.refuse("air", "mac_water does not compute the flow of air; the solver \"two_phase\" does",
                     "solver = \"two_phase\" with gas = { density = 1.2 }, or air = \"enclosed\"");
    if (!options_.encloses_air) {
        if (scene.has("enclosed_gas"))
            scene.refuse("enclosed_gas", "enclosed_gas has no effect with air = \"empty\"", "air = \"enclosed\"");
        return;
    }
    const auto without = [&](const std::string& key) {
        scene.refuse("air", "air = \"enclosed\" is not supported with " + key, "air = \"empty\", or the scene without " + key);
    };
    if (bodies_) without("bodies");
    if (LiquidHeat<D>::named(scene)) without("substance");
    if (brush_forcing_) without("effects.hand");
    if (options_.poisson.method == "dct") without("scheme.poisson.method = \"dct\"");
}

template <int D>
void Water<D>::fill_with_liquid(const scene::Scene& scene) {
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    if (shapes.empty()) {
        const real end = scene.number("time.end");
        if (std::none_of(emitters_.begin(), emitters_.end(), [&](const auto& e) { return e.works(0, end); }))
            scene.refuse("liquid", "a scene of water needs liquid: at least one shape, or an emitter that gives some before the end");
        surface_.redistance();
    } else {
        start_level_set<D>(*geometry::unite<D>(shapes), solids_.solids(), frame_, surface_);
    }
    volume_target_ = surface_.volume();
    // beside a free body the surface depends on extrapolation, and corrections of it would act on the body
    keeps_volume_ = !bodies_ && options_.sigma == 0 && !options_.volume_control;
    volume_.start(surface_, state_);
    if (options_.encloses_air)
        pressure_.enclose_air(
            std::make_unique<AirPockets<D>>(frame_, options_.enclosed_gas, surface_, closed_, keeps_volume_ ? &volume_.part() : nullptr),
            wave_acceleration());
    if (!shapes.empty() && volume_target_ == 0) refuse_no_volume<D>(scene, *geometry::unite<D>(shapes), frame_);
    pressure_.set_surface(surface_, closed_, state_);
}

template <int D>
void Water<D>::seed_markers() {
    const std::size_t cells = product(frame_.cells);
    refresh_faces(state_.u, frame_, 3);  // ghost markers of one plane read the faces around them
    if (!own().distributed())
        markers_.reserve(static_cast<std::size_t>(1.25 * volume_target_ / frame_.cell_volume() * Markers<D>::per_cell) + 64);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const Index<D> I = frame_.index_of(cell);
        if (!Markers<D>::holds(frame_, I[D - 1])) continue;
        if (surface_.phi(I) > norm(frame_.h)) continue;
        for (int sub = 0; sub < Markers<D>::per_cell; ++sub) {
            const Vec<D> x = Markers<D>::jittered(frame_, I, sub, options_.seed);
            const Stencil<D> stencil(frame_, x);
            if (surface_.at(x) < 0 && (!solids_.any() || solids_.solids().distance(x) > 0)) markers_.add(x, sample(state_.u, stencil));
        }
    }
    markers_.sort(frame_);
    const auto [first, last] = markers_.own(frame_);
    const std::int64_t count = sum_of_ranks(own(), static_cast<std::int64_t>(last - first));
    if (count > 0)
        markers_.volume = volume_target_ / static_cast<real>(count);
    else
        markers_.volume = frame_.cell_volume() / Markers<D>::per_cell;
    markers_.keep_held(frame_);
}

template Water<2>::Water(const scene::Scene&, const Partition&);
template Water<3>::Water(const scene::Scene&, const Partition&);

}  // namespace weir::water
