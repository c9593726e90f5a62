// What a scene of particles does not name costs nothing, and no step after the first allocates, but for room that grows: the neighbour
// list's where particles gather (by a quarter), that of the cells where they spread (by a half), that of the images beyond periodic sides.
#include "support/count_allocations.hpp"
#include "support/test.hpp"
#include "unit/pbf/scenes.hpp"
#include "unit/sph/scenes.hpp"

namespace weir {

namespace {

constexpr int steps_seen = 40;  // the arrays are rearranged every sixteenth

/// A box of 8 x 12 [x 8] spacings with gravity, and liquid 8 spacings deep in the part x < width of it; `more` is added.
template <int D>
std::unique_ptr<Solver> make(const std::string& solver, const std::string& scheme, const std::string& more, real width = 1,
                             bool periodic = false) {
    const std::string cells = D == 2 ? "[8, 12]" : "[8, 12, 8]";
    const std::string size = std::string(D == 2 ? "[1, 1.5]" : "[1, 1.5, 1]") + (periodic ? ", periodic = [\"x\"]" : "");
    if (solver == "pbf")
        return std::make_unique<pbf::PbfSolver<D>>(test::pbf_scene<D>(test::box<D>(width, 1, 1), scheme, more, cells, size));
    return std::make_unique<sph::SphSolver<D>>(test::sph_box<D>(width, 1, 1, scheme, more, cells, size));
}

/// Allocations of steps after the first.
long allocations_in_steps(Solver& solver) {
    const real dt = solver.advised_dt();
    solver.step(dt);
    const long before = test::allocations;
    for (int s = 0; s < steps_seen; ++s) solver.step(dt);
    return test::allocations - before;
}

/// Water with some ice, a warm wall and a heater.
template <int D>
std::string heat() {
    const std::string gradient = D == 2 ? "[20, 10]" : "[20, 10, 0]", lo = D == 2 ? "[0, 0]" : "[0, 0, 0]",
                      hi = D == 2 ? "[1, 1]" : "[1, 1, 1]";
    return "substance = \"water\"\ninitial.temperature = { name = \"linear\", value = 265, gradient = " + gradient +
           " }\nsides.x_min = { kind = \"wall\", temperature = 320 }\nheaters = [ { shape = \"box\", min = " + lo + ", max = " + hi +
           ", power = 100 } ]\n";
}

template <int D>
std::string ball() {
    return D == 2 ? "solids = [ { shape = \"sphere\", centre = [0.8, 0.2], radius = 0.15 } ]\n"
                  : "solids = [ { shape = \"sphere\", centre = [0.8, 0.2, 0.8], radius = 0.15 } ]\n";
}

}  // namespace

TEST_IN_2D_AND_3D("after the first, a step allocates nothing, whatever the scheme and the effects") {
    set_threads(1);  // OpenMP's runtime allocates when it makes its threads
    const std::string smooth = "effects.xsph = { c = 0.05 }\neffects.vorticity = { epsilon = 0.01 }\n";
    const struct {
        std::string solver, scheme, more;
    } scenes[] = {{"sph", "", ""},
                  {"sph", "kernel = \"muller\", support = 2.0, density = \"summation\"", "effects.artificial_viscosity = {}\n"},
                  {"sph", "tension = true", smooth + "effects.surface_tension = { sigma = 1.0 }\neffects.viscosity = {}\n"},
                  {"pbf", "", ""},
                  {"pbf", "warm_start = 0.0, tolerance = 1e-3", ""},
                  {"pbf", "", smooth + "effects.artificial_pressure = {}\n"},
                  {"sph", "", heat<D>()},
                  {"pbf", "", heat<D>()}};
    for (const auto& scene : scenes) {
        const auto solver = make<D>(scene.solver, scene.scheme, scene.more);
        EXPECT_EQ(allocations_in_steps(*solver), 0) << scene.solver << " { " << scene.scheme << " } " << scene.more;
    }
}

TEST_IN_2D_AND_3D("where a block collapses over a ball, or its images gather, room grows, and then no more") {
    set_threads(1);
    for (const char* name : {"sph", "pbf"})
        for (const bool periodic : {false, true}) {
            const auto solver = make<D>(name, "", periodic ? "" : ball<D>(), 0.5, periodic);
            for (int s = 0; s < 400; ++s) solver->step(solver->advised_dt());
            EXPECT_EQ(allocations_in_steps(*solver), 0) << name << (periodic ? " periodic" : " over a ball");
        }
}

TEST_IN_2D_AND_3D("an effect brings the passes that it needs and no others") {
    const auto passes = [](const std::string& solver, const std::string& more) {
        const auto s = make<D>(solver, "", more);
        s->step(s->advised_dt());
        std::vector<std::string> names;
        for (const auto& pass : s->passes().list()) names.push_back(pass.name);
        return names;
    };
    EXPECT_EQ(passes("sph", ""), (std::vector<std::string>{"neighbours", "forces", "effect gravity", "integrate", "density"}));
    EXPECT_EQ(passes("sph", heat<D>()),
              (std::vector<std::string>{"neighbours", "forces", "effect gravity", "integrate", "density", "heat"}));
    EXPECT_EQ(passes("pbf", ""),
              (std::vector<std::string>{"predict", "neighbours", "lambda", "correct", "update", "effect gravity", "warm start"}));
}

TEST_IN_2D_AND_3D("memory grows only with what is named") {
    for (const char* name : {"sph", "pbf"}) {
        const auto bytes = [&](const std::string& more, bool periodic) {
            const auto solver = make<D>(name, "", more, 1, periodic);
            solver->step(solver->advised_dt());
            return solver->bytes();
        };
        EXPECT_GT(bytes("", true), bytes("", false)) << name;  // images
        EXPECT_EQ(bytes("sinks = [ { shape = \"sphere\", centre = " + std::string(D == 2 ? "[0.5, 1.4]" : "[0.5, 1.4, 0.5]") +
                            ", radius = 0.01 } ]",
                        false),
                  bytes("", false))
            << name;
    }
}

}  // namespace weir
