// Scenes of bodies in fluid for the tests.
#pragma once
#include "core/parallel.hpp"
#include "smoke/solver.hpp"
#include "support/test.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

#include <memory>

namespace weir::test {

inline scene::Scene scene_of(const std::string& text) {
    static const std::vector<scene::SolverSchema> schemas{water::kind().schema, smoke::kind().schema};
    return scene::parse(text, "bodies.toml", schemas);
}

inline std::unique_ptr<Solver> solver_of(const std::string& text) {
    const scene::Scene scene = scene_of(text);
    return scene.solver() == "mac" ? smoke::kind().make(scene, {}) : water::kind().make(scene, {});
}

/// Loops of problems too small to share are not shared while it lives, as a Simulation sees to.
struct OneThread {
    OneThread() { set_threads(1); }
    ~OneThread() { set_threads(0); }
};

/// The component of a field of body number `body`.
inline real shown(const Solver& solver, const char* field, std::size_t component, std::size_t body = 0) {
    const FieldSet set = solver.fields();
    return set.find(rigid::body_set_name, field)->data[component][body];
}

/// A box that crosses five cells in a step towards a ball and a wall, over a floor; `more`: further bodies.
inline std::string box_that_strikes(const std::string& more = "") {
    return R"(solver = "mac"
dim = 3
grid = { cells = [20, 16, 12], size = [1.0, 0.8, 0.6] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
effects = { gravity = { g = [0.0, -9.81, 0.0] } }
solids = [ { shape = "box", min = [-0.1, -0.1, -0.1], max = [1.1, 0.11, 0.7] } ]
bodies = [ { shape = "box", min = [0.1, 0.3, 0.1], max = [0.3, 0.45, 0.3], density = 300.0, spin = [1.0, 5.0, 2.0], velocity = [25.0, 0.0, 0.5] },
           { shape = "sphere", centre = [0.75, 0.5, 0.3], radius = 0.1, density = 500.0 })" +
           more + " ]\n";
}

/// A box on a box in the water, and a ball that spins near the floor.
inline std::string bodies_that_touch(real ball) {
    return fmt::format(
        "{{ shape = \"box\", min = [0.1, 0.41], max = [0.3, 0.55], density = 300.0, friction = 0.3 }}, {{ shape = \"box\", min = "
        "[0.12, 0.56], max = [0.28, 0.66], density = 2000.0 }}, {{ shape = \"sphere\", centre = [0.7, {}], radius = 0.1, "
        "density = 5000.0, spin = [1.0] }}",
        ball);
}

/// Of everything that bodies show, to the bit.
inline void expect_same_bodies(const Solver& one, const Solver& two, std::size_t bodies, int dim) {
    const std::size_t axes = dim == 2 ? 2 : 3, turns = dim == 2 ? 1 : 3;
    for (std::size_t body = 0; body < bodies; ++body) {
        for (const char* field : {"position", "velocity", "force"})
            for (std::size_t a = 0; a < axes; ++a) EXPECT_EQ(shown(one, field, a, body), shown(two, field, a, body)) << field << body;
        for (const char* field : {dim == 2 ? "angle" : "rotation", "spin", "torque"})
            for (std::size_t a = 0; a < turns; ++a) EXPECT_EQ(shown(one, field, a, body), shown(two, field, a, body)) << field << body;
    }
}

/// Of a list of numbers in their checkpoints.
inline void expect_same_numbers(const Solver& one, const Solver& two, const char* name) {
    Checkpoint a, b;
    one.save(a), two.save(b);
    std::vector<real> p, q;
    a.get(name, p), b.get(name, q);
    EXPECT_EQ(p, q) << name;
}

inline void run(Solver& solver, real end, real most = infinity) {
    while (solver.time() < end * (1 - 1e-12)) solver.step(std::min({solver.advised_dt(), most, end - solver.time()}));
}

}  // namespace weir::test
