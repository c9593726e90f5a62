// Solver "reconstruction": static particles on or near a lattice, in space or in a plane. A step reconstructs the surface around them, to
// measure it and its cost.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"
#include "surfaces/reconstruction.hpp"

#include <array>
#include <memory>
#include <vector>

namespace weir::studies {

class ReconstructionStudy final : public Solver {
public:
    explicit ReconstructionStudy(const scene::Scene& scene);
    static scene::Key jitter_key();

    StepReport step(real dt) override;
    real advised_dt() const override { return infinity; }
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return time_; }
    void save(Checkpoint& to) const override { to.put_value("time", time_); }
    void restore(const Checkpoint& from) override { time_ = from.get_value<real>("time"); }
    const Passes& passes() const override { return maker_->passes(); }
    Passes& passes() override { return maker_->passes(); }
    std::size_t bytes() const override;

private:
    GridView grid_;
    template <int D>
    void fill(const scene::Scene& scene);

    std::array<std::vector<real>, 3> x_;  // in a plane only two are used
    std::unique_ptr<surfaces::Reconstruction> maker_;
    real time_ = 0;
};

}  // namespace weir::studies
