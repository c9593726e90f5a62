// Velocities as functions of position and time, for advection tests.
#pragma once
#include "mac/advection/trace.hpp"
#include "mac/grid/velocity.hpp"
#include "scene/scene.hpp"

#include <array>

namespace weir::studies {

using namespace mac;  // the grid's words are the solver's own

/// A velocity by name. All except "constant" are defined on the unit square or cube.
template <int D>
class PrescribedFlow {
public:
    explicit PrescribedFlow(const scene::Table& table);
    static scene::Key key();
    Vec<D> operator()(const Vec<D>& x, real t) const;
    bool steady() const { return period_ == infinity; }

private:
    enum class Kind { constant, rotation, single_vortex, enright };
    Kind kind_;
    Vec<D> constant_{}, centre_{};
    real rate_ = 0, period_ = infinity;
};

/// Traces through a prescribed flow, evaluated exactly at the position and time of every stage.
template <int D>
class PrescribedBacktrace final : public Backtrace<D> {
public:
    PrescribedBacktrace(const PrescribedFlow<D>& flow, const MacVelocity<D>& grid, const geometry::Sides<D>& sides,
                        const std::string& scheme);
    /// Sets the traced step, [t, t + dt]: backwards from its end, forwards (negative dt of row) from its start.
    void set_step(real t, real dt) { start_ = t, length_ = dt; }
    void row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const override;

private:
    const PrescribedFlow<D>& flow_;
    Vec<D> h_, origin_;
    Domain<D> domain_;
    Tableau rk_;
    real start_ = 0, length_ = 0;
};

}  // namespace weir::studies
