// Scalar constraints on the velocities of bodies, and their impulses: projected Gauss-Seidel in a fixed order, accelerated by nonsmooth
// nonlinear conjugate gradients (Silcowitz-Hansen, Niebe & Erleben 2010), which also converges for stacks of light and heavy bodies.
#pragma once
#include "rigid/body.hpp"

#include <vector>

namespace weir::rigid {

/// A dense symmetric matrix, row by row: velocities of all bodies, `freedoms<D>` each, per unit impulse.
struct Mobility {
    std::size_t size = 0;
    std::vector<real> entries;
    void resize(std::size_t n) {
        size = n;
        entries.assign(n * n, 0.0);
    }
    real& operator()(std::size_t row, std::size_t column) { return entries[row * size + column]; }
    real operator()(std::size_t row, std::size_t column) const { return entries[row * size + column]; }
};

/// For bodies in air: the inverse of their masses; fixed velocities have zero rows.
template <int D>
void dry_mobility(const std::vector<Body<D>>& bodies, Mobility& mobility);
/// The inverse of the free rows and columns of a symmetric matrix; zero in the others.
void invert(const Mobility& matrix, const std::vector<char>& free, Mobility& inverse);

/// Bounds of an impulse.
enum class Limit {
    none,
    pushes,  // never negative
    pulls,   // never positive
    rubs,    // at most friction times the impulse of the row `normal`
};

/// The compliance of a line.
struct Spring {
    real stiffness = 0, damping = 0;  // [N/m], [N s/m]; zero stiffness: the row is not a line
    real stretch = 0, rate = 0, dt = 0;
};

/// v = target − softness × impulse, where v is the relative velocity of two bodies along one direction.
template <int D>
struct Row {
    std::size_t body = 0;
    std::ptrdiff_t other = -1;                 // −1: the other side has prescribed motion or is at rest
    std::array<real, 2 * freedoms<D>> sees{};  // v per unit of the velocities of both
    Vec<D> moves{};                            // velocity of the other side where it is prescribed
    real target = 0, softness = 0;
    Limit limit = Limit::none;
    real friction = 0;
    std::size_t normal = 0;
    Spring spring{};    // for a line: target and softness are computed from it and the response
    real response = 0;  // change of v per unit impulse
};

/// Two unit vectors perpendicular to a unit vector and to each other.
std::array<Vec<3>, 2> both_across(const Vec<3>& n);
/// Velocity of a body's point along a direction, per unit of its rigid velocities.
template <int D>
Twist<D> sees(const Body<D>& body, const Vec<D>& point, const Vec<D>& along);
/// The row of the relative velocity of two bodies at a common point.
template <int D>
Row<D> row_at(const std::vector<Body<D>>& bodies, std::size_t body, std::ptrdiff_t other, const Vec<D>& point, const Vec<D>& along);

template <int D>
class Rows {
public:
    void clear() { list_.clear(), impulse_.clear(), given_.clear(); }
    /// With an unchanged number of rows, the previous impulses are the initial guess.
    void set(std::vector<Row<D>>& rows, const Mobility& mobility);
    std::vector<Row<D>>& list() { return list_; }
    const std::vector<real>& impulses() const { return impulse_; }
    /// Declares that the velocities include the impulses found so far: further impulses are added, and bounds apply to the sum.
    void carry_on() { given_ = impulse_; }
    /// Velocity of the body's point relative to the other side.
    real relative(const Row<D>& row, const std::vector<real>& velocities) const;
    void solve(std::vector<real>& velocities);
    /// Adds the impulses of the rows to `freedoms<D>` numbers per body.
    void add_impulses(std::vector<real>& impulses) const;

private:
    real speed(const Row<D>& row, const std::vector<real>& velocities) const;
    real sweep(std::vector<real>& velocities);
    real limited(const Row<D>& row, real impulse) const;
    void go_on(real beta, std::vector<real>& velocities);
    void push(std::size_t row, real impulse, std::vector<real>& velocities) const;
    void find_runs(const real* response);

    std::vector<Row<D>> list_;
    std::vector<real> impulse_, direction_, gained_;  // per row
    std::vector<real> given_;                         // the part of each impulse already included in the velocities
    std::vector<real> responses_;                     // per row, the change of all velocities
    /// The velocities that a row changes: without fluid, or without coupling through it, only those of its own bodies.
    struct Run {
        std::size_t begin = 0, end = 0;
    };
    std::vector<Run> runs_;
    std::vector<std::size_t> runs_end_;  // per row, index in runs_
    std::vector<real> free_;             // velocities without any impulse
    std::size_t size_ = 0;
};

}  // namespace weir::rigid
