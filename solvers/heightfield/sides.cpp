#include "heightfield/sides.hpp"

#include <algorithm>
#include <cmath>

namespace weir::heightfield {

namespace {

/// Depth h with  2 sqrt(g h) - q/h = r:  an inflow discharge q > 0 with the outgoing invariant r. With s = sqrt(g h) it is f(s) = 2 s^3 - r
/// s^2 - g q = 0, which has one positive root; right of it f is increasing and convex, so Newton's method converges monotonically.
real depth_of_discharge(real q, real r, real g) {
    real s = std::max(0.0, r / 2) + std::cbrt(g * q / 2);
    for (int n = 0; n < 60; ++n) {
        const real next = s - ((2 * s - r) * s * s - g * q) / (6 * s * s - 2 * r * s);
        if (std::abs(next - s) <= 1e-15 * s) break;
        s = next;
    }
    return s * s / g;
}

Side read_side(const scene::Scene& scene, const std::string& path, int axis, int end) {
    const std::string& kind = scene.text(path + ".kind");
    Side side;
    if (kind == "wall") {
        if (scene.text(path + ".slip") == "no")
            scene.refuse(path + ".slip", "a height field has no boundary layers: its walls are free slip",
                         "use effects.friction for friction on the bed");
    } else if (kind == "periodic") {
        side.kind = SideKind::periodic;
    } else if (kind == "outflow" || kind == "open") {
        side.kind = SideKind::outflow;
    } else if (kind == "inflow") {
        side.kind = SideKind::inflow;
        const auto& u = scene.root().numbers(path + ".velocity");
        if (u[1] != 0) scene.refuse(path + ".velocity", "a height field has no vertical velocity: that along y is 0");
        const std::size_t normal = axis == 0 ? 0 : 2, other = 2 - normal;
        side.value = (end == 0 ? 1 : -1) * u[normal];
        side.along = other < u.size() ? u[other] : 0;
    } else if (kind == "discharge") {
        side.kind = SideKind::discharge;
        side.value = scene.number(path + ".discharge");
    } else if (kind == "level") {
        side.kind = SideKind::level;
        side.value = scene.number(path + ".level");
    } else {
        scene.refuse(path + ".kind", "a height field does not support walls that drag water",
                     "known: wall, inflow, outflow, open, discharge, level, periodic");
    }
    return side;
}

}  // namespace

Sides::Sides(const scene::Scene& scene) {
    for (int axis = 0; axis < scene.dim() - 1; ++axis)
        for (int end = 0; end < 2; ++end)
            if (const std::string path = std::string("sides.") + "xz"[axis] + (end == 0 ? "_min" : "_max"); scene.has(path))
                side[static_cast<std::size_t>(2 * axis + end)] = read_side(scene, path, axis, end);
    for (const std::string& name : scene.root().texts("grid.periodic")) {
        if (name == "y") scene.refuse("grid.periodic", "a height field cannot be periodic along y");
        const std::size_t first = name == "x" ? 0 : 2;
        side[first].kind = side[first + 1].kind = SideKind::periodic;
    }
}

Beside beside(const Side& side, const Beside& inside, real bed, real g) {
    const real c = std::sqrt(g * inside.h), leaving = inside.out + 2 * c;  // the outgoing invariant
    switch (side.kind) {
        case SideKind::inflow: {
            if (inside.out > c) return inside;
            const real s = std::max(0.0, (leaving + side.value) / 2);
            return {g > 0 ? s * s / g : inside.h, -side.value, side.along};
        }
        case SideKind::discharge: {
            if (side.value <= 0) return {inside.h, -inside.out, inside.along};  // no inflow: a wall
            const real h = g > 0 ? depth_of_discharge(side.value, leaving, g) : inside.h;
            return {h, h > 0 ? -side.value / h : 0, 0};
        }
        case SideKind::level: {
            if (inside.out > c) return inside;  // supercritical outflow: the level has no effect
            const real h = std::max(0.0, side.value - bed);
            const real out = leaving - 2 * std::sqrt(g * h);
            return {h, std::clamp(out, -std::sqrt(g * h), leaving), out < 0 ? 0 : inside.along};
        }
        default:
            return inside;
    }
}

}  // namespace weir::heightfield
