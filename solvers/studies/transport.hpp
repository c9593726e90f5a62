// Solver "transport": cell fields advected by a prescribed velocity, with the advection code of the flow solvers.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "mac/advection/advection.hpp"
#include "mac/advection/conservative.hpp"
#include "mac/grid/state.hpp"
#include "studies/prescribed_flow.hpp"

#include <optional>

namespace weir::studies {

template <int D>
class TransportSolver final : public Solver {
public:
    explicit TransportSolver(const scene::Scene& scene);

    /// Dq/Dt = 0 for each field.
    StepReport step(real dt) override;
    real advised_dt() const override;
    StepLimit stable_dt() const override;
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return state_.time; }
    void save(Checkpoint& to) const override { state_.save(to); }
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return state_.bytes() + characteristics_.bytes(); }

private:
    void set_velocity(real t);
    PrescribedFlow<D> flow_;
    MacState<D> state_;
    AdvectionOptions options_;
    CharacteristicAdvection<D> characteristics_;
    PrescribedBacktrace<D> trace_;
    std::vector<StageBlend<D>> blend_;
    real cfl_;
    real fastest_ = not_applicable;  // max |u|/h after the last step; unknown before the first [1/s]
    Passes passes_;
};

}  // namespace weir::studies
