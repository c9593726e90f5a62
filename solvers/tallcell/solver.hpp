// The solver "tallcell": liquid with a free surface on a restricted tall cell grid (Chentanez & Müller 2011): regular cells near the
// surface, tall cells below them, one to a column as in the paper or several stacked. The velocity and the level set live on the lattice
// that the tall cells stand for; the pressure, which is what costs, has unknowns at the knots of columns only. Where this departs from the
// paper, and why, is docs/adr/0016-tall-cells.md.
#pragma once
#include "core/effects.hpp"
#include "core/held_planes.hpp"
#include "core/solver.hpp"
#include "scene/solver_kind.hpp"
#include "staggered/solid_faces.hpp"
#include "surface/extrapolate.hpp"
#include "surface/leapfrog.hpp"
#include "surface/solid_faces.hpp"
#include "surface/start.hpp"
#include "surface/volume_fraction.hpp"
#include "tallcell/transport.hpp"

namespace weir::tallcell {

/// The registered solver "tallcell".
scene::SolverKind kind();

/// Over ranks, where the planes of a scene are cut: nowhere where columns go through all of them, along the slowest axis.
Cut cut_of_columns(const scene::Scene& scene, int ranks);
/// May each then hold its own planes alone? Not where somebody looks at whole fields on all ranks.
bool holds_own_planes(const scene::Scene& scene, const Cut& cut);
/// What a rank sends in a step of a scene that is cut so.
StepTraffic traffic_of_step(const scene::Scene& scene, const RankOf& of, const StepShape& shape);

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
    explicit TallCells(const scene::Scene& scene);

    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return held_.alone(); }
    std::vector<Integral> integrals() const override;
    Hand* hand() const override { return hand_.get(); }
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
    // Start (start.cpp)
    void refuse_what_it_cannot(const scene::Scene& scene) const;
    void fill_with_liquid(const scene::Scene& scene);

    // The passes of a step, in order
    void find_rate(real dt);
    void place_solids(real t);
    void move_surface(real dt);
    void pour_and_drain_by_hand();
    void control_volume();
    void remesh();
    void advect(real dt);
    void forces(real dt);
    poisson::Report project(real dt);
    void extend_velocity();

    // Over ranks (ranks.cpp)
    void bring_faces(real dt);
    void make_whole() const;
    void bring_beside() const;

    void set_fixed_faces();
    void mark_liquid_faces();
    real max_speed_rate() const;

    TallOptions options_;
    HeldPlanes held_;  // cut nowhere in one process, nor where every rank does all
    MacState<D> state_;
    Frame<D> frame_;
    SolidPlacement<D> solids_;
    Effects<MacState<D>> effects_;
    Vec<D> gravity_{};
    int up_ = 1;  // the axis that gravity is most along, as are tall cells
    Grid<std::uint8_t, D> closed_;
    FacesInSolids<D> in_solids_;
    LevelSet<D> surface_;
    LiquidVolume<D> volume_;  // what the surface is to enclose
    TallPressure<D> pressure_;
    Transport<D> transport_;
    Extrapolation<D> extrapolate_;
    Leapfrog<D> leapfrog_;
    FaceMarks<D> known_;
    mutable Grid<real, D> tall_;  // height of the element that a cell lies in [m], made when it is shown
    real volume_target_ = 0, volume_shift_ = 0;
    real rate_ = 0;  // max |u|/h over known faces [1/s]
    std::int64_t steps_ = 0;
    std::shared_ptr<Hand> hand_;  // none where the scene names none
    Passes passes_;
    int reach_ = 0;              // planes beyond the cuts that motion reads in this step
    mutable bool whole_ = true;  // all planes stand here, or those that this rank looks at
};

}  // namespace weir::tallcell
