// Who owns which planes and what travels: arithmetic that all ranks do alike, against its definition; and that one rank asks for nothing.
#include "parallel/grid.hpp"
#include "parallel/load_balance.hpp"
#include "support/test.hpp"

#include <set>

namespace weir {

namespace {

TEST("planes are cut at multiples of 8 where there are enough, of fewer where not, and every rank has some") {
    EXPECT_TRUE(equal_partition(100, 1).empty());
    EXPECT_EQ(equal_partition(64, 4).at, (std::vector<int>{0, 16, 32, 48, 64}));
    EXPECT_EQ(equal_partition(70, 3).at, (std::vector<int>{0, 16, 40, 70}));
    EXPECT_EQ(equal_partition(3, 3).at, (std::vector<int>{0, 1, 2, 3}));
    for (int planes = 1; planes < 80; ++planes)
        for (int ranks = 2; ranks <= std::min(planes, 9); ++ranks) {
            const Partition cut = equal_partition(planes, ranks);
            ASSERT_EQ(cut.ranks(), ranks);
            ASSERT_EQ(cut.planes(), planes);
            for (int r = 0; r < ranks; ++r) ASSERT_LT(cut.begin(r), cut.end(r, planes)) << planes << " planes, " << ranks << " ranks";
        }
}

TEST("cuts by work: the slabs of a tank whose upper half is empty are in its lower half, and every rank has one") {
    std::vector<std::int64_t> half(128, 0);
    std::fill_n(half.begin(), 64, 1000);
    EXPECT_EQ(load_balanced_partition(half, 2).at, (std::vector<int>{0, 32, 128}));
    EXPECT_EQ(load_balanced_partition(half, 4).at, (std::vector<int>{0, 16, 32, 48, 128}));
    EXPECT_TRUE(load_balanced_partition(half, 1).empty());
    const std::vector<std::int64_t> even(64, 7), none(64, 0);
    EXPECT_EQ(load_balanced_partition(even, 4), equal_partition(64, 4));
    EXPECT_EQ(load_balanced_partition(none, 3), equal_partition(64, 3));
    std::vector<std::int64_t> one(20, 0);  // all of it in the last plane
    one.back() = 5;
    for (const int ranks : {2, 3, 7, 20}) {
        const Partition cut = load_balanced_partition(one, ranks);
        for (int r = 0; r < ranks; ++r) EXPECT_LT(cut.begin(r), cut.end(r, 20)) << ranks;
        EXPECT_EQ(cut.planes(), 20);
    }
}

/// Beyond both cuts, plane by plane as one would say it.
std::set<int> wanted(const Partition& cut, int rank, int count, int ghost_planes, bool ring) {
    std::set<int> planes;
    const int n = cut.planes();
    for (int plane = cut.begin(rank) - ghost_planes; plane < cut.end(rank, n) + ghost_planes; ++plane) {
        if (plane >= 0 && plane < count) planes.insert(plane);
        if (ring && (plane < 0 || plane >= n)) planes.insert((plane + 8 * n) % n);
    }
    for (int plane = cut.begin(rank); plane < cut.end(rank, count); ++plane) planes.erase(plane);
    return planes;
}

TEST("what all ranks together send to one are its ghost planes, each once, from its owner; cells and faces, around a ring too") {
    for (const int n : {4, 9, 16, 24, 33})
        for (const int ranks : {2, 3, 4})
            for (const int faces : {0, 1})
                for (const int ghost_planes : {1, 3, 7})
                    for (const bool ring : {false, true}) {
                        const Partition cut = equal_partition(n, ranks);
                        for (int to = 0; to < ranks; ++to) {
                            std::set<int> sent;
                            for (int from = 0; from < ranks; ++from)
                                for (const PlaneRange& range : halo_from(cut, from, to, n + faces, ghost_planes, ring))
                                    for (int plane = range.begin; plane < range.end; ++plane) {
                                        EXPECT_TRUE(plane >= cut.begin(from) && plane < cut.end(from, n + faces));
                                        EXPECT_TRUE(sent.insert(plane).second) << "twice";
                                    }
                            EXPECT_EQ(sent, wanted(cut, to, n + faces, std::min(ghost_planes, n), ring))
                                << n << ' ' << ranks << ' ' << ghost_planes << ' ' << ring;
                        }
                    }
}

TEST("one rank owns everything, and an empty cut changes no loop") {
    EXPECT_FALSE(communicator().several());
    const Partition none = equal_partition(10, communicator().ranks());
    const OwnPlanes mine(none);
    EXPECT_FALSE(is_distributed());
    int visited = 0;
    const int before = set_threads(1);
    for_each_cell(Index<2>{{3, 10}}, [&](const Index<2>&) { ++visited; });
    set_threads(before);
    EXPECT_EQ(visited, 30);
    Grid<real, 2> q(Index<2>{{3, 10}}, 2);
    refresh(q, true, 3);
    gather(q);
    EXPECT_EQ(sum_over(q.extent(), [&](const Index<2>& I) { return q(I); }), 60);
    EXPECT_EQ(communicator().traffic().messages, 0);
}

/// Two ranks of which the other answers with a plane's own number, as a rank whose planes hold those would.
class Echo final : public Communicator {
public:
    Echo() : Communicator(1, 2) {}
    void gather(const Partition& cut, const Planes& planes) override {
        auto* values = static_cast<real*>(planes.first);
        for (int plane = 0; plane < cut.end(0, planes.count); ++plane) values[plane] = plane;
    }
};

TEST("in parallel a loop does its own planes, and a sum adds those of all ranks in the order of the planes") {
    set_communicator(std::make_unique<Echo>());
    {
        const Partition cut = equal_partition(16, 2);
        const OwnPlanes mine(cut);
        std::vector<int> seen(17, 0);
        for_each_plane(0, 17, [&](int plane) { seen[static_cast<std::size_t>(plane)] = 1; });  // 17: faces
        for (int plane = 0; plane < 17; ++plane) EXPECT_EQ(seen[static_cast<std::size_t>(plane)], plane >= 8 ? 1 : 0);
        EXPECT_EQ(plane_sum(16, [](int plane) { return real(plane); }), 120);
        EXPECT_EQ(plane_max(16, [](int plane) { return -real(plane); }), 7);  // of the other's, which echo their numbers
        const AllPlanes all;
        EXPECT_FALSE(is_distributed());
        EXPECT_EQ(plane_max(16, [](int plane) { return -real(plane); }), 0);
    }
    set_communicator(nullptr);
    EXPECT_FALSE(is_distributed());
}

}  // namespace

}  // namespace weir
