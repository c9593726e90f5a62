// The backend "reference" as a scene names it: a dam break on it and on threads through the registry of solvers, a restart, and what it
// refuses.
#include "core/checkpoint.hpp"
#include "shared/surroundings.hpp"
#include "sim/registry.hpp"

#include "support/test.hpp"

namespace {

using namespace weir;

/// A column of 8 x 8 [x 6] particles in a box of 24 x 12 [x 6] spacings of 1/16 m.
template <int D>
scene::Scene dam(const std::string& solver, const std::string& backend, const std::string& scheme = "", const std::string& more = "") {
    const std::string text = fmt::format(
        "title = \"dam\"\nsolver = \"{}\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime = {{ end = 1.0 }}\n"
        "fluid = {{ density = 1000.0 }}\nliquid = [{{ shape = \"box\", min = {}, max = {} }}]\n"
        "scheme = {{ support = 2.0, backend = \"{}\"{} }}\neffects.gravity = {{ g = {} }}\n{}\n",
        solver, D, test::list<D>(24, 12, 6), test::list<D>(1.5, 0.75, 0.375), test::list<D>(0, 0, 0), test::list<D>(0.5, 0.5, 0.375),
        backend, scheme, test::list<D>(0, -9.81, 0), more);
    return scene::parse(text, "dam.toml", sim::schemas());
}
std::unique_ptr<Solver> made(const scene::Scene& scene) { return sim::kind_named(scene.solver()).make(scene, {}); }

constexpr real h = 2.0 / 16;

/// The largest distance of a particle on one from the same on the other.
real apart(const Solver& a, const Solver& b) {
    const auto fa = a.fields(), fb = b.fields();
    const auto &x = fa.find("position")->data, &y = fb.find("position")->data;
    const auto ida = fa.find("id")->data[0], idb = fb.find("id")->data[0];
    EXPECT_EQ(std::vector<real>(ida.begin(), ida.end()), std::vector<real>(idb.begin(), idb.end()));
    real worst = 0;
    for (std::size_t i = 0; i < ida.size(); ++i) {
        real sum = 0;
        for (std::size_t c = 0; c < x.size(); ++c) sum += (x[c][i] - y[c][i]) * (x[c][i] - y[c][i]);
        worst = std::max(worst, std::sqrt(sum));
    }
    return worst;
}

struct Method {
    const char *solver, *scheme;
    real dt;
};
// PBF from its settled state: in the lattice that comes before it pairs are as far apart as the support, and rounding decides which of them
// are neighbours
const Method methods[] = {{"pbf", "", 0.005}, {"sph", "", 0.0005}, {"sph", ", density = \"summation\"", 0.0005}};

TEST_IN_2D_AND_3D("a dam breaks on the reference as on threads: 1e-5 of the support after a step, 1e-4 after ten") {
    for (const Method& m : methods) {
        auto here = made(dam<D>(m.solver, "reference", m.scheme)), there = made(dam<D>(m.solver, "threads", m.scheme));
        const auto start = made(dam<D>(m.solver, "reference", m.scheme));
        for (int s = 0; s < 10; ++s) {
            const StepReport a = here->step(m.dt), b = there->step(m.dt);
            EXPECT_EQ(a.iterations, b.iterations);
            EXPECT_NEAR(a.cfl, b.cfl, 1e-3);
            EXPECT_NEAR(a.density_error, b.density_error, 1e-5);  // a mean of numbers known to some 1e-6
            EXPECT_NEAR(here->advised_dt(), there->advised_dt(), 1e-4 * there->advised_dt());
            EXPECT_NEAR(here->stable_dt().dt, there->stable_dt().dt, 1e-3 * there->stable_dt().dt);
            // coordinates of up to 6 h in single precision are rounded to 4e-7 h; four iterations, each with a sum of tens of terms
            if (s == 0) {
                EXPECT_LE(apart(*here, *there), 1e-5 * h) << m.solver << m.scheme;
            }
        }
        // a step's rounding, 1e-6 h, stays as speed: after n steps n (n + 1) / 2 times that
        EXPECT_LE(apart(*here, *there), 1e-4 * h) << m.solver << m.scheme;
        EXPECT_GT(apart(*here, *there), 0) << "both are the same path";
        EXPECT_GT(apart(*here, *start), 0.5 * 9.81 * m.dt * m.dt * 55) << "nothing falls";
        const auto a = here->integrals(), b = there->integrals();
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].name, b[k].name);
    }
}

TEST_IN_2D_AND_3D("emitters and sinks act on the reference as on threads") {
    const std::string more = fmt::format(
        "emitters = [{{ shape = \"box\", min = {}, max = {}, velocity = {} }}]\nsinks = [{{ shape = \"box\", min = {}, max = {} }}]",
        test::list<D>(1, 0.5, 0.1), test::list<D>(1.1, 0.7, 0.3), test::list<D>(4, 0, 0), test::list<D>(0.4, 0, 0),
        test::list<D>(0.6, 0.1, 0.375));
    for (const Method& m : methods) {
        auto here = made(dam<D>(m.solver, "reference", m.scheme, more)), there = made(dam<D>(m.solver, "threads", m.scheme, more));
        for (int s = 0; s < 10; ++s) here->step(m.dt), there->step(m.dt);
        EXPECT_LE(apart(*here, *there), 1e-4 * h) << m.solver;  // which are the same particles, too
    }
}

TEST_IN_2D_AND_3D("a restart on the reference continues bit for bit") {
    for (const Method& m : methods) {
        auto through = made(dam<D>(m.solver, "reference", m.scheme)), first = made(dam<D>(m.solver, "reference", m.scheme)),
             second = made(dam<D>(m.solver, "reference", m.scheme));
        for (int s = 0; s < 8; ++s) through->step(m.dt);
        for (int s = 0; s < 5; ++s) first->step(m.dt);
        Checkpoint saved;
        first->save(saved);
        second->restore(saved);
        for (int s = 5; s < 8; ++s) second->step(m.dt);
        EXPECT_EQ(apart(*through, *second), 0) << m.solver;
        EXPECT_EQ(through->advised_dt(), second->advised_dt()) << m.solver;
    }
}

TEST("effects that the reference lacks are refused together, by name, with those it has; an unknown backend with all that are known") {
    const auto told = [](const char* solver, const char* backend, const std::string& more) -> std::string {
        try {
            made(dam<2>(solver, backend, "", more));
        } catch (const BadInput& e) {
            return e.what();
        }
        return "";
    };
    const std::string more =
        "effects.xsph = {}\neffects.vorticity = { epsilon = 0.1 }\nsides.x_min = { kind = \"periodic\" }\nsides.x_max = "
        "{ kind = \"periodic\" }\n";
    for (const char* solver : {"pbf", "sph"}) {
        EXPECT_EQ(told(solver, "threads", more), "");
        const std::string text = told(solver, "reference", more);
        EXPECT_NE(text.find("the backend reference has no effect \"xsph\""), std::string::npos) << text;
        EXPECT_NE(text.find("the backend reference has no effect \"vorticity\""), std::string::npos) << text;
        EXPECT_NE(text.find(std::string("it has gravity, ") + (solver[0] == 'p' ? "artificial_pressure" : "viscosity")), std::string::npos)
            << text;
        EXPECT_EQ(text.find("periods"), std::string::npos) << "24 spacings are more than two supports";
        for (const char* known : {"threads,", "threads:avx512", "opencl:N", "reference"})
            EXPECT_NE(told(solver, "referee", "").find(known), std::string::npos) << known;
        EXPECT_NE(told(solver, "reference:1", "").find("unknown backend"), std::string::npos);
    }
}

}  // namespace
