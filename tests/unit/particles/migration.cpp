// Particles that migrate between ranks, against the definition: the rank that owns the cell where a particle stands owns it, with all that
// the state knows of it, and it is a ghost particle of the ranks that read that cell or one of an image of it. Each rank is a process of
// its own.
#include "particles/ranks/migration.hpp"
#include "core/error.hpp"
#include "particles/threads/pairs.hpp"

#include "support/forked_ranks.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace migration_tests {

using namespace weir;
using namespace weir::particles;

namespace {

constexpr real radius = 0.12;

/// All particles of all ranks, as every rank knows them here: in the unit box.
struct Cloud {
    int dim = 2;
    std::array<std::vector<real>, 3> x;
    Frame frame;

    Cloud(int axes, bool repeats) : dim(axes) {
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) frame.centre[a] = 0.5, frame.period[a] = repeats ? 1 : 0;
    }
    int count() const { return static_cast<int>(x[0].size()); }
    Coordinates coordinates() const { return {x[0].data(), x[1].data(), dim == 3 ? x[2].data() : nullptr}; }
    void scatter(int count, int seed) {
        std::mt19937 random(static_cast<unsigned>(seed));
        std::uniform_real_distribution<real> anywhere(0, 1);
        for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
            x[a].resize(static_cast<std::size_t>(count));
            for (real& here : x[a]) here = anywhere(random);
        }
    }
    void put(int i, real along_x, real along_y) {
        x[0][static_cast<std::size_t>(i)] = along_x;
        x[1][static_cast<std::size_t>(i)] = along_y;
    }
};

/// What a rank holds: positions, places, what is shown of a particle, and what is not.
struct State {
    int dim;
    std::vector<std::vector<real>> numbers;
    Migration migration;
    static constexpr real shown = 1000, kept = 5000;  // plus its number

    State(const Cloud& cloud, const std::function<int(int)>& rank_of) : dim(cloud.dim), numbers(static_cast<std::size_t>(dim) + 3) {
        for (int i = 0; i < cloud.count(); ++i) {
            if (rank_of(i) != communicator().rank()) continue;
            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) numbers[a].push_back(cloud.x[a][static_cast<std::size_t>(i)]);
            place().push_back(i);
            numbers[numbers.size() - 2].push_back(shown + i);
            numbers.back().push_back(kept + i);
        }
    }
    std::vector<real>& place() { return numbers[static_cast<std::size_t>(dim)]; }
    int who(int k) { return static_cast<int>(place()[static_cast<std::size_t>(k)]); }
    ParticleExchange::Arrays arrays() {
        ParticleExchange::Arrays list;
        for (auto& array : numbers) list.push_back(&array);
        return list;
    }
    /// As a step does: ghosts are dropped, own ones move, and all migrate.
    void follow(const Cloud& cloud) {
        for (auto& array : numbers)
            if (migration.total() > 0) array.resize(static_cast<std::size_t>(migration.own()));
        for (int k = 0; k < static_cast<int>(place().size()); ++k)
            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
                numbers[a][static_cast<std::size_t>(k)] = cloud.x[a][static_cast<std::size_t>(who(k))];
        migration.apply(cloud.frame, radius, dim, arrays(), static_cast<std::size_t>(dim) + 2);
    }
    std::set<int> own() {
        std::set<int> list;
        for (int k = 0; k < migration.own(); ++k) EXPECT_TRUE(list.insert(who(k)).second) << "twice";
        return list;
    }
    std::set<int> ghosts() {
        std::set<int> list;
        for (int k = migration.own(); k < static_cast<int>(place().size()); ++k) EXPECT_TRUE(list.insert(who(k)).second) << "twice";
        return list;
    }
};

/// One process' sort of all of the cloud says which cells and images there are.
void expect_as_defined(const Cloud& cloud, State& state) {
    Pairs all(passes_for("sse2"), cloud.frame);
    all.find(cloud.coordinates(), cloud.count(), radius);
    const CellCut& cut = *state.migration.held(state.place()).cut;
    std::set<int> own, ghosts;
    for (int k = 0; k < all.size(); ++k) {
        const int cell = all.cells().cell_of()[static_cast<std::size_t>(k)];
        if (!all.is_image(k) && cut.owner(cell) == communicator().rank()) own.insert(all.owner(k));
        if (cut.reads(communicator().rank(), cell)) ghosts.insert(all.owner(k));
    }
    for (const int i : own) ghosts.erase(i);
    EXPECT_EQ(state.own(), own) << "rank " << communicator().rank();
    EXPECT_EQ(state.ghosts(), ghosts) << "rank " << communicator().rank();
    for (int k = 0; k < static_cast<int>(state.place().size()); ++k) {
        const auto at = static_cast<std::size_t>(k), i = static_cast<std::size_t>(state.who(k));
        for (std::size_t a = 0; a < static_cast<std::size_t>(cloud.dim); ++a) ASSERT_EQ(state.numbers[a][at], cloud.x[a][i]);
        ASSERT_EQ(state.numbers[state.numbers.size() - 2][at], State::shown + state.who(k));
        const real kept = state.numbers.back()[at];  // ghosts lack it, and here it is poisoned
        ASSERT_TRUE(k < state.migration.own() ? kept == State::kept + state.who(k) : std::isnan(kept));
    }
    const std::vector<int> counts = of_ranks(state.migration.own());
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), cloud.count());
    EXPECT_EQ(state.migration.total(), cloud.count());
    EXPECT_EQ(state.migration.before(), std::accumulate(counts.begin(), counts.begin() + communicator().rank(), 0));
}

TEST(
    "from whatever rank has them, particles come to the owners of their cells and are shown to those who read them or an image, as they "
    "move") {
    for (const int dim : {2, 3})
        for (const bool repeats : {false, true})
            for (const int ranks : {2, 3, 5})
                test::on_ranks(
                    ranks,
                    [&] {
                        Cloud cloud(dim, repeats);
                        cloud.scatter(600, 1);
                        State state(cloud, [&](int i) { return i % ranks; });
                        state.follow(cloud);
                        expect_as_defined(cloud, state);
                        for (std::size_t i = 0; i < 600; ++i)  // no farther than to a neighbour's cell
                            for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a)
                                cloud.x[a][i] = std::fmod(cloud.x[a][i] + 0.03 * static_cast<real>(i % 3), 1);
                        state.follow(cloud);
                        expect_as_defined(cloud, state);
                        cloud.scatter(600, 2);  // anywhere
                        state.follow(cloud);
                        expect_as_defined(cloud, state);
                    },
                    true);
}

TEST("a particle goes to a neighbour below or above, to a rank that is none, and through a side that repeats, and no other moves") {
    test::on_ranks(
        4,
        [] {
            Cloud cloud(2, true);
            const int rows = 40;  // of 20: every rank owns 10 rows, but for a part of one
            for (int i = 0; i < 20 * rows; ++i) {
                cloud.x[0].push_back((i % 20 + 0.5) / 20);
                cloud.x[1].push_back((i / 20 + 0.5) / rows);
            }
            State state(cloud, [](int i) { return i / 200; });
            state.follow(cloud);
            const auto owner = [&](int i) {
                const std::vector<int> has = of_ranks(static_cast<int>(state.own().count(i)));
                return static_cast<int>(std::find(has.begin(), has.end(), 1) - has.begin());
            };
            const int from_1 = 15 * 20, from_3 = 38 * 20;
            const std::set<int> before = state.own();
            state.follow(cloud);
            EXPECT_EQ(state.own(), before) << "nothing moved";
            EXPECT_EQ(owner(from_1), 1);
            EXPECT_EQ(owner(from_3), 3);
            for (const auto& [i, y, to] : {std::tuple{from_1, 0.12, 0},
                                           {from_1, 0.62, 2},
                                           {from_1, 0.9, 3},
                                           {from_1, 0.3, 1},
                                           {from_3, 0.02, 0},
                                           {from_3, 0.98, 3}}) {
                const int was = owner(i);
                const std::int64_t sent = communicator().traffic().bytes;
                const std::set<int> own = state.own();
                cloud.put(i, 0.5, y);
                state.follow(cloud);
                EXPECT_EQ(owner(i), to) << "to " << y;
                std::set<int> expected = own;
                if (communicator().rank() == was) expected.erase(i);
                if (communicator().rank() == to) expected.insert(i);
                EXPECT_EQ(state.own(), expected) << "rank " << communicator().rank() << ", to " << y;
                expect_as_defined(cloud, state);
                EXPECT_GT(communicator().traffic().bytes, sent);
            }
        },
        true);
}

TEST("a particle near a side that repeats is shown to the rank at the other end") {
    test::on_ranks(
        4,
        [] {
            Cloud cloud(3, true);
            cloud.scatter(2000, 3);
            cloud.x[2][0] = 0.01;
            State state(cloud, [](int i) { return i % 4; });
            state.follow(cloud);
            expect_as_defined(cloud, state);
            EXPECT_EQ(state.own().count(0), communicator().rank() == 0 ? 1u : 0u);
            EXPECT_EQ(state.ghosts().count(0), communicator().rank() == 3 ? 1u : 0u);
        },
        true);
}

TEST("a rank whose cells have run empty owns nothing and holds what it reads, and takes part again when particles come back") {
    test::on_ranks(
        4,
        [] {
            Cloud cloud(2, false);
            cloud.scatter(400, 4);
            State state(cloud, [](int i) { return i / 100; });
            state.follow(cloud);
            Cloud low = cloud;
            const auto highest = std::max_element(low.x[1].begin(), low.x[1].end()) - low.x[1].begin();
            for (real& y : low.x[1]) y *= 0.1;                                                            // below every cut
            low.x[1][static_cast<std::size_t>(highest)] = cloud.x[1][static_cast<std::size_t>(highest)];  // cells stay where they were
            state.follow(low);
            expect_as_defined(low, state);
            EXPECT_EQ(of_ranks(state.migration.own()), (std::vector<int>{399, 0, 0, 1}));
            EXPECT_EQ(communicator().rank() == 2, state.place().empty()) << "rank 1 reads the lowest cells, and rank 2 none that holds any";
            state.follow(cloud);
            expect_as_defined(cloud, state);
            EXPECT_GT(state.migration.own(), 0);
        },
        true);
}

TEST("fewer particles than ranks, and all in one cell") {
    test::on_ranks(
        5,
        [] {
            for (const bool repeats : {false, true}) {
                Cloud few(2, repeats);
                few.scatter(3, 5);
                State state(few, [](int) { return 4; });
                state.follow(few);
                expect_as_defined(few, state);
                for (int i = 0; i < 3; ++i) few.put(i, 0.5, 0.5);
                state.follow(few);
                expect_as_defined(few, state);
            }
        },
        true);
}

TEST(
    "cuts stay until a rank has more than its share by more than allowed; new ones leave no rank more than its share and a cell's "
    "particles") {
    test::on_ranks(4, [] {
        Cloud cloud(2, false);
        cloud.scatter(4000, 6);
        State state(cloud, [](int i) { return i / 1000; });
        state.follow(cloud);
        const std::vector<int> at = state.migration.held(state.place()).cut->at;
        for (real& y : cloud.x[1]) y = y * y;  // two thirds of the particles come into the lower half
        cloud.put(0, 0, 0), cloud.put(1, 1, 1);
        state.follow(cloud);
        const int crowded = state.migration.own();
        state.migration.balance(10);
        state.follow(cloud);
        EXPECT_EQ(state.migration.own(), crowded) << "they were allowed to";
        state.migration.balance(0.03);
        state.follow(cloud);
        Pairs all(passes_for("sse2"), cloud.frame);
        all.find(cloud.coordinates(), cloud.count(), radius);
        int fullest = 0;
        for (std::size_t c = 0; c + 1 < all.cells().start().size(); ++c)
            fullest = std::max(fullest, all.cells().start()[c + 1] - all.cells().start()[c]);
        EXPECT_LE(state.migration.own(), 1000 + fullest);
        EXPECT_GT(communicator().largest(crowded), 1000 + fullest) << "the cloud was not crowded enough to tell";
    });
}

TEST("a position that is not finite on one rank fails all of them") {
    test::on_ranks(3, [] {
        Cloud cloud(2, false);
        cloud.scatter(90, 7);
        State state(cloud, [](int i) { return i / 30; });
        cloud.x[1][45] = std::nan("");
        EXPECT_THROW(state.follow(cloud), NumericalFailure) << "rank " << communicator().rank();
    });
}

}  // namespace

}  // namespace migration_tests
