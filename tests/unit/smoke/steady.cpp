// A steady flow is a property of the equations and the grid, not of the time step: with fluxes every term of a step is taken from the same
// state, so that a flow which one step leaves alone is left alone by every other. Along paths the step stays in the truncation error.
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

namespace weir::smoke::steady_tests {

namespace {

struct Case {
    const char* name;
    std::string scene;  // without its scheme
    real dt;            // the longest of its steps [s]
};

std::string box(int n, const std::string& rest) {
    const std::string cells = std::to_string(n);
    return "solver = \"mac\"\ndim = 2\ngrid = { cells = [" + cells + ", " + cells + "], size = [1.0, 1.0] }\ntime = { end = 1.0 }\n" + rest;
}

/// Air between a hot wall and a cold one, Ra = 1e4, and what else acts on it.
std::string heated(int n, const std::string& effects, const std::string& rest = "") {
    return box(n,
               "fluid = { viscosity = 0.0071 }\n"
               "sides = { x_min = { kind = \"wall\", slip = \"no\", temperature = 1.0 }, x_max = { kind = \"wall\", slip = \"no\", "
               "temperature = 0.0 },"
               " y_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"wall\", slip = \"no\" } }\n"
               "initial = { temperature = { name = \"linear\", value = 1.0, gradient = [-1.0, 0.0], at = [0.0, 0.0] } }\n"
               "effects = { buoyancy = { beta = 0.71, ambient = 0.5 }" +
                   effects + " }\n" + rest);
}
const std::string implicit = ", viscosity = {}, diffusion = { temperature = 0.01 }";
const std::string explicitly = ", viscosity = { scheme = \"explicit\" }, diffusion = { temperature = 0.01, scheme = \"explicit\" }";
const std::string backward = ", viscosity = { scheme = \"implicit\" }, diffusion = { temperature = 0.01, scheme = \"implicit\" }";

/// A cavity whose lid moves, Re = 100, and what else acts there.
std::string driven(const std::string& effects, const std::string& rest = "") {
    return box(16,
               "fluid = { viscosity = 0.01 }\n"
               "sides = { x_min = { kind = \"wall\", slip = \"no\" }, x_max = { kind = \"wall\", slip = \"no\" },"
               " y_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"moving_wall\", velocity = [1.0, 0.0] } }\n"
               "effects = { viscosity = {}" +
                   effects + " }\n" + rest);
}

std::string with(const std::string& scheme) { return "scheme = { " + scheme + ", poisson = { tolerance = 1e-10 } }\n"; }

using Values = std::vector<std::vector<real>>;

/// The velocity's components and the carried fields.
Values values(const FlowSolver<2>& flow) {
    Values list;
    for (int a = 0; a < 2; ++a) list.emplace_back(flow.state().u[a].values().begin(), flow.state().u[a].values().end());
    for (const auto& field : flow.state().fields) list.emplace_back(field.values.values().begin(), field.values.values().end());
    return list;
}

/// Largest difference of a quantity over its largest magnitude.
real distance(const Values& a, const Values& b) {
    real largest = 0;
    for (std::size_t q = 0; q < a.size(); ++q) {
        real difference = 0, magnitude = 0;
        for (std::size_t i = 0; i < a[q].size(); ++i) {
            difference = std::max(difference, std::abs(a[q][i] - b[q][i]));
            magnitude = std::max(magnitude, std::abs(a[q][i]));
        }
        largest = std::max(largest, difference / magnitude);
    }
    return largest;
}

/// Steps of dt until nothing changes by more than `rate` of itself in a second.
void settle(FlowSolver<2>& flow, real dt, real rate) {
    constexpr int between = 20;
    for (int steps = 0; steps < 20000; steps += between) {
        for (int i = 1; i < between; ++i) flow.step(dt);
        const Values last = values(flow);
        flow.step(dt);
        if (distance(last, values(flow)) < rate * dt) return;
    }
    FAIL() << "not steady";
}

/// How far the steady state of steps of dt is from that of a tenth of them. What is left to change when it counts as steady is the rate
/// times the slowest decay, the diffusion time of some 10 s.
real dependence(const std::string& scene, real dt, real rate) {
    FlowSolver<2> flow(test::mac_scene(scene));
    settle(flow, dt, rate);
    const Values at_dt = values(flow);
    settle(flow, dt / 10, rate);
    return distance(at_dt, values(flow));
}

}  // namespace

TEST("with fluxes a steady state does not depend on the step, whatever acts") {
    set_threads(1);  // threads would only wait for one another on so few cells
    const std::string ball = "emitters = [ { shape = \"sphere\", centre = [0.4, 0.3], radius = 0.12, ";
    const std::vector<Case> cases{
        {"buoyancy, conduction and viscosity, Crank-Nicolson", heated(16, implicit), 0.15},
        {"the same, explicit", heated(16, explicitly), 0.09},
        {"the same, implicit", heated(16, backward), 0.15},
        {"cooling", heated(16, implicit + ", cooling = { rate = 0.5, ambient = 0.3 }"), 0.15},
        {"cooling and explicit conduction", heated(16, explicitly + ", cooling = { rate = 0.5, ambient = 0.3 }"), 0.09},
        {"a solid", heated(16, implicit, "solids = [ { shape = \"sphere\", centre = [0.4, 0.3], radius = 0.15 } ]\n"), 0.15},
        {"emitted heat", heated(16, implicit, ball + "temperature = 2.0 } ]\n"), 0.1},
        {"emitted smoke that sinks, spreads and fades",
         driven(", buoyancy = { alpha = 0.2 }, diffusion = { smoke = 0.01 }, decay = { rate = 0.3 }", ball + "smoke = 1.0 } ]\n"), 0.1},
        {"smoke at a solid",
         driven(", diffusion = { smoke = 0.01 }, decay = { rate = 0.3 }",
                ball + "smoke = 1.0 } ]\nsolids = [ { shape = \"sphere\", centre = [0.6, 0.6], radius = 0.15 } ]\n"),
         0.1},
        {"gravity and confinement", driven(", gravity = { g = [0.3, -1.0] }, confinement = { epsilon = 0.05 }"), 0.1},
    };
    for (const char* flux : {"central", "van_leer"})
        for (const auto& c : cases)
            EXPECT_LE(dependence(c.scene + with("advection = \"conservative\", flux = \"" + std::string(flux) + "\""), c.dt, 1e-7), 1e-4)
                << c.name << ", " << flux;
}

// Interpolation errs by h²/dt a second times functions of the CFL number, and terms along a path by dt² (MacCormack, which takes half of
// each at either end) or dt: at a fixed CFL number the step's share falls with the grid, at the scheme's order.
TEST("along paths a steady state depends on the step at order 2 with MacCormack, at order 1 with semi-Lagrangian") {
    set_threads(1);  // threads would only wait for one another on so few cells
    const auto order = [](const std::string& scheme, const std::string& effects) {
        const auto at = [&](int n) { return dependence(heated(n, effects) + with(scheme), 3.2 / n, 1e-6); };
        return std::log2(at(12) / at(24));
    };
    const std::string cooled = implicit + ", cooling = { rate = 0.5, ambient = 0.3 }";
    EXPECT_GE(order("advection = \"maccormack\", limiter = \"none\"", implicit), 1.8);  // formal orders less 0.2
    EXPECT_GE(order("advection = \"maccormack\", limiter = \"none\"", cooled), 1.8);
    EXPECT_GE(order("advection = \"semi_lagrangian\"", cooled), 0.8);
}

}  // namespace weir::smoke::steady_tests
