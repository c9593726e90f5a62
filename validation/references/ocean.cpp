#include "validation/references/ocean.hpp"
#include "validation/harness/fitting.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/waves.hpp"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_roots.h>

#include <cmath>

namespace weir::validation {
namespace {

/// Integral of f by GSL's adaptive rule, to nine digits.
real integral(const std::function<real(real)>& f, real from, real to) {
    gsl_integration_workspace* space = gsl_integration_workspace_alloc(1000);
    gsl_function wrapped{[](double x, void* of) { return (*static_cast<const std::function<real(real)>*>(of))(x); },
                         const_cast<std::function<real(real)>*>(&f)};
    double value = 0, error = 0;
    gsl_integration_qag(&wrapped, from, to, 0, 1e-9, 1000, GSL_INTEG_GAUSS41, space, &value, &error);
    gsl_integration_workspace_free(space);
    return value;
}

/// The wavenumber of a frequency at a depth, by bisection.
real wavenumber_of(real g, real omega, real depth) {
    real low = 0, high = omega * omega / g;
    while (wave_frequency(g, high, depth) < omega) high *= 2;
    for (int i = 0; i < 100; ++i) {
        const real middle = 0.5 * (low + high);
        (wave_frequency(g, middle, depth) < omega ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Variance a unit of wavenumber of Phillips's rounded spectrum, of frequency of the other two.
real density(const scene::Table& s, real g, real at) {
    const std::string& kind = s.text("kind");
    const real U = s.number("wind");
    if (kind == "phillips") {
        const real L = U * U / g;
        return 0.5 * s.number("alpha") * std::exp(-1 / (at * at * L * L)) / (at * at * at);
    }
    if (kind == "pierson_moskowitz") return 8.1e-3 * g * g * std::pow(at, -5) * std::exp(-0.74 * std::pow(g / (U * at), 4));
    const real F = s.number("fetch"), peak = 22 * std::pow(g * g / (U * F), 1.0 / 3), alpha = 0.076 * std::pow(U * U / (F * g), 0.22);
    const real width = at <= peak ? 0.07 : 0.09, b = std::exp(-std::pow(at - peak, 2) / (2 * std::pow(width * peak, 2)));
    return alpha * g * g * std::pow(at, -5) * std::exp(-1.25 * std::pow(peak / at, 4)) * std::pow(s.number("gamma"), b);
}

real gravity_of(const scene::Scene& scene) { return -needed_effect(scene, "gravity").numbers("g").at(1); }
real depth_of(const scene::Scene& scene) { return scene.root().number_or("waves.depth", infinity); }
real level_of(const scene::Scene& scene) { return scene.root().number_or("waves.level", 0); }

}  // namespace

FentonWave fenton(real g, real depth, real height, real wavelength, int order) {
    const real k = 2 * pi / wavelength, d = std::min(depth, 18 / k), kd = k * d, e = k * height / 2;
    const real S = 1 / std::cosh(2 * kd), C = 1 / std::tanh(kd), s1 = std::sinh(kd), m = 1 - S;
    const auto p = [](real x, int n) { return std::pow(x, n); };
    const real S2 = S * S, S3 = S2 * S, S4 = S3 * S, S5 = S4 * S, S6 = S5 * S, S7 = S6 * S, S8 = S7 * S;
    const real e1 = e, e2 = order >= 2 ? p(e, 2) : 0, e3 = order >= 3 ? p(e, 3) : 0, e4 = order >= 4 ? p(e, 4) : 0,
               e5 = order >= 5 ? p(e, 5) : 0;
    const real B22 = C * (1 + 2 * S) / (2 * m), B31 = -3 * (1 + 3 * S + 3 * S2 + 2 * S3) / (8 * p(m, 3)),
               B42 = C * (6 - 26 * S - 182 * S2 - 204 * S3 - 25 * S4 + 26 * S5) / (6 * (3 + 2 * S) * p(m, 4)),
               B44 = C * (24 + 92 * S + 122 * S2 + 66 * S3 + 67 * S4 + 34 * S5) / (24 * (3 + 2 * S) * p(m, 4)),
               B53 = 9 * (132 + 17 * S - 2216 * S2 - 5897 * S3 - 6292 * S4 - 2687 * S5 + 194 * S6 + 467 * S7 + 82 * S8) /
                     (128 * (3 + 2 * S) * (4 + S) * p(m, 6)),
               B55 = 5 * (300 + 1579 * S + 3176 * S2 + 2949 * S3 + 1188 * S4 + 675 * S5 + 1326 * S6 + 827 * S7 + 130 * S8) /
                     (384 * (3 + 2 * S) * (4 + S) * p(m, 6));
    const real A11 = 1 / s1, A22 = 3 * S2 / (2 * m * m), A31 = (-4 - 20 * S + 10 * S2 - 13 * S3) / (8 * s1 * p(m, 3)),
               A33 = (-2 * S2 + 11 * S3) / (8 * s1 * p(m, 3)), A42 = (12 * S - 14 * S2 - 264 * S3 - 45 * S4 - 13 * S5) / (24 * p(m, 5)),
               A44 = (10 * S3 - 174 * S4 + 291 * S5 + 278 * S6) / (48 * (3 + 2 * S) * p(m, 5)),
               A51 = (-1184 + 32 * S + 13232 * S2 + 21712 * S3 + 20940 * S4 + 12554 * S5 - 500 * S6 - 3341 * S7 - 670 * S8) /
                     (64 * s1 * (3 + 2 * S) * (4 + S) * p(m, 6)),
               A53 = (4 * S + 105 * S2 + 198 * S3 - 1376 * S4 - 1302 * S5 - 117 * S6 + 58 * S7) / (32 * s1 * (3 + 2 * S) * p(m, 6)),
               A55 = (-6 * S3 + 272 * S4 - 1552 * S5 + 852 * S6 + 2029 * S7 + 430 * S8) / (64 * s1 * (3 + 2 * S) * (4 + S) * p(m, 6));
    const real C0 = std::sqrt(std::tanh(kd)), C2 = C0 * (2 + 7 * S2) / (4 * m * m),
               C4 = C0 * (4 + 32 * S - 116 * S2 - 400 * S3 - 71 * S4 + 146 * S5) / (32 * p(m, 5));
    FentonWave w{.k = k, .depth = d, .speed = std::sqrt(g / k) * (C0 + (order >= 3 ? e * e * C2 : 0) + e5 / e * C4), .eta = {}, .u = {}};
    w.eta = {e1 + e3 * B31 - e5 * (B53 + B55), e2 * B22 + e4 * B42, -e3 * B31 + e5 * B53, e4 * B44, e5 * B55};
    w.u = {e1 * A11 + e3 * A31 + e5 * A51, e2 * A22 + e4 * A42, e3 * A33 + e5 * A53, e4 * A44, e5 * A55};
    for (int j = 1; j <= 5; ++j) {
        w.eta[static_cast<std::size_t>(j - 1)] /= k;
        w.u[static_cast<std::size_t>(j - 1)] *= C0 * std::sqrt(g / k) * j * std::cosh(j * kd);
    }
    return w;
}

real Trochoid::rest(real x, real y, real t, real& depth) const {
    real x0 = x, y0 = std::min(y, 0.0);
    for (int i = 0; i < 60; ++i) {  // Newton; the determinant is 1 - (k r)^2 > 0
        const real r = amplitude * std::exp(k * y0), s = k * r * std::sin(k * x0 - omega * t), c = k * r * std::cos(k * x0 - omega * t);
        const real off_x = x - (x0 - s / k), off_y = y - (y0 + c / k), det = 1 - (s * s + c * c);
        const real dx = ((1 + c) * off_x + s * off_y) / det, dy = ((1 - c) * off_y + s * off_x) / det;
        x0 += dx, y0 += dy;
        if (std::abs(dx) + std::abs(dy) < 1e-15 / k) break;
    }
    depth = y0;
    return x0;
}

real Trochoid::height(real x, real t) const {
    real x0 = x;
    for (int i = 0; i < 60; ++i) {
        const real theta = k * x0 - omega * t;
        x0 += (x - (x0 - amplitude * std::sin(theta))) / (1 - k * amplitude * std::cos(theta));
    }
    return amplitude * std::cos(k * x0 - omega * t);
}

Vec<3> Trochoid::velocity(real x, real y, real t) const {
    real y0 = 0;
    const real theta = k * rest(x, y, t, y0) - omega * t, speed = omega * amplitude * std::exp(k * y0);
    return {{speed * std::cos(theta), speed * std::sin(theta), 0}};
}

real sea_variance(const scene::Scene& scene, real from, real to) {
    const scene::Table& s = scene.root().table("waves.spectrum");
    const real g = gravity_of(scene);
    return integral([&](real at) { return density(s, g, at); }, from, to);
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

// The first of a scene's trains by linear theory.
REFERENCE(wave_train) {
    const scene::Table& train = scene.root().tables("waves.trains").at(0);
    const scene::Table* tension = scene.effect("surface_tension");
    const real sigma = tension ? tension->number("sigma") / scene.number("fluid.density") : 0, k = 2 * pi / train.number("wavelength");
    Reference ref{.source = "Lamb 1932, sec. 228 and 267"};
    ref.numbers = {{"frequency", wave_frequency(gravity_of(scene), k, depth_of(scene), sigma)},
                   {"level", level_of(scene)},
                   {"amplitude", train.number("amplitude")}};
    return ref;
}

// One of Gerstner's trochoids in deep water.
REFERENCE(gerstner) {
    const scene::Table& train = scene.root().tables("waves.trains").at(0);
    const real k = 2 * pi / train.number("wavelength"), g = gravity_of(scene), level = level_of(scene);
    const Trochoid wave{k, std::sqrt(g * k), train.number("amplitude")};
    Reference ref{.source = "Gerstner 1802; Lamb 1932, sec. 251"};
    ref.scalars["level_set"] = [=](const Vec<3>& x, real t) { return x[1] - level - wave.height(x[0], t); };
    ref.vectors["velocity"] = [=](const Vec<3>& x, real t) { return wave.velocity(x[0], x[1] - level, t); };
    ref.covers = [=](const Vec<3>& x, real t) { return x[1] - level < wave.height(x[0], t); };
    ref.numbers = {{"frequency", wave.omega}, {"wavenumber", k}, {"amplitude", wave.amplitude}, {"gravity", g}, {"level", level}};
    return ref;
}

// A steady train by Fenton's expansion.
REFERENCE(stokes) {
    const scene::Table& waves = scene.root().table("waves");
    const real g = gravity_of(scene), level = level_of(scene);
    const FentonWave w =
        fenton(g, depth_of(scene), waves.number("height"), waves.number("wavelength"), static_cast<int>(waves.integer("order")));
    const auto height = [=](real x, real t) {
        real sum = 0;
        for (int j = 1; j <= 5; ++j) sum += w.eta[static_cast<std::size_t>(j - 1)] * std::cos(j * w.k * (x - w.speed * t));
        return sum;
    };
    Reference ref{.source = "Fenton 1985"};
    ref.scalars["level_set"] = [=](const Vec<3>& x, real t) { return x[1] - level - height(x[0], t); };
    ref.vectors["velocity"] = [=](const Vec<3>& x, real t) {
        Vec<3> u{};
        for (int j = 1; j <= 5; ++j) {
            const real kj = j * w.k, size = w.u[static_cast<std::size_t>(j - 1)] / std::cosh(kj * w.depth),
                       theta = kj * (x[0] - w.speed * t);
            u[0] += size * std::cosh(kj * (x[1] - level + w.depth)) * std::cos(theta);
            u[1] += size * std::sinh(kj * (x[1] - level + w.depth)) * std::sin(theta);
        }
        return u;
    };
    ref.covers = [=](const Vec<3>& x, real t) { return x[1] - level < height(x[0], t); };
    ref.numbers = {{"speed", w.speed}, {"wavenumber", w.k}, {"gravity", g}, {"level", level}};
    return ref;
}

// The height of a wind sea, and its variance between frequencies that lie halfway between the waves of a tile along x.
REFERENCE(sea) {
    const scene::Table& s = scene.root().table("waves.spectrum");
    const real g = gravity_of(scene), U = s.number("wind");
    const std::string& kind = s.text("kind");
    Reference ref{.source = kind == "jonswap"    ? "Hasselmann et al. 1973"
                            : kind == "phillips" ? "Phillips 1958"
                                                 : "Pierson & Moskowitz 1964"};
    const real scale = kind == "phillips"  ? g / (U * U)
                       : kind == "jonswap" ? 22 * std::pow(g * g / (U * s.number("fetch")), 1.0 / 3)
                                           : 0.877 * g / U;
    ref.numbers["significant_height"] = 4 * std::sqrt(sea_variance(scene, 0.05 * scale, 400 * scale));
    if (kind == "phillips") return ref;
    Curve bands{.label = ref.source, .x = {}, .y = {}};
    const real dk = 2 * pi / scene.root().numbers("grid.size").at(0);
    for (real from = 0.7; from < 1.95; from += 0.2) {
        const auto edge = [&](real part) {  // the nearest half between two waves
            const real omega = part * scale, m = std::floor(wavenumber_of(g, omega, depth_of(scene)) / dk) + 0.5;
            return wave_frequency(g, m * dk, depth_of(scene));
        };
        if (bands.x.empty()) bands.x.push_back(edge(from));
        bands.y.push_back(sea_variance(scene, bands.x.back(), edge(from + 0.2)));
        bands.x.push_back(edge(from + 0.2));
    }
    ref.curves["bands"] = bands;
    return ref;
}

// A small wave from deep water over a bed of straight slopes along x: phase by integral, height by Green's law, direction by Snell's.
REFERENCE(shoaling) {
    const scene::Table& train = scene.root().tables("waves.trains").at(0);
    const auto &x = scene.root().numbers("waves.bed.x"), &depth = scene.root().numbers("waves.bed.depth");
    const real g = gravity_of(scene), deep = 2 * pi / train.number("wavelength"), omega = std::sqrt(g * deep),
               kz = deep * std::sin(train.number("heading"));
    const auto depth_at = [&](real at) { return interpolate({.x = x, .y = depth}, std::clamp(at, x.front(), x.back())); };
    const auto kx = [&](real at) { return std::sqrt(std::pow(wavenumber_of(g, omega, depth_at(at)), 2) - kz * kz); };
    const auto flux = [&](real at) {  // of the energy of a unit amplitude squared, along x
        const real h = depth_at(at), k = wavenumber_of(g, omega, h);
        return 0.5 * omega / k * (1 + 2 * k * h / std::sinh(2 * k * h)) * kx(at) / k;
    };
    Reference ref{.source = "linear dispersion, Snell's law, Green's law"};
    Curve phase{.label = "integral of k", .x = {}, .y = {}}, growth{.label = "Green's law", .x = {}, .y = {}};
    constexpr int places = 40;
    for (int i = 0; i <= places; ++i) {
        const real at = x.front() + (x.back() - x.front()) * i / places;
        phase.x.push_back(at);
        phase.y.push_back(i == 0 ? 0 : phase.y.back() + integral(kx, phase.x[phase.x.size() - 2], at));
        growth.x.push_back(at);
        growth.y.push_back(std::sqrt(flux(x.front()) / flux(at)));
    }
    ref.curves = {{"phase", phase}, {"growth", growth}};
    ref.numbers = {{"frequency", omega}, {"kz", kz}, {"level", level_of(scene)}};
    return ref;
}
