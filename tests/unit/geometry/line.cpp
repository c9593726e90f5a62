// Where a line lies inside a shape: closed formulas, shapes of shapes, and films that no sample would meet.
#include "geometry/line.hpp"

#include "support/test.hpp"

#include <random>

namespace line_tests {

using namespace weir;
using namespace weir::geometry;

namespace {

template <int D>
Vec<D> vec(real x, real y, real z) {
    Vec<D> v;
    v[0] = x, v[1] = y;
    if constexpr (D == 3) v[2] = z;
    return v;
}

template <int D>
std::vector<Interval> inside(const ShapePtr<D>& shape, real x, real low = -1, real high = 2, const Pose<D>& pose = {}) {
    std::vector<Interval> list;
    find_inside(*shape, Line<D>{vec<D>(x, 0, 0), 1, low, high, pose}, list);
    return list;
}

}  // namespace

TEST_IN_2D_AND_3D("a film of any thickness is found, and its ends to the last bit") {
    for (const real thick : {0.3, 1e-3, 1e-6, 1e-9, 1e-12})
        for (const real bottom : {0.0, 0.123456789, 1.7}) {
            const auto list = inside<D>(box<D>(vec<D>(-1, bottom, -1), vec<D>(1, bottom + thick, 1)), 0.3);
            ASSERT_EQ(list.size(), 1u) << thick << ' ' << bottom;
            EXPECT_EQ(list[0].high, bottom + thick);
            EXPECT_NEAR(list[0].low, bottom, 4e-16);  // a bit below it is outside
        }
    for (const real deep : {1e-2, 1e-5, 1e-8}) {  // a ball that the line hardly touches
        const real r = 0.5, half = std::sqrt(r * r - (r - deep) * (r - deep));
        const auto list = inside<D>(sphere<D>(vec<D>(0, 0.4, 0), r), r - deep);
        ASSERT_EQ(list.size(), 1u) << deep;
        EXPECT_NEAR(list[0].low, 0.4 - half, 1e-7);  // 1e-16 of the distance is 1e-8 of the chord where it is flat
        EXPECT_NEAR(list[0].high, 0.4 + half, 1e-7);
    }
    EXPECT_TRUE(inside<D>(sphere<D>(vec<D>(0, 0.4, 0), 0.5), 0.5 + 1e-12).empty());
}

TEST_IN_2D_AND_3D("half spaces, waves and shapes of shapes are intervals") {
    auto list = inside<D>(plane<D>(vec<D>(0, 0.5, 0), vec<D>(-1, 2, 0)), 0.2);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_EQ(list[0].low, -1);
    EXPECT_NEAR(list[0].high, 0.6, 1e-15);
    list = inside<D>(wave<D>(0.5, 0.1, 1.0), 0.25);
    ASSERT_EQ(list.size(), 1u);
    EXPECT_NEAR(list[0].high, 0.5, 1e-15);
    const auto slab = [](real low, real high) { return box<D>(vec<D>(-1, low, -1), vec<D>(1, high, 1)); };
    list = inside<D>(unite<D>({slab(0, 0.5), slab(0.5, 0.7), slab(0.9, 1.1)}), 0);
    ASSERT_EQ(list.size(), 2u);  // those that touch are one: no point between them is outside
    EXPECT_NEAR(list[0].high, 0.7, 1e-15);
    list = inside<D>(subtract<D>(slab(0, 1), {slab(0.2, 0.2 + 1e-9), slab(0.7, 3)}), 0);
    ASSERT_EQ(list.size(), 2u);
    EXPECT_NEAR(list[1].low, 0.2 + 1e-9, 1e-15);
    EXPECT_NEAR(list[1].high, 0.7, 1e-15);
}

TEST_IN_2D_AND_3D("shapes that are turned are what their distance says at samples") {
    const std::vector<ShapePtr<D>> shapes{box<D>(vec<D>(-0.2, 0.1, -0.3), vec<D>(0.4, 0.5, 0.3)), sphere<D>(vec<D>(0.1, 0.3, 0), 0.4),
                                          capsule<D>(vec<D>(0, 0, 0), vec<D>(0.3, 0.5, 0.1), 0.2),
                                          cylinder<D>(vec<D>(0, 0, 0), vec<D>(0.3, 0.5, 0.1), 0.2)};
    Pose<D> pose;
    const real c = std::cos(0.7), s = std::sin(0.7);
    pose.rotation[0] = vec<D>(c, -s, 0), pose.rotation[1] = vec<D>(s, c, 0);
    pose.offset = vec<D>(0.05, 0.1, 0);
    for (const auto& shape : shapes)
        for (const real x : {-0.35, -0.1, 0.0, 0.21, 0.4}) {
            const auto list = inside<D>(shape, x, -1, 2, pose);
            for (int i = 0; i <= 3000; ++i) {
                const real y = -1 + 1e-3 * i;
                const bool told = std::any_of(list.begin(), list.end(), [&](const Interval& at) { return y >= at.low && y <= at.high; });
                const real d = shape->distance(Line<D>{vec<D>(x, 0, 0), 1, -1, 2, pose}.at(y));
                if (std::abs(d) <= 1e-12) continue;
                EXPECT_EQ(told, d < 0) << x << ' ' << y;
            }
        }
}

}  // namespace line_tests
