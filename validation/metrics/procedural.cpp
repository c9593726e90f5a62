// Procedural waves: frequencies and spectra read off gauges, and whether exact waves are exact, asked of the solver at points of its water.
#include "core/error.hpp"
#include "sim/simulation.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace weir::validation {
namespace {

using Complex = std::complex<real>;

Curve gauge(const RunRecord& run) { return column(run.probe("gauge"), 0); }

real gauge_frequency_error(const RunRecord& run, const Reference& ref) {
    Curve c = gauge(run);
    const real rest = ref.number("level") - run.fields.grid.origin[1];
    for (real& y : c.y) y -= rest;
    return std::abs(frequency(c) / ref.number("frequency") - 1);
}

/// From the mean of the variance over the run: waves that meet head on make it swing, by twice the product of their heights.
real significant_height(const RunRecord& run) {
    const Curve c = run.series("significant_height");
    real squares = 0;
    for (const real h : c.y) squares += h * h / static_cast<real>(c.size());
    return std::sqrt(squares);
}

/// Variance of a gauge between two frequencies: the periodogram under Hann's window, whose lobe is four lines wide.
real band_variance(const Curve& c, real from, real to) {
    const std::size_t n = c.size();
    const real dt = (c.x.back() - c.x.front()) / static_cast<real>(n - 1), line = 2 * pi / (static_cast<real>(n) * dt);
    real mean = 0, squares = 0, sum = 0;
    for (const real y : c.y) mean += y / static_cast<real>(n);
    std::vector<real> windowed(n);
    for (std::size_t i = 0; i < n; ++i) {
        const real w = 0.5 - 0.5 * std::cos(2 * pi * (static_cast<real>(i) + 0.5) / static_cast<real>(n));
        windowed[i] = w * (c.y[i] - mean);
        squares += w * w;
    }
    for (auto j = static_cast<int>(std::ceil(from / line)); j * line < to; ++j) {
        const Complex turn = std::polar(1.0, -j * line * dt);
        Complex phase = 1, amplitude = 0;
        for (std::size_t i = 0; i < n; ++i) {
            amplitude += windowed[i] * phase;
            phase *= turn;
            if (i % 1024 == 1023) phase /= std::abs(phase);
        }
        sum += 2 * std::norm(amplitude);
    }
    return sum / (static_cast<real>(n) * squares);
}

real band_error(const RunRecord& run, const Reference& ref) {
    const Curve c = gauge(run), bands = ref.curve("bands");
    real worst = 0;
    for (std::size_t b = 0; b < bands.y.size(); ++b)
        worst = std::max(worst, std::abs(band_variance(c, bands.x[b], bands.x[b + 1]) / bands.y[b] - 1));
    return worst;
}

Panel band_panel(const RunRecord& run, const Reference& ref) {
    const Curve c = gauge(run), bands = ref.curve("bands");
    Curve ours{.label = "weir", .x = {}, .y = {}}, theirs{.label = bands.label, .x = {}, .y = {}, .points = true};
    for (std::size_t b = 0; b < bands.y.size(); ++b) {
        const real width = bands.x[b + 1] - bands.x[b], middle = bands.x[b] + 0.5 * width;
        ours.x.push_back(middle), ours.y.push_back(band_variance(c, bands.x[b], bands.x[b + 1]) / width);
        theirs.x.push_back(middle), theirs.y.push_back(bands.y[b] / width);
    }
    return {.title = "Spectrum at a gauge", .x = {"frequency [1/s]"}, .y = {"S [m^2 s]"}, .curves = {theirs, ours}};
}

Solver& solver_of(const RunRecord& run) {
    if (!run.simulation) throw BadInput("this metric requires the solver, which this run does not keep");
    return run.simulation->solver();
}

/// A field at a point, from a solver that knows it there.
template <std::size_t N>
std::array<real, N> ask(const Solver& solver, const char* field, const Vec<3>& at) {
    std::array<real, N> values{};
    if (!solver.answer(field, at, values)) throw BadInput(std::string("the solver does not provide \"") + field + "\" at a point");
    return values;
}

/// Particles that rest on a lattice over one wavelength and down to half of it, at eight times of a period: f(their place, time).
template <class F>
void for_particles(const RunRecord& run, const Reference& ref, const F& f) {
    Solver& solver = solver_of(run);
    const real k = ref.number("wavenumber"), period = 2 * pi / ref.number("frequency");
    for (int turn = 0; turn < 8; ++turn) {
        for (int i = 0; i < 12; ++i)
            for (int j = 0; j < 5; ++j) f(solver, Vec<3>{{2 * pi / k * i / 12.0, ref.number("level") - pi / k * j / 4.0, 0}});
        solver.step(period / 8);
    }
}

/// The area of a patch of particles, by central differences of its places over 2e-4 of 1/k.
real patch(const Solver& solver, const Vec<3>& at, real k) {
    const real h = 1e-4 / k;
    const auto x = [&](real dx, real dy) { return ask<2>(solver, "position", at + Vec<3>{{dx, dy, 0}}); };
    const auto e = x(h, 0), w = x(-h, 0), n = x(0, h), s = x(0, -h);
    return ((e[0] - w[0]) * (n[1] - s[1]) - (e[1] - w[1]) * (n[0] - s[0])) / (4 * h * h);
}

/// Largest difference of the area of a patch of particles to 1 - (k a)^2 e^(2 k b), at any time.
real jacobian_error(const RunRecord& run, const Reference& ref) {
    real worst = 0;
    const real k = ref.number("wavenumber"), steep = k * ref.number("amplitude");
    for_particles(run, ref, [&](const Solver& solver, const Vec<3>& at) {
        const real exact = 1 - steep * steep * std::exp(2 * k * (at[1] - ref.number("level")));
        worst = std::max(worst, std::abs(patch(solver, at, k) - exact));
    });
    return worst;
}

/// Largest slope of the pressure along lines of particles that rest at one depth, over rho g: (x'' + g) . dx/da, by differences in time
/// and along the line. Where it is zero the pressure is a function of depth alone, and so each particle's stays what it is.
real pressure_slope(const RunRecord& run, const Reference& ref) {
    real worst = 0;
    const real k = ref.number("wavenumber"), g = ref.number("gravity"), dt = 1e-3 / ref.number("frequency"), h = 1e-4 / k;
    Solver& mover = solver_of(run);
    for_particles(run, ref, [&](const Solver& solver, const Vec<3>& at) {
        const auto now = ask<2>(solver, "position", at), e = ask<2>(solver, "position", at + Vec<3>{{h, 0, 0}}),
                   w = ask<2>(solver, "position", at - Vec<3>{{h, 0, 0}});
        mover.step(dt);
        const auto after = ask<2>(solver, "position", at);
        mover.step(-2 * dt);
        const auto before = ask<2>(solver, "position", at);
        mover.step(dt);
        real slope = 0;
        for (std::size_t a = 0; a < 2; ++a)
            slope += ((after[a] - 2 * now[a] + before[a]) / (dt * dt) + (a == 1 ? g : 0)) * (e[a] - w[a]) / (2 * h);
        worst = std::max(worst, std::abs(slope) / g);
    });
    return worst;
}

/// Bernoulli's constant along the surface of a steady train, |u - c|^2/2 + g eta: how far it varies, over c^2.
real bernoulli_residual(const RunRecord& run, const Reference& ref) {
    const Solver& solver = solver_of(run);
    const real k = ref.number("wavenumber"), c = ref.number("speed");
    real least = infinity, most = -infinity;
    for (int i = 0; i < 256; ++i) {
        const real x = 2 * pi / k * i / 256;
        const real y = ask<1>(solver, "surface", {{x, 0, 0}})[0];
        const auto u = ask<2>(solver, "velocity", {{x, y, 0}});
        const real constant = 0.5 * ((u[0] - c) * (u[0] - c) + u[1] * u[1]) + ref.number("gravity") * y;
        least = std::min(least, constant), most = std::max(most, constant);
    }
    return (most - least) / (c * c);
}

/// The first harmonic of the surface at the reference's places, from 32 times of one period.
std::vector<Complex> harmonics(const RunRecord& run, const Reference& ref, const std::vector<real>& places, real z) {
    Solver& solver = solver_of(run);
    const real omega = ref.number("frequency");
    std::vector<Complex> sums(places.size());
    for (int turn = 0; turn < 32; ++turn) {
        for (std::size_t i = 0; i < places.size(); ++i)
            sums[i] += (ask<1>(solver, "surface", {{places[i], 0, z}})[0] - ref.number("level")) *
                       std::polar(1.0 / 16, omega * run.simulation->time());
        solver.step(2 * pi / omega / 32);
    }
    return sums;
}

real phase_error(const RunRecord& run, const Reference& ref) {
    const Curve exact = ref.curve("phase");
    const GridView& g = run.fields.grid;
    const real across = g.dim == 3 ? g.origin[2] + g.cells[2] * g.spacing[2] : 0;
    const auto near = harmonics(run, ref, exact.x, 0), far = harmonics(run, ref, exact.x, across);
    real worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        worst = std::max(worst, std::abs(std::arg(near[i] / near[0] * std::polar(1.0, -exact.y[i]))));
        worst = std::max(worst, std::abs(std::arg(far[i] / near[i] * std::polar(1.0, -ref.number("kz") * across))));
    }
    return worst;
}

real growth_error(const RunRecord& run, const Reference& ref) {
    const Curve exact = ref.curve("growth");
    const auto near = harmonics(run, ref, exact.x, 0);
    real worst = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) worst = std::max(worst, std::abs(std::abs(near[i] / near[0]) / exact.y[i] - 1));
    return worst;
}

}  // namespace

std::vector<Metric> procedural_metrics() {
    return {
        {.name = "gauge.frequency_error",
         .unit = "",
         .doc = "Relative error of the frequency at the probe \"gauge\", from its zero crossings.",
         .measure = gauge_frequency_error},
        {.name = "sea.height_error",
         .unit = "",
         .doc = "Relative error of the significant height, 4 times the root of the surface's variance over the tile and the run, to 4 "
                "sqrt(m0).",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(significant_height(run) / ref.number("significant_height") - 1); }},
        {.name = "sea.band_error",
         .unit = "",
         .doc = "Largest relative error of the variance that the probe \"gauge\" sees in any of seven bands of frequency.",
         .measure = band_error,
         .figure = band_panel},
        {.name = "gerstner.jacobian_error",
         .unit = "",
         .doc = "Largest difference of the area of a patch of particles to 1 - (k a)^2 e^(2 k b), which does not depend on time.",
         .measure = jacobian_error},
        {.name = "gerstner.pressure_slope",
         .unit = "",
         .doc = "Largest slope of the pressure along particles that rest at one depth, over rho g: zero where each keeps its pressure.",
         .measure = pressure_slope},
        {.name = "stokes.bernoulli_residual",
         .unit = "",
         .doc = "How far Bernoulli's constant varies along the surface in the frame of the crests, over the square of their speed.",
         .measure = bernoulli_residual},
        {.name = "refraction.phase_error",
         .unit = "rad",
         .doc = "Largest difference of the wave's phase to the integral of the exact wavenumber, along x and across the domain.",
         .measure = phase_error},
        {.name = "refraction.growth_error",
         .unit = "",
         .doc = "Largest relative difference of the wave's height to Green's law.",
         .measure = growth_error},
    };
}

}  // namespace weir::validation
