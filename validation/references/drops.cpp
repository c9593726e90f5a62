#include "validation/references/drops.hpp"
#include "validation/harness/fitting.hpp"

#include "validation/harness/reference.hpp"

#include <cmath>

namespace weir::validation {

Ellipse stretched(const Ellipse& start, real Omega, real t, int steps) {
    const auto rate = [Omega](const Ellipse& e) {
        const real a2 = e.a * e.a, b2 = e.b * e.b;
        return Ellipse{-e.a * e.A, e.b * e.A, (e.A * e.A + Omega * Omega) * (a2 - b2) / (a2 + b2)};
    };
    const auto moved = [](const Ellipse& e, real h, const Ellipse& r) { return Ellipse{e.a + h * r.a, e.b + h * r.b, e.A + h * r.A}; };
    const real h = t / steps;
    Ellipse e = start;
    for (int s = 0; s < steps; ++s) {
        const Ellipse k1 = rate(e), k2 = rate(moved(e, h / 2, k1)), k3 = rate(moved(e, h / 2, k2)), k4 = rate(moved(e, h, k3));
        e = moved(moved(moved(moved(e, h / 6, k1), h / 3, k2), h / 3, k3), h / 6, k4);
    }
    return e;
}

real rotating_patch_pressure(real x, real y) {
    real sum = 0;
    for (int m = 1; m < 200; m += 2)  // terms fall as 1 / (m n (m^2 + n^2)): the rest is below 1e-6
        for (int n = 1; n < 200; n += 2)
            sum -= 32 / (m * n * pi * pi * (m * m + n * n) * pi * pi) * std::sin(m * pi * (x + 0.5)) * std::sin(n * pi * (y + 0.5));
    return sum;
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

namespace {

constexpr int points_of_curve = 200;

const scene::Table& disk(const scene::Scene& scene) { return scene.root().tables("liquid").at(0); }

}  // namespace

// The liquid is a disk (a cylinder along z in 3D), its velocity the strain of initial.velocity; effects.central_force may pull it.
REFERENCE(stretching_drop) {
    const scene::Table* field = scene.effect("central_force");
    const real R = disk(scene).number("radius"), Omega = field ? field->number("omega") : 0;
    const real end = scene.number("time.end");
    Reference ref{.source = field ? "oscillating drop in a central field (ODE; Monaghan & Rafiee 2013)"
                                  : "stretching drop (ODE; Monaghan 1994, J. Comput. Phys. 110, 399)"};
    Curve a{.label = "a, exact", .x = {}, .y = {}}, b{.label = "b, exact", .x = {}, .y = {}};
    Ellipse e{R, R, scene.number("initial.velocity.rate")};
    for (int k = 0; k <= points_of_curve; ++k) {
        if (k > 0) e = stretched(e, Omega, end / points_of_curve, 100);
        a.x.push_back(end * k / points_of_curve), b.x.push_back(a.x.back());
        a.y.push_back(e.a), b.y.push_back(e.b);
    }
    ref.curves = {{"a", a}, {"b", b}};
    ref.numbers["radius"] = R;
    return ref;
}

// The liquid is a square box centred where initial.velocity, a rotation, vanishes.
REFERENCE(rotating_patch) {
    const scene::Table& box = scene.root().tables("liquid").at(0);
    const Vec<2> lo = box.vec<2>("min"), hi = box.vec<2>("max");
    const real omega = scene.number("initial.velocity.omega"), L = hi[0] - lo[0];
    Reference ref{.source = "rigid start of a rotating square (series; Colagrossi 2005, Le Touze et al. 2013)"};
    const real scale = scene.number("fluid.density") * omega * omega * L * L;
    ref.numbers = {{"centre", scale * rotating_patch_pressure(0, 0)}, {"quarter", scale * rotating_patch_pressure(0.25, 0.25)}};
    return ref;
}

// The liquid is a circle or sphere at rest.
REFERENCE(static_drop) {
    const real R = disk(scene).number("radius");
    Reference ref{.source = "Laplace 1806: the pressure in a drop"};
    ref.numbers = {{"pressure", (scene.dim() - 1) * needed_effect(scene, "surface_tension").number("sigma") / R}, {"radius", R}};
    return ref;
}

// The liquid is a short capsule let go at rest in the middle of a domain: in 2D its second mode, of the circle of its area.
REFERENCE(swinging_drop) {
    const scene::Table& capsule = disk(scene);
    const Vec<2> from = capsule.vec<2>("from"), to = capsule.vec<2>("to");
    const real r = capsule.number("radius"), R = std::sqrt(r * r + 2 * r * norm(to - from) / pi);
    Reference ref{.source = "Rayleigh 1879, Proc. R. Soc. 29, 71: omega^2 = n (n^2 - 1) sigma/(rho R^3), n = 2"};
    const real sigma = needed_effect(scene, "surface_tension").number("sigma");
    ref.numbers["frequency"] = std::sqrt(6 * sigma / (scene.number("fluid.density") * R * R * R));
    ref.numbers["middle"] = 0.5 * (from[0] + to[0]) - 0.5 * (from[1] + to[1]);
    return ref;
}

// A short capsule of one fluid in the middle of the other, let go at rest: its second mode, of the circle or sphere of its volume.
REFERENCE(swinging_capsule) {
    const scene::Table& outer = disk(scene);
    const bool is_bubble = outer.text("shape") == "difference";
    const scene::Table& capsule = is_bubble ? outer.tables("minus").at(0) : outer;
    const int dim = scene.dim();
    const real length =
        dim == 2 ? norm(capsule.vec<2>("to") - capsule.vec<2>("from")) : norm(capsule.vec<3>("to") - capsule.vec<3>("from"));
    const real r = capsule.number("radius"), liquid = scene.number("fluid.density"), gas = scene.number("gas.density");
    const real inside = is_bubble ? gas : liquid, outside = is_bubble ? liquid : gas;
    const real R = dim == 2 ? std::sqrt(r * r + 2 * r * length / pi) : std::cbrt(r * r * r + 0.75 * r * r * length);
    const real mass = dim == 2 ? (inside + outside) / 6 : (3 * inside + 2 * outside) / 24;
    Reference ref{.source =
                      "Lamb 1932, Hydrodynamics, art. 273 and 275: omega^2 = n (n^2 - 1) sigma/((rho_i + rho_e) R^3) for cylinders, "
                      "(n - 1) n (n + 1) (n + 2) sigma/(((n + 1) rho_i + n rho_e) R^3) for spheres, n = 2"};
    const real sigma = needed_effect(scene, "surface_tension").number("sigma");
    ref.numbers = {{"frequency", std::sqrt(sigma / (mass * R * R * R))}, {"radius", R}};
    return ref;
}

// The liquid is a box in the corner of a wall and a floor that it sticks to, and spreads on that floor.
REFERENCE(viscous_current) {
    const scene::Table& box = disk(scene);
    const Vec<2> to = box.vec<2>("max");
    const Vec<2> g = needed_effect(scene, "gravity").vec<2>("g");
    const real A = to[0] * to[1], reach = 1.411 * std::pow(norm(g) * A * A * A / (3 * scene.number("fluid.viscosity")), 0.2);
    Reference ref{.source = "Huppert 1982, J. Fluid Mech. 121, 43: x_N = 1.411 (g A^3/(3 nu))^(1/5) t^(1/5)"};
    ref.numbers = {{"reach", reach}, {"wall", 0.0}};
    Curve front{.label = "Huppert 1982", .x = {}, .y = {}};
    for (int k = 1; k <= points_of_curve; ++k) {
        front.x.push_back(scene.number("time.end") * k / points_of_curve);
        front.y.push_back(reach * std::pow(front.x.back(), 0.2));
    }
    ref.curves["front"] = front;
    return ref;
}
