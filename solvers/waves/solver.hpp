// The solver "waves": a surface that is a formula of place and time. A step only sets the time; the surface is then computed afresh, so
// that no error is carried on and any time may be asked for at once.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "scene/solver_kind.hpp"
#include "waves/model.hpp"

#include <memory>
#include <optional>

namespace weir::waves {

/// Over ranks: would each hold its own planes of a scene alone? Not where somebody looks at whole fields on all ranks.
bool holds_own_planes(const scene::Scene& scene, const Cut& cut);

class Waves final : public Solver {
public:
    explicit Waves(const scene::Scene& scene);

    StepReport step(real dt) override;
    /// Nothing limits a step: the whole scene may be one.
    real advised_dt() const override { return end_; }
    bool checks_itself() const override { return true; }
    std::string concern() const override;
    FieldSet fields() const override;
    bool holds_own_planes() const override { return held_.alone(); }
    /// "position" is that of the particle that rests at the point.
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
    void bring() const;
    std::vector<Values*> shared();
    void place_surface();
    void fill_water();
    void make_foam();
    real foam_of(real jacobian) const;
    real least_jacobian() const;
    real foam_cover() const;
    /// Below the surface the grid has cells: it shows the water. With one cell along y it shows the surface.
    bool shows_water() const { return box_.ny() > 1; }

    Box box_;
    HeldPlanes held_;  // cut by cut_of_box
    std::unique_ptr<Model> model_;
    real level_, density_, g_, end_, time_ = 0;
    bool with_velocity_, gravity_, tension_;
    std::optional<real> foam_below_;  // the Jacobian below which there is foam
    Sheet sheet_;
    std::array<Values, 3> position_;  // of the surface's points [m]
    Values foam_;
    Values level_set_;             // of the water, where the grid shows it
    std::array<Values, 3> water_;  // its velocity
    mutable bool brought_ = true;  // whether what whoever looks may read is here, and not this rank's planes alone
    Passes passes_;
};

/// The registered solver.
scene::SolverKind kind();

}  // namespace weir::waves
