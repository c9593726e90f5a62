#include "validation/references/channel.hpp"
#include "validation/harness/fitting.hpp"

#include "validation/harness/reference.hpp"

#include <cmath>

namespace weir::validation {
namespace {

constexpr real negligible = 40;     // exp(-40) = 4e-18: further terms do not change a double
constexpr int most_terms = 200000;  // of times so near 0 that exp() does not end the sum before

}  // namespace

real poiseuille_startup(real y, real t, real H, real G, real nu) {
    if (t <= 0) return 0;
    real u = G / (2 * nu) * y * (H - y);
    for (int n = 0; n < most_terms; ++n) {
        const real k = (2 * n + 1) * pi / H;
        if (nu * k * k * t > negligible) break;
        u -= 4 * G / (nu * H * k * k * k) * std::sin(k * y) * std::exp(-nu * k * k * t);
    }
    return u;
}

real couette_startup(real y, real t, real H, real U, real nu) {
    if (t <= 0) return y < H ? 0 : U;
    real u = U * y / H;
    for (int n = 1; n < most_terms; ++n) {
        const real k = n * pi / H;
        if (nu * k * k * t > negligible) break;
        u += 2 * U / (n * pi) * (n % 2 ? -1 : 1) * std::sin(k * y) * std::exp(-nu * k * k * t);
    }
    return u;
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

namespace {

/// A flow along x that depends on the height above the lower plate only.
Reference parallel_flow(const scene::Scene& scene, std::string source, std::function<real(real y, real t)> u) {
    Reference ref{.source = std::move(source)};
    const real floor = scene.vec<2>("grid.origin")[1];
    ref.vectors["velocity"] = [u = std::move(u), floor](const Vec<3>& x, real t) { return Vec<3>{u(x[1] - floor, t), 0, 0}; };
    return ref;
}

}  // namespace

REFERENCE(poiseuille) {
    const real H = scene.vec<2>("grid.size")[1], nu = scene.number("fluid.viscosity");
    const real G = needed_effect(scene, "gravity").vec<2>("g")[0];
    return parallel_flow(scene, "plane Poiseuille flow from rest (exact series; Batchelor 1967, sec. 4.3)",
                         [=](real y, real t) { return poiseuille_startup(y, t, H, G, nu); });
}

REFERENCE(couette) {
    const real H = scene.vec<2>("grid.size")[1], nu = scene.number("fluid.viscosity");
    const real U = scene.vec<2>("sides.y_max.velocity")[0];
    return parallel_flow(scene, "plane Couette flow from rest (exact series; Batchelor 1967, sec. 4.3)",
                         [=](real y, real t) { return couette_startup(y, t, H, U, nu); });
}

REFERENCE(poiseuille_beside_solid) {
    const real H = scene.root().tables("solids").at(0).vec<2>("min")[1], nu = scene.number("fluid.viscosity");
    const real G = needed_effect(scene, "gravity").vec<2>("g")[0];
    Reference ref = parallel_flow(scene, "plane Poiseuille flow from rest (exact series; Batchelor 1967, sec. 4.3)",
                                  [=](real y, real t) { return poiseuille_startup(y, t, H, G, nu); });
    ref.covers = [=](const Vec<3>& x, real) { return x[1] < H; };
    return ref;
}

REFERENCE(turning_cylinder) {
    const auto solids = scene.root().tables("solids");
    const Vec<2> centre = solids.at(0).vec<2>("centre");
    const real inner = solids.at(0).number("radius"), outer = solids.at(1).tables("minus").at(0).number("radius");
    const real rate = solids.at(0).number("motion.rate"), square = inner * inner / (outer * outer - inner * inner);
    Reference ref{.source = "Taylor-Couette flow, steady (exact; Batchelor 1967, sec. 4.5)"};
    ref.vectors["velocity"] = [=](const Vec<3>& x, real) {
        const real dx = x[0] - centre[0], dy = x[1] - centre[1], turns = rate * square * (outer * outer / (dx * dx + dy * dy) - 1);
        return Vec<3>{-turns * dy, turns * dx, 0};
    };
    ref.covers = [=](const Vec<3>& x, real) {
        const real r = std::hypot(x[0] - centre[0], x[1] - centre[1]);
        return r > inner && r < outer;
    };
    return ref;
}

REFERENCE(cylinder_in_stream) {
    return {.source =
                "Tritton 1959; Coutanceau & Bouard 1977; Williamson 1989; Park, Kwon & Choi 1998: a cylinder in a stream without bounds"};
}

REFERENCE(backward_step) {
    return {.source =
                "Erturk 2008: reattachment at 2.922 heights of the step for Re = 100, by twice the inlet's height and its mean speed"};
}
