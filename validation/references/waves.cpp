#include "validation/references/waves.hpp"
#include "validation/harness/fitting.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/faddeeva.hpp"

#include <gsl/gsl_poly.h>

#include <array>

namespace weir::validation {
namespace {

/// Roots of z^4 + 2n z^2 + 4 n^(3/2) z + n^2 + w0^2: two conjugate pairs, one of them in the left half plane.
std::array<Complex, 4> roots(real n, real w0) {
    const std::array<double, 5> coefficients = {n * n + w0 * w0, 4 * n * std::sqrt(n), 2 * n, 0, 1};
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

real prosperetti(real t, real nu, real k, real omega0, real a0) {
    if (nu == 0) return a0 * std::cos(omega0 * t);
    const real n = nu * k * k, w2 = omega0 * omega0;
    const std::array<Complex, 4> z = roots(n, omega0);
    Complex a = 4 * n * n / (8 * n * n + w2) * std::erfc(std::sqrt(n * t));
    for (std::size_t i = 0; i < 4; ++i) {
        Complex Z = 1;
        for (std::size_t j = 0; j < 4; ++j)
            if (j != i) Z *= z[j] - z[i];
        a += z[i] / Z * (w2 / (z[i] * z[i] - n)) * damped_erfc(z[i], n, t);
    }
    return a0 * a.real();
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

}  // namespace

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
