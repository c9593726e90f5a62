// Arrays of which a rank holds its own planes alone: which planes those are, that there is no memory behind the others, and that nothing is
// lost where more are opened and given back.
#include "parallel/plane_store.hpp"
#include "parallel/grid.hpp"
#include "support/test.hpp"

#include <csignal>
#include <vector>

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace weir::plane_store_tests {

namespace {

/// The second of three ranks, which never talks to the others.
class Alone final : public Communicator {
public:
    Alone() : Communicator(1, 3) {}
};

/// While it lives there are three ranks of 24 planes.
class ThreeRanks {
public:
    ThreeRanks() { set_communicator(std::make_unique<Alone>()); }
    ~ThreeRanks() { set_communicator(nullptr); }
    ThreeRanks(const ThreeRanks&) = delete;
    ThreeRanks& operator=(const ThreeRanks&) = delete;
    /// Arrays on this rank's planes; with ghost planes, of distributed storage.
    OwnPlanes own(int ghost_planes = 0) const { return OwnPlanes(slab_of(equal_partition(24, 3), ghost_planes)); }
};

/// Does f die of looking where there is no memory?
template <class F>
bool faults(F&& f) {
    const pid_t child = fork();
    if (child == 0) {
        std::signal(SIGSEGV, SIG_DFL);
        f();
        _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status) && WTERMSIG(status) == SIGSEGV;
}

/// Bytes of an array that stand in memory.
template <class T, int D>
std::size_t resident(const Grid<T, D>& q) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::vector<unsigned char> in(q.size() * sizeof(T) / page + 1);
    const auto begin = reinterpret_cast<std::uintptr_t>(q.data()) / page * page;
    if (mincore(reinterpret_cast<void*>(begin), q.size() * sizeof(T), in.data()) != 0) return 0;
    std::size_t bytes = 0;
    for (const unsigned char here : in) bytes += (here & 1) * page;
    return bytes;
}

TEST("a rank holds its planes and that number of ghost planes, around a ring too, and what lies beyond an end that it comes to") {
    const Partition cut{{0, 8, 16, 24}};
    const auto list = [&](int rank, int count, int margin, int ghost_planes, bool ring) {
        std::vector<int> planes;
        const auto held = planes_held(cut, rank, count, margin, ghost_planes, ring);
        for (int k = 0; k < static_cast<int>(held.size()); ++k)
            if (held[static_cast<std::size_t>(k)] != 0) planes.push_back(k - margin);
        return planes;
    };
    EXPECT_EQ(list(1, 24, 0, 2, false), (std::vector<int>{6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18}));
    EXPECT_EQ(list(0, 24, 1, 1, false), (std::vector<int>{-1, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(list(2, 25, 1, 1, false), (std::vector<int>{15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25}));
    EXPECT_EQ(list(0, 25, 0, 2, true), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 22, 23, 24}));  // 24: face 0 again
    EXPECT_EQ(list(2, 24, 0, 1, true), (std::vector<int>{0, 1, 15, 16, 17, 18, 19, 20, 21, 22, 23}));
}

TEST(
    "near a rank's own planes are those beside them: around a ring the last too, and there face n is face 0; where one does all, all are") {
    const ThreeRanks three;
    EXPECT_TRUE(planes_near(nullptr, 24, 2, false).empty());
    const Slab* const slab = three.own().slab;
    const auto list = [slab](int count, int ghost_planes, bool ring) {
        std::vector<int> planes;
        const auto near = planes_near(slab, count, ghost_planes, ring);
        EXPECT_EQ(static_cast<int>(near.size()), count);
        for (int k = 0; k < count; ++k)
            if (near[static_cast<std::size_t>(k)] != 0) planes.push_back(k);
        return planes;
    };
    EXPECT_EQ(list(24, 2, false), (std::vector<int>{6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17}));
    EXPECT_EQ(list(24, 9, false).front(), 0);
    EXPECT_EQ(list(24, 9, false).back(), 23);
    EXPECT_EQ(list(25, 9, false).back(), 24);
    EXPECT_EQ(list(24, 7, true).front(), 1);
    EXPECT_EQ(list(24, 7, true).back(), 22);
    EXPECT_EQ(list(24, 8, true), list(24, 100, true));
    EXPECT_EQ(list(25, 7, true).back(), 22);
    const auto faces = planes_near(slab, 25, 9, true);  // 24, which is 0
    EXPECT_TRUE(faces[24] != 0 && faces[0] != 0);
}

TEST("a copy of as many planes takes no other memory: what is done in every step maps none") {
    const ThreeRanks three;
    const Extent<2> extent(Index<2>{{512, 24}}, three.own(2));
    Grid<real, 2> from(extent, 7), to(extent, 3);
    const real* const place = to.data();
    to.store().open(4, false);
    to(Index<2>{{0, 4}}) = 5;
    to = from;
    EXPECT_EQ(to.data(), place);
    EXPECT_EQ(to(Index<2>{{0, 6}}), 7);
    EXPECT_EQ(to(Index<2>{{0, 4}}), 5);  // not among those that the other holds
    EXPECT_TRUE(from.store().reaches(2) && !from.store().reaches(3) && to.store().reaches(4));
}

TEST("behind the planes of others there is no memory: an access to them faults; those that are opened keep what stood there") {
    const ThreeRanks three;
    const Extent<3> extent(Index<3>{{64, 32, 24}}, three.own(2));
    const std::size_t plane = 64 * 32 * sizeof(real);
    {
        Grid<real, 3> q(extent, 7);
        EXPECT_EQ(q.size(), product<3>(extent));
        EXPECT_EQ(q.bytes(), 13 * plane);
        EXPECT_EQ(resident(q), 13 * plane);  // planes are whole pages here
        EXPECT_EQ(q(Index<3>{{0, 0, 6}}), 7);
        EXPECT_EQ(q(Index<3>{{63, 31, 18}}), 7);
        EXPECT_TRUE(faults([&] { q(Index<3>{{63, 31, 5}}) = 1; }));
        EXPECT_TRUE(faults([&] { q(Index<3>{{0, 0, 19}}) = 1; }));
        EXPECT_FALSE(faults([&] { q(Index<3>{{0, 0, 18}}) = 1; }));
        q.store().open(4, false);
        EXPECT_EQ(q.bytes(), 17 * plane);
        EXPECT_EQ(q(Index<3>{{5, 5, 6}}), 7);
        EXPECT_EQ(q(Index<3>{{5, 5, 4}}), 0);
        const Grid<real, 3> copy = q;
        EXPECT_EQ(copy.bytes(), q.bytes());
        EXPECT_EQ(copy(Index<3>{{5, 5, 6}}), 7);
        q.store().open_all();
        q.fill(3);
        EXPECT_EQ(resident(q), 24 * plane);
        q.store().close();
        EXPECT_EQ(resident(q), 17 * plane);
        EXPECT_EQ(q(Index<3>{{5, 5, 4}}), 3);
        EXPECT_TRUE(faults([&] { q(Index<3>{{0, 0, 0}}) = 1; }));
        int planes = 0;
        for_each_held(q, Index<3>{}, Index<3>{{1, 1, 24}}, [&](const Index<3>&) { ++planes; });
        EXPECT_EQ(planes, 17);
    }
}

TEST("an array that has not the planes of the cut is whole, as all are without distributed storage") {
    const ThreeRanks three;
    const auto stored = [](int planes, const OwnPlanes& own) {
        const Grid<real, 2> q(Extent<2>(Index<2>{{8, planes}}, own));
        int count = 0;
        for (int plane = 0; plane < planes; ++plane) count += q.store().holds(plane) ? 1 : 0;
        EXPECT_EQ(q.bytes(), static_cast<std::size_t>(count) * 8 * sizeof(real));
        return count;
    };
    EXPECT_EQ(stored(24, three.own(2)), 13);  // [6, 19)
    EXPECT_EQ(stored(25, three.own(2)), 13);  // faces
    EXPECT_EQ(stored(23, three.own(2)), 23);
    EXPECT_EQ(stored(24, three.own()), 24);
    EXPECT_EQ(stored(24, {}), 24);
}

}  // namespace

}  // namespace weir::plane_store_tests
