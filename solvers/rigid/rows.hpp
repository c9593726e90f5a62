// Constraints on the velocities of bodies, one number each, and the impulses that keep them: projected Gauss-Seidel in a fixed order, each
// sweep a step of nonsmooth nonlinear conjugate gradients (Silcowitz-Hansen, Niebe & Erleben 2010), so that stacks of light and heavy
// bodies converge too.
#pragma once
#include "rigid/body.hpp"

#include <vector>

namespace weir::rigid {

/// A dense symmetric matrix, row by row: velocities of all bodies, `freedoms<D>` each, from impulses on them.
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

/// Of bodies in the air: the inverse of their masses; what is held does not move.
template <int D>
void dry_mobility(const std::vector<Body<D>>& bodies, Mobility& mobility);
/// The inverse of a symmetric matrix, of the rows and columns that are free; zero in the others.
void invert(const Mobility& matrix, const std::vector<char>& free, Mobility& inverse);

/// What an impulse may be.
enum class Limit {
    none,
    pushes,  // never negative
    pulls,   // never positive
    rubs,    // at most friction times that of the row `normal`
};

/// What a line gives way by.
struct Spring {
    real stiffness = 0, damping = 0;  // [N/m], [N s/m]; no stiffness: the row is no line
    real stretch = 0, rate = 0, dt = 0;
};

/// v = target − softness × impulse, where v is the velocity of a body past another along one direction.
template <int D>
struct Row {
    std::size_t body = 0;
    std::ptrdiff_t other = -1;                 // −1: nothing that moves by itself
    std::array<real, 2 * freedoms<D>> sees{};  // v by the velocities of both
    Vec<D> moves{};                            // velocity of the other side where that is prescribed
    real target = 0, softness = 0;
    Limit limit = Limit::none;
    real friction = 0;
    std::size_t normal = 0;
    Spring spring{};    // where it is a line: target and softness follow from it and the response
    real response = 0;  // change of v by a unit impulse
};

/// Two directions across a unit vector, and each other.
std::array<Vec<3>, 2> both_across(const Vec<3>& n);
/// How a body's rigid velocity moves its point, along a direction.
template <int D>
Twist<D> sees(const Body<D>& body, const Vec<D>& point, const Vec<D>& along);
/// The row of a point of a body past the same point of another.
template <int D>
Row<D> row_at(const std::vector<Body<D>>& bodies, std::size_t body, std::ptrdiff_t other, const Vec<D>& point, const Vec<D>& along);

template <int D>
class Rows {
public:
    void clear() { list_.clear(), impulse_.clear(), given_.clear(); }
    /// Of the same number of rows again, the impulses that were found are where it begins.
    void set(std::vector<Row<D>>& rows, const Mobility& mobility);
    std::vector<Row<D>>& list() { return list_; }
    const std::vector<real>& impulses() const { return impulse_; }
    /// The velocities have the impulses found so far: what is found next comes on top of them, and limits hold for the whole.
    void carry_on() { given_ = impulse_; }
    /// Of the body's point past the other side.
    real relative(const Row<D>& row, const std::vector<real>& velocities) const;
    void solve(std::vector<real>& velocities);
    /// What the rows push the bodies by, to `freedoms<D>` numbers a body.
    void add_impulses(std::vector<real>& impulses) const;

private:
    real speed(const Row<D>& row, const std::vector<real>& velocities) const;
    real sweep(std::vector<real>& velocities);
    real limited(const Row<D>& row, real impulse) const;
    void go_on(real beta, std::vector<real>& velocities);
    void push(std::size_t row, real impulse, std::vector<real>& velocities) const;
    void find_runs(const real* response);

    std::vector<Row<D>> list_;
    std::vector<real> impulse_, direction_, gained_;  // of each row
    std::vector<real> given_;                         // that part of each impulse which the velocities have already
    std::vector<real> responses_;                     // of each row, the change of all velocities
    /// Velocities that a row changes at all: without a fluid between them, or with one that knows nothing of the others, those of its own
    /// bodies alone.
    struct Run {
        std::size_t begin = 0, end = 0;
    };
    std::vector<Run> runs_;
    std::vector<std::size_t> runs_end_;  // of each row, in runs_
    std::vector<real> free_;             // velocities without any impulse
    std::size_t size_ = 0;
};

}  // namespace weir::rigid
