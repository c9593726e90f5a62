// The solver "two_phase": a liquid and a gas, both incompressible, with any ratio of densities and viscosities, on a MAC grid.
//
//     ∂f/∂t + ∇·(f u) = 0,     ∂(ρu)/∂t + ∇·(ρ u u) = −∇p + ∇·2μD + ρ g + σ κ ∇f,     ∇·u = 0,     ρ = f ρ_l + (1 − f) ρ_g
//
// Geometric volume of fluid (Weymouth & Yue 2010) with momentum in the same fluxes (Rudman 1998), tension in balance with the pressure by
// height functions (Popinet 2009), projection with the densities of the faces (Chorin 1968).
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "mac/bodies/bodies_in_flow.hpp"
#include "mac/grid/projection.hpp"
#include "mac/grid/state.hpp"
#include "scene/solver_kind.hpp"
#include "two_phase/curvature.hpp"
#include "two_phase/heat.hpp"
#include "two_phase/moving_solids.hpp"
#include "two_phase/solids.hpp"
#include "two_phase/transport.hpp"
#include "two_phase/viscosity.hpp"

#include <memory>
#include <vector>

namespace weir::two_phase {

/// The registered solver "two_phase".
scene::SolverKind kind();

/// The field of liquid fractions of cells.
inline constexpr const char* fraction_name = "fraction";

struct Options {
    Densities rho;
    real nu_liquid = 0, nu_gas = 0;  // [m²/s]; act only with the effect viscosity
    real sigma = 0;                  // [N/m]
    real gravity = 0;                // |g| [m/s²]
    real cfl = 0.5;
    PoissonChoice poisson;
    explicit Options(const scene::Scene& scene);
};

/// Parts of the method that tests switch to show what they are for. Not keys of a scene.
struct Experiment {
    bool velocity_form = false;  // velocity is advected by itself, without the masses that carry it
    bool mean_density = false;   // the pressure has the mean fraction of a face's cells, the momentum that of the halves beside it
    WithoutHeights curvature = WithoutHeights::fit;
    real fixed_curvature = 0;  // of all interfacial cells [1/m]; 0: computed
    int first_order_of_sweeps = 0;
};

/// What bounds a step.
enum class Bound { speed, tension, gravity };
inline constexpr int bounds = 3;

template <int D>
class TwoPhase final : public Solver {
public:
    explicit TwoPhase(const scene::Scene& scene, const Partition& partition = {}, const Experiment& experiment = {});

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    FieldSet fields() const override;
    void synchronize() override;
    bool holds_own_planes() const override { return own().distributed_storage(); }
    bool checks_itself() const override { return true; }
    std::vector<Integral> integrals() const override;
    real time() const override { return state_.time; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }
    BrushForcing* brush() const override { return brush_forcing_.get(); }

    /// For tests and studies.
    const MacState<D>& state() const { return state_; }
    const Grid<real, D>& fraction() const { return state_.fields[0].values; }
    const Grid<real, D>& curvature() const { return curvature_.kappa; }
    const FaceFractions<D>& face_fractions() const { return faces_; }
    const Heat<D>* heat() const { return heat_.get(); }

private:
    /// Ghost planes of arrays without a larger requirement: those that readers of fields need.
    static constexpr int planes_beside = 2;

    const OwnPlanes& own() const { return state_.own(); }
    // Start (start.cpp)
    void refuse_sides(const scene::Scene& scene) const;
    bool has_open_sides() const;
    void place_solids(const scene::Scene& scene);
    void place_heat(const scene::Scene& scene);
    void start_liquid(const scene::Scene& scene);
    void start_bodies(const scene::Scene& scene);
    void start_velocity(const scene::Scene& scene);
    void require_room(const scene::Scene& scene) const;

    // The passes of a step, in order
    Motion<D> motion(real dt);
    void transport(real dt);
    void move_solids(real dt);
    void see_solids();
    void find_face_densities();
    void use_mean_densities();
    real advect_cells(const Motion<D>& motion);
    void apply_heat(real dt);
    void apply_viscosity(real dt);
    void apply_tension(real dt);
    /// `bodies`: those that the pressure moves; nullptr: all move as they do.
    const poisson::Report& project(real dt, BodiesInFlow<D>* bodies);
    void find_rate();
    void add_rate(int a, const Index<D>& first, int count, real* sum) const;
    void check() const;
    void exchange_densities();  // in parallel (ranks.cpp)
    void update_distance() const;

    Interface<D> interface() const { return {fraction(), fraction_ghosts_, around_, state_.u.h}; }
    real limit(Bound bound) const;
    Bound ruling_bound() const;
    real sum_of_faces(int a, real (*power)(real)) const;
    Vec<D> moment_of_liquid() const;
    Vec<D> moment_of_space() const;
    void add_volumes(std::vector<Integral>& list) const;
    real furthest(int axis) const;
    real room(const Index<D>& I) const { return solids_.moving() ? visible_.part(I) : is_open(state_, I) ? 1 : 0; }

    Options options_;
    Experiment experiment_;
    MacState<D> state_;                        // its density is that of the lighter phase, its mobility that over the density of the face
    std::unique_ptr<BodiesInFlow<D>> bodies_;  // nullptr where the scene has none
    SolidPlacement<D> solids_;                 // with the bodies
    EnteringFractions<D> entering_;
    std::array<Boundary<D>, D> mirrored_;  // conditions of the advecting velocity: no flow through walls
    FractionGhosts<D> ghosts_of_fraction_;
    Around<D> around_;
    Effects<MacState<D>> effects_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    Vec<D> gravity_{};
    int up_ = 1;
    Transport<D> transport_;
    PaddedVelocity<D> open_flow_;      // empty without solids
    ContinuedFractions<D> continued_;  // likewise
    VisibleLiquid<D> visible_;         // empty without moving solids
    UncoveredFaces<D> uncovered_;      // likewise
    Padded<D> fraction_ghosts_;
    FaceFractions<D> faces_;
    Curvature<D> curvature_;                   // empty without tension
    std::unique_ptr<Viscosity<D>> viscosity_;  // nullptr without the effect
    std::unique_ptr<Heat<D>> heat_;            // likewise
    Projection<D> projection_;
    mutable Grid<real, D> distance_;  // for drawing and probes; empty until it is shown
    mutable bool distance_is_stale_ = true;
    bool whole_ = true;  // other ranks' planes, or the ghost planes, are up to date
    std::int64_t steps_ = 0;
    std::array<std::int64_t, bounds> ruled_{};  // steps that each bound ruled
    real poured_ = 0;                           // liquid that came in through sides since the start, less what left [m³; m²]
    real rate_ = 0;                             // max Σ|u|/h over cells [1/s]
    Passes passes_;
};

}  // namespace weir::two_phase
