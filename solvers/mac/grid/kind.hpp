// Shared by the solver kinds on this grid: choice of the dimension, and the table "scheme".
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace weir::mac {

/// Constructs the solver S of the scene's dimension.
template <template <int> class S>
std::unique_ptr<Solver> make(const scene::Scene& scene) {
    if (scene.dim() == 2) return std::make_unique<S<2>>(scene);
    return std::make_unique<S<3>>(scene);
}

/// The same for solvers without a free surface; they reject liquid in a part of the domain.
template <template <int> class S>
std::unique_ptr<Solver> make_without_surface(const scene::Scene& scene) {
    if (!scene.root().tables("liquid").empty())
        scene.refuse("liquid", "solver \"" + scene.solver() + "\" has no free surface and does not support liquid",
                     "solver \"mac_water\" has one");
    return make<S>(scene);
}

inline scene::Key scheme_key(std::vector<scene::Key> keys) {
    return {.name = "scheme", .type = scene::Type::table, .doc = "Numerical methods, by name.", .keys = std::move(keys)};
}

}  // namespace weir::mac
