// The neighbour list of the fast path: its sets are those of brute force and of nanoflann, on random, clustered, coincident points and
// points on the borders of cells, and their order; periodic images; sweeps in lanes; lattice counts from the reference table.
#include "particles/threads/pairs.hpp"
#include "core/error.hpp"
#include "particles/reference/neighbours.hpp"
#include "particles/state/fluid.hpp"

#include "support/csv.hpp"
#include "support/test.hpp"

#include <nanoflann.hpp>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

namespace pairs_tests {

using namespace weir;
using namespace weir::particles;

namespace {

using Points = std::array<std::vector<real>, 3>;

struct Cloud {
    const Points& p;
    std::size_t kdtree_get_point_count() const { return p[0].size(); }
    float kdtree_get_pt(std::size_t i, std::size_t a) const { return static_cast<float>(p[a][i]); }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

Points random_points(int count, int dim, const std::string& how) {
    std::mt19937 random(11);
    std::uniform_real_distribution<real> anywhere(-0.5, 0.5);
    std::normal_distribution<real> close(0, 0.03);
    Points p;
    for (auto& axis : p) axis.assign(static_cast<std::size_t>(count), 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            if (how == "random") p[a][i] = anywhere(random);
            if (how == "clustered") p[a][i] = (i % 3 ? 0.3 : -0.3) + close(random);
            if (how == "coincident") p[a][i] = i % 2 ? p[a][i - 1] : anywhere(random);
            if (how == "borders") p[a][i] = 0.125 * std::round(anywhere(random) / 0.125);  // multiples of the radius
            p[a][i] = static_cast<real>(static_cast<float>(p[a][i]));
        }
    return p;
}

/// The list as sets of state particles.
std::vector<std::multiset<int>> sets(const Pairs& pairs, int count) {
    std::vector<std::multiset<int>> found(static_cast<std::size_t>(count));
    const int lanes = pairs.table().lanes;
    pairs.list().each_chunk([&](const ListChunk& chunk) {
        for (int s = chunk.begin; s < chunk.end; ++s)
            for (int row = 0; row < pairs.list().rows()[s]; ++row)
                for (int l = 0; l < lanes && s * lanes + l < pairs.size(); ++l) {
                    const int k = s * lanes + l;
                    const auto j =
                        static_cast<int>(chunk.entries[pairs.list().first()[s] + static_cast<std::size_t>(row * lanes + l)] / 16);
                    if (j < pairs.size() && !pairs.is_image(k)) found[static_cast<std::size_t>(pairs.owner(k))].insert(pairs.owner(j));
                }
    });
    return found;
}

}  // namespace

TEST_IN_2D_AND_3D("the list's sets are those of brute force and of nanoflann, on every instruction set and any number of threads") {
    const float radius = 0.125f;
    for (const std::string how : {"random", "clustered", "coincident", "borders"})
        for (const auto* table : available_passes())
            for (const int count : {1, 3}) {
                set_threads(count);
                const int n = 700;
                const Points p = random_points(n, D, how);
                Pairs pairs(*table, Frame{});
                pairs.find({p[0].data(), p[1].data(), D == 3 ? p[2].data() : nullptr}, n, static_cast<real>(radius));
                const auto found = sets(pairs, n);
                const Cloud cloud{p};
                nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3> tree(3, cloud, {10});
                for (int i = 0; i < n; ++i) {
                    const auto at = static_cast<std::size_t>(i);
                    std::multiset<int> brute, independent;
                    const float x[3] = {static_cast<float>(p[0][at]), static_cast<float>(p[1][at]), static_cast<float>(p[2][at])};
                    for (int j = 0; j < n; ++j) {
                        const auto b = static_cast<std::size_t>(j);
                        real d2 = 0;
                        for (std::size_t a = 0; a < 3; ++a) d2 += (p[a][at] - p[a][b]) * (p[a][at] - p[a][b]);
                        if (j != i && d2 < static_cast<real>(radius) * static_cast<real>(radius)) brute.insert(j);
                    }
                    std::vector<std::pair<std::uint32_t, float>> near;
                    tree.radiusSearch(x, radius * radius, near, {});
                    for (const auto& [j, d2] : near)
                        if (static_cast<int>(j) != i) independent.insert(static_cast<int>(j));
                    ASSERT_EQ(found[at], brute) << how << " " << table->name;
                    ASSERT_EQ(found[at], independent) << how << " " << table->name;
                }
            }
    set_threads(2);
}

TEST_IN_2D_AND_3D(
    "neighbours are listed in the order of the sorted particles, on every instruction set and any number of threads") {  // so are sums
    const int n = 700;
    const Points p = random_points(n, D, "random");
    std::vector<std::vector<int>> first;
    for (const auto* table : available_passes())
        for (const int count : {1, 3}) {
            set_threads(count);
            Pairs pairs(*table, Frame{});
            pairs.find({p[0].data(), p[1].data(), D == 3 ? p[2].data() : nullptr}, n, 0.125);
            std::vector<std::vector<int>> lists(static_cast<std::size_t>(n));
            pairs.list().each_chunk([&](const ListChunk& chunk) {
                for (int k = chunk.begin * table->lanes; k < std::min(n, chunk.end * table->lanes); ++k)
                    for (int row = 0; row < pairs.list().rows()[k / table->lanes]; ++row) {
                        const auto at =
                            pairs.list().first()[k / table->lanes] + static_cast<std::size_t>(row * table->lanes + k % table->lanes);
                        if (const auto j = static_cast<int>(chunk.entries[at] / 16); j < n) lists[static_cast<std::size_t>(k)].push_back(j);
                    }
            });
            std::size_t longest = 0;
            for (const auto& list : lists) {
                longest = std::max(longest, list.size());
                ASSERT_TRUE(std::is_sorted(list.begin(), list.end())) << table->name;
            }
            EXPECT_GT(longest, 5u);
            if (first.empty()) first = lists;
            ASSERT_EQ(lists, first) << table->name << ", " << count << " threads";
        }
    set_threads(2);
}

TEST("sweeps in lanes find what a plain loop finds, wherever it stands, and nothing hides what is not finite") {
    const real no_number = std::numeric_limits<real>::quiet_NaN();
    std::mt19937 random(5);
    std::uniform_real_distribution<real> anywhere(-3, 3);
    for (const int n : {1, 7, 8, 9, 2047, 2048, 2056, 5003}) {
        std::vector<real> x(static_cast<std::size_t>(n));
        for (real& value : x) value = anywhere(random);
        const auto value = [&](int i) { return x[static_cast<std::size_t>(i)]; };
        const Coordinates along{x.data(), nullptr, nullptr};
        for (const int at : {0, n / 2, n - 1}) {
            const real before = x[static_cast<std::size_t>(at)];
            for (const real extreme : {10.0, -10.0, no_number, infinity, -infinity}) {
                x[static_cast<std::size_t>(at)] = extreme;
                const real largest = block_max(n, value);
                const auto both = whole_sum_and_max(n, value);
                set_threads(1);
                const auto backwards = whole_sum_and_max(n, [&](int i) { return value(n - 1 - i); });
                set_threads(2);
                CellSort cells;
                if (std::isnan(extreme)) {
                    EXPECT_TRUE(std::isnan(largest) && std::isnan(both.most) && std::isnan(both.sum()));
                } else {
                    EXPECT_EQ(largest, *std::max_element(x.begin(), x.end()));
                    EXPECT_EQ(both.most, largest);
                    const real plain = block_sum(n, [&](int i) { return std::clamp<real>(value(i), 0, SumAndMost::limit); });
                    EXPECT_LE(both.sum(), plain * (1 + 1e-12));                         // 5003 sums of doubles are rounded by 1e-16 each
                    EXPECT_GE(both.sum(), plain * (1 - 1e-12) - n * SumAndMost::unit);  // each is rounded down
                    EXPECT_TRUE(both.units == backwards.units);
                }
                if (!std::isfinite(extreme)) {
                    EXPECT_THROW(cells.box(along, n), NumericalFailure);
                    continue;
                }
                const Box box = cells.box(along, n);
                EXPECT_EQ(box.lo[0], *std::min_element(x.begin(), x.end()));
                EXPECT_EQ(box.hi[0], *std::max_element(x.begin(), x.end()));
                cells.sort(along, n, 0.5);
                for (int k = 0; k < n; ++k)
                    ASSERT_EQ(cells.cell_of()[static_cast<std::size_t>(k)], cells.cell(along, cells.order()[static_cast<std::size_t>(k)]));
                EXPECT_TRUE(std::is_sorted(cells.cell_of().begin(), cells.cell_of().end()));
            }
            x[static_cast<std::size_t>(at)] = before;
        }
    }
}

TEST_IN_2D_AND_3D("a repeating lattice has the neighbour counts of the reference table at every particle") {
    const auto rows = test::read_csv(WEIR_SOURCE_DIR "/tests/unit/particles/data/neighbour_counts_lattice.csv");
    int compared = 0;
    for (const auto& row : rows) {
        if (static_cast<int>(row[0]) != D || row[2] != row[3]) continue;  // skip supports that end on a shell of the lattice
        ++compared;
        const int side = 9;
        Points p;
        for (int c = 0; c < (D == 2 ? side * side : side * side * side); ++c) {
            p[0].push_back(c % side + 0.5), p[1].push_back(c / side % side + 0.5), p[2].push_back(D == 2 ? 0 : c / (side * side) + 0.5);
        }
        Frame frame;
        for (std::size_t a = 0; a < D; ++a) frame.period[a] = side, frame.centre[a] = 0.5 * side;
        Pairs pairs(*available_passes().front(), frame);
        const int n = static_cast<int>(p[0].size());
        pairs.find({p[0].data(), p[1].data(), D == 3 ? p[2].data() : nullptr}, n, row[1]);
        for (const auto& set : sets(pairs, n)) ASSERT_EQ(static_cast<int>(set.size()), static_cast<int>(row[2]));
    }
    EXPECT_GE(compared, 4);
}

TEST_IN_2D_AND_3D("brute force, grid and sorted grid give the same lists, and those are what the distances say") {
    for (const std::string how : {"random", "clustered", "coincident", "borders"})
        for (const int count : {1, 3}) {
            set_threads(count);
            const int n = 500;
            const Points p = random_points(n, D, how);
            const Coordinates x{p[0].data(), p[1].data(), D == 3 ? p[2].data() : nullptr};
            std::vector<int> expected;
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    real d2 = 0;
                    for (std::size_t a = 0; a < 3; ++a) {
                        const real d = p[a][static_cast<std::size_t>(i)] - p[a][static_cast<std::size_t>(j)];
                        d2 += d * d;
                    }
                    if (j != i && d2 < 0.125 * 0.125) expected.push_back(j);
                }
            EXPECT_GT(expected.size(), 0u);
            for (const auto& method : neighbour_methods())
                EXPECT_EQ(make_neighbour_search(method)->find(x, n, 0.125).index, expected) << method << " " << how;
        }
    set_threads(2);
}

}  // namespace pairs_tests
