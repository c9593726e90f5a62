// Who computes which particles over several ranks, against one process: from its own particles and those shown to it, in any order, a rank
// sorts what it owns as one process does, with the same neighbours, and what it has of others comes from their owners.
#include "particles/ranks/shares.hpp"
#include "particles/threads/pairs.hpp"

#include "support/test.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <set>

namespace shares_tests {

using namespace weir;
using namespace weir::particles;

namespace {

/// A rank that is alone: what it would send goes nowhere.
class Alone final : public Communicator {
public:
    Alone(int rank, int ranks) : Communicator(rank, ranks) {}
    bool poisons() const override { return true; }
};

struct Cloud {
    std::array<std::vector<real>, 3> x;
    int dim = 2;
    Frame frame;
    Coordinates coordinates() const { return {x[0].data(), x[1].data(), dim == 3 ? x[2].data() : nullptr}; }
    int count() const { return static_cast<int>(x[0].size()); }
};

/// In the unit box, whose axes repeat or do not.
Cloud cloud(int count, int dim, bool repeats) {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> anywhere(0, 1);
    Cloud c;
    c.dim = dim;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
        for (int i = 0; i < count; ++i) c.x[a].push_back(anywhere(random));
        c.frame.centre[a] = 0.5;
        if (repeats) c.frame.period[a] = 1;
    }
    return c;
}

constexpr real radius = 0.12;

struct Rank {
    std::vector<int> held;    // of the cloud, in an order of its own
    std::vector<real> place;  // of each of these: its number in the cloud
    std::array<std::vector<real>, 3> x;
    std::unique_ptr<Pairs> pairs;
};

/// The cloud as one process sorts it, and as ranks do whose cells are cut.
struct Shared {
    Pairs all;
    CellCut cut;
    std::vector<Rank> ranks;

    Shared(const Cloud& c, int count) : all(passes_for("sse2"), c.frame) {
        all.find(c.coordinates(), c.count(), radius);
        const auto& cells = all.cells().cells();
        std::vector<int> at{0};
        for (int r = 1; r <= count; ++r) at.push_back(cells[0] * cells[1] * cells[2] * r / count);
        cut = CellCut(at, cells);
        Box box;
        for (std::size_t a = 0; a < static_cast<std::size_t>(c.dim); ++a) {
            box.lo[a] = *std::min_element(c.x[a].begin(), c.x[a].end());
            box.hi[a] = *std::max_element(c.x[a].begin(), c.x[a].end());
        }
        for (int r = 0; r < count; ++r) {
            set_communicator(std::make_unique<Alone>(r, count));
            ranks.push_back(rank(c, r, box));
        }
        set_communicator(nullptr);
    }
    /// By the definition: it holds what stands in its cells, and what it reads there or of an image there.
    Rank rank(const Cloud& c, int r, const Box& box) const {
        std::set<int> held;
        for (int k = 0; k < all.size(); ++k) {
            const int cell = all.cells().cell_of()[static_cast<std::size_t>(k)];
            if (cut.reads(r, cell) || (!all.is_image(k) && cut.owner(cell) == r)) held.insert(all.owner(k));
        }
        Rank one;
        one.held.assign(held.begin(), held.end());
        std::shuffle(one.held.begin(), one.held.end(), std::mt19937(5));
        for (const int i : one.held) {
            one.place.push_back(i);
            for (std::size_t a = 0; a < static_cast<std::size_t>(c.dim); ++a) one.x[a].push_back(c.x[a][static_cast<std::size_t>(i)]);
        }
        one.pairs = std::make_unique<Pairs>(passes_for("sse2"), c.frame);
        one.pairs->find({one.x[0].data(), one.x[1].data(), c.dim == 3 ? one.x[2].data() : nullptr}, static_cast<int>(one.held.size()),
                        radius, {box, c.count(), &cut, one.place.data()});
        return one;
    }
    /// The cloud's particle at sorted entry k of a rank.
    int who(int r, int k) const {
        const Rank& one = ranks[static_cast<std::size_t>(r)];
        return one.held[static_cast<std::size_t>(one.pairs->owner(k))];
    }
    std::vector<int> who(int r, std::span<const int> entries) const {
        std::vector<int> list;
        for (const int k : entries) list.push_back(who(r, k));
        return list;
    }
};

std::vector<Cloud> clouds() { return {cloud(500, 2, false), cloud(500, 2, true), cloud(700, 3, false), cloud(700, 3, true)}; }

TEST("in parallel own particles and images are those of one process, in its order, with as many neighbours") {
    for (const Cloud& c : clouds()) {
        const Shared shared(c, 3);
        int at = 0;
        for (int r = 0; r < 3; ++r) {
            const Pairs& mine = *shared.ranks[static_cast<std::size_t>(r)].pairs;
            for (int k = mine.shares().own().begin; k < mine.shares().own().end; ++k, ++at) {
                EXPECT_EQ(shared.who(r, k), shared.all.owner(at));
                EXPECT_EQ(mine.is_image(k), shared.all.is_image(at));
                for (int a = 0; a < c.dim; ++a) EXPECT_EQ(mine.found_at(k, a), shared.all.found_at(at, a));
                EXPECT_EQ(mine.list().neighbours()[static_cast<std::size_t>(k)],
                          shared.all.list().neighbours()[static_cast<std::size_t>(at)]);
            }
        }
        EXPECT_EQ(at, shared.all.size());
    }
}

TEST("in parallel what one sends is what the other gets, in the same order, and all that a rank holds of others comes from their owners") {
    for (const Cloud& c : clouds()) {
        const Shared shared(c, 3);
        for (int r = 0; r < 3; ++r) {
            const Shares& shares = shared.ranks[static_cast<std::size_t>(r)].pairs->shares();
            std::set<int> got;
            for (int peer = 0; peer < 3; ++peer) {
                const Shares& theirs = shared.ranks[static_cast<std::size_t>(peer)].pairs->shares();
                EXPECT_EQ(shared.who(r, shares.sent_to(peer)), shared.who(peer, theirs.got_from(r)));
                for (const int k : shares.got_from(peer)) {
                    const int cell = shared.ranks[static_cast<std::size_t>(r)].pairs->cells().cell_of()[static_cast<std::size_t>(k)];
                    EXPECT_EQ(shared.cut.owner(cell), peer) << "from another than its owner";
                    EXPECT_TRUE(got.insert(k).second) << "twice";
                }
            }
            int own = 0;
            const Pairs& mine = *shared.ranks[static_cast<std::size_t>(r)].pairs;
            for (int k = shares.own().begin; k < shares.own().end; ++k) own += !mine.is_image(k);
            EXPECT_EQ(own + static_cast<int>(got.size()), mine.particles());
        }
    }
}

TEST("in parallel where nothing was placed stands NaN") {
    const Shared shared(cloud(500, 2, true), 3);
    int unplaced = 0;
    for (const Rank& rank : shared.ranks)
        for (int k = 0; k < rank.pairs->size(); ++k) {
            if (rank.pairs->shares().read().has(k)) continue;
            ++unplaced;
            EXPECT_TRUE(std::isnan(rank.pairs->a()[4 * k]));
        }
    EXPECT_GT(unplaced, 0);
}

TEST("in parallel the sort has cells of this rank and those that it reads, and no others, where axes repeat or not") {
    const int threads_before = set_threads(2);
    for (const int dim : {2, 3})
        for (const bool repeats : {false, true}) {
            Cloud column = cloud(4000, dim, false);
            const auto last = static_cast<std::size_t>(dim) - 1;
            for (real& here : column.x[last]) here *= 50;  // cells are many and mostly empty
            if (repeats) column.frame.period = {1, dim == 3 ? 1.0 : 50.0, dim == 3 ? 50.0 : 0};
            const Shared shared(column, 4);
            for (int r = 0; r < 4; ++r) {
                const CellSort& cells = shared.ranks[static_cast<std::size_t>(r)].pairs->cells();
                const auto [first, end] = shared.cut.read(r);
                const auto window = static_cast<std::size_t>(end - first), held = static_cast<std::size_t>(cells.count());
                EXPECT_EQ(cells.start().size(), window + 1);
                // cell starts and a count a thread, of these cells and one bin for all others, with half as much room; 3 numbers a particle
                EXPECT_LE(cells.bytes(), (3 * (window + 1 + (window + 1) / 2 + 1) + 3 * held) * sizeof(int));
                EXPECT_LT(4 * window, shared.all.cells().start().size() * 3 / 2);  // a quarter and what lies beside it
            }
        }
    set_threads(threads_before);
}

TEST("more ranks than cells with particles: some have none, and all are somebody's") {
    const Shared shared(cloud(5, 2, false), 8);
    int owned = 0;
    for (const Rank& rank : shared.ranks) owned += rank.pairs->shares().own().count();
    EXPECT_EQ(owned, 5);
}

}  // namespace

}  // namespace shares_tests
