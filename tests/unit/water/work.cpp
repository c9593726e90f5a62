// What a step takes of each plane, and the cuts that follow from it.
#include "parallel/load_balance.hpp"
#include "support.hpp"

#include <numeric>

namespace work_tests {

using namespace weir;
using namespace weir::test;

namespace {

/// A tank of 96 planes along z with liquid below `end` [m] of its 0.96.
std::string one_end(const char* end) {
    return fmt::format(R"(solver = "mac_water"
dim = 3
grid = {{ cells = [16, 12, 96], size = [0.16, 0.12, 0.96] }}
time = {{ end = 1.0 }}
liquid = [ {{ shape = "box", min = [0.0, 0.0, 0.0], max = [0.16, 0.08, {}] }} ]
solids = [ {{ shape = "sphere", centre = [0.08, 0.03, 0.1], radius = 0.02 }} ]
)",
                       end);
}

std::int64_t sum(std::span<const std::int64_t> work) { return std::accumulate(work.begin(), work.end(), std::int64_t{0}); }

}  // namespace

// Cuts are at multiples of 8 planes, each at the one nearest to where an even share ends: off by half of such a slab at either end of a
// rank's planes, so that no rank has more than the mean and the heaviest slab.
TEST(
    "liquid in one end of a tank: the rank with most work has at most the heaviest 8 planes more than the mean; by planes alone one has "
    "all") {
    const auto work = water::work_of_planes(water_scene(one_end("0.48")));
    ASSERT_EQ(work.size(), 96u);
    std::int64_t heaviest = 0;
    for (std::size_t at = 0; at < 96; at += 8) heaviest = std::max(heaviest, sum(std::span(work).subspan(at, 8)));
    for (const int ranks : {2, 3, 4}) {
        const Partition cut = load_balanced_partition(work, ranks);
        EXPECT_LE(largest_share(work, cut), sum(work) / ranks + heaviest) << ranks;
        for (int r = 1; r < ranks; ++r) EXPECT_EQ(cut.begin(r) % 8, 0) << ranks;
    }
    EXPECT_EQ(load_balanced_partition(work, 2).at, (std::vector<int>{0, 24, 96}));  // 6 slabs of liquid: 3 for each
    // empty planes are not free, but a wet cell takes 28 times as much, and two thirds of the cells of 48 planes are wet
    EXPECT_GT(static_cast<double>(largest_share(work, equal_partition(96, 2))), 0.9 * static_cast<double>(sum(work)));
}

// Both count cells in liquid and within three cells of the surface; the level set knows that a surface ends at solids and at walls, where
// the shapes of a scene go on: a skin of the ball, of some 150 cells of 6144.
TEST("what the planes of a scene take is what those of the state take with which it begins") {
    const scene::Scene scene = water_scene(one_end("0.48"));
    const water::Water<3> water(scene);
    Checkpoint state;
    water.save(state);
    const auto told = water::work_of_planes(scene), found = water::work_of_planes(scene, &state);
    ASSERT_EQ(told.size(), found.size());
    EXPECT_NEAR(static_cast<double>(sum(told)) / static_cast<double>(sum(found)), 1, 0.05);
    for (const int ranks : {2, 3, 4}) EXPECT_EQ(load_balanced_partition(told, ranks), load_balanced_partition(found, ranks)) << ranks;
}

TEST("a tank that is wet along all of its length is cut into as many planes for each") {
    const auto work = water::work_of_planes(water_scene(one_end("0.96"), {{"solids", "[]"}}));
    for (const int ranks : {2, 3, 4, 6}) EXPECT_EQ(load_balanced_partition(work, ranks), equal_partition(96, ranks)) << ranks;
}

// An emitter fills the tank later: nothing is known of where the liquid will be.
TEST("a tank without liquid at the start is cut into as many planes for each") {
    const auto work = water::work_of_planes(water_scene(one_end("0.48"), {{"liquid", "[]"}}));
    for (const int ranks : {2, 3, 4}) EXPECT_EQ(load_balanced_partition(work, ranks), equal_partition(96, ranks)) << ranks;
}

}  // namespace work_tests
