// Aggregates for weights that jump, as those of two phases of very different density do: box × cluster of strongly coupled unknowns.
//
// A bubble that straddles the sides of coarse cells is 2^D strongly coupled coarse cells on every level. Its constant is then a near-null
// vector that no smoother reduces, one per bubble. A thin film of gas is a chain of such bubbles: beside a partly filled cell a face has
// nearly the weight of the liquid. A face is strong here if its weight is at least a quarter of the largest weight of both its unknowns
// (Ruge & Stüben 1987), and above four times that of the heavier phase. Unknowns that strong faces connect are a cluster. A cluster of at
// most four boxes along each axis is one aggregate. A box of 2^D unknowns gives one aggregate for each larger cluster, and one for the
// rest.
#pragma once
#include "poisson/geometric/natural.hpp"
#include "poisson/matrix/aggregation.hpp"

namespace weir::poisson {

/// The unknowns of a level: parts of boxes.
template <int D>
struct PhaseUnknowns {
    Index<D> boxes{};      // boxes along each axis
    int width = 1;         // of a box [cells], along the coarsened axes
    std::vector<int> box;  // linear index of each unknown's box; of a cluster that is one unknown, its first box; −1: no unknown
    std::size_t bytes() const { return box.capacity() * sizeof(int); }
};

/// A face between unknowns is strong if its weight is above `floor` and at least a quarter of the largest of either.
inline bool is_strong(real weight, real largest, real other_largest, real floor) {
    return weight > floor && weight >= 0.25 * std::max(largest, other_largest);
}

/// The cluster of each unknown, −1: none; and the largest side of each cluster [boxes].
struct Clusters {
    std::vector<int> of, extent;
    std::size_t bytes() const { return (of.capacity() + extent.capacity()) * sizeof(int); }
};

/// Union-find over pairs of strongly coupled unknowns.
class ClusterFinder {
public:
    explicit ClusterFinder(std::size_t unknowns) : parent_(unknowns, -1) {}
    void join(int i, int j);
    template <int D>
    Clusters find(const PhaseUnknowns<D>& at);

private:
    int root(int i);
    std::vector<int> parent_;  // −1: in no pair
};

/// The cells of a problem: every fluid cell is one unknown; unknowns are numbered like the cells. Cells outside fluid have box −1.
template <int D>
PhaseUnknowns<D> unknown_cells(const Natural<D>& problem);

/// Joins the unknowns of boxes of two along each axis of `halved`. The aggregates are numbered by colour: boxes of even and of odd index
/// sum, then whole clusters; a sweep in this order has no long chain of dependent unknowns.
template <int D>
Aggregation join_clusters(const PhaseUnknowns<D>& fine, const std::array<bool, D>& halved, const Clusters& clusters,
                          PhaseUnknowns<D>& coarse);

}  // namespace weir::poisson
