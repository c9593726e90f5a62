// Solver "mac": one incompressible fluid that fills the domain, on a staggered grid, with what effects add to it: smoke, heat, forces.
#pragma once
#include "core/held_planes.hpp"
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "flow/effects.hpp"
#include "flow/heat.hpp"
#include "scene/solver_kind.hpp"
#include "staggered/advection.hpp"
#include "staggered/conservative.hpp"
#include "staggered/projection.hpp"
#include "staggered/solid_faces.hpp"
#include "staggered/solid_walls.hpp"
#include "staggered/state.hpp"
#include "staggered/trace.hpp"

#include <memory>

namespace weir::flow {

/// What a rank sends in a step of a scene that is cut so: an exchange after each pass that is read across cuts, and the numbers of planes
/// that everybody adds up.
StepTraffic traffic_of_step(const scene::Scene& scene, const RankOf& of, const StepShape& shape);

/// What the scene's effects, emitters and initial values ask for.
template <int D>
FieldPlan field_plan(const Effects<MacState<D>>& effects, const scene::Scene& scene);

/// Planes beyond a cut that a path of so many cells reads, with the stencil at its end.
int planes_reached(real cells, int planes);

/// The registered solver "mac".
scene::SolverKind kind();

template <int D>
class FlowSolver : public Solver {
public:
    explicit FlowSolver(const scene::Scene& scene);

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return held_.alone(); }
    std::vector<Integral> integrals() const override;
    real time() const override { return state_.time; }
    Hand* hand() const override { return hand_.get(); }
    std::vector<EditableField> editable() override;
    void edited(const EditableField& field) override;
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    /// Over ranks, of the planes that each has computed.
    bool checks_itself() const override { return !held_.cut().empty(); }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

    const MacState<D>& state() const { return state_; }
    /// To be changed: what the last step knew of it is forgotten.
    MacState<D>& state() {
        fastest_ = not_applicable;
        return state_;
    }
    /// The report of the last pressure solve.
    const poisson::Report& pressure_report() const { return *report_; }

private:
    void apply(Stage stage, real dt);
    void remember(real dt);
    int planes_to_extend() const;
    void fill_field_planes();
    void extend_fields();
    void rub(real t, real dt);
    void depart(real dt);
    void arrive(real dt);
    void advect_fields(real dt);
    void advect_velocity(real dt);
    void blend(const Substep& stage);
    void meet_walls(real now, real last);
    Vec<D> friction();
    void move_solids(real t, real dt);
    void place_solids(real t, real dt);
    void conduct(real dt);
    void lift(real dt);
    void slow(real dt);
    void project(real dt);
    void hold();
    void clear_solids();
    void remember_solids();
    real rate(real fluid) const;
    real last_rate() const;
    StepReport report(real dt);
    void refresh_fields();
    void check_own_planes() const;
    void make_whole() const;

    void bring_beside() const;
    void add_loads(std::vector<Integral>& list) const;

    HeldPlanes held_;
    Effects<MacState<D>> effects_;
    MacState<D> state_;
    std::unique_ptr<BodiesInFlow<D>> bodies_;  // none where the scene has none
    SolidPlacement<D> solids_;
    std::unique_ptr<SolidWalls<D>> walls_;  // none without solids or without viscosity
    std::unique_ptr<Heat<D>> heat_;         // none where the scene names no substance
    AdvectionOptions options_;
    CharacteristicAdvection<D> characteristics_;
    std::vector<Carried<D>> carried_fields_;
    GridBacktrace<D> trace_;
    std::array<StageBlend<D>, D> velocity_blend_;
    std::vector<StageBlend<D>> field_blend_;
    CutFaces<D> cuts_;           // of fluxes beside solids
    PaddedVelocity<D> carried_;  // MacCormack: what the flow carries, u less half the old pressure's push
    Projection<D> projection_;
    const poisson::Report* report_ = nullptr;
    real smoke_removed_ = 0;           // from inside solids since the start, times the cells' volume [m^D]
    real smoke_continued_ = 0;         // what stood in cells that a body had left, continued from beside it [m^D]
    Grid<std::uint8_t, D> was_solid_;  // where smoke was cleared last; only beside solids that move
    Vec<D> impulse_{};                 // of the pressure on all solids since the start [N s]
    real cfl_, side_rate_ = 0;
    real fastest_ = not_applicable;  // max |u|/h after the last step; not known before the first [1/s]
    bool wants_vorticity_ = false, wants_divergence_ = false;
    mutable std::vector<Grid<real, D>> vorticity_;  // filled when somebody looks
    mutable Grid<real, D> divergence_;
    std::shared_ptr<Hand> hand_;  // none where the scene names none
    Passes passes_;
    std::vector<WithBoundary<D>> remembered_fields_, remembered_;  // uⁿ, qⁿ and both
    std::vector<WithBoundary<D>> carried_velocity_;
    std::vector<Planes> shared_;  // scratch: what travels together
    mutable bool whole_ = true;   // all planes stand here, or those that this rank looks at, not its own alone
};

}  // namespace weir::flow
