// Scenes of liquid and gas for the tests.
#pragma once
#include "core/parallel.hpp"
#include "support/test.hpp"
#include "two_phase/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace weir::test {

inline scene::Scene two_phase_scene(const std::string& text, const std::vector<scene::Override>& changes = {}) {
    static const std::vector<scene::SolverSchema> schemas{two_phase::kind().schema};
    return scene::parse(text, "two_phase.toml", schemas, changes);
}

inline std::string list(std::vector<std::string> entries, int dim) {
    std::string text = "[";
    for (int d = 0; d < dim; ++d) text += (d ? ", " : "") + entries[static_cast<std::size_t>(d)];
    return text + "]";
}

template <int D>
std::string box(const std::vector<std::string>& min, const std::vector<std::string>& max) {
    return "{ shape = \"box\", min = " + list(min, D) + ", max = " + list(max, D) + " }";
}

/// A tank of 1 m by 1 m (by 0.75 m), 1000:1, with gravity and n cells along x and y, without friction and tension. `liquid`: its shapes;
/// `more`: further lines.
template <int D>
std::string tank(int n, const std::string& liquid, const std::string& more) {
    const std::string along = std::to_string(n), across = std::to_string(3 * n / 4);
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 10.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {} ]
effects = {{ gravity = {{ g = {} }} }}
scheme = {{ poisson = {{ tolerance = 1e-10 }} }}
{}
)",
                       D, list({along, along, across}, D), list({"1.0", "1.0", "0.75"}, D), liquid, list({"0.0", "-9.81", "0.0"}, D), more);
}

/// The liquid of a tank up to a level [m].
template <int D>
std::string up_to(const std::string& level) {
    return box<D>({"-1.0", "-1.0", "-1.0"}, {"2.0", level, "2.0"});
}

/// A tank of 1 m by 1 m (by 0.75 m), 1000:1, with a column of liquid in its lower left corner. Viscosities and tension are so large that
/// each of them matters within a few steps.
template <int D>
std::string collapse(const std::string& more = "") {
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0, viscosity = 1e-3 }}
gas = {{ density = 1.0, viscosity = 1e-2 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
effects = {{ gravity = {{ g = {} }}, viscosity = {{}}, surface_tension = {{ sigma = 10.0 }} }}
scheme = {{ poisson = {{ tolerance = 1e-10 }} }}
{}
)",
                       D, list({"16", "16", "12"}, D), list({"1.0", "1.0", "0.75"}, D), list({"0.0", "0.0", "0.0"}, D),
                       list({"0.41", "0.63", "0.33"}, D), list({"0.0", "-9.81", "0.0"}, D), more);
}

/// A periodic box of n^D cells and 1 m with a drop of radius 0.2 m in its middle, 1000:1, without forces.
template <int D>
std::string drop(int n, const std::string& more = "") {
    const std::string cells = std::to_string(n);
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {}, periodic = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {{ shape = "sphere", centre = {}, radius = 0.2 }} ]
scheme = {{ poisson = {{ tolerance = 1e-12 }} }}
{}
)",
                       D, list({cells, cells, cells}, D), list({"1.0", "1.0", "1.0"}, D), list({"\"x\"", "\"y\"", "\"z\""}, D),
                       list({"0.5", "0.5", "0.5"}, D), more);
}

inline real integral(const Solver& solver, const std::string& name) {
    for (const auto& value : solver.integrals())
        if (value.name == name) return value.value;
    ADD_FAILURE() << "no integral " << name;
    return 0;
}

template <int D>
const Grid<real, D>& temperature(const two_phase::TwoPhase<D>& solver) {
    return *solver.state().find("temperature");
}

template <int D>
void run(two_phase::TwoPhase<D>& solver, int steps) {
    for (int step = 0; step < steps; ++step) solver.step(solver.advised_dt());
}

template <int D>
real max_speed(const two_phase::TwoPhase<D>& solver) {
    real most = 0;
    for (int a = 0; a < D; ++a) most = std::max(most, mac::max_magnitude(solver.state().u[a]));
    return most;
}

template <int D>
bool same_bits(const two_phase::TwoPhase<D>& one, const two_phase::TwoPhase<D>& other) {
    const auto same = [](const auto& a, const auto& b) { return std::equal(a.values().begin(), a.values().end(), b.values().begin()); };
    bool all = same(one.state().p, other.state().p);
    for (std::size_t i = 0; i < one.state().fields.size(); ++i)
        all = all && same(one.state().fields[i].values, other.state().fields[i].values);
    for (int a = 0; a < D; ++a) all = all && same(one.state().u[a], other.state().u[a]);
    return all;
}

/// The same bits by one thread, by three, and by a run that is restored after `before` of all steps.
template <int D>
void expect_reproducible(const scene::Scene& scene, int before, int after) {
    two_phase::TwoPhase<D> one(scene), three(scene), second(scene);
    set_threads(1);
    run(one, before);
    Checkpoint checkpoint;
    one.save(checkpoint);
    run(one, after);
    second.restore(checkpoint);
    run(second, after);
    set_threads(3);
    run(three, before + after);
    set_threads(1);
    for (const two_phase::TwoPhase<D>* other : {&three, &second}) {
        EXPECT_TRUE(same_bits(one, *other));
        const auto of_one = one.integrals(), of_other = other->integrals();
        for (std::size_t i = 0; i < of_one.size(); ++i) EXPECT_EQ(of_one[i].value, of_other[i].value) << of_one[i].name;
    }
}

}  // namespace weir::test
