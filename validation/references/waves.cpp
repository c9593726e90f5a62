#include "validation/references/waves.hpp"
#include "validation/harness/fitting.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/faddeeva.hpp"

#include <gsl/gsl_poly.h>

#include <array>

namespace weir::validation {
namespace {

/// Roots of z^4 - 4 b n^(1/2) z^3 + 2 (1 - 6 b) n z^2 + 4 (1 - 3 b) n^(3/2) z + (1 - 4 b) n^2 + w0^2. For a wave two conjugate pairs, one
/// of them in the left half plane.
std::array<Complex, 4> roots(real n, real w2, real beta) {
    const std::array<double, 5> coefficients = {(1 - 4 * beta) * n * n + w2, 4 * (1 - 3 * beta) * n * std::sqrt(n), 2 * (1 - 6 * beta) * n,
                                                -4 * beta * std::sqrt(n), 1};
    std::array<double, 8> packed{};
    gsl_poly_complex_workspace* workspace = gsl_poly_complex_workspace_alloc(5);
    gsl_poly_complex_solve(coefficients.data(), 5, workspace, packed.data());
    gsl_poly_complex_workspace_free(workspace);
    std::array<Complex, 4> z;
    for (std::size_t i = 0; i < 4; ++i) z[i] = {packed[2 * i], packed[2 * i + 1]};
    return z;
}

/// exp((z^2 - n) t) erfc(z sqrt t), with the exponents joined before anything can overflow.
Complex damped_erfc(Complex z, real n, real t) {
    const Complex s = z * std::sqrt(t);
    if (s.real() >= 0) return std::exp(-n * t) * scaled_erfc(s);
    return 2.0 * std::exp((z * z - n) * t) - std::exp(-n * t) * scaled_erfc(-s);  // erfc(z) = 2 - erfc(-z)
}

}  // namespace

real wave_frequency(real g, real k, real depth, real sigma_over_rho) {
    return std::sqrt((g * k + sigma_over_rho * k * k * k) * std::tanh(k * depth));
}

real prosperetti(real t, real nu, real k, real omega0, real a0, real beta) {
    if (nu == 0) return a0 * std::cos(omega0 * t);
    const real n = nu * k * k, w2 = omega0 * omega0, m = (1 - 4 * beta) * n * n;
    const std::array<Complex, 4> z = roots(n, w2, beta);
    Complex a = 4 * m / (8 * m + w2) * std::erfc(std::sqrt(n * t));
    for (std::size_t i = 0; i < 4; ++i) {
        Complex Z = 1;
        for (std::size_t j = 0; j < 4; ++j)
            if (j != i) Z *= z[j] - z[i];
        a += z[i] / Z * (w2 / (z[i] * z[i] - n)) * damped_erfc(z[i], n, t);
    }
    return a0 * a.real();
}

real growth_rate(real nu, real k, real omega2, real beta) {
    const real n = nu * k * k;
    real rate = 0;
    for (const Complex z : roots(n, omega2, beta))
        if (z.real() < 0 && std::abs(z.imag()) < 1e-9 * std::abs(z)) rate = std::max(rate, (z * z).real() - n);
    return rate;
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

namespace {

constexpr int samples_a_period = 64;  // of the drawn and fitted reference curve: a parabola between samples errs by under 1e-4

real gravity(const scene::Scene& scene) {
    const auto& g = needed_effect(scene, "gravity").numbers("g");
    return -g.at(1);
}

// Two fluids of one kinematic viscosity, each deep against the wavelength.
struct TwoFluids {
    real nu, k, omega2, beta, a0, level;
    explicit TwoFluids(const scene::Scene& scene) {
        const scene::Table& wave = scene.root().tables("liquid").at(0);
        const real below = scene.number("fluid.density"), above = scene.number("gas.density"), sum = below + above;
        const scene::Table* tension = scene.effect("surface_tension");
        k = 2 * pi / wave.number("wavelength");
        omega2 = (gravity(scene) * k * (below - above) + (tension ? tension->number("sigma") * k * k * k : 0)) / sum;
        beta = below * above / (sum * sum);
        nu = scene.effect("viscosity") ? scene.number("fluid.viscosity") : 0;
        a0 = wave.number("amplitude"), level = wave.number("level");
    }
};

}  // namespace

REFERENCE(two_fluid_wave) {
    const TwoFluids fluids(scene);
    const real omega = std::sqrt(fluids.omega2);
    Reference ref{.source = "Prosperetti 1981, two fluids of equal kinematic viscosity"};
    ref.numbers = {{"frequency", omega}, {"amplitude", fluids.a0}, {"wavenumber", fluids.k}, {"level", fluids.level}};
    Curve history{.label = "Prosperetti 1981", .x = {}, .y = {}};
    const real end = scene.number("time.end"), dt = 2 * pi / omega / samples_a_period;
    for (int i = 0; i * dt <= end + dt; ++i) {
        history.x.push_back(i * dt);
        history.y.push_back(prosperetti(i * dt, fluids.nu, fluids.k, omega, fluids.a0, fluids.beta));
    }
    ref.curves["amplitude"] = history;
    return ref;
}

// Gravity points from the light to the dense fluid's far side: the surface is unstable.
REFERENCE(two_fluid_growth) {
    const TwoFluids fluids(scene);
    Reference ref{.source = "growth rate of the dispersion relation of Prosperetti 1981 (Chandrasekhar 1961, sec. 94)"};
    ref.numbers = {{"rate", growth_rate(fluids.nu, fluids.k, fluids.omega2, fluids.beta)}};
    return ref;
}

// A wave between walls half a wavelength (or a multiple) apart, released at rest from eta = level + amplitude cos(k x).
REFERENCE(standing_wave) {
    const scene::Table& wave = scene.root().tables("liquid").at(0);
    const real k = 2 * pi / wave.number("wavelength"), a0 = wave.number("amplitude");
    const real depth = wave.number("level") - scene.vec<2>("grid.origin")[1];
    const real nu = scene.effect("viscosity") ? scene.number("fluid.viscosity") : 0;
    const scene::Table* tension = scene.effect("surface_tension");
    const real sigma = tension ? tension->number("sigma") / scene.number("fluid.density") : 0;
    const real omega = wave_frequency(gravity(scene), k, depth, sigma);
    Reference ref{.source = "linear dispersion (Lamb 1932); viscous decay: Prosperetti 1981"};
    ref.numbers = {{"frequency", omega}, {"amplitude", a0}, {"wavenumber", k}, {"level", wave.number("level")}, {"decay", 2 * nu * k * k}};
    Curve history{.label = nu > 0 ? "Prosperetti 1981" : "linear theory", .x = {}, .y = {}};
    const real end = scene.number("time.end"), dt = 2 * pi / omega / samples_a_period;
    for (int i = 0; i * dt <= end + dt; ++i) {
        history.x.push_back(i * dt);
        history.y.push_back(prosperetti(i * dt, nu, k, omega, a0));
    }
    ref.curves["amplitude"] = history;
    return ref;
}
