#include "geometry/motion.hpp"

#include "support/test.hpp"

namespace motion_tests {

using namespace weir;
using namespace weir::geometry;

namespace {

template <int D>
std::vector<Motion<D>> motions() {
    Vec<D> v{};
    v[0] = 0.7, v[1] = -0.2;
    const std::array<real, 3> axis = D == 2 ? std::array<real, 3>{0, 0, 1} : std::array<real, 3>{1, 2, -1};
    return {Motion<D>::constant(v), Motion<D>::sinusoidal(v, 1.3, 0.4), Motion<D>::rotating(v, axis, 2.1),
            Motion<D>::keyframed({{0, {}, 0}, {1, v, 0.5}, {4, 2 * v, -1.0}}, v, axis)};
}

}  // namespace

TEST_IN_2D_AND_3D("the velocity of a solid's point is the time derivative of where the point is") {
    const real eps = 1e-6;
    for (const auto& motion : motions<D>())
        for (const real t : {0.37, 2.3}) {  // in both of the keyframes' spans
            Vec<D> rest = Vec<D>::constant(0.3);
            rest[0] = -0.8;
            const Vec<D> before = motion.pose(t - eps).to_world(rest), after = motion.pose(t + eps).to_world(rest);
            const auto pose = motion.pose(t);
            const Vec<D> v = pose.velocity_at(pose.to_world(rest));
            for (int a = 0; a < D; ++a) EXPECT_NEAR(v[a], (after[a] - before[a]) / (2 * eps), 1e-8);  // eps^2 and 1e-16 / eps
        }
}

TEST_IN_2D_AND_3D("to_rest undoes to_world, and distances are kept") {
    for (const auto& motion : motions<D>()) {
        const auto pose = motion.pose(2.9);
        const Vec<D> x = Vec<D>::constant(0.4), y = 3 * Vec<D>::unit(1);
        EXPECT_LT(norm(pose.to_rest(pose.to_world(x)) - x), 1e-14);
        EXPECT_NEAR(norm(pose.to_world(x) - pose.to_world(y)), norm(x - y), 1e-14);
    }
}

TEST_IN_2D_AND_3D("a motion starts where the scene puts the solid") {
    for (const auto& motion : motions<D>())
        EXPECT_LT(norm(motion.pose(0).to_world(Vec<D>::constant(0.25)) - Vec<D>::constant(0.25)), 1e-15);
}

TEST("outside its frames a keyframed solid is at rest") {
    const auto motion = Motion<2>::keyframed({{1, {}, 0}, {2, {{1, 0}}, 1}}, {}, {0, 0, 1});
    for (real t : {0.5, 2.5}) EXPECT_EQ(norm(motion.pose(t).velocity_at({{0.3, 0.4}})), 0);
    EXPECT_NEAR(motion.pose(1.5).velocity_at({{0.5, 0}})[0], 1, 1e-15);
}

}  // namespace motion_tests
