// What the order of the passes of a step does to flows that should not know the step.
#include "support.hpp"

namespace weir::water::splitting_tests {

namespace {

constexpr real honey = 0.02;

/// Water 0.5 m deep and as viscous as that between no-slip walls; open along x where that repeats.
std::string viscous(bool film, real nu, const std::string& g, const std::string& scheme, const std::string& transfer) {
    const char* const stick = "{ kind = \"wall\", slip = \"no\" }";
    return fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = {}, size = {} }}
time = {{ end = 9.0 }}
fluid = {{ density = 1000.0, viscosity = {} }}
sides = {{ y_min = {}{} }}
liquid = [ {{ shape = "plane", point = [0.0, 0.5], normal = [0.0, 1.0] }} ]
effects = {{ gravity = {{ g = {} }}, viscosity = {{ scheme = "{}" }} }}
scheme = {{ transfer = "{}", poisson = {{ tolerance = 1e-12 }} }}
)",
                       film ? "[4, 12]" : "[16, 16]", film ? "[0.25, 0.75], periodic = [\"x\"]" : "[1.0, 1.0]", nu, stick,
                       film ? "" : fmt::format(", x_min = {0}, x_max = {0}", stick), g, scheme, transfer);
}

/// The fastest of the film, which flows along x, when it is steady.
real film_speed(const std::string& scheme, real dt) {
    Water<2> water(test::water_scene(viscous(true, honey, "[0.05, -1.0]", scheme, "grid")));
    constexpr real diffusion_times = 5;  // H²/ν; the slowest mode decays by π²/4 in one: 4e-6 are left
    const int steps = static_cast<int>(diffusion_times * 0.25 / honey / dt);
    for (int i = 0; i < steps; ++i) water.step(dt);
    return water.state().u[0]({2, 7});
}

/// Amplitude of cos(k x) of a wave as long as the tank after `time`, in `steps` steps, over that at the start.
real amplitude(const std::string& transfer, real time, int steps) {
    constexpr int n = 32, rows = 24;
    Water<2> water(test::water_scene(fmt::format(R"(solver = "mac_water"
dim = 2
grid = {{ cells = [{}, {}], size = [1.0, 0.75] }}
time = {{ end = 9.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "wave", level = 0.5, amplitude = 0.01, wavelength = 1.0 }} ]
effects = {{ gravity = {{ g = [0.0, -9.81] }} }}
scheme = {{ transfer = "{}", flip_blend = 1.0, poisson = {{ tolerance = 1e-10 }} }}
)",
                                                 n, rows, transfer)));
    const auto mode = [&] {
        const auto& phi = water.surface().phi;
        real sum = 0;
        for (int i = 0; i < n; ++i) {
            int j = rows - 2;
            while (phi({i, j}) >= 0) --j;
            sum += (j + phi({i, j}) / (phi({i, j}) - phi({i, j + 1}))) * std::cos(2 * pi * (i + 0.5) / n);
        }
        return sum;
    };
    const real start = mode();
    for (int i = 0; i < steps; ++i) water.step(time / steps);
    return mode() / start;
}

/// Order of what is left to change when steps are halved twice.
real order(real coarse, real middle, real fine) { return std::log2(std::abs(coarse - middle) / std::abs(middle - fine)); }

}  // namespace

TEST("viscous water between no-slip walls stays at rest, whatever the step") {
    set_threads(1);  // threads would only wait for one another on so few cells
    for (const char* scheme : {"crank-nicolson", "implicit"})
        for (const auto& [nu, dt] : {std::pair{honey, 0.02}, std::pair{honey, 0.002}, std::pair{100 * honey, 0.02}}) {
            Water<2> water(test::water_scene(viscous(false, nu, "[0.0, -9.81]", scheme, "grid")));
            for (int i = 0; i < 50; ++i) water.step(dt);
            real fastest = 0;  // of the faces of liquid
            for (int a = 0; a < 2; ++a)
                for_each_in(Index<2>{}, replicated(Index<2>{{16, 8}}),
                            [&](const Index<2>& I) { fastest = std::max(fastest, std::abs(water.state().u[a](I))); });
            EXPECT_LE(fastest, 50 * 1e-12 * 9.81 * dt * 16)
                << scheme << ", nu " << nu << ", dt " << dt;  // tolerance of what g dt asks for, 16 cells wide
        }
}

// Friction feels the force of its own step: K u = M g. What is left of the start is 4e-6 of 0.3 m/s; were it to act before the force, θ dt
// g = 6e-4 and more would be between the two steps.
TEST("a film's steady speed does not depend on the step") {
    set_threads(1);  // threads would only wait for one another on so few cells
    for (const char* scheme : {"crank-nicolson", "implicit"}) {
        const real dt = 0.05, slow = film_speed(scheme, dt / 2), fast = film_speed(scheme, dt);
        EXPECT_NEAR(fast, slow, 4e-6 * 0.3) << scheme;
    }
}

// Surface and forces are leapfrog: what is left of the lag of half a step, ω/2 where forces acted at the end of each, is below a twentieth
// of it with every transfer. By FLIP and APIC the markers' noise is of the size of what steps still change, so that the order is that of
// "grid".
TEST("a standing wave does not lag, and is of second order in the step") {
    set_threads(1);                            // threads would only wait for one another on so few cells
    constexpr real omega = 7.836, time = 0.2;  // ω² = g k tanh(k d); a quarter of a period, where a lag is seen best
    for (const std::string transfer : {"grid", "flip", "apic"}) {
        const real coarse = amplitude(transfer.c_str(), time, 16), middle = amplitude(transfer.c_str(), time, 32),
                   fine = amplitude(transfer.c_str(), time, 64);
        EXPECT_LT(std::abs(coarse - fine) / (time / 16 - time / 64), 0.05 * 0.5 * omega) << transfer;
        EXPECT_TRUE(transfer != "grid" || order(coarse, middle, fine) >= 1.8) << order(coarse, middle, fine);
    }
}

}  // namespace weir::water::splitting_tests
