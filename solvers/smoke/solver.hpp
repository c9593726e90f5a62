// Solver "mac": a single incompressible fluid that fills the domain, on a staggered grid, with effects: smoke, heat, forces.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "mac/advection/advection.hpp"
#include "mac/advection/conservative.hpp"
#include "mac/advection/trace.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/bodies/solid_walls.hpp"
#include "mac/grid/projection.hpp"
#include "mac/grid/state.hpp"
#include "scene/solver_kind.hpp"
#include "smoke/effects.hpp"
#include "smoke/heat.hpp"

#include <memory>

namespace weir::smoke {

/// The fields requested by the scene's effects, emitters and initial values.
template <int D>
FieldPlan field_plan(const Effects<MacState<D>>& effects, const scene::Scene& scene);

/// Ghost planes read by trajectories of so many cells, including the stencil at their ends.
int planes_reached(real cells, int planes);

/// The registered solver "mac".
scene::SolverKind kind();

template <int D>
class FlowSolver : public Solver {
public:
    explicit FlowSolver(const scene::Scene& scene, const Partition& partition = {});

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    void synchronize() override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return own().distributed_storage(); }
    std::vector<Integral> integrals() const override;
    real time() const override { return state_.time; }
    BrushForcing* brush() const override { return brush_forcing_.get(); }
    std::vector<EditableField> editable() override;
    void edited(const EditableField& field) override;
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    /// In parallel, for the planes that each rank owns.
    bool checks_itself() const override { return own().distributed(); }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

    const MacState<D>& state() const { return state_; }
    /// Write access: clears the data derived from the last step.
    MacState<D>& state() {
        fastest_ = not_applicable;
        return state_;
    }
    /// The report of the last pressure solve.
    const poisson::Report& pressure_report() const { return *report_; }

private:
    /// Ghost planes of arrays without a larger requirement: the width of two nested differences.
    static constexpr int planes_beside = 2;

    const OwnPlanes& own() const { return state_.own(); }
    void start_heat(const scene::Scene& scene);
    void start_bodies(const scene::Scene& scene);
    void list_advected();
    void apply(Stage stage, real dt);
    void remember(real dt);
    int planes_to_extend() const;
    void fill_field_planes();
    void extend_fields();
    void move_no_slip_bodies(real t, real dt);
    void explicit_terms_before_advection(real dt);
    void explicit_terms_after_advection(real dt);
    void advect_fields(real dt);
    void advect_velocity(real dt);
    void blend(const Substep& stage);
    void meet_walls(real now, real last);
    Vec<D> friction();
    void move_solids(real t, real dt);
    void place_solids(real t, real dt);
    void conduct(real dt);
    void apply_buoyancy(real dt);
    void apply_ice_drag(real dt);
    void project(real dt);
    void enforce_sources();
    void clear_solids();
    void remember_solids();
    real rate(real fluid) const;
    real last_rate() const;
    StepReport report(real dt);
    void refresh_fields();
    void exchange_fields();
    void check_own_planes() const;

    void add_loads(std::vector<Integral>& list) const;

    Effects<MacState<D>> effects_;
    MacState<D> state_;
    std::unique_ptr<BodiesInFlow<D>> bodies_;  // nullptr where the scene has no bodies
    SolidPlacement<D> solids_;
    std::unique_ptr<SolidWalls<D>> walls_;  // nullptr without solids or without viscosity
    std::unique_ptr<Heat<D>> heat_;         // nullptr where the scene names no substance
    AdvectionOptions options_;
    CharacteristicAdvection<D> characteristics_;
    std::vector<Carried<D>> carried_fields_;
    GridBacktrace<D> trace_;
    std::array<StageBlend<D>, D> velocity_blend_;
    std::vector<StageBlend<D>> field_blend_;
    CutFaces<D> cuts_;           // for fluxes beside solids
    PaddedVelocity<D> carried_;  // MacCormack: the advected velocity, u minus half of the old pressure gradient
    Projection<D> projection_;
    const poisson::Report* report_ = nullptr;
    real smoke_removed_ = 0;           // from inside solids since the start, times the cells' volume [m^D]
    real smoke_continued_ = 0;         // extrapolated into cells that a body has uncovered [m^D]
    Grid<std::uint8_t, D> was_solid_;  // solid cells at the last removal of smoke; only with moving solids
    Vec<D> impulse_{};                 // of the pressure on all solids since the start [N s]
    real cfl_, side_rate_ = 0;
    real fastest_ = not_applicable;  // max |u|/h after the last step; unknown before the first [1/s]
    bool wants_vorticity_ = false, wants_divergence_ = false;
    mutable std::vector<Grid<real, D>> vorticity_;  // computed on request
    mutable Grid<real, D> divergence_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    Passes passes_;
    std::vector<WithBoundary<D>> remembered_fields_, remembered_;  // uⁿ, qⁿ and both
    std::vector<WithBoundary<D>> carried_velocity_;
    std::vector<Planes> shared_;  // scratch: arrays exchanged in one message
    bool whole_ = true;           // other ranks' planes, or the ghost planes, are up to date
};

}  // namespace weir::smoke
