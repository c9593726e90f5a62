// The solver "mac_water": liquid with a free surface on a MAC grid, with markers, a level set corrected by the markers, and second-order
// surface pressure; air is empty (p = σ κ on the surface). Harlow & Welch 1965; Foster & Fedkiw 2001; Enright et al. 2002; Zhu & Bridson
// 2005; Batty et al. 2007; Bridson 2015.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "free_surface/extrapolate.hpp"
#include "free_surface/leapfrog.hpp"
#include "free_surface/level_set.hpp"
#include "free_surface/marker_motion.hpp"
#include "free_surface/markers.hpp"
#include "free_surface/solid_faces.hpp"
#include "free_surface/start.hpp"
#include "free_surface/volume_fraction.hpp"
#include "geometry/solids.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/projection.hpp"
#include "mac/grid/state.hpp"
#include "scene/solver_kind.hpp"
#include "water/emitters.hpp"
#include "water/heat.hpp"
#include "water/mixing.hpp"
#include "water/pressure.hpp"
#include "water/transfer.hpp"
#include "water/viscosity.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace weir::water {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// Estimated time of a step per plane of cells [ns], for the start of a scene or for a state. Collective for a state in distributed
/// storage.
std::vector<std::int64_t> work_of_planes(const scene::Scene& scene, const Checkpoint* state = nullptr);

/// The registered solver "mac_water".
scene::SolverKind kind();

/// Advection of momentum: on the grid (semi-Lagrangian), or on the markers.
enum class Transfer { grid, pic, flip, apic };

struct WaterOptions {
    Transfer transfer = Transfer::flip;
    real flip_blend = 0.97;  // β: 1 pure FLIP, 0 pure PIC (Zhu & Bridson 2005)
    Trace trace = Trace::rk2;
    PoissonChoice poisson;
    real cfl = 1;
    bool reseed = true;
    std::uint64_t seed = 1;
    real sigma = 0;      // surface tension [N/m]; 0: no curvature is computed
    real viscosity = 0;  // θ of the viscous solve: ½ Crank–Nicolson, 1 implicit; 0: no viscosity
    bool volume_control = false;
    bool encloses_air = false;           // air = "enclosed"
    std::optional<GasLaw> enclosed_gas;  // none: incompressible
    explicit WaterOptions(const scene::Scene& scene);
};

/// Shared data of the friction and pressure solves of one step (friction.cpp).
template <int D>
struct StepOfFriction {
    MacVelocity<D> before, forces;  // u at the start of the step; dt f
    std::array<Grid<real, D>, D> with_pressure;
    Grid<real, D> p, residual;  // the pressure used in with_pressure; F(p) − p
    AndersonMixing<D> mixing;
    int iterations = 0;  // iterations after the first
    explicit StepOfFriction(const MacState<D>& state);
    std::size_t bytes() const;
};

template <int D>
class Water final : public Solver {
public:
    explicit Water(const scene::Scene& scene, const Partition& partition = {});

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
    bool add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) override;
    bool remove_particles(std::string_view set, std::span<const unsigned char> gone) override;
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    /// In parallel, each rank checks its own planes.
    bool checks_itself() const override { return own().distributed(); }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

    /// For tests and studies.
    const MacState<D>& state() const { return state_; }
    const LevelSet<D>& surface() const { return surface_; }
    const Markers<D>& markers() const { return markers_; }
    const LiquidVolume<D>& volume() const { return volume_; }

private:
    const OwnPlanes& own() const { return state_.own(); }

    // Start (start.cpp)
    void read_emitters(const scene::Scene& scene);
    void refuse_buried_emitters(const scene::Scene& scene) const;
    real wave_acceleration() const;
    void refuse_enclosed_air(const scene::Scene& scene) const;
    void fill_with_liquid(const scene::Scene& scene);
    void seed_markers();
    void couple_friction(const scene::Scene& scene);

    // The passes of a step, in order (solver.cpp, sources.cpp)
    real to_middle(real dt);
    void find_rate(real dt);
    void move_bodies(real dt);
    void move_solids(real t);
    void place_solids(real t);
    void mark_closed();
    void move_surface(real dt);
    void apply_sources_and_sinks(real dt);
    void redistribute_markers();
    bool fill_cell(const Index<D>& I, int wanted);
    std::int64_t emit(const Emitter<D>& emitter, real dt);
    bool is_free(const Vec<D>& x) const;
    void impose_emitters(real dt, real Emitter<D>::Face::*speed);
    void carry_emitters_velocity(real dt);
    void apply_brush_sources();
    const Grid<std::uint8_t, D>& not_solved_for(real dt);
    void curvature();
    void correct_surface(real dt);
    void evaporate(real dt);
    void conduct(real dt);
    void apply_ice_drag(real dt);
    void momentum_to_faces(real dt);
    void remember_velocity();
    void apply_viscosity(real dt);
    poisson::Report balance_friction(real dt, real kick, poisson::Report report);
    void velocity_with_pressure(real dt);
    void repeat_viscosity(real dt);
    void mix_pressures();
    poisson::Report project_once(real dt, real kick, bool again);
    void forces(real dt);
    poisson::Report project(real dt, real kick);
    void extend_velocity(real dt);
    void momentum_to_markers(real dt);

    // In parallel (ranks.cpp)
    void refresh_velocity(real dt);
    std::array<std::int64_t, 2> migrate_markers();
    void check_own() const;
    void fill_solid_ghosts();
    void restore_markers(const Checkpoint& from);
    const Markers<D>& all_markers() const { return own().distributed() ? all_markers_ : markers_; }

    // Edits between steps (edit.cpp)
    void keep_faces();
    void take_velocity();
    void join_cell(const Index<D>& I);
    void find_liquid();
    void follow_new_liquid(const Grid<poisson::Cell, D>& before, const Markers<D>& added);

    void advect_faces(real dt);
    void control_volume();
    void set_fixed_faces();
    void mark_liquid_faces();
    real max_speed_rate() const;

    WaterOptions options_;
    MacState<D> state_;
    Frame<D> frame_;
    std::unique_ptr<BodiesInFlow<D>> bodies_;  // nullptr where the scene has none
    SolidPlacement<D> solids_;
    Effects<MacState<D>> effects_;
    Vec<D> gravity_{};
    std::vector<Emitter<D>> emitters_;
    Grid<std::uint8_t, D> closed_, near_solid_;
    Grid<std::uint8_t, D> not_solved_for_;  // closed cells and those of emitters; allocated only if the scene has emitters
    FacesInSolids<D> in_solids_;

    Markers<D> markers_;
    LevelSet<D> surface_;
    LiquidVolume<D> volume_;  // the volume that the surface must enclose
    bool keeps_volume_ =
        true;  // false with free bodies, volume_control or surface tension: the correction would disturb bodies and drops at rest
    SurfacePressure<D> pressure_;
    Extrapolation<D> extrapolate_;
    FaceSums<D> sums_;
    FaceMarks<D> known_;
    Leapfrog<D> leapfrog_;
    MacVelocity<D> before_;  // faces as transferred from the markers, or before advection
    Grid<real, D> curvature_;
    std::unique_ptr<SurfaceViscosity<D>> viscosity_;
    std::unique_ptr<StepOfFriction<D>> friction_;  // nullptr without viscosity
    std::unique_ptr<LiquidHeat<D>> heat_;          // nullptr where the scene names no substance
    real volume_target_ = 0;                       // the volume balance: start + poured in − drained [m^D]
    std::int64_t steps_ = 0;
    real rate_ = 0;                                // max |u|/h over known faces [1/s]
    int up_ = 1;                                   // the axis closest to gravity
    std::int64_t escaped_ = 0, reseeded_ = 0;      // in parallel: on this rank
    real volume_shift_ = 0;                        // total displacement by volume control [m]
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    Passes passes_;
    int reach_ = 0;           // ghost planes that motion reads in this step
    bool whole_ = true;       // other ranks' or ghost planes are up to date; so is all_markers_
    Markers<D> all_markers_;  // where whole fields are read: those of all ranks
};

}  // namespace weir::water
