// Who owns which planes and what travels: arithmetic that all ranks do alike, against its definition; and that one rank asks for nothing.
#include "parallel/grid.hpp"
#include "parallel/load_balance.hpp"
#include "support/forked_ranks.hpp"
#include "support/test.hpp"

#include <cmath>
#include <csignal>
#include <numeric>
#include <set>

namespace weir::slabs_tests {

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
    EXPECT_EQ(slab_of(none), nullptr);
    const Extent<2> extent(Index<2>{{3, 10}}, OwnPlanes(slab_of(none)));
    EXPECT_FALSE(extent.own.distributed());
    EXPECT_EQ(extent.own, OwnPlanes());
    int visited = 0;
    const int before = set_threads(1);
    for_each_cell(extent, [&](const Index<2>&) { ++visited; });
    set_threads(before);
    EXPECT_EQ(visited, 30);
    Grid<real, 2> q(extent, 2);
    refresh(q, true, 3);
    gather(q);
    EXPECT_EQ(sum_over(q.extent(), [&](const Index<2>& I) { return q(I); }), 60);
    EXPECT_EQ(communicator().traffic().messages, 0);
}

/// Equal slabs are one object: an extent tells by a pointer whether two grids share a partition.
TEST("a slab is this rank's part of a partition; the planes beyond the ends of the axis belong to the first and to the last rank") {
    const Partition cut = equal_partition(24, 3);
    const auto planes_of_rank = [&](int rank) {
        set_communicator(std::make_unique<Communicator>(rank, 3));
        const Slab* slab = slab_of(cut, 2);
        EXPECT_EQ(slab, slab_of(equal_partition(24, 3), 2));
        EXPECT_NE(slab, slab_of(cut, 3));
        EXPECT_NE(slab, slab_of(cut, 2, true));
        EXPECT_EQ(slab->rank(), rank);
        const OwnPlanes own(slab);
        set_communicator(nullptr);
        return own;
    };
    const OwnPlanes first = planes_of_rank(0), second = planes_of_rank(1), last = planes_of_rank(2);
    EXPECT_TRUE(first.contains(-1) && first.contains(7) && !first.contains(8));
    EXPECT_TRUE(!second.contains(7) && second.contains(8) && second.contains(15) && !second.contains(16));
    EXPECT_TRUE(!last.contains(15) && last.contains(16) && last.contains(24));
    EXPECT_EQ(second.lower(0), 8);
    EXPECT_EQ(second.upper(24), 16);
    EXPECT_EQ(second.lower(10), 10);
    EXPECT_EQ(second.upper(12), 12);
    EXPECT_EQ(second.wider(3).lower(0), 5);
    EXPECT_EQ(second.wider(3).upper(24), 19);
    EXPECT_EQ(first.wider(3).lower(-4), -4);
    EXPECT_EQ(first.wider(3).upper(24), 11);
    EXPECT_EQ(last.wider(3).lower(0), 13);
    EXPECT_EQ(last.wider(3).upper(26), 26);
    const Index<2> cells{{5, 24}};
    const Extent<2> extent(cells, second), faces = extent + e<2>(1);
    EXPECT_EQ(faces.own, second);
    EXPECT_EQ(faces[1], 25);
    EXPECT_EQ((extent - e<2>(0)).own, second);
    EXPECT_FALSE(replicated<2>(extent).own.distributed());
}

TEST("in parallel a loop does its own planes, and a sum adds those of all ranks, exactly") {
    for (const int ranks : {1, 2, 3})
        test::on_ranks(ranks, [ranks] {
            const OwnPlanes own(slab_of(equal_partition(16, ranks)));
            EXPECT_EQ(own.distributed(), ranks > 1);
            const int begin = 16 * communicator().rank() / ranks, last = communicator().rank() + 1 == ranks;
            std::vector<int> seen(17, 0);
            for_each_plane(own, 0, 17, [&](int plane) { seen[static_cast<std::size_t>(plane)] = 1; });  // 17: faces
            EXPECT_EQ(seen[0], communicator().rank() == 0);
            EXPECT_EQ(seen[16], last);
            if (ranks == 2) {
                EXPECT_EQ(seen[7] + 10 * seen[8], begin == 0 ? 1 : 10);
            }
            const auto term = [](int plane) { return plane == 3 ? 1e20 : plane == 12 ? -1e20 : real(plane); };
            EXPECT_EQ(plane_sum(own, 16, term), 120 - 3 - 12);  // lost in a sum in floating point
            EXPECT_EQ(plane_max(own, 16, [](int plane) { return -real(plane); }), 0);
            EXPECT_TRUE(std::isnan(plane_max(own, 16, [](int plane) { return plane == 9 ? std::nan("") : 1; })));
            EXPECT_EQ(sum_of_ranks(own, std::int64_t{communicator().rank() + 1}), ranks * (ranks + 1) / 2);
        });
}

TEST("loops and sums over a grid follow its extent; over a replicated box they cover all of it on every rank") {
    test::on_ranks(2, [] {
        const bool upper = communicator().rank() == 1;
        const Index<2> cells{{3, 16}};
        const Grid<real, 2> q(Extent<2>(cells, OwnPlanes(slab_of(equal_partition(16, 2)))), 1);
        EXPECT_TRUE(q.own().distributed() && !q.own().distributed_storage());
        EXPECT_EQ(q.bytes(), q.size() * sizeof(real));  // all planes are stored
        const auto one = [](const Index<2>&) { return 1.0; };
        const auto visited = [](const Index<2>& lo, const Extent<2>& hi) {
            std::vector<int> cells_in_plane(32, 0);
            for_each_in(lo, hi, [&](const Index<2>& I) { ++cells_in_plane[static_cast<std::size_t>(I[1])]; });
            return std::accumulate(cells_in_plane.begin(), cells_in_plane.end(), 0);
        };
        EXPECT_EQ(sum_over(q.extent(), one), 48);
        EXPECT_EQ(sum_over(replicated(cells), one), 48);
        EXPECT_EQ(visited({}, q.extent()), 24);
        EXPECT_EQ(visited({}, q.extent() + e<2>(1)), upper ? 27 : 24);
        EXPECT_EQ(visited({}, q.extent().wider(2)), 30);
        EXPECT_EQ(visited({}, replicated(cells)), 48);
        EXPECT_EQ(visited(Index<2>{{1, 10}}, q.extent()), upper ? 12 : 0);
        const Grid<real, 2> copy = q;
        EXPECT_EQ(copy.own(), q.own());
    });
}

}  // namespace

TEST("after a halo exchange a rank knows its own planes and its ghosts; where stale ghosts are poisoned, all others are NaN") {
    constexpr int planes = 24, ranks = 3, ghosts = 2;
    const Partition cut = equal_partition(planes, ranks);
    for (const bool poisons : {false, true})
        test::on_ranks(
            ranks,
            [&] {
                const int here = communicator().rank();
                std::vector<double> values(planes, -1);
                for (int plane = cut.begin(here); plane < cut.end(here, planes); ++plane) values[static_cast<std::size_t>(plane)] = plane;
                const Planes array{values.data(), sizeof(double), planes};
                communicator().refresh(cut, {&array, 1}, ghosts, false);
                for (int plane = 0; plane < planes; ++plane) {
                    const double value = values[static_cast<std::size_t>(plane)];
                    if (plane >= cut.begin(here) - ghosts && plane < cut.end(here, planes) + ghosts)
                        EXPECT_EQ(value, plane);
                    else
                        EXPECT_TRUE(poisons ? std::isnan(value) : value == -1) << plane << ": " << value;
                }
            },
            poisons);
}

TEST("of forked ranks that fail the cause is told, not its consequences") {
    const auto thrown = fork_ranks(3, [](ForkedRanks& self) -> std::string {
        if (self.rank() == 1) throw std::runtime_error("no memory");
        self.largest(0);  // waits for rank 1
        return "";
    });
    ASSERT_NE(cause_of_failure(thrown), nullptr);
    EXPECT_EQ(cause_of_failure(thrown)->said, "no memory");
    EXPECT_EQ(cause_of_failure(thrown), &thrown[1]);
    const auto killed = fork_ranks(2, [](ForkedRanks& self) -> std::string {
        if (self.rank() == 1) std::raise(SIGKILL);
        self.largest(0);
        return "";
    });
    ASSERT_NE(cause_of_failure(killed), nullptr);
    EXPECT_EQ(cause_of_failure(killed)->said, "rank 1 was ended by signal 9");
    EXPECT_EQ(cause_of_failure(killed)->status, 128 + SIGKILL);
    EXPECT_EQ(cause_of_failure(fork_ranks(2, [](ForkedRanks&) { return std::string("done"); })), nullptr);
}

}  // namespace weir::slabs_tests
