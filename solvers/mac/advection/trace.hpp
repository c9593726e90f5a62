// Backward trajectories: Runge-Kutta traces of rows of points through a velocity field.
#pragma once
#include "geometry/sides.hpp"
#include "mac/advection/sample.hpp"
#include "mac/grid/velocity.hpp"

#include <array>
#include <string>

namespace weir::mac {

/// A Runge-Kutta scheme in which each stage depends only on the previous one: nodes c and weights b.
struct Tableau {
    int stages;
    std::array<real, 4> c;  // stage s is evaluated at x − c[s] dt k(s−1)
    std::array<real, 4> b;
};
/// "rk1" Euler; "rk2" midpoint; "rk3" Ralston 1962; "rk4" the classical scheme.
const Tableau& tableau(const std::string& name);

/// Traces rows of nodes. One virtual call per row.
template <int D>
class Backtrace {
public:
    virtual ~Backtrace() = default;
    /// Displacement [cells] to the points from which the nodes [first, first + count) of the row are reached in dt; for negative dt, to
    /// their destinations. `home_axis`: the faces' axis, −1 for cell centres. The points stay in the domain.
    virtual void row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const = 0;
    /// Returns whether all displacements are within one cell.
    virtual bool is_near(real) const { return false; }
};

/// The box of traced points: they are clamped to it, or wrapped along periodic axes.
template <int D>
struct Domain {
    Index<D> cells{};
    std::array<bool, D> periodic{};
    Domain(const Index<D>& cells_, const geometry::Sides<D>& sides) : cells(cells_) {
        for (int a = 0; a < D; ++a) periodic[static_cast<std::size_t>(a)] = sides.periodic(a);
    }
    void keep_inside(int home_axis, const Index<D>& first, int count, Displacement<D>& x) const;
    /// The allowed displacements of a node along axis a; along a periodic axis the ghost layers limit them.
    std::array<real, 2> reach(int home_axis, const Index<D>& first, int a) const;
};

/// Traces through the staggered velocity, frozen over the step.
template <int D>
class GridBacktrace final : public Backtrace<D> {
public:
    GridBacktrace(const PaddedVelocity<D>& u, const MacVelocity<D>& grid, const geometry::Sides<D>& sides, const std::string& scheme);
    void row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const override;
    bool is_near(real dt) const override { return std::abs(dt) * max_rate_ <= 1; }
    /// max |u/h| [1/s] of the velocity now: traces of less than a cell take the fast path of near_sample.hpp.
    void set_max_rate(real rate) { max_rate_ = rate; }

private:
    void velocity_at(int home_axis, const Index<D>& first, int count, const Displacement<D>& x, Displacement<D>& k) const;
    void velocity_at_home(int home_axis, const Index<D>& first, int count, Displacement<D>& k) const;
    template <int Home>
    void near_midpoint(const Index<D>& first, int count, real dt, Displacement<D>& to) const;
    const PaddedVelocity<D>& u_;
    Vec<D> h_;
    Domain<D> domain_;
    Tableau rk_;
    real max_rate_ = infinity;
};

}  // namespace weir::mac
