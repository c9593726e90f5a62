// Scenes of bodies in fluid for the tests.
#pragma once
#include "core/parallel.hpp"
#include "flow/solver.hpp"
#include "support/test.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

#include <memory>

namespace weir::test {

inline scene::Scene scene_of(const std::string& text) {
    static const std::vector<scene::SolverSchema> schemas{water::kind().schema, flow::kind().schema};
    return scene::parse(text, "bodies.toml", schemas);
}

inline std::unique_ptr<Solver> solver_of(const std::string& text) {
    const scene::Scene scene = scene_of(text);
    return scene.solver() == "mac" ? flow::kind().make(scene) : water::kind().make(scene);
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

inline void run(Solver& solver, real end, real most = infinity) {
    while (solver.time() < end * (1 - 1e-12)) solver.step(std::min({solver.advised_dt(), most, end - solver.time()}));
}

}  // namespace weir::test
