#include "poisson/geometric/phase_aggregates.hpp"

#include <algorithm>

namespace weir::poisson {

namespace {

constexpr int whole_boxes = 4;  // two coarse boxes: a cluster of this width lies in three of them at most

template <int D>
Index<D> index_of(int box, const Index<D>& boxes) {
    Index<D> I;
    for (int a = 0; a < D; ++a) I[a] = box % boxes[a], box /= boxes[a];
    return I;
}

/// Finds or makes the aggregate of a key: a box and a cluster. The aggregates of one box are a linked list.
class Finder {
public:
    Finder(std::size_t boxes, std::size_t clusters) : first_(boxes, -1), whole_(clusters, -1) {
        next_.reserve(boxes + boxes / 4), box_.reserve(boxes + boxes / 4), cluster_.reserve(boxes + boxes / 4);
    }
    int of_box(int box, int cluster) {
        for (int k = at(first_, box); k >= 0; k = at(next_, k))
            if (at(cluster_, k) == cluster) return k;
        next_.push_back(at(first_, box));
        return at(first_, box) = make(box, cluster);
    }
    int of_whole(int box, int cluster) {
        int& k = at(whole_, cluster);
        if (k < 0) next_.push_back(-1), k = make(box, whole);
        return k;
    }
    int count() const { return static_cast<int>(box_.size()); }
    int box(int k) const { return box_[static_cast<std::size_t>(k)]; }
    bool is_whole(int k) const { return cluster_[static_cast<std::size_t>(k)] == whole; }

private:
    static constexpr int whole = -2;
    static int& at(std::vector<int>& v, int i) { return v[static_cast<std::size_t>(i)]; }
    int make(int box, int cluster) {
        box_.push_back(box), cluster_.push_back(cluster);
        return count() - 1;
    }
    std::vector<int> first_, whole_, next_, box_, cluster_;
};

/// The coarse box of each box, and the parity of each coarse box.
template <int D>
struct BoxTables {
    std::vector<int> above;
    std::vector<std::uint8_t> odd;
    BoxTables(const Index<D>& fine, const Index<D>& coarse, const std::array<bool, D>& halved) {
        above.reserve(product(fine)), odd.reserve(product(coarse));
        Index<D> I{};
        for (std::size_t box = 0; box < product(fine); ++box) {
            int to = 0;
            for (int a = D - 1; a >= 0; --a) to = to * coarse[a] + (halved[static_cast<std::size_t>(a)] ? I[a] / 2 : I[a]);
            above.push_back(to);
            step(I, fine);
        }
        I = {};
        for (std::size_t box = 0; box < product(coarse); ++box) {
            int sum = 0;
            for (int a = 0; a < D; ++a) sum += I[a];
            odd.push_back(static_cast<std::uint8_t>(sum & 1));
            step(I, coarse);
        }
    }

private:
    static void step(Index<D>& I, const Index<D>& n) {
        for (int a = 0; a < D && ++I[a] == n[a]; ++a)
            if (a + 1 < D) I[a] = 0;
    }
};

/// New numbers by colour.
std::vector<int> numbers_by_colour(const Finder& found, const std::vector<std::uint8_t>& odd) {
    const auto colour = [&](int k) -> std::size_t { return found.is_whole(k) ? 2 : odd[static_cast<std::size_t>(found.box(k))]; };
    std::array<int, 4> first{};
    for (int k = 0; k < found.count(); ++k) ++first[colour(k) + 1];
    for (std::size_t c = 1; c < 4; ++c) first[c] += first[c - 1];
    std::vector<int> number(static_cast<std::size_t>(found.count()));
    for (int k = 0; k < found.count(); ++k) number[static_cast<std::size_t>(k)] = first[colour(k)]++;
    return number;
}

}  // namespace

int ClusterFinder::root(int i) {
    const auto at = [&](int k) -> int& { return parent_[static_cast<std::size_t>(k)]; };
    while (at(i) != i) i = at(i) = at(at(i));
    return i;
}

/// A root is the smallest index of its cluster. An unknown in no pair yet takes the root of a lower one: faces that come by rising i and
/// falling axis then mostly find both sides with one parent.
void ClusterFinder::join(int i, int j) {
    int &one = parent_[static_cast<std::size_t>(std::max(i, j))], &other = parent_[static_cast<std::size_t>(std::min(i, j))];
    if (one >= 0 && one == other) return;
    if (other < 0) other = std::min(i, j);
    const int b = root(std::min(i, j));
    if (one < 0) return void(one = b);
    const int a = root(std::max(i, j));
    parent_[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
}

template <int D>
Clusters ClusterFinder::find(const PhaseUnknowns<D>& at) {
    Clusters found;
    found.of.assign(parent_.size(), -1);
    std::vector<Index<D>> low, high;
    Index<D> I{};
    int box = 0;  // of I
    for (std::size_t i = 0; i < parent_.size(); ++i) {
        if (parent_[i] < 0) continue;
        const auto r = static_cast<std::size_t>(root(static_cast<int>(i)));
        const bool next = at.box[i] == box + 1 && I[0] + 1 < at.boxes[0];
        box = at.box[i];
        if (next)
            ++I[0];
        else
            I = index_of<D>(box, at.boxes);
        if (r == i) found.of[i] = static_cast<int>(low.size()), low.push_back(I), high.push_back(I);
        const int c = found.of[i] = found.of[r];
        for (int a = 0; a < D; ++a) {
            int &lo = low[static_cast<std::size_t>(c)][a], &hi = high[static_cast<std::size_t>(c)][a];
            lo = std::min(lo, I[a]), hi = std::max(hi, I[a]);
        }
    }
    for (std::size_t c = 0; c < low.size(); ++c) {
        int side = 0;
        for (int a = 0; a < D; ++a) side = std::max(side, high[c][a] - low[c][a] + 1);
        found.extent.push_back(side);
    }
    return found;
}

template <int D>
PhaseUnknowns<D> unknown_cells(const Natural<D>& problem) {
    constexpr auto fluid = static_cast<std::uint8_t>(Cell::fluid);
    PhaseUnknowns<D> cells;
    cells.boxes = problem.extent();
    const int n = cells.boxes[0], rows = problem.planes() * problem.rows_in_plane();
    cells.box.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(rows), -1);
    for (int row = 0; row < rows; ++row)
        for (int i = 0; i < n; ++i)
            if (problem.cells(row)[i] == fluid) cells.box[static_cast<std::size_t>(row * n + i)] = row * n + i;
    return cells;
}

template <int D>
Aggregation join_clusters(const PhaseUnknowns<D>& fine, const std::array<bool, D>& halved, const Clusters& clusters,
                          PhaseUnknowns<D>& coarse) {
    coarse.width = 2 * fine.width;
    for (int a = 0; a < D; ++a) coarse.boxes[a] = halved[static_cast<std::size_t>(a)] ? (fine.boxes[a] + 1) / 2 : fine.boxes[a];
    const BoxTables<D> tables(fine.boxes, coarse.boxes, halved);
    Finder found(product(coarse.boxes), clusters.extent.size());
    Aggregation groups;
    groups.of.assign(fine.box.size(), -1);
    for (std::size_t i = 0; i < fine.box.size(); ++i) {
        if (fine.box[i] < 0) continue;
        const int box = tables.above[static_cast<std::size_t>(fine.box[i])], c = clusters.of[i];
        const bool whole = c >= 0 && clusters.extent[static_cast<std::size_t>(c)] <= whole_boxes;
        groups.of[i] = whole ? found.of_whole(box, c) : found.of_box(box, c);
    }
    groups.count = found.count();
    const std::vector<int> number = numbers_by_colour(found, tables.odd);
    for (int& k : groups.of) k = k < 0 ? k : number[static_cast<std::size_t>(k)];
    coarse.box.assign(number.size(), 0);
    for (int k = 0; k < groups.count; ++k) coarse.box[static_cast<std::size_t>(number[static_cast<std::size_t>(k)])] = found.box(k);
    return groups;
}

template Clusters ClusterFinder::find<2>(const PhaseUnknowns<2>&);
template Clusters ClusterFinder::find<3>(const PhaseUnknowns<3>&);
template PhaseUnknowns<2> unknown_cells<2>(const Natural<2>&);
template PhaseUnknowns<3> unknown_cells<3>(const Natural<3>&);
template Aggregation join_clusters<2>(const PhaseUnknowns<2>&, const std::array<bool, 2>&, const Clusters&, PhaseUnknowns<2>&);
template Aggregation join_clusters<3>(const PhaseUnknowns<3>&, const std::array<bool, 3>&, const Clusters&, PhaseUnknowns<3>&);

}  // namespace weir::poisson
