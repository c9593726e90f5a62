#include "unit/waves/support.hpp"
#include "waves/random.hpp"

#include <algorithm>

namespace ocean_tests {

using namespace weir;
using namespace weir::waves;
using weir::test::ask;
using weir::test::middle_of;
using weir::test::sea_scene;
using weir::test::values_of;

namespace {

/// What the FFT has at points of the sheet against the sum over all waves there.
void compare_with_sums(const scene::Scene& scene) {
    Waves solver(scene);
    solver.step(3.7);
    const FieldSet fields = solver.fields();
    const auto height = values_of(solver, "surface");
    const auto& position = fields.find("surface", "position")->data;
    const int nx = fields.grid.cells[0], nz = fields.grid.cells[2];
    for (const auto& [i, k] : {std::pair{0, 0}, {5, nz / 9}, {17, nz / 3}, {nx - 1, nz - 1}}) {
        const std::size_t at = static_cast<std::size_t>(i + k * nx);
        const Vec<3> rest = middle_of(fields, i, k);
        const Motion m = solver.model().motion(rest[0], rest[2]);
        EXPECT_NEAR(height[at], m.moved[1], 1e-12);
        EXPECT_NEAR(position[0][at] - rest[0], m.moved[0], 1e-11);
        for (int a = 0; a < fields.grid.dim; ++a) EXPECT_NEAR(values_of(solver, "velocity", a)[at], m.velocity[a], 1e-12);
        if (fields.find("jacobian") != nullptr) {
            EXPECT_NEAR(values_of(solver, "jacobian")[at], m.jacobian(), 1e-12);
        }
    }
}

}  // namespace

TEST("fields by FFT are the plain sums over all waves: flat and choppy, deep and shallow, on odd and even grids") {
    compare_with_sums(sea_scene(""));
    compare_with_sums(sea_scene(", choppiness = 0.8"));
    compare_with_sums(sea_scene(", choppiness = 0.8, depth = 9.0"));
    compare_with_sums(sea_scene(", choppiness = 0.8", "[45, 1, 35]"));
    compare_with_sums(
        test::wave_scene(2, "[64, 1]", "[200.0, 10.0]",
                         "waves = { model = \"spectrum\", choppiness = 1.0, spectrum = { kind = \"pierson_moskowitz\", wind = 8.0 } }"));
}

TEST("velocities are derivatives in time, and slopes of the displacement are in the Jacobian") {
    Waves solver(sea_scene(", choppiness = 1.0"));
    const Model& model = solver.model();
    solver.step(10);
    const Motion now = model.motion(31, 47);
    const real dt = 1e-4, h = 1e-4;
    solver.step(dt);
    const Motion after = model.motion(31, 47);
    solver.step(-2 * dt);
    const Motion before = model.motion(31, 47);
    solver.step(dt);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR((after.moved[a] - before.moved[a]) / (2 * dt), now.velocity[a], 1e-7);  // dt^2 omega^3 a
    const auto slope = [&](int of, real dx, real dz) {
        return (model.motion(31 + dx, 47 + dz).moved[of] - model.motion(31 - dx, 47 - dz).moved[of]) / (2 * h);
    };
    EXPECT_NEAR(slope(0, h, 0), now.xx, 1e-7);
    EXPECT_NEAR(slope(2, 0, h), now.zz, 1e-7);
    EXPECT_NEAR(slope(0, 0, h), now.xz, 1e-7);
}

TEST("the water below a sea has no divergence and no rotation, and its grid shows what it answers") {
    Waves solver(test::sea_scene(", depth = 8.0", "[24, 8, 18]"));
    solver.step(2);
    const real h = 1e-3;
    const auto u = [&](real x, real y, real z) { return ask<3>(solver, "velocity", {{x, y, z}}); };
    const auto d = [&](int of, int by) {
        Vec<3> up{{40, -2, 60}}, down = up;
        up[by] += h, down[by] -= h;
        const auto a = static_cast<std::size_t>(of);
        return (u(up[0], up[1], up[2])[a] - u(down[0], down[1], down[2])[a]) / (2 * h);
    };
    EXPECT_NEAR(d(0, 0) + d(1, 1) + d(2, 2), 0, 1e-8);  // (h k)^2/6 of the largest k, 0.8/m, of a slope of 0.2/s
    EXPECT_NEAR(d(0, 1) - d(1, 0), 0, 1e-8);
    EXPECT_NEAR(d(2, 1) - d(1, 2), 0, 1e-8);
    const FieldSet fields = solver.fields();
    const GridView& g = fields.grid;
    const std::size_t at = 7 + 24 * (2 + 8 * 11);
    const Vec<3> x{{g.origin[0] + 7.5 * g.spacing[0], g.origin[1] + 2.5 * g.spacing[1], g.origin[2] + 11.5 * g.spacing[2]}};
    for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(fields.find("", "velocity")->data[a][at], ask<3>(solver, "velocity", x)[a], 1e-12);
    EXPECT_NEAR(fields.find("level_set")->data[0][at], ask<1>(solver, "level_set", x)[0], 1e-12);
}

TEST("no bit depends on the number of threads, or on how a time was reached") {
    const auto run = [](int threads, int steps) {
        set_threads(threads);
        Waves solver(sea_scene(", choppiness = 1.0", "[48, 1, 36]", "effects.foam = {}\n"));
        for (int s = 0; s < steps; ++s) solver.step(8.0 / steps);
        std::vector<real> all;
        for (const FieldView& f : solver.fields().fields)
            for (const auto& values : f.data) all.insert(all.end(), values.begin(), values.end());
        for (const Integral& i : solver.integrals()) all.push_back(i.value);
        set_threads(0);
        return all;
    };
    const auto one = run(1, 1);
    EXPECT_EQ(one, run(2, 1));
    EXPECT_EQ(one, run(3, 1));
    EXPECT_EQ(one, run(1, 8));
    EXPECT_NE(one, run(1, 7));  // 8/7 is no number of a machine
}

TEST("a finer grid has the same sea, and shorter waves beside; another seed has another") {
    const auto at = [](const std::string& cells, const std::string& more) {
        Waves solver(sea_scene(", shortest = 20.0" + more, cells));
        solver.step(5);
        return ask<1>(solver, "surface", {{33, 0, 71}})[0];
    };
    const real height = at("[48, 1, 36]", "");
    EXPECT_GT(std::abs(height), 0.01);
    EXPECT_NEAR(at("[96, 1, 72]", ""), height, 1e-12);
    EXPECT_GT(std::abs(at("[48, 1, 36]", ", seed = 2") - height), 0.01);
    EXPECT_GT(std::abs(at("[48, 1, 36]", ", amplitudes = \"gaussian\"") - height), 0.001);
}

TEST("random numbers are whole-number arithmetic: the same on any machine, as worked out apart from this code") {
    EXPECT_EQ(uniform(1, 3, -2, 0), 0x1.a379aa94f3110p-1);
    EXPECT_EQ(uniform(7, -40, 0, 1), 0x1.71671e7b89504p-4);
    real sum = 0;
    for (int m = -50; m < 50; ++m)
        for (int n = -50; n < 50; ++n) sum += uniform(1, m, n, 0);
    EXPECT_NEAR(sum / 1e4, 0.5, 0.01);  // sqrt(1/12)/100 = 0.003
}

TEST("most waves of a sea with a narrow spread travel where the wind blows") {
    Waves solver(sea_scene(", spread = 40.0"));
    const auto mean_flux = [&](int a) {  // of energy: height times horizontal velocity
        const auto y = values_of(solver, "surface"), u = values_of(solver, "velocity", a);
        real sum = 0;
        for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * u[i];
        return sum;
    };
    EXPECT_NEAR(std::atan2(mean_flux(2), mean_flux(0)), 0.7, 0.1);
    EXPECT_GT(mean_flux(0), 0);
}

TEST("a choppy sea that folds says so, once it is not asked to mark the place with foam") {
    const std::string chop = ", choppiness = 9.0";
    Waves folded(sea_scene(chop)), marked(sea_scene(chop, "[48, 1, 36]", "effects.foam = { below = 0.5 }\n")),
        smooth(sea_scene(", choppiness = 0.3"));
    EXPECT_NE(folded.concern().find("folded over itself"), std::string::npos);
    EXPECT_EQ(marked.concern(), "");
    EXPECT_EQ(smooth.concern(), "");
    const auto foam = values_of(marked, "foam"), jacobian = values_of(marked, "jacobian");
    for (std::size_t i = 0; i < foam.size(); ++i) EXPECT_EQ(foam[i], std::clamp(1 - jacobian[i] / 0.5, 0.0, 1.0));
    EXPECT_EQ(*std::max_element(foam.begin(), foam.end()), 1);
}

}  // namespace ocean_tests
