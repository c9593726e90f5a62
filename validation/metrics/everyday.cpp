// What the scenes of everyday life keep or follow: the energy of waves, the volume of a closed tap, the contraction of a jet, the waves of
// a paddle, the drag and the shedding of a body in a stream.
#include "validation/metrics/lists.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace weir::validation {
namespace {

real gravity_of(const RunRecord& run) {
    const auto* gravity = run.scene->effect("gravity");
    if (!gravity || gravity->numbers("g").at(1) >= 0) throw BadInput("gravity has to point along -y");
    return -gravity->numbers("g").at(1);
}

real density_of(const RunRecord& run) { return run.scene->number("fluid.density"); }

real mean(const std::vector<real>& y, std::size_t first) {
    if (first >= y.size()) throw BadInput("the run is too short");
    return std::accumulate(y.begin() + static_cast<std::ptrdiff_t>(first), y.end(), 0.0) / static_cast<real>(y.size() - first);
}

/// Kinetic and potential energy above what as much water has at rest in a box with upright walls, over that of the start. Of the water
/// that there is now: what a change of volume does to the energy at rest is no wave.
Curve wave_energy(const RunRecord& run) {
    const auto& size = run.scene->root().numbers("grid.size");
    const real area = size.size() == 3 ? size[0] * size[2] : size[0], weight = density_of(run) * gravity_of(run);
    Curve energy = run.series("kinetic_energy");
    const Curve potential = run.series("potential_energy"), volume = run.series("volume");
    for (std::size_t i = 0; i < energy.size(); ++i) energy.y[i] += potential.y[i] - 0.5 * weight * volume.y[i] * volume.y[i] / area;
    const real first = energy.y.front();
    for (real& e : energy.y) e /= first;
    return energy;
}

real most_wave_energy(const RunRecord& run, const Reference&) {
    const Curve energy = wave_energy(run);
    return *std::max_element(energy.y.begin(), energy.y.end());
}
real last_wave_energy(const RunRecord& run, const Reference&) { return wave_energy(run).y.back(); }

/// Largest change of the volume after the last emitter has closed, over the volume then.
real volume_after(const RunRecord& run, const Reference&) {
    real closed = 0;
    for (const scene::Table& emitter : run.scene->root().tables("emitters")) closed = std::max(closed, emitter.number("end"));
    const Curve volume = run.series("volume");
    real then = 0, change = 0;
    for (std::size_t i = 0; i < volume.size(); ++i) {
        if (volume.x[i] < closed * (1 + 1e-9)) continue;
        if (then == 0) then = volume.y[i];
        change = std::max(change, std::abs(volume.y[i] - then) / then);
    }
    if (then == 0) throw BadInput("the run ends before its emitters do");
    return change;
}

/// What flows out of a slot between the first two solids, over its width and sqrt(2 g H), H from the slot's upper edge to the level that
/// the probe "level" reads; of the second half of the run.
real contraction(const RunRecord& run, const Reference&) {
    const auto& solids = run.scene->root().tables("solids");
    const real width = solids.at(1).numbers("min").at(0) - solids.at(0).numbers("max").at(0), edge = solids.at(0).numbers("max").at(1);
    const Curve volume = run.series("volume"), level = run.series("probe.level");
    const real begin = 0.5 * run.time;
    real head = 0;
    int samples = 0;
    for (std::size_t i = 0; i < level.size(); ++i)
        if (level.x[i] >= begin) head += std::sqrt(2 * gravity_of(run) * std::max(0.0, level.y[i] - edge)), ++samples;
    std::size_t first = 0;
    while (first + 1 < volume.size() && volume.x[first] < begin) ++first;
    const real flow = (volume.y[first] - volume.y.back()) / (volume.x.back() - volume.x[first]);
    return flow / (width * head / samples);
}

/// k tanh(k d) = omega^2/g by Newton's method.
real wavenumber(real omega, real g, real depth) {
    real k = std::max(omega * omega / g, omega / std::sqrt(g * depth));
    for (int i = 0; i < 50; ++i) {
        const real t = std::tanh(k * depth), f = g * k * t - omega * omega;
        k -= f / (g * (t + k * depth * (1 - t * t)));
    }
    return k;
}

/// Height of the waves at the probe "wave" over that of a piston's linear theory, H = S (2 cosh 2kd - 2)/(sinh 2kd + 2kd) (Dean &
/// Dalrymple 1991, eq. 6.25); of the last two periods.
real paddle_height(const RunRecord& run, const Reference&) {
    const scene::Table& motion = run.scene->root().tables("solids").at(0).table("motion");
    const real stroke = 2 * motion.numbers("amplitude").at(0), omega = 2 * std::numbers::pi * motion.number("frequency");
    const real depth = run.scene->root().tables("liquid").at(0).numbers("max").at(1) - run.scene->root().numbers("grid.origin").at(1);
    const real kd = wavenumber(omega, gravity_of(run), depth) * depth;
    const real expected = stroke * (2 * std::cosh(2 * kd) - 2) / (std::sinh(2 * kd) + 2 * kd);
    const Curve wave = run.series("probe.wave");
    real low = infinity, high = -infinity;
    for (std::size_t i = 0; i < wave.size(); ++i)
        if (wave.x[i] >= run.time - 4 * std::numbers::pi / omega) low = std::min(low, wave.y[i]), high = std::max(high, wave.y[i]);
    return (high - low) / expected;
}

/// How far thick liquid from the lower end of x has come over Huppert's (1982) x = 1.411 (g A^3/(3 nu))^(1/5) t^(1/5), A its area.
real viscous_current(const RunRecord& run, const Reference&) {
    const real area = run.series("volume").y.front(), nu = run.scene->number("fluid.viscosity");
    const real reach = 1.411 * std::pow(gravity_of(run) * area * area * area / (3 * nu) * run.time, 0.2);
    return run.series("probe.front").y.back() / reach;
}

/// Diameter of a disc, height of a box: the first solid across the stream.
real breadth(const RunRecord& run) {
    const scene::Table& body = run.scene->root().tables("solids").at(0);
    return body.has("radius") ? 2 * body.number("radius") : body.numbers("max").at(1) - body.numbers("min").at(1);
}
real stream(const RunRecord& run) { return run.scene->root().numbers("sides.x_min.velocity").at(0); }

/// Mean force along the stream over rho U^2/2 times the breadth, of the last third of the run.
real drag(const RunRecord& run, const Reference&) {
    const Curve force = run.series("solid_force_x");
    std::size_t first = 0;
    while (first < force.size() && force.x[first] < run.time * 2 / 3) ++first;
    return mean(force.y, first) / (0.5 * density_of(run) * stream(run) * stream(run) * breadth(run));
}

/// Frequency of the force across the stream times breadth over speed: by its zeros in the last half of the run.
real strouhal(const RunRecord& run, const Reference&) {
    const Curve force = run.series("solid_force_y");
    std::size_t first = 0;
    while (first < force.size() && force.x[first] < run.time / 2) ++first;
    const real middle = mean(force.y, first);
    real begin = -1, end = -1;
    int periods = -1;
    for (std::size_t i = first + 1; i < force.size(); ++i) {
        const real a = force.y[i - 1] - middle, b = force.y[i] - middle;
        if (!(a < 0 && b >= 0)) continue;
        end = force.x[i - 1] + (force.x[i] - force.x[i - 1]) * a / (a - b);
        if (begin < 0) begin = end;
        ++periods;
    }
    return periods < 1 ? 0 : periods / (end - begin) * breadth(run) / stream(run);
}

/// How far the wake reaches behind the first solid along the line of the probe "wake", over its breadth: where the speed changes sign.
real wake_in_breadths(const RunRecord& run, const Reference&) {
    const ProbeSeries& probe = run.probe("wake");
    const scene::Table& body = run.scene->root().tables("solids").at(0);
    const real rear = body.has("radius") ? body.numbers("centre").at(0) + body.number("radius") : body.numbers("max").at(0);
    real length = 0, last_x = rear, last_u = 0;
    for (std::size_t c = 0; c < probe.columns.size(); ++c) {
        if (!probe.columns[c].starts_with("velocity_x")) continue;
        const real x = probe.positions.at(c)[0], u = probe.values.back().at(c);
        if (x <= rear) continue;
        if (last_u < 0 && u >= 0) length = last_x + (x - last_x) * last_u / (last_u - u) - rear;
        last_x = x, last_u = u;
    }
    return length / breadth(run);
}

/// Largest pressure that the probe "p1" reads over the largest of the reference's P1.
real impact_peak(const RunRecord& run, const Reference& ref) {
    const auto largest = [](const std::vector<real>& values) { return *std::max_element(values.begin(), values.end()); };
    return largest(run.series("probe.p1").y) / largest(ref.curve("P1").y);
}

/// The first place of a curve above 1 kPa.
std::size_t first_felt(const Curve& curve) {
    return static_cast<std::size_t>(std::find_if(curve.y.begin(), curve.y.end(), [](real p) { return p > 1000; }) - curve.y.begin());
}

/// When p1 first exceeds 1 kPa, less when the reference's does [s]; NaN where the run ends before.
real impact_time(const RunRecord& run, const Reference& ref) {
    const auto felt = [](const Curve& curve) {
        const std::size_t first = first_felt(curve);
        return first < curve.size() ? curve.x[first] : std::nan("");
    };
    return felt(run.series("probe.p1")) - felt(ref.curve("P1"));
}

/// Pressure at p1 over the first tenth of a second after it exceeds 1 kPa, over the same of the reference.
real impact_impulse(const RunRecord& run, const Reference& ref) {
    const auto impulse = [](const Curve& curve) {
        const std::size_t first = first_felt(curve);
        real sum = 0;
        for (std::size_t i = first + 1; i < curve.size() && curve.x[i] <= curve.x[first] + 0.1; ++i)
            sum += 0.5 * (curve.y[i] + curve.y[i - 1]) * (curve.x[i] - curve.x[i - 1]);
        return sum;
    };
    return impulse(run.series("probe.p1")) / impulse(ref.curve("P1"));
}

}  // namespace

std::vector<Metric> everyday_metrics() {
    return {
        {"wave_energy.most", "", "Largest energy of waves in a box over that of the start", Quantity::value, most_wave_energy},
        {"wave_energy.last", "", "Energy of waves in a box at the end over that of the start", Quantity::value, last_wave_energy},
        {"volume_after", "", "Largest change of volume after the last emitter has closed", Quantity::error, volume_after},
        {"contraction", "", "Flow through a slot over its width times sqrt(2 g H)", Quantity::value, contraction},
        {"paddle.height", "", "Height of a piston's waves over that of linear theory", Quantity::value, paddle_height},
        {"viscous_current", "", "Reach of a viscous gravity current over Huppert's", Quantity::value, viscous_current},
        {"drag", "", "Mean force along the stream over rho U^2/2 times the breadth", Quantity::value, drag},
        {"strouhal", "", "Frequency of the force across the stream times breadth over speed", Quantity::value, strouhal},
        {"impact.peak", "", "Largest pressure at the probe p1 over the reference's", Quantity::value, impact_peak},
        {"impact.time", "s", "When p1 first exceeds 1 kPa, less when the reference's does", Quantity::value, impact_time},
        {"impact.impulse", "", "Pressure at p1 over the first 0.1 s of the impact, over the reference's", Quantity::value, impact_impulse},
        {"wake_length", "", "Length of the wake that turns back, in breadths", Quantity::value, wake_in_breadths}};
}

}  // namespace weir::validation
