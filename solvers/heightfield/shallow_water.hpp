// The shallow-water equations on a plane of columns: second order in space and time, well balanced, no negative depth.
#pragma once
#include "heightfield/brush.hpp"
#include "heightfield/effects.hpp"
#include "heightfield/rows.hpp"
#include "heightfield/start.hpp"

namespace weir::heightfield {

class ShallowWater final : public Solver {
public:
    explicit ShallowWater(const scene::Scene& scene, const Partition& partition = {});
    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    void synchronize() override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return state_.plane.own.distributed_storage(); }
    bool checks_itself() const override { return true; }
    std::vector<Integral> integrals() const override;
    BrushForcing* brush() const override { return brush_forcing_.get(); }
    real time() const override { return state_.time; }
    std::vector<EditableField> editable() override;
    void edited(const EditableField& field) override;
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return effects_.plans(); }

private:
    void move_water(real dt);
    void take_reports(real weight);
    void raise_bed(real t);
    void measure();
    void refresh_water(const std::array<Field*, 3>& water, int ghost_planes);
    const OwnPlanes& own() const { return state_.plane.own; }

    State state_;
    Rows rows_;
    std::vector<RowReport> reports_;
    mutable Field h1_, qx1_, qz1_;  // intermediate stage; between steps, the surface and the velocity for output
    Field terrain_, nothing_;       // the bed without solids, where these move; the vertical velocity
    std::unique_ptr<RaisedBed> raised_;
    Effects<State> effects_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    bool ghosts_filled_ = true;                    // whether ghost rows, or all rows, are up to date
    Passes passes_;
    real cfl_ = 0, volume_ = 0, rate_ = 0, clipped_ = 0;
};

}  // namespace weir::heightfield
