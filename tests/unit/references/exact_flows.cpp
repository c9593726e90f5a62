// Exact solutions are put into the equations they claim to solve: the residual, by sixth-order differences in double precision, must be
// that of the differences alone.
#include "support/test.hpp"
#include "validation/references/channel.hpp"
#include "validation/references/kovasznay.hpp"
#include "validation/references/taylor_green.hpp"

#include <functional>

namespace exact_flows_tests {

using namespace weir;
using namespace weir::validation;

namespace {

constexpr real h = 0.01;      // step of the differences: truncation 1e-12 times the 7th derivative, round-off 1e-16/h^2
constexpr real small = 2e-9;  // of residuals whose terms are of order 1 to 100

using F = std::function<real(real)>;
real first(const F& f) { return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h); }
real second(const F& f) {
    return (2 * (f(3 * h) + f(-3 * h)) - 27 * (f(2 * h) + f(-2 * h)) + 270 * (f(h) + f(-h)) - 490 * f(0)) / (180 * h * h);
}

/// Largest of the residuals of u_t + u.grad u + grad p / rho - nu lap u = 0 and div u = 0 at (x, t).
template <class U, class P>
real navier_stokes_residual(const U& u, const P& p, real nu, const Vec<2>& x, real t) {
    const auto along = [&](int axis, int component) {
        return [&, axis, component](real s) { return u(x + s * Vec<2>::unit(axis), t)[component]; };
    };
    real worst = std::abs(first(along(0, 0)) + first(along(1, 1)));
    for (int c = 0; c < 2; ++c) {
        const real u_t = first([&](real s) { return u(x, t + s)[c]; });
        const real advection = u(x, t)[0] * first(along(0, c)) + u(x, t)[1] * first(along(1, c));
        const real p_c = first([&](real s) { return p(x + s * Vec<2>::unit(c), t); });
        worst = std::max(worst, std::abs(u_t + advection + p_c - nu * (second(along(0, c)) + second(along(1, c)))));
    }
    return worst;
}

}  // namespace

TEST("the Taylor-Green vortex solves the Navier-Stokes equations for any speed, wavenumber and viscosity") {
    for (const TaylorGreen flow : {TaylorGreen{1, 1, 0.01, 1}, TaylorGreen{0.7, 2, 0.1, 1}, TaylorGreen{2, 0.5, 0, 1}})
        for (real x : {0.1, 1.3, 4.0})
            for (real y : {0.4, 2.2}) {
                const auto u = [&](const Vec<2>& at, real t) { return flow.velocity(at, t); };
                const auto p = [&](const Vec<2>& at, real t) { return flow.pressure(at, t); };
                EXPECT_NEAR(navier_stokes_residual(u, p, flow.nu, {x, y}, 0.3), 0, small);
            }
}

TEST("Taylor-Green: energy falls by 2 nu enstrophy, and both are means of the field") {
    const TaylorGreen flow{1.3, 2, 0.05, 1};
    EXPECT_NEAR(first([&](real s) { return flow.energy(0.7 + s); }), -2 * flow.nu * flow.enstrophy(0.7), small);
    real sum = 0;
    const int n = 16;  // the mean of products of sines over 16 points a period is exact
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const Vec<2> u = flow.velocity({i * pi / n, j * pi / n}, 0.7);
            sum += dot(u, u) / 2 / (n * n);
        }
    EXPECT_NEAR(sum, flow.energy(0.7), 1e-14);
    EXPECT_EQ(flow.velocity({0, 0.3}, 0)[0], 0);  // nothing passes x = 0
    EXPECT_NEAR(flow.velocity({pi / flow.k, 0.3}, 0)[0], 0, 1e-15);
}

TEST("Kovasznay's flow solves the steady Navier-Stokes equations and repeats in y") {
    for (real Re : {10.0, 40.0}) {
        const Kovasznay flow{Re};
        const auto u = [&](const Vec<2>& at, real) { return flow.velocity(at); };
        const auto p = [&](const Vec<2>& at, real) { return flow.pressure(at); };
        for (real x : {-0.4, 0.0, 0.8})
            for (real y : {-0.3, 0.15}) EXPECT_NEAR(navier_stokes_residual(u, p, 1 / Re, {x, y}, 0), 0, 2e-7);  // lap u reaches 4 pi^2 e
        EXPECT_NEAR(flow.velocity({0.2, -0.5})[0], flow.velocity({0.2, 1.5})[0], 1e-14);
    }
}

TEST("Poiseuille start-up solves u_t = G + nu u_yy, sticks to both plates, starts from rest and ends as a parabola") {
    const real H = 1.5, G = 2, nu = 0.3;
    const auto u = [&](real y, real t) { return poiseuille_startup(y, t, H, G, nu); };
    for (real t : {0.2, 0.5, 2.0})
        for (real y : {0.2, 0.75, 1.3}) {
            const real u_t = first([&](real s) { return u(y, t + s); });
            EXPECT_NEAR(u_t, G + nu * second([&](real s) { return u(y + s, t); }), 1e-8);
            EXPECT_NEAR(u(y, t), u(H - y, t), 1e-14);
        }
    EXPECT_NEAR(u(0, 0.5), 0, 1e-14);
    EXPECT_NEAR(u(0.6, 0), 0, 1e-9);  // the tail of sum 1/n^3 after 200,000 terms is 1e-12
    EXPECT_NEAR(u(H / 2, 50), G * H * H / (8 * nu), 1e-14);
}

TEST("Couette start-up solves u_t = nu u_yy, rests at the floor, moves with the lid and ends as a straight line") {
    const real H = 1.5, U = 2, nu = 0.3;
    const auto u = [&](real y, real t) { return couette_startup(y, t, H, U, nu); };
    for (real t : {0.8, 1.5, 3.0})  // later than the front's d^2/(4 nu) = 0.5, so that the differences' h^6/140 u^(7) is small
        for (real y : {0.2, 0.75, 1.3}) {
            const real u_t = first([&](real s) { return u(y, t + s); });
            EXPECT_NEAR(u_t, nu * second([&](real s) { return u(y + s, t); }), 1e-8);
        }
    EXPECT_EQ(u(0, 0.5), 0);
    EXPECT_NEAR(u(H, 0.5), U, 1e-13);
    EXPECT_EQ(u(0.4, 0), 0);
    EXPECT_NEAR(u(0.4, 50), U * 0.4 / H, 1e-14);
}

TEST("early Couette flow is Stokes' first problem: U erfc(distance from the lid / (2 sqrt(nu t)))") {
    const real H = 1, U = 1, nu = 0.1, t = 0.02;  // the far wall is felt by erfc(H / (2 sqrt(nu t))) = erfc(11)
    for (real d : {0.02, 0.05, 0.1}) EXPECT_NEAR(couette_startup(H - d, t, H, U, nu), std::erfc(d / (2 * std::sqrt(nu * t))), 1e-12);
}

}  // namespace exact_flows_tests
