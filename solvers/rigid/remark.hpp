// What a scene with bodies says without meaning it.
#pragma once
#include "scene/scene.hpp"

#include <string>

namespace weir::rigid {

/// Of bodies that sink because the scene names no density for its fluid, which is then that of air; empty where there are none.
std::string remark_on_density(const scene::Scene& scene);

}  // namespace weir::rigid
