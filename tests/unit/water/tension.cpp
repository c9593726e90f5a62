// Surface tension and viscosity at the free surface, against Laplace, Rayleigh and the film that runs down a plate.
#include "support.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tension_tests {

using namespace weir;
using namespace weir::test;

namespace {

constexpr real radius = 0.25;

/// A drop of radius 1/4 in the middle of a box of side 1, ρ = σ = 1, without gravity, 8 cells a radius. `strain` [1/s] sets
/// it swinging: near its stagnation point the vortex of Taylor and Green is the strain (x, −y).
template <int D>
std::string drop(const std::string& transfer, real strain) {
    return fmt::format(R"(solver = "mac_water"
dim = {}
grid = {{ cells = {}, size = {}, origin = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1.0 }}
liquid = [ {{ shape = "sphere", centre = {}, radius = {} }} ]
initial = {{ velocity = {{ name = "taylor_green", speed = {}, wavenumber = 0.1 }} }}
effects = {{ surface_tension = {{ sigma = 1.0 }} }}
scheme = {{ transfer = "{}" }}
)",
                       D, list({"32", "32", "32"}, D), list({"1.0", "1.0", "1.0"}, D), list({"-0.5", "-0.5", "-0.5"}, D),
                       list({"0.0", "0.0", "0.0"}, D), radius, strain / 0.1, transfer);
}

/// Width of the liquid along an axis through the middle [m].
template <int D>
real width(const water::Water<D>& water, int axis) {
    const auto& phi = water.surface().phi;
    const real h = water.state().u.h[axis];
    real sum = 0;
    Index<D> lo = phi.extent();
    for (int d = 0; d < D; ++d) lo[d] = phi.extent()[d] / 2 - 1;
    Index<D> hi = lo + Index<D>::constant(2);
    lo[axis] = 0, hi[axis] = phi.extent()[axis] - 1;
    int lines = 1;
    for (int d = 1; d < D; ++d) lines *= 2;
    for (Index<D> I = lo; I[D - 1] < hi[D - 1];) {  // the lines beside the middle, one after the other
        const real here = phi(I), next = phi(I + e<D>(axis));
        if ((here < 0) != (next < 0)) sum += (here < 0 ? 1 : -1) * h * (I[axis] + here / (here - next));
        for (int d = 0; d < D; ++d) {
            if (++I[d] < hi[d] || d == D - 1) break;
            I[d] = lo[d];
        }
    }
    return sum / lines;
}

}  // namespace

TEST_IN_2D_AND_3D("a drop at rest has the pressure of Laplace, and stays at rest") {
    // κ is made of second differences of a distance that is of first order beyond the cells beside the surface: its error does not fall
    // with h. 5% is asked for (1.0% in 2D, 1.8% in 3D), and of the surface's energy at most a thousandth may turn into spurious currents.
    water::Water<D> water(water_scene(drop<D>("flip", 0)));
    const real surface_energy = D == 2 ? 2 * pi * radius : 4 * pi * radius * radius;
    for (int step = 0; step < (D == 2 ? 100 : 25); ++step) water.step(water.advised_dt());
    real sum = 0;
    int count = 0;
    const auto& phi = water.surface().phi;
    for (std::size_t i = 0; i < phi.size(); ++i)
        if (phi[i] < -2 * water.state().u.h[0]) sum += water.state().p[i], ++count;
    ASSERT_GT(count, 0);
    EXPECT_NEAR(sum / count / ((D - 1) / radius), 1, 0.05);
    EXPECT_LT(integral(water, "kinetic_energy"), 1e-3 * surface_energy);
}

TEST_IN_2D_AND_3D("a drop swings with the period of Rayleigh") {
    // ω² = n (n² − 1) σ/(ρ R³) in 2D, n (n − 1)(n + 2) σ/(ρ R³) in 3D, n = 2. 25 cells a wavelength: second order in k h allows 0.3%, the
    // amplitude ε = 0.05 as much; κ's error of 5% at most (see above) half of that in ω.
    const real omega = std::sqrt((D == 2 ? 6 : 8) / (radius * radius * radius)), period = 2 * pi / omega;
    for (const std::string transfer : {"flip", "apic"}) {
        if (D == 3 && transfer == "apic") continue;  // time
        water::Water<D> water(water_scene(drop<D>(transfer, 0.05 * omega)));
        real largest = 0, before = 0, t_before = 0, full = 0;
        while (full == 0 && water.time() < 1.5 * period) {
            water.step(water.advised_dt());
            const real now = width(water, 0) - width(water, 1);
            largest = std::max(largest, now);
            if (water.time() > 0.75 * period && before < 0 && now >= 0)
                full = t_before + (water.time() - t_before) * before / (before - now);
            before = now, t_before = water.time();
        }
        EXPECT_NEAR(full / period, 1, 0.035) << transfer;
        EXPECT_GT(largest, 0.5 * 4 * 0.05 * radius) << transfer << ": r = R (1 + ε cos 2θ sin ω t), damped by less than half";
    }
}

// A block of liquid, which tension makes round, in the middle of a periodic box and across its seams: the same half a period away, and 7 of
// 24 cells, which brings a side of it to 0.3 cells beyond the seam of x, so that the surface crosses the faces there. Places
// differ by round-off, which ten steps let grow to some thousand units.
TEST_IN_2D_AND_3D("tension knows no seam: what swings across periodic sides is what swings in the middle, shifted by half a period") {
    constexpr int n = 24;
    const auto block = [](real x, real y, real half) {
        return fmt::format("{{ shape = \"box\", min = {}, max = {} }}",
                           list({fmt::format("{}", x - half), fmt::format("{}", y - 0.14), "-0.17"}, D),
                           list({fmt::format("{}", x + half), fmt::format("{}", y + 0.14), "0.17"}, D));
    };
    const auto scene = [&](const std::string& liquid) {
        return water_scene(
            fmt::format("solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {}, origin = {}, periodic = {} }}\ntime = {{ end = "
                        "1.0, dt = 0.001 }}\n"
                        "fluid = {{ density = 1.0 }}\nliquid = [ {} ]\neffects = {{ surface_tension = {{ sigma = 1.0 }} }}\n"
                        "scheme = {{ transfer = \"grid\", poisson = {{ tolerance = 1e-12 }} }}\n",
                        D, list({"24", "24", "24"}, D), list({"1.0", "1.0", "1.0"}, D), list({"-0.5", "-0.5", "-0.5"}, D),
                        list({"\"x\"", "\"y\"", "\"z\""}, D), liquid));
    };
    for (const auto& [cells, half] : {std::pair<int, real>{n / 2, 0.2}, {7, 0.22}}) {
        water::Water<D> middle(scene(block(0, 0, half)));
        for (int step = 0; step < 10; ++step) middle.step(0.001);
        const real x = cells / real(n);
        water::Water<D> seam(
            scene(block(x, 0.5, half) + ", " + block(x - 1, 0.5, half) + ", " + block(x, -0.5, half) + ", " + block(x - 1, -0.5, half)));
        for (int step = 0; step < 10; ++step) seam.step(0.001);
        const auto &a = middle.surface().phi, &b = seam.surface().phi;
        real apart = 0, fastest = 0;
        for (int k = 0; k < (D == 3 ? n : 1); ++k)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    Index<D> I, J;
                    I[0] = i, I[1] = j, J[0] = (i + cells) % n, J[1] = (j + n / 2) % n;
                    if constexpr (D == 3) I[2] = J[2] = k;
                    if (a(I) < 0 || b(J) < 0) apart = std::max(apart, std::abs(a(I) - b(J)));
                }
        for (std::size_t f = 0; f < middle.state().u[0].size(); ++f) fastest = std::max(fastest, std::abs(middle.state().u[0][f]));
        EXPECT_GT(fastest, 0.1);  // it does swing
        EXPECT_LT(apart, 1e-8 / n) << cells;
    }
}

TEST("a film that runs down a plate reaches the parabola of Nusselt") {
    // u = g (H y − y²/2)/ν. The wall's mirrored face is wrong by h² u″/8 = g h²/(8 ν). FLIP's part of PIC, 1 − β, spreads momentum by a hat
    // of variance h²/6 a step at least: a viscosity of (1 − β) h²/(6 Δt) beside ν, and the film is slower by their ratio.
    const real h = 1.0 / 16, height = 0.5, nu = 0.1, dt = 0.02, top = height * height / (2 * nu);
    for (const std::string transfer : {"apic", "flip"}) {
        const std::string text = R"(solver = "mac_water"
dim = 2
grid = { cells = [4, 16], size = [0.25, 1.0], periodic = ["x"] }
time = { end = 8.0, dt = 0.02 }
fluid = { density = 1000.0, viscosity = 0.1 }
sides = { y_min = { kind = "wall", slip = "no" } }
liquid = [ { shape = "box", min = [-1.0, 0.0], max = [2.0, 0.5] } ]
effects = { gravity = { g = [1.0, -9.81] }, viscosity = {} }
)";
        water::Water<2> water(water_scene(text + "scheme = { transfer = \"" + transfer + "\" }\n"));
        while (water.time() < 6) water.step(dt);  // e^(−ν (π/2H)² t) = 0.003 of it is missing
        real worst = 0;
        for (int j = 0; j < 8; ++j) {
            const real y = (j + 0.5) * h;
            worst = std::max(worst, std::abs(water.state().u[0](Index<2>{1, j}) - (height * y - y * y / 2) / nu));
        }
        const real wall = h * h / (8 * nu), blend = transfer == "flip" ? 0.03 * h * h / (6 * dt) / nu : 0;
        EXPECT_LT(worst, wall + (blend + 0.003) * top) << transfer;
        EXPECT_NEAR(integral(water, "volume"), 0.125, 1e-6) << transfer;
    }
}

}  // namespace tension_tests
