// Initial fields by name: velocities and cell fields as functions of position.
#pragma once
#include "core/types.hpp"
#include "mac/grid/state.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <string>
#include <vector>

namespace weir::mac {

/// The velocities and shapes of cell fields that scenes may name under "initial", in addition to the common ones.
scene::Key initial_keys(const std::vector<std::string>& extra_fields = {});

/// The fields besides velocity with initial values in the scene.
std::vector<std::string> initial_fields(const scene::Scene& scene);

/// Sets u from "initial.velocity" (at rest where absent) and the faces of closed sides from the sides.
template <int D>
void set_initial_velocity(MacState<D>& s, const scene::Scene& scene);
/// Sets a cell field from "initial.<name>" (unchanged where absent).
template <int D>
void set_initial_field(Grid<real, D>& q, const MacVelocity<D>& grid, const scene::Scene& scene, const std::string& name);

/// The function described by a table { name = "gaussian", ... }.
template <int D>
std::function<real(const Vec<D>&)> field_function(const scene::Table& table);
template <int D>
std::function<Vec<D>(const Vec<D>&)> velocity_function(const scene::Table& table, real nu);

}  // namespace weir::mac
