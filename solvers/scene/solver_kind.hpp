// How a solver joins the program: its schema and its maker, registered once in sim/registry.cpp. Everything else (messages, describe,
// run, validate, studies) finds it there.
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <memory>

namespace weir::scene {

struct SolverKind {
    SolverSchema schema;
    std::function<std::unique_ptr<Solver>(const Scene&)> make;
};

}  // namespace weir::scene
