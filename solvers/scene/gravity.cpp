#include "scene/gravity.hpp"

namespace weir::scene {

Variant gravity_effect(std::string doc) {
    Key g{.name = "g", .type = Type::numbers, .doc = "Acceleration.", .unit = "m/s^2", .required = true, .length = -1};
    g.example = "g = [0.0, -9.81]";
    return {"gravity", std::move(doc), {std::move(g)}, {"g"}};
}

}  // namespace weir::scene
