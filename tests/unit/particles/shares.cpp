// Who computes which particles over several ranks, against the definition: every neighbour of what a rank owns is known to it, and comes
// from the one rank that owns it; what is known to none is poisoned.
#include "particles/shares.hpp"
#include "particles/pairs.hpp"

#include "support/test.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

using namespace weir;
using namespace weir::particles;

namespace {

/// A rank that is alone: what it would send goes nowhere.
class Alone final : public Slabs {
public:
    Alone(int rank, int ranks) : Slabs(rank, ranks) {}
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

/// What stands closer than the radius to sorted entry k, as one rank finds it, which places all.
std::vector<int> beside(const Pairs& all, int k, real radius) {
    std::vector<int> list;
    for (int j = 0; j < all.size(); ++j) {
        real squares = 0;
        for (int a = 0; a < 3; ++a) squares += std::pow(static_cast<real>(all.found_at(j, a)) - static_cast<real>(all.found_at(k, a)), 2);
        if (j != k && squares < radius * radius) list.push_back(j);
    }
    return list;
}

constexpr real radius = 0.12;

/// The pairs of each rank, found by itself.
std::vector<std::unique_ptr<Pairs>> pairs_of_ranks(const Cloud& c, int ranks) {
    std::vector<std::unique_ptr<Pairs>> list;
    for (int rank = 0; rank < ranks; ++rank) {
        set_slabs(std::make_unique<Alone>(rank, ranks));
        list.push_back(std::make_unique<Pairs>(passes_for("sse2"), c.frame));
        list.back()->find(c.coordinates(), c.count(), radius);
    }
    set_slabs(nullptr);
    return list;
}

void expect_known(const Pairs& all, const Pairs& mine) {
    const Shares& shares = mine.shares();
    std::set<int> got;
    for (int peer = 0; peer < 3; ++peer)
        for (const int k : shares.got_from(peer)) {
            EXPECT_TRUE(shares.own(peer).has(k)) << "from another than its owner";
            EXPECT_TRUE(got.insert(k).second) << "twice";
        }
    std::map<int, int> at;  // where the particles of the state are
    for (int k = 0; k < all.size(); ++k)
        if (!all.is_image(k)) at[all.owner(k)] = k;
    for (int k = shares.own().begin; k < shares.own().end; ++k)
        for (const int j : beside(all, k, radius)) {
            ASSERT_TRUE(shares.read().has(j)) << "a neighbour is not read";
            EXPECT_EQ(mine.found_at(j, 0), all.found_at(j, 0));
            const int particle = at[all.owner(j)];
            EXPECT_TRUE(shares.own().has(particle) || got.count(particle)) << "a neighbour's particle is not known";
        }
}

TEST("over ranks every neighbour of an own particle, or image, is read and known, and comes from its owner, once") {
    for (const int dim : {2, 3})
        for (const bool repeats : {false, true}) {
            const Cloud c = cloud(dim == 2 ? 500 : 700, dim, repeats);
            Pairs all(passes_for("sse2"), c.frame);
            all.find(c.coordinates(), c.count(), radius);
            const auto ranks = pairs_of_ranks(c, 3);
            int next = 0;
            for (int r = 0; r < 3; ++r) {
                const Shares& shares = ranks[static_cast<std::size_t>(r)]->shares();
                EXPECT_EQ(shares.own().begin, next);
                next = shares.own().end;
                expect_known(all, *ranks[static_cast<std::size_t>(r)]);
                for (int peer = 0; peer < 3; ++peer)
                    EXPECT_TRUE(std::ranges::equal(shares.sent_to(peer), ranks[static_cast<std::size_t>(peer)]->shares().got_from(r)));
            }
            EXPECT_EQ(next, all.size());
        }
}

TEST("over ranks the neighbours of own particles are those of one rank; where nothing was placed stands NaN") {
    const Cloud c = cloud(500, 2, true);
    Pairs all(passes_for("sse2"), c.frame);
    all.find(c.coordinates(), c.count(), radius);
    const auto ranks = pairs_of_ranks(c, 3);
    for (const auto& mine : ranks) {
        int unplaced = 0;
        for (int k = 0; k < all.size(); ++k) {
            if (mine->shares().own().has(k)) {
                EXPECT_EQ(mine->list().neighbours()[static_cast<std::size_t>(k)], all.list().neighbours()[static_cast<std::size_t>(k)]);
            }
            if (mine->shares().read().has(k)) continue;
            ++unplaced;
            EXPECT_TRUE(std::isnan(mine->a()[4 * k]));
        }
        EXPECT_GT(unplaced, 0);
    }
}

TEST("more ranks than slices of particles: some have none, and know nothing") {
    const Cloud c = cloud(5, 2, false);
    const auto ranks = pairs_of_ranks(c, 3);
    int owned = 0;
    for (const auto& mine : ranks) owned += mine->shares().own().count();
    EXPECT_EQ(owned, 5);
}

}  // namespace
