// Columns of water as in real-time graphics (sweep.hpp), with floating or dragged objects (floats.hpp).
#pragma once
#include "heightfield/brush.hpp"
#include "heightfield/effects.hpp"
#include "heightfield/floats.hpp"
#include "heightfield/sweep.hpp"

namespace weir::heightfield {

class Columns final : public Solver {
public:
    static constexpr int checked_every = 16;  // steps: a check of all columns costs as much as half a step
    explicit Columns(const scene::Scene& scene, const Partition& partition = {});
    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override { return {limit_, "columns that pull their neighbours across more than one another overshoot"}; }
    std::string concern() const override;
    void synchronize() override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return state_.plane.own.distributed_storage(); }
    bool checks_itself() const override { return true; }
    std::vector<Integral> integrals() const override;
    BrushForcing* brush() const override { return brush_forcing_.get(); }
    real time() const override { return state_.time; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    std::vector<EditableField> editable() override;
    void edited(const EditableField& field) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override { return plans_; }

private:
    void make_stiffness();
    void outflow_at_open_sides(real dt);
    const OwnPlanes& own() const { return state_.plane.own; }
    void check() const;
    real volume() const;
    bool is_wet(std::size_t c) const { return state_.h[c] > 0; }

    State state_;  // h is the still depth
    Field surface_, rate_;
    real volume_before_ = 0;  // before an edit [m^3]
    bool periodic_x_, periodic_z_;
    Stiffness k_;
    Sweep sweep_;
    Floats floats_;
    std::vector<EffectPlan> plans_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    mutable Field depth_, displaced_;
    Field nothing_;
    bool ghosts_filled_ = true;  // whether ghost rows, or all rows, are up to date
    Passes passes_;
    real cfl_ = 0, limit_ = infinity, damping_ = 0;
    real through_ = 0;  // volume rate through sides [m^3/s]
    std::int64_t steps_ = 0;
};

}  // namespace weir::heightfield
