#include "parallel/grid.hpp"

#include "support/test.hpp"

#include <cmath>

namespace grid_tests {

using namespace weir;

TEST_IN_2D_AND_3D("x runs fastest, and strides lead to neighbours") {
    Extent<D> n(Index<D>::constant(4));
    n[0] = 5;
    Grid<double, D> grid(n);
    EXPECT_EQ(grid.size(), product(n));
    const auto I = Index<D>::constant(1);
    for (int a = 0; a < D; ++a) EXPECT_EQ(grid.linear(I + e<D>(a)) - grid.linear(I), static_cast<std::size_t>(grid.stride(a)));
    EXPECT_EQ(grid.stride(0), 1);
}

TEST_IN_2D_AND_3D("sums and maxima are bitwise equal for any number of threads") {
    const Extent<D> n(Index<D>::constant(17));
    const auto f = [](const Index<D>& I) { return std::sin(1.7 * I[0] + 0.3 * I[1]) * 1e3 + std::cos(double(I[D - 1])); };
    const int before = threads();
    set_threads(1);
    const real sum = sum_over<D>(n, f), largest = max_over<D>(n, f);
    for (int count : {2, 3, 7}) {
        set_threads(count);
        EXPECT_EQ(sum_over<D>(n, f), sum);
        EXPECT_EQ(max_over<D>(n, f), largest);
    }
    set_threads(before);
}

TEST("a maximum over values with one NaN is NaN") {
    const real largest =
        max_over<2>(replicated(Index<2>::constant(8)), [](const Index<2>& I) { return I[0] == 3 && I[1] == 2 ? std::nan("") : 1.0; });
    EXPECT_TRUE(std::isnan(largest));
}

TEST_IN_2D_AND_3D("a loop over a box visits each index once") {
    Grid<int, D> seen(replicated(Index<D>::constant(6)), 0);
    for_each_in<D>(Index<D>::constant(1), replicated(Index<D>::constant(5)), [&](const Index<D>& I) { ++seen(I); });
    const real inside = sum_over<D>(seen.extent(), [&](const Index<D>& I) { return seen(I); });
    EXPECT_EQ(inside, std::pow(4, D));
    EXPECT_EQ(max_over<D>(seen.extent(), [&](const Index<D>& I) { return seen(I); }), 1);
}

}  // namespace grid_tests
