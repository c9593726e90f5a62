// The solver "tallcell": liquid with a free surface on a restricted tall cell grid (Chentanez & Müller 2011): regular cells near the
// surface, tall cells below them, one per column as in the paper or several stacked. Velocity and level set are stored on the lattice that
// the tall cells represent. The pressure, the most expensive part, has unknowns at the knots of columns only. Differences to the paper and
// their reasons: docs/adr/0016-tall-cells.md.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "free_surface/extrapolate.hpp"
#include "free_surface/leapfrog.hpp"
#include "free_surface/solid_faces.hpp"
#include "free_surface/start.hpp"
#include "free_surface/volume_fraction.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "scene/solver_kind.hpp"
#include "tallcell/transport.hpp"

namespace weir::tallcell {

/// The registered solver "tallcell".
scene::SolverKind kind();

/// In parallel, the partition of a scene's planes: empty where columns run along the slowest axis and so pass through all planes.
Partition partition_of_columns(const scene::Scene& scene, int ranks);
/// Returns whether fields can have distributed storage: not where whole fields are read on all ranks.
bool holds_own_planes(const scene::Scene& scene, const Partition& cut);
struct TallOptions {
    Shape shape;
    bool maccormack = true;
    poisson::Options poisson;
    real cfl = 1;
    bool volume_control = false;
    explicit TallOptions(const scene::Scene& scene);
};

template <int D>
class TallCells final : public Solver {
public:
    explicit TallCells(const scene::Scene& scene, const Partition& partition = {});

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    void synchronize() override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return own().distributed_storage(); }
    std::vector<Integral> integrals() const override;
    BrushForcing* brush() const override { return brush_forcing_.get(); }
    real time() const override { return state_.time; }
    bool checks_itself() const override { return true; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    std::vector<EditableField> editable() override;
    void edited(const EditableField& field) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

    /// For tests and studies.
    const MacState<D>& state() const { return state_; }
    const LevelSet<D>& surface() const { return surface_; }
    const TallPressure<D>& mesh() const { return pressure_; }

private:
    const OwnPlanes& own() const { return state_.own(); }

    // Start (start.cpp)
    void refuse_what_it_cannot(const scene::Scene& scene) const;
    void fill_with_liquid(const scene::Scene& scene);

    // The passes of a step, in order
    void find_rate(real dt);
    void place_solids(real t);
    void move_surface(real dt);
    void apply_brush_sources();
    void control_volume();
    void remesh();
    void advect(real dt);
    void forces(real dt);
    poisson::Report project(real dt);
    void extend_velocity();

    // In parallel (ranks.cpp)
    void refresh_velocity(real dt);

    void set_fixed_faces();
    void mark_liquid_faces();
    real max_speed_rate() const;

    TallOptions options_;
    MacState<D> state_;
    Frame<D> frame_;
    SolidPlacement<D> solids_;
    Effects<MacState<D>> effects_;
    Vec<D> gravity_{};
    int up_ = 1;  // the axis closest to gravity, along which cells are tall
    Grid<std::uint8_t, D> closed_;
    FacesInSolids<D> in_solids_;
    LevelSet<D> surface_;
    LiquidVolume<D> volume_;  // the volume that the surface must enclose
    TallPressure<D> pressure_;
    Transport<D> transport_;
    Extrapolation<D> extrapolate_;
    Leapfrog<D> leapfrog_;
    FaceMarks<D> known_;
    mutable Grid<real, D> tall_;  // height of the element that contains a cell [m], computed on request
    real volume_target_ = 0, volume_shift_ = 0;
    real rate_ = 0;  // max |u|/h over known faces [1/s]
    std::int64_t steps_ = 0;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    Passes passes_;
    int reach_ = 0;      // ghost planes that motion reads in this step
    bool whole_ = true;  // other ranks' planes, or the ghost planes, are up to date
};

}  // namespace weir::tallcell
