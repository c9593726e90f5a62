// The advection tests' shapes are true distances with the right areas; their flows are divergence-free and end where they began.
#include "validation/references/advection.hpp"

#include "support/test.hpp"

namespace advection_tests {

using namespace weir;
using namespace weir::validation;

TEST("both level sets have the exact area, and 0.0582 and 0.0707 as the baselines say") {
    const int n = 2000;
    real slotted = 0, round = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec<2> x{(i + 0.5) / n, (j + 0.5) / n};
            slotted += slotted_disk(x) < 0, round += vortex_disk(x) < 0;
        }
    // cells cut by the boundary: perimeter/h of them, each wrong by a fraction with random sign: h^2 sqrt(perimeter/h) = 1e-5
    EXPECT_NEAR(slotted / n / n, slotted_disk_area(), 2e-5);
    EXPECT_NEAR(round / n / n, vortex_disk_area(), 2e-5);
    EXPECT_NEAR(slotted_disk_area(), 0.0582, 5e-5);
    EXPECT_NEAR(vortex_disk_area(), 0.0707, 5e-5);
}

TEST("the slotted disk's distance is symmetric and never changes faster than the way walked") {
    for (real x = 0.3; x <= 0.5; x += 0.013)
        for (real y = 0.55; y <= 0.95; y += 0.011) {
            EXPECT_NEAR(slotted_disk({x, y}), slotted_disk({1 - x, y}), 1e-14);
            for (const Vec<2> s : {Vec<2>{1e-3, 0}, Vec<2>{0, 1e-3}})
                EXPECT_LE(std::abs(slotted_disk(Vec<2>{x, y} + s) - slotted_disk({x, y})), 1e-3 * (1 + 1e-9));
        }
}

TEST("the slotted disk's distance is the distance to its boundary's points") {
    std::vector<Vec<2>> boundary;  // walls and roof of the slot, and the arc that is left
    const real mouth = 0.75 - std::sqrt(0.15 * 0.15 - 0.025 * 0.025), gap = std::asin(0.025 / 0.15);
    for (int i = 0; i <= 4000; ++i) {
        const real s = i / 4000.0, angle = -pi / 2 + gap + s * (2 * pi - 2 * gap);
        boundary.push_back({0.475, mouth + s * (0.85 - mouth)});
        boundary.push_back({0.525, mouth + s * (0.85 - mouth)});
        boundary.push_back({0.475 + 0.05 * s, 0.85});
        boundary.push_back({0.5 + 0.15 * std::cos(angle), 0.75 + 0.15 * std::sin(angle)});
    }
    for (const Vec<2> x : {Vec<2>{0.5, 0.58}, {0.5, 0.61}, {0.49, 0.7}, {0.5, 0.9}, {0.3, 0.5}, {0.47, 0.595}, {0.6, 0.75}, {0.45, 0.72}}) {
        real nearest = infinity;
        for (const auto& b : boundary) nearest = std::min(nearest, norm(x - b));
        EXPECT_NEAR(std::abs(slotted_disk(x)), nearest, 2.5e-4);  // points of the arc stand 2.2e-4 apart
    }
    EXPECT_GT(slotted_disk({0.5, 0.7}), 0);   // in the slot
    EXPECT_LT(slotted_disk({0.5, 0.87}), 0);  // above it
}

TEST("both flows are divergence-free and nothing passes the vortex's walls") {
    const real h = 1e-4;
    for (real x : {0.2, 0.5, 0.83})
        for (real y : {0.1, 0.64}) {
            const auto divergence = [&](auto u) {
                return (u(Vec<2>{x + h, y})[0] - u(Vec<2>{x - h, y})[0] + u(Vec<2>{x, y + h})[1] - u(Vec<2>{x, y - h})[1]) / (2 * h);
            };
            EXPECT_NEAR(divergence([](const Vec<2>& at) { return rigid_rotation(at); }), 0, 1e-9);
            EXPECT_NEAR(divergence([](const Vec<2>& at) { return single_vortex(at, 1, 8); }), 0, 1e-6);  // h^2 pi^3/3
            EXPECT_NEAR(single_vortex({0, y}, 0, 8)[0], 0, 1e-15);
            EXPECT_NEAR(single_vortex({x, 1}, 0, 8)[1], 0, 1e-15);
        }
}

TEST("a point carried by each flow for its period comes back; after a quarter turn it is where `unturned` says") {
    const auto carry = [](auto u, Vec<2> x, real end) {
        const int steps = 2000;  // classical Runge-Kutta: (dt/T)^4 = 1e-13 with a factor of the flow's strain
        const real dt = end / steps;
        for (int i = 0; i < steps; ++i) {
            const real t = i * dt;
            const Vec<2> k1 = u(x, t), k2 = u(x + dt / 2 * k1, t + dt / 2), k3 = u(x + dt / 2 * k2, t + dt / 2),
                         k4 = u(x + dt * k3, t + dt);
            x += dt / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        }
        return x;
    };
    const Vec<2> x0{0.55, 0.8};
    EXPECT_NEAR(norm(carry([](const Vec<2>& x, real t) { return single_vortex(x, t, 8); }, x0, 8) - x0), 0, 1e-9);
    const Vec<2> quarter = carry([](const Vec<2>& x, real) { return rigid_rotation(x); }, x0, 0.25);
    EXPECT_NEAR(norm(unturned(quarter, 0.25) - x0), 0, 1e-10);
    EXPECT_NEAR(gaussian_hill(unturned(quarter, 0.25)), gaussian_hill(x0), 1e-10);
}

}  // namespace advection_tests
