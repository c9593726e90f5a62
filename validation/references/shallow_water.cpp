// Exact solutions of the shallow-water equations, as collected by SWASHES (Delestre, Lucas, Ksinant, Darboux, Laguerre, Vo, James &
// Cordier 2013). Depth, surface and velocity; a height field's samples have no height of their own, so that y is not looked at.
#include "scene/formula.hpp"
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"
#include "validation/references/bore.hpp"

#include <algorithm>
#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

/// A formula of the scene, of x and in 3D of z.
ScalarField formula_of(const scene::Scene& scene, const std::string& path) {
    const bool flat = scene.dim() == 3;
    const scene::Formula f(scene.text(path), flat ? std::vector<std::string>{"x", "z"} : std::vector<std::string>{"x"});
    return [f](const Vec<3>& x, real) {
        const real at[2] = {x[0], x[2]};
        return f(at);
    };
}
ScalarField bed_of(const scene::Scene& scene) {
    if (!scene.has("terrain")) {
        const real floor = scene.root().numbers("grid.origin").at(1);
        return [floor](const Vec<3>&, real) { return floor; };
    }
    return formula_of(scene, "terrain.height");
}

/// Depth and velocity along x as functions of x and time.
struct Flow {
    real h = 0, u = 0;
};
void add_flow(Reference& ref, const std::function<Flow(real x, real t)>& flow) {
    ref.scalars["depth"] = [flow](const Vec<3>& x, real t) { return flow(x[0], t).h; };
    ref.vectors["velocity"] = [flow](const Vec<3>& x, real t) { return Vec<3>{{flow(x[0], t).u, 0, 0}}; };
}

/// The fan of Ritter 1892, from still water of depth h at the left.
Flow fan(real h, real g, real x, real t) {
    const real c = std::sqrt(g * h), xi = x / t;
    return {4 / (9 * g) * (c - xi / 2) * (c - xi / 2), 2.0 / 3 * (xi + c)};
}

}  // namespace

REFERENCE(lake_at_rest) {
    Reference ref{.source = "water at rest (the C-property of Bermudez & Vazquez 1994)"};
    const ScalarField surface = formula_of(scene, "initial.surface"), bed = bed_of(scene);
    ref.scalars["surface"] = [=](const Vec<3>& x, real t) { return std::max(surface(x, t), bed(x, t)); };
    ref.scalars["depth"] = [=](const Vec<3>& x, real t) { return std::max(0.0, surface(x, t) - bed(x, t)); };
    ref.vectors["velocity"] = [](const Vec<3>&, real) { return Vec<3>{}; };
    return ref;
}

REFERENCE(ritter) {
    Reference ref{.source = "Ritter 1892: a dam breaks on dry ground"};
    const Dam dam = dam_of(scene);
    const real g = gravity_down(scene), c = std::sqrt(g * dam.left);
    add_flow(ref, [=](real x, real t) -> Flow {
        const real from = x - dam.x;
        if (from <= -c * t) return {from < 0 || t > 0 ? dam.left : 0, 0};
        if (from >= 2 * c * t) return {};
        return fan(dam.left, g, from, t);
    });
    ref.numbers["front_speed"] = 2 * c;
    return ref;
}

REFERENCE(stoker) {
    Reference ref{.source = "Stoker 1957: a dam breaks on wet ground"};
    const Dam dam = dam_of(scene);
    const real g = gravity_down(scene), c = std::sqrt(g * dam.left);
    const Bore bore(dam, g);
    const real tail = bore.u - std::sqrt(g * bore.h);
    add_flow(ref, [=](real x, real t) -> Flow {
        const real from = x - dam.x;
        if (from <= -c * t) return {dam.left, 0};
        if (from <= tail * t) return fan(dam.left, g, from, t);
        return from <= bore.speed * t ? Flow{bore.h, bore.u} : Flow{dam.right, 0};
    });
    ref.numbers["middle_depth"] = bore.h, ref.numbers["middle_speed"] = bore.u, ref.numbers["shock_speed"] = bore.speed;
    return ref;
}

namespace {

/// Steady flow of discharge q over a bed: Bernoulli's h + z + q^2/(2 g h^2) = E, on the branch that is asked for.
struct Bernoulli {
    real q, g;
    real critical() const { return std::cbrt(q * q / g); }
    real head(real h, real z) const { return h + z + q * q / (2 * g * h * h); }
    real depth(real head_, real z, bool shooting) const {
        const real c = critical();
        const auto f = [&](real h) { return head(h, z) - head_; };
        if (f(c) >= 0) return c;
        return shooting ? root_between(f, 1e-3 * c, c) : root_between(f, c, std::max(2 * head_, 2 * c));
    }
    /// Momentum flux over g, which a jump keeps.
    real thrust(real h) const { return q * q / (g * h) + h * h / 2; }
};

}  // namespace

REFERENCE(flow_over_bump) {
    Reference ref{.source = "Goutal & Maurel 1997, by Bernoulli and the jump's momentum"};
    const Bernoulli flow{scene.number("sides.x_min.discharge"), gravity_down(scene)};
    const ScalarField bed = bed_of(scene);
    const auto z = [bed](real x) { return bed({{x, 0, 0}}, 0); };
    const real left = scene.root().numbers("grid.origin").at(0), right = left + scene.root().numbers("grid.size").at(0);
    real crest = left;  // the bump's top
    constexpr int places = 100000;
    for (int i = 0; i <= places; ++i)
        if (const real x = left + (right - left) * i / places; z(x) > z(crest)) crest = x;
    const real head_crest = flow.head(flow.critical(), z(crest));
    const bool held = scene.text("sides.x_max.kind") == "level";
    const real head_below = held ? flow.head(scene.number("sides.x_max.level") - z(right), z(right)) : 0;
    const bool subcritical = held && head_below >= head_crest;
    real jump = held ? crest : infinity;
    if (held && !subcritical) {  // where the shooting flow behind the crest has the thrust of the tranquil one before the outlet
        const auto differs = [&](real x) {
            return flow.thrust(flow.depth(head_crest, z(x), true)) - flow.thrust(flow.depth(head_below, z(x), false));
        };
        real toe = crest;
        while (toe < right && flow.head(flow.critical(), z(toe)) > head_below) toe += (right - left) / places;
        jump = differs(right) > 0 ? infinity : root_between(differs, toe, right);  // else it is washed out of the end
    }
    const auto depth = [=](real x) {
        if (subcritical) return flow.depth(head_below, z(x), false);
        return x < jump ? flow.depth(head_crest, z(x), x > crest) : flow.depth(head_below, z(x), false);
    };
    add_flow(ref, [=](real x, real) -> Flow {
        const real h = depth(x);
        return {h, flow.q / h};
    });
    ref.numbers["jump"] = jump;
    ref.numbers["discharge"] = flow.q;
    return ref;
}

REFERENCE(thacker_planar) {
    Reference ref{.source = "Thacker 1981: a planar surface turns in a paraboloid, a = 1 m, h0 = 0.1 m, eta = 0.5 m (SWASHES)"};
    constexpr real a = 1, h0 = 0.1, eta = 0.5, middle = 2;
    const real omega = std::sqrt(2 * gravity_down(scene) * h0) / a;
    const auto depth = [=](const Vec<3>& x, real t) {
        const real X = x[0] - middle, Z = x[2] - middle, bed = -h0 * (1 - (X * X + Z * Z) / (a * a));
        return std::max(0.0, eta * h0 / (a * a) * (2 * X * std::cos(omega * t) + 2 * Z * std::sin(omega * t) - eta) - bed);
    };
    ref.scalars["depth"] = depth;
    ref.vectors["velocity"] = [=](const Vec<3>& x, real t) {
        if (depth(x, t) == 0) return Vec<3>{};
        return Vec<3>{{-eta * omega * std::sin(omega * t), 0, eta * omega * std::cos(omega * t)}};
    };
    ref.numbers["period"] = 2 * pi / omega;
    return ref;
}

REFERENCE(simple_wave) {
    Reference ref{.source = "a simple wave of one family (Stoker 1957, sec. 10.3)"};
    // h keeps its value along dx/dt = u + c = 3 c - 2 c0 while u = 2 (c - c0), until it breaks; the scene gives h and u at t = 0
    const real g = gravity_down(scene), wide = scene.root().numbers("grid.size").at(0);
    const ScalarField surface = formula_of(scene, "initial.surface"), bed = bed_of(scene);
    const auto start = [=](real x) { return surface({{x, 0, 0}}, 0) - bed({{x, 0, 0}}, 0); };
    real least = start(0), most = least;
    for (int i = 0; i < 20000; ++i) {
        const real h = start(wide * i / 20000);
        least = std::min(least, h), most = std::max(most, h);
    }
    const real c0 = std::sqrt(g * start(0)) - formula_of(scene, "initial.velocity.x")(Vec<3>{}, 0) / 2;
    add_flow(ref, [=](real x, real t) -> Flow {
        const auto speed = [&](real h) { return 3 * std::sqrt(g * h) - 2 * c0; };
        const real slack = 1e-3 * (most - least) + 1e-12;
        // where it came from: x = from + speed(start(from)) t grows with from as long as nothing has broken
        const real from =
            root_between([&](real y) { return y + speed(start(y)) * t - x; }, x - speed(most + slack) * t, x - speed(least - slack) * t);
        const real h = start(from);
        return {h, 2 * (std::sqrt(g * h) - c0)};
    });
    return ref;
}

REFERENCE(solitary_wave) {
    Reference ref{.source = "Boussinesq 1872, Rayleigh 1876 (profile); Synolakis 1987 (run-up)"};
    // the scene gives surface and velocity at t = 0; what dispersion would keep of it: its shape, at c = sqrt(g (d + H))
    const real g = gravity_down(scene), left = scene.root().numbers("grid.origin").at(0), wide = scene.root().numbers("grid.size").at(0);
    const ScalarField surface = formula_of(scene, "initial.surface"), bed = bed_of(scene);
    real crest = 0;
    constexpr int places = 100000;
    for (int i = 0; i <= places; ++i) crest = std::max(crest, surface({{left + wide * i / places, 0, 0}}, 0));
    const real depth = -bed({{left, 0, 0}}, 0), speed = std::sqrt(g * (depth + crest));
    ref.scalars["surface"] = [=](const Vec<3>& x, real t) { return surface({{x[0] - speed * t, 0, 0}}, 0); };
    ref.scalars["depth"] = [=](const Vec<3>& x, real t) { return surface({{x[0] - speed * t, 0, 0}}, 0) - bed(x, t); };
    const real right = left + wide, slope = (bed({{right, 0, 0}}, 0) - bed({{right - 1e-3 * wide, 0, 0}}, 0)) / (1e-3 * wide);
    if (slope > 0) ref.numbers["run_up"] = 2.831 * depth * std::sqrt(1 / slope) * std::pow(crest / depth, 1.25);
    return ref;
}

namespace {

/// f on so many times from 0 to `end`.
template <class F>
Curve history(const std::string& label, real end, F&& f) {
    Curve curve{.label = label, .x = {}, .y = {}};
    constexpr int points = 4000;
    for (int i = 0; i <= points; ++i) curve.x.push_back(end * i / points), curve.y.push_back(f(end * i / points));
    return curve;
}

}  // namespace

REFERENCE(long_wave) {
    Reference ref{.source = "omega = k sqrt(g d): waves much longer than the water is deep (Lamb 1932, sec. 169)"};
    const scene::Table& wave = scene.root().tables("liquid").at(0);
    const real floor = scene.root().numbers("grid.origin").at(1), k = 2 * pi / wave.number("wavelength");
    const real omega = k * std::sqrt(gravity_down(scene) * (wave.number("level") - floor)), a = wave.number("amplitude");
    ref.numbers["frequency"] = omega, ref.numbers["amplitude"] = a;
    ref.curves["amplitude"] = history("long waves", 1.1 * scene.number("time.end"), [=](real t) { return a * std::cos(omega * t); });
    return ref;
}

REFERENCE(heave) {
    Reference ref{.source = "long waves that a heaving box radiates along a channel (Lannes 2017; Bocchi 2020)"};
    // Below a box of length L, D above the bed, the water moves at -Y' x/D, so that its pressure bears rho L^3/(12 D) of added mass; at the
    // ends it makes waves of height -Y' L/(2 c). So (M + rho L^3/(12 D)) Y'' + rho g L^2/(2 c) Y' + rho g L Y = 0, a metre of the channel.
    const scene::Table& box = scene.root().tables("floats").at(0);
    const real g = gravity_down(scene), rho = scene.number("fluid.density"), length = box.numbers("size").at(0),
               height = box.numbers("size").at(1);
    const real density = box.number("density"), depth = -bed_of(scene)({}, 0), draft = density * height, gap = depth - draft;
    const real mass = rho * density * length * height + rho * length * length * length / (12 * gap);
    const real damping = rho * g * length * length / (2 * std::sqrt(g * depth)) / (2 * mass), stiffness = rho * g * length / mass;
    const real omega = std::sqrt(stiffness - damping * damping), start = box.numbers("at").at(1) + draft;
    ref.numbers["draft"] = draft, ref.numbers["frequency"] = omega, ref.numbers["start"] = start;
    ref.curves["height"] = history("long waves", 1.1 * scene.number("time.end"), [=](real t) {
        return start * std::exp(-damping * t) * (std::cos(omega * t) + damping / omega * std::sin(omega * t)) - draft;
    });
    return ref;
}

REFERENCE(dragged) {
    Reference ref{.source = "Mach's angle, sin a = c/U: waves that all run at c = sqrt(g d)"};
    const scene::Table& box = scene.root().tables("floats").at(0);
    const real c = std::sqrt(-gravity_down(scene) * bed_of(scene)({}, 0)), speed = box.numbers("motion.velocity").at(0);
    ref.numbers["angle"] = std::asin(std::min(1.0, c / speed));
    return ref;
}
