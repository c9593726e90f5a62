// Fixed points p = F(p) of a nearly linear F: the last few steps and their changes of the residual F(p) − p give the combination with the
// smallest residual (Anderson 1965; Walker & Ni 2011, type II).
#pragma once
#include "poisson/poisson.hpp"

#include <array>

namespace weir::water {

template <int D>
class AndersonMixing {
public:
    static constexpr int depth = 5;  // number of stored changes
    AndersonMixing() = default;
    explicit AndersonMixing(const Extent<D>& cells);
    void restart() { count_ = 0, any_ = false; }
    /// Replaces p by the next iterate, given the residual F(p) − p; counted in liquid cells only.
    void next(Grid<real, D>& p, const Grid<real, D>& residual, const Grid<poisson::Cell, D>& cells);
    std::size_t bytes() const;

private:
    using Weights = std::array<real, depth>;
    struct Change {
        Grid<real, D> p, residual;
    };
    Weights weights(const Grid<real, D>& residual, const Grid<poisson::Cell, D>& cells) const;

    std::array<Change, depth> changes_;  // the newest overwrites the oldest
    Grid<real, D> last_p_, last_residual_;
    int count_ = 0;
    bool any_ = false;
};

}  // namespace weir::water
