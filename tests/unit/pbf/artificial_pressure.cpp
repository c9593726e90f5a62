// Artificial pressure (Macklin & Müller 2013, eq. 13 and 14) of two particles alone: in closed form.
#include "pbf/reference_solver.hpp"

#include "scenes.hpp"
#include "support/test.hpp"

#include <cmath>

namespace artificial_pressure_tests {

using namespace weir;

namespace {

constexpr real spacing = 0.125, strength = 0.1, dq = 0.3;  // [m], k over the support squared, delta q over the support

/// Two particles near the middle of a closed box of eight spacings: no wall is within their support. One iteration, nothing carried over.
template <int D>
scene::Scene pair_scene(const std::string& kernel, const std::string& backend) {
    return scene::parse(
        fmt::format("solver = \"pbf\"\ndim = {}\ngrid = {{ cells = [{}], size = [{}] }}\ntime.end = 1.0\nfluid.density = 1000.0\n"
                    "liquid = [ {{ shape = \"box\", min = [{}], max = [{}] }} ]\nscheme = {{ iterations = 1, warm_start = 0, settle = 0, "
                    "kernel = \"{}\", backend = \"{}\" }}\neffects.artificial_pressure = {{ k = {}, dq = {} }}\n",
                    D, D == 2 ? "8, 8" : "8, 8, 8", D == 2 ? "1, 1" : "1, 1, 1", D == 2 ? "0.375, 0.5" : "0.375, 0.5, 0.5",
                    D == 2 ? "0.625, 0.625" : "0.625, 0.625, 0.625", kernel, backend, strength, dq),
        "test.toml", {pbf::kind().schema});
}

/// Along no axis.
template <int D>
Vec<D> along() {
    if constexpr (D == 2)
        return {{0.6, 0.8}};
    else
        return {{0.48, 0.6, 0.64}};
}

/// How far one step moves each of two particles at distance r that rest, away from the other.
template <int D, class Solver>
std::array<real, 2> moves(Solver& solver, real r) {
    particles::Fluid<D>& fluid = solver.fluid();
    EXPECT_EQ(fluid.count(), 2);
    const Vec<D> n = along<D>(), middle = fluid.domain.centre();
    for (int i = 0; i < 2; ++i) particles::Fluid<D>::put(fluid.x, i, middle + (i == 0 ? 0.5 : -0.5) * r * n);
    std::array<Vec<D>, 2> before;  // by birth: a step may change the order of the particles
    for (int i = 0; i < 2; ++i) before[static_cast<std::size_t>(fluid.id[static_cast<std::size_t>(i)])] = fluid.position(i);
    solver.step(0.01);
    std::array<real, 2> by{};
    for (int i = 0; i < 2; ++i) {
        const auto born = static_cast<std::size_t>(fluid.id[static_cast<std::size_t>(i)]);
        const Vec<D> move = fluid.position(i) - before[born], out = before[born] - middle;
        by[born] = dot(move, out) / norm(out);
        EXPECT_NEAR(norm(move), std::abs(by[born]), 1e-5 * strength) << "the pair moves along the line between its particles";
    }
    return by;
}

/// The part of eq. 13 and 14 that depends on the kernels, in closed form; q = r / h: W over its value at q = 0, and -h^(D + 1) dW/dr.
struct Profile {
    const char* kernel;
    real (*value)(real q);
    real (*slope2d)(real q);
    real (*slope3d)(real q);
};
real cubic_value(real q) { return q < 0.5 ? 1 - 6 * q * q + 6 * q * q * q : 2 * std::pow(1 - q, 3); }
real cubic_slope(real q) { return q < 0.5 ? 12 * q - 18 * q * q : 6 * std::pow(1 - q, 2); }
real wendland_slope(real q) { return 20 * q * std::pow(1 - q, 3); }
const Profile profiles[] = {
    {"muller", [](real q) { return std::pow(1 - q * q, 3); }, [](real q) { return 30 / pi * std::pow(1 - q, 2); },
     [](real q) { return 45 / pi * std::pow(1 - q, 2); }},
    {"cubic", cubic_value, [](real q) { return 40 / (7 * pi) * cubic_slope(q); }, [](real q) { return 8 / pi * cubic_slope(q); }},
    {"wendland", [](real q) { return std::pow(1 - q, 4) * (1 + 4 * q); }, [](real q) { return 7 / pi * wendland_slope(q); },
     [](real q) { return 21 / (2 * pi) * wendland_slope(q); }}};

/// |m / rho0 s_corr grad W|, with s_corr = -k h^2 (W(r) / W(dq h))^4, m / rho0 = spacing^D and h = support spacings [m].
template <int D>
real expected(const Profile& profile, real q, real support) {
    const real h = support * spacing, ratio = profile.value(q) / profile.value(dq);
    const real slope = (D == 2 ? profile.slope2d : profile.slope3d)(q) / std::pow(h, D + 1);
    return std::pow(spacing, D) * strength * h * h * std::pow(ratio, 4) * slope;
}

}  // namespace

// Two particles alone are less dense than the liquid: C < 0, so lambda = 0 (a liquid resists compression only), and only the
// artificial pressure moves them. At q = dq it has its nominal strength; nearer it is stronger and farther weaker by the fourth power of W.
TEST_IN_2D_AND_3D("artificial pressure pushes two particles apart by the fourth power of the kernel's ratio") {
    for (const Profile& profile : profiles)
        for (const real q : {0.2, 0.3, 0.5, 0.7}) {
            pbf::ReferencePbfSolver<D> plain(pair_scene<D>(profile.kernel, "reference"));
            const real exact = expected<D>(profile, q, plain.options().support);
            // Double precision; r^2 has a guard of 1e-10 h^2 added, which is 2.5e-9 of it at q = 0.2, times at most some ten powers.
            for (const real move : moves<D>(plain, q * plain.options().support * spacing))
                EXPECT_NEAR(move, exact, 1e-7 * exact) << profile.kernel << q;
            for (const auto* table : particles::available_passes()) {
                pbf::PbfSolver<D> fast(pair_scene<D>(profile.kernel, std::string("threads:") + table->name));
                // Single precision: two coordinates of 0.1 m round by 4e-9 m each, before and after: 1e-8 m of the move, and 1e-7 of r, of
                // which s_corr grad W is at most the 45th power (Wendland's at q = 0.7). The factors round by 1e-6 (unit.particles.single).
                for (const real move : moves<D>(fast, q * fast.options().support * spacing))
                    EXPECT_NEAR(move, exact, 2e-5 * exact + 1e-8) << profile.kernel << q << table->name;
            }
        }
}

}  // namespace artificial_pressure_tests
