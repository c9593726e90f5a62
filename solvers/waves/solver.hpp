// The solver "waves": a surface given by a formula of position and time. A step only sets the time and evaluates the surface, so errors do
// not accumulate and any time can be requested directly.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "scene/solver_kind.hpp"
#include "waves/model.hpp"

#include <memory>
#include <optional>

namespace weir::waves {

class Waves final : public Solver {
public:
    explicit Waves(const scene::Scene& scene, const Partition& partition = {});

    StepReport step(real dt) override;
    /// Steps have no limit: the whole scene may be one step.
    real advised_dt() const override { return end_; }
    bool checks_itself() const override { return true; }
    std::string concern() const override;
    void synchronize() override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return box_.own.distributed_storage(); }
    /// "position" is that of the particle with the given rest position.
    bool answer(std::string_view field, const Vec<3>& at, std::span<real> values) const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return time_; }
    void save(Checkpoint& to) const override { to.put_value("waves.time", time_); }
    void restore(const Checkpoint& from) override { set_time(from.get_value<real>("waves.time")); }
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override;
    std::vector<EffectPlan> effects() const override;

    const Model& model() const { return *model_; }

private:
    void set_time(real t);
    void compute();
    std::vector<Values*> shared();
    void place_surface();
    void fill_water();
    void make_foam();
    real foam_of(real jacobian) const;
    real least_jacobian() const;
    real foam_cover() const;
    /// With cells below the surface the grid shows the water; with one cell along y it shows the surface.
    bool shows_water() const { return box_.ny() > 1; }

    Box box_;
    std::unique_ptr<Model> model_;
    real level_, density_, g_, end_, time_ = 0;
    bool with_velocity_, gravity_, tension_;
    std::optional<real> foam_below_;  // foam exists below this Jacobian
    Sheet sheet_;
    std::array<Values, 3> position_;  // of the surface's points [m]
    Values foam_;
    Values level_set_;             // of the water, where the grid shows it
    std::array<Values, 3> water_;  // its velocity
    bool ghosts_filled_ = true;    // whether ghost planes, or all planes, are up to date
    Passes passes_;
};

/// The registered solver.
scene::SolverKind kind();

}  // namespace weir::waves
