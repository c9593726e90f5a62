// Melting by conduction: Stefan's and Neumann's moving fronts, and what ice in water comes to in a box that no heat leaves. The substance
// is one of the scene's own, of one density, so that it melts at its triple point's temperature whatever the pressure.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

struct Wax {
    real T, L, c_solid, c_liquid, k_solid, k_liquid, rho;
    explicit Wax(const scene::Scene& scene, bool one_density = true)
        : T(scene.root().numbers("substance.triple").at(0)),
          L(scene.number("substance.fusion")),
          c_solid(scene.number("substance.solid.heat_capacity")),
          c_liquid(scene.number("substance.liquid.heat_capacity")),
          k_solid(scene.number("substance.solid.conductivity")),
          k_liquid(scene.number("substance.liquid.conductivity")),
          rho(scene.number("fluid.density")) {
        const real solid = scene.number("substance.solid.density"), liquid = scene.number("substance.liquid.density");
        if (one_density && (solid != liquid || rho != liquid))
            throw BadInput("the exact solutions of melting are for one density of solid and liquid");
    }
};

/// The zero of a function that rises from below to above, by bisection.
template <class F>
real zero_of(F f, real lo, real hi) {
    for (int i = 0; i < 200; ++i) (f(0.5 * (lo + hi)) < 0 ? lo : hi) = 0.5 * (lo + hi);
    return 0.5 * (lo + hi);
}

}  // namespace

/// x = s(t) = 2 λ √(α t) (Neumann; Carslaw & Jaeger 1959, 11.2), with n = √(α_l/α_s):
///     St_l/(e^λ² erf λ) − St_s/(n e^(n² λ²) erfc(n λ)) = λ √π
REFERENCE(stefan) {
    const Wax w(scene);
    const real hot = scene.number("sides.x_min.temperature"), cold = scene.number("initial.temperature.value");
    const real alpha = w.k_liquid / (w.rho * w.c_liquid), alpha_solid = w.k_solid / (w.rho * w.c_solid), n = std::sqrt(alpha / alpha_solid);
    const real St = w.c_liquid * (hot - w.T) / w.L, St_solid = w.c_solid * (w.T - cold) / w.L;
    const real lambda = zero_of(
        [&](real l) {
            return l * std::sqrt(pi) - St / (std::exp(l * l) * std::erf(l)) + St_solid / (n * std::exp(n * n * l * l) * std::erfc(n * l));
        },
        1e-6, 5);
    Reference ref{.source = "Stefan 1891; Neumann (Carslaw & Jaeger 1959)"};
    ref.numbers = {{"lambda", lambda}, {"speed", 2 * lambda * std::sqrt(alpha)}};
    ref.scalars["temperature"] = [=](const Vec<3>& x, real t) {
        const real eta = x[0] / (2 * std::sqrt(alpha * t));
        return eta < lambda ? hot - (hot - w.T) * std::erf(eta) / std::erf(lambda)
                            : cold + (w.T - cold) * std::erfc(n * eta) / std::erfc(n * lambda);
    };
    return ref;
}

/// The lever rule: a ball of ice in water, all heat kept. Shares by the ball's area; the run's own cells decide (`initial_ice`).
REFERENCE(ice_in_water) {
    const Wax w(scene, false);
    const scene::Table& ball = scene.root().table("initial.temperature");
    Reference ref{.source = "the lever rule"};
    ref.numbers = {{"melts", w.T},         {"fusion", w.L},         {"cold", ball.number("value")}, {"warm", ball.number("outside")},
                   {"c_solid", w.c_solid}, {"c_liquid", w.c_liquid}};
    return ref;
}

/// Gallium that melts from a side wall, as measured; and what conduction alone would melt.
REFERENCE(melting_gallium) {
    (void)scene;
    Reference ref{.source = "Gau & Viskanta 1986 (digitised)"};
    const Table fronts = read_table(data / "gau_viskanta1986_fronts.csv");
    for (const char* station : {"top", "middle", "bottom"})
        ref.curves[station] = fronts.curve("time_min", std::string(station) + "_mm", "");
    const Table melted = read_table(data / "melted_fraction.csv");
    ref.curves["share"] = melted.curve("time_min", "melted_fraction", ref.source);
    ref.curves["share"].points = true;
    ref.curves["conduction"] = melted.curve("time_min", "neumann_conduction_only", "conduction alone, no subcooling");
    ref.curves["conduction"].dashed = true;
    return ref;
}

/// A wave of temperature along x with one period in the domain decays as exp(−α k² t).
REFERENCE(decaying_sine) {
    const Wax w(scene);
    const real k = 2 * pi / scene.root().numbers("grid.size").at(0);
    Reference ref{.source = "Fourier 1822"};
    ref.numbers = {{"rate", w.k_liquid / (w.rho * w.c_liquid) * k * k}};
    return ref;
}

/// Ice and water at rest between two walls: each side is linear, what flows is the same, between them it is as warm as melting ice.
REFERENCE(steady_slab) {
    const Wax w(scene);
    const real hot = scene.number("sides.x_min.temperature"), cold = scene.number("sides.x_max.temperature");
    const real l = scene.root().numbers("grid.size").at(0);
    const real q = (w.k_liquid * (hot - w.T) + w.k_solid * (w.T - cold)) / l, front = w.k_liquid * (hot - w.T) / q;
    Reference ref{.source = "steady conduction: k dT/dx is constant"};
    ref.numbers = {{"difference", hot - cold}, {"front", front}, {"flux", q}};
    ref.scalars["temperature"] = [=](const Vec<3>& x, real) {
        return x[0] < front ? w.T + q / w.k_liquid * (front - x[0]) : w.T - q / w.k_solid * (x[0] - front);
    };
    return ref;
}

/// Ice at one temperature, x < middle, and water at another, brought into contact; it melts at the temperature of the contact, which both
/// effusivities e = √(k ρ c) decide, so that no front moves (Carslaw & Jaeger 1959, 2.9).
REFERENCE(contact) {
    const Wax w(scene);
    const scene::Table& halves = scene.root().table("initial.temperature");
    const real cold = halves.number("value"), warm = halves.number("outside"), middle = scene.root().numbers("grid.size").at(0) / 2;
    const real e_solid = std::sqrt(w.k_solid * w.rho * w.c_solid), e_liquid = std::sqrt(w.k_liquid * w.rho * w.c_liquid);
    const real contact = (e_solid * cold + e_liquid * warm) / (e_solid + e_liquid);
    if (!(std::abs(contact - w.T) < 1e-6 * (warm - cold)))
        throw BadInput("the contact has " + std::to_string(contact) + " K, and the substance melts at another temperature: a front moves");
    Reference ref{.source = "Carslaw & Jaeger 1959"};
    ref.numbers = {{"contact", contact}, {"cold", cold}, {"warm", warm}, {"middle", middle}};
    ref.scalars["temperature"] = [=](const Vec<3>& x, real t) {
        const real d = x[0] - middle, k = d < 0 ? w.k_solid : w.k_liquid, c = d < 0 ? w.c_solid : w.c_liquid;
        const real reach = 2 * std::sqrt(k / (w.rho * c) * t);
        return contact + (d < 0 ? contact - cold : warm - contact) * std::erf(d / reach);
    };
    return ref;
}
