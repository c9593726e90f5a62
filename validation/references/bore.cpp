// The depth behind a bore is the one at which the fan from the dam and the jump across the bore give the same velocity.
#include "validation/references/bore.hpp"

#include "validation/harness/fitting.hpp"

#include <cmath>

namespace weir::validation {
namespace {

/// Change of velocity across a bore between depths h and hr.
real jump(real h, real hr, real g) { return (h - hr) * std::sqrt(g / 2 * (h + hr) / (h * hr)); }

}  // namespace

real gravity_down(const scene::Scene& scene) { return -needed_effect(scene, "gravity").numbers("g").at(1); }

Dam dam_of(const scene::Scene& scene) {
    const auto& boxes = scene.root().tables("liquid");
    const real floor = scene.root().numbers("grid.origin").at(1);
    Dam dam{boxes.at(0).numbers("max").at(0), boxes.at(0).numbers("max").at(1) - floor, 0};
    if (boxes.size() > 1) dam.right = boxes.at(1).numbers("max").at(1) - floor;
    return dam;
}

Bore::Bore(const Dam& dam, real g) {
    const real c = std::sqrt(g * dam.left);
    h = root_between([&](real depth) { return 2 * (c - std::sqrt(g * depth)) - jump(depth, dam.right, g); }, dam.right, dam.left);
    u = 2 * (c - std::sqrt(g * h)), speed = h * u / (h - dam.right);
}

real Bore::reflected(real g) const {
    return root_between([&](real depth) { return jump(depth, h, g) - u; }, h, 10 * h);
}

}  // namespace weir::validation
