// Packs of eight numbers where a row ends, and tests of all lanes.
#include "core/simd.hpp"

#include "support/test.hpp"

#include <array>
#include <cmath>

namespace simd_tests {

using namespace weir;
using simd::d8, simd::Side;

TEST("a pack of the first n values repeats the last one; storing n lanes leaves the others") {
    const std::array<double, 8> from{1, 2, 3, 4, 5, 6, 7, 8};
    for (int n = 1; n <= 12; ++n) {
        const d8 v = simd::load(from.data(), n);
        std::array<double, 8> to{};
        simd::store(to.data(), v, n);
        for (int l = 0; l < 8; ++l) {
            EXPECT_EQ(v[l], std::min(l + 1, n)) << n;
            EXPECT_EQ(to[static_cast<std::size_t>(l)], l < n ? l + 1 : 0) << n;
        }
    }
}

TEST("tests of all lanes see each one; NaN is within no limit") {
    EXPECT_TRUE(simd::all_within(d8{-1, 1, 0, 0, 0, 0, 0, 0}, 1));
    for (int l = 0; l < 8; ++l)
        for (const double value : {-2.0, 2.0, std::nan("")}) {
            d8 v{};
            v[l] = value;
            EXPECT_FALSE(simd::all_within(v, 1));
            EXPECT_FALSE(simd::all(simd::magnitude(v) <= 1));
        }
    EXPECT_TRUE(simd::all(simd::magnitude(d8{} - 1) <= 1));
}

TEST("the common sign of lanes: zero belongs to neither side") {
    EXPECT_EQ(simd::side_of(d8{} + 1), Side::above);
    EXPECT_EQ(simd::side_of(d8{} - 1), Side::below);
    EXPECT_EQ(simd::side_of(d8{}), Side::on);
    for (int l = 0; l < 8; ++l) {
        d8 v = d8{} + 1;
        v[l] = 0;
        EXPECT_EQ(simd::side_of(v), Side::both);
    }
}

}  // namespace simd_tests
