// The added mass of bodies is estimated from the response of the fluid.
#include "rigid/added_mass.hpp"

#include "support/test.hpp"

#include <cmath>

namespace added_mass_tests {

using namespace weir;
using namespace weir::rigid;

namespace {

/// Two bodies in a fluid that answers by a matrix which the estimate does not know: each has its own added mass, and they feel each other.
struct Fluid {
    static constexpr std::size_t n = freedoms<2>, size = 2 * n;
    Mobility added;
    Fluid() {
        added.resize(size);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j)
                added(i, j) = i == j ? 1.5 + 0.3 * static_cast<real>(i) : 0.2 * std::cos(1.0 + static_cast<real>(i * j + i + j));
    }
    std::vector<real> impulse(const std::vector<real>& velocity) const {
        std::vector<real> sum(size, 0.0);
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j) sum[i] += added(i, j) * velocity[j];
        return sum;
    }
};

/// Turns until (M + m) V = r is met to 1e-12, with what is known of m.
int turns_until_met(const Fluid& fluid, AddedMass<2>& known, real mass, const std::vector<real>& wanted) {
    constexpr std::size_t n = Fluid::n, size = Fluid::size;
    Block<2> own{};
    for (std::size_t k = 0; k < n; ++k) own[k][k] = mass;
    const std::vector<Block<2>> masses(2, own);
    const std::vector<char> free(size, 1);
    Mobility mobility;
    known.begin(masses, free, mobility);
    std::vector<real> velocity(size, 0.0), change(size), before(size, 0.0);
    for (int turn = 1; turn < 100; ++turn) {
        std::vector<real> missing = wanted;
        const auto met = fluid.impulse(velocity);
        for (std::size_t i = 0; i < size; ++i) missing[i] -= met[i] + mass * velocity[i];
        if (turn > 1) {
            std::vector<real> answer(size);
            for (std::size_t i = 0; i < size; ++i) answer[i] = met[i] - before[i];
            known.learn(change, answer, masses, free, mobility);
        }
        before = met;
        real largest = 0;
        for (std::size_t i = 0; i < size; ++i) {
            change[i] = 0;
            for (std::size_t j = 0; j < size; ++j) change[i] += mobility(i, j) * missing[j];
            largest = std::max(largest, std::abs(missing[i]));
        }
        if (largest < 1e-12) return turn;
        for (std::size_t i = 0; i < size; ++i) velocity[i] += change[i];
    }
    return 100;
}

}  // namespace

TEST("bodies of any mass, none too, meet the fluid's answers in few turns, and the next time in fewer") {
    const Fluid fluid;
    const std::vector<real> wanted{1, -0.5, 0.2, 0.3, 0.7, -0.4};
    Block<2> guess{};
    for (std::size_t k = 0; k < 3; ++k) guess[k][k] = 1;
    for (const real mass : {0.0, 1.0, 1000.0}) {
        AddedMass<2> known;
        known.resize(2);
        known.see(0, guess), known.see(1, guess);
        const int first = turns_until_met(fluid, known, mass, wanted);
        EXPECT_LE(first, 20) << mass;  // quasi-Newton steps without line search need about two for each of the six unknowns at worst
        known.see(0, guess), known.see(1, guess);
        const int second = turns_until_met(fluid, known, mass, wanted);
        EXPECT_LE(second, first) << mass;
    }
}

TEST("a body that dips deeper keeps what is known of it, in units of its wet surface; a dry one knows nothing of it") {
    AddedMass<2> known;
    known.resize(1);
    Block<2> guess{}, deeper{};
    for (std::size_t k = 0; k < 3; ++k) guess[k][k] = 1, deeper[k][k] = 4;
    Mobility exact;
    exact.resize(3);
    for (std::size_t k = 0; k < 3; ++k) exact(k, k) = 2, exact(k, (k + 1) % 3) = exact((k + 1) % 3, k) = 0.5;
    known.see(0, guess);
    known.learn(exact);
    known.see(0, deeper);
    EXPECT_NEAR(known.of(0)[0][0], 0.9 * 8 + 0.1 * 4, 1e-14);  // a step forgets a tenth of the estimate
    EXPECT_NEAR(known.of(0)[0][1], 0.9 * 2, 1e-14);
    known.see(0, {});
    EXPECT_EQ(known.of(0)[0][0], 0);
    known.see(0, guess);
    EXPECT_EQ(known.of(0)[0][0], 1);
    EXPECT_EQ(known.of(0)[0][1], 0);
}

}  // namespace added_mass_tests
