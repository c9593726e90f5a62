// Warnings about bodies of a scene that are probably unintended.
#pragma once
#include "scene/scene.hpp"

#include <string>

namespace weir::rigid {

/// A warning about bodies that sink because the scene gives no fluid density, which is then that of air; otherwise empty.
std::string remark_on_density(const scene::Scene& scene);

}  // namespace weir::rigid
