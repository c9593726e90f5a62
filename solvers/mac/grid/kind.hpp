// Shared by the solver kinds on this grid: choice of the dimension, and the table "scheme".
#pragma once
#include "core/solver.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <utility>
#include <vector>

namespace weir::mac {

/// Constructs the solver S of the scene's dimension; `more`: further arguments of its constructor, such as the partition.
template <template <int> class S, class... More>
std::unique_ptr<Solver> make(const scene::Scene& scene, const More&... more) {
    if (scene.dim() == 2) return std::make_unique<S<2>>(scene, more...);
    return std::make_unique<S<3>>(scene, more...);
}

/// The same for solvers without a free surface; they reject liquid in a part of the domain.
template <template <int> class S, class... More>
std::unique_ptr<Solver> make_without_surface(const scene::Scene& scene, const More&... more) {
    if (!scene.root().tables("liquid").empty())
        scene.refuse("liquid", "solver \"" + scene.solver() + "\" has no free surface and does not support liquid",
                     "solver \"mac_water\" has one");
    return make<S>(scene, more...);
}

inline scene::Key scheme_key(std::vector<scene::Key> keys) {
    return {.name = "scheme", .type = scene::Type::table, .doc = "Numerical methods, by name.", .keys = std::move(keys)};
}

}  // namespace weir::mac
