#include "geometry/shape.hpp"

#include "geometry/solids.hpp"
#include "support/test.hpp"

#include <random>

namespace shape_tests {

using namespace weir;
using namespace weir::geometry;

namespace {

template <int D>
Vec<D> random_point(std::mt19937& random, real reach) {
    std::uniform_real_distribution<real> coordinate(-reach, reach);
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = coordinate(random);
    return x;
}

template <int D>
std::vector<ShapePtr<D>> exact_shapes() {
    Vec<D> a{}, b{};
    a[0] = -0.4, b[0] = 0.5, b[1] = 0.3;
    return {box<D>(Vec<D>::constant(-0.5), Vec<D>::constant(0.7)), sphere<D>(a, 0.6), plane<D>(a, b), capsule<D>(a, b, 0.2),
            cylinder<D>(a, b, 0.3)};
}

}  // namespace

TEST_IN_2D_AND_3D("the gradient of an exact distance has length one, and following it leads to the surface") {
    std::mt19937 random(7);
    const real eps = 1e-6;
    for (const auto& shape : exact_shapes<D>()) {
        int checked = 0;
        for (int sample = 0; sample < 400; ++sample) {
            const Vec<D> x = random_point<D>(random, 1.5);
            const real d = shape->distance(x);
            Vec<D> gradient;
            bool smooth = true;  // not across a medial axis, where the distance has a kink
            for (int a = 0; a < D; ++a) {
                const real up = shape->distance(x + eps * Vec<D>::unit(a)) - d, down = d - shape->distance(x - eps * Vec<D>::unit(a));
                gradient[a] = (up + down) / (2 * eps);
                smooth = smooth && std::abs(up - down) < 1e-3 * eps;
            }
            if (!smooth) continue;
            ++checked;
            EXPECT_NEAR(norm(gradient), 1, 1e-4);  // central differences: O(eps^2) and round-off / eps
            if (d <= 0) continue;
            EXPECT_NEAR(shape->distance(x - d * gradient), 0, 1e-4);  // nearest point, from outside
        }
        EXPECT_GT(checked, 300);
    }
}

TEST("a union is inside where any part is, a difference where the first is and no other") {
    const auto left = sphere<2>({{-0.3, 0}}, 0.5), right = sphere<2>({{0.3, 0}}, 0.5);
    const auto both = unite<2>({left, right}), moon = subtract<2>(left, {right});
    std::mt19937 random(11);
    for (int sample = 0; sample < 1000; ++sample) {
        const auto x = random_point<2>(random, 1);
        EXPECT_EQ(both->contains(x), left->contains(x) || right->contains(x));
        EXPECT_EQ(moon->contains(x), left->contains(x) && right->distance(x) > 0);
    }
}

TEST("known distances: box corner, cylinder rim, inside of a box") {
    EXPECT_DOUBLE_EQ((box<3>({{0, 0, 0}}, {{1, 1, 1}})->distance({{2, 2, 2}})), std::sqrt(3.0));
    EXPECT_DOUBLE_EQ((box<2>({{0, 0}}, {{4, 1}})->distance({{2, 0.25}})), -0.25);
    EXPECT_DOUBLE_EQ((cylinder<3>({{0, 0, 0}}, {{0, 0, 2}}, 1)->distance({{4, 0, 6}})), 5.0);
    EXPECT_DOUBLE_EQ((plane<2>({{0, 1}}, {{0, 3}})->distance({{9, 3}})), 2.0);
}

TEST_IN_2D_AND_3D("a wave's surface is where its cosine says, and a step of its distance along the normal leads there") {
    const real level = 0.3, amplitude = 0.02, wavelength = 1.5, k = 2 * pi / wavelength;
    const auto water = wave<D>(level, amplitude, wavelength);
    for (real x = -1; x <= 2; x += 0.17) {
        Vec<D> surface{};
        surface[0] = x, surface[1] = level + amplitude * std::cos(k * x);
        EXPECT_NEAR(water->distance(surface), 0, 1e-15);
        EXPECT_TRUE(water->contains(surface - 0.1 * Vec<D>::unit(1)));
        Vec<D> normal = Vec<D>::unit(1);
        normal[0] = amplitude * k * std::sin(k * x);
        normal = normal / norm(normal);
        const real d = 0.05;  // the error is d^2/2 times slope' (a k^2 = 0.35) times slope (a k = 0.084): 4e-5
        EXPECT_NEAR(water->distance(surface + d * normal), d, 6e-5);
    }
}

TEST_IN_2D_AND_3D("a capsule ends in half a ball at both of its ends, whichever is named first") {
    const Vec<D> a = Vec<D>::constant(0.1), b = a + 0.5 * Vec<D>::unit(0), beyond = 0.4 * Vec<D>::unit(0) + 0.3 * Vec<D>::unit(1);
    for (const bool turned : {false, true}) {
        const auto shape = turned ? capsule<D>(b, a, 0.2) : capsule<D>(a, b, 0.2);
        EXPECT_NEAR(shape->distance(b + beyond), 0.3, 1e-15);
        EXPECT_NEAR(shape->distance(a - beyond), 0.3, 1e-15);
    }
}

}  // namespace shape_tests
