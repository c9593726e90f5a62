// A standing wave: the amplitude of its one mode, from the liquid fractions of columns, the level set or the surface of columns, against
// the linear (viscous) solution.
#include "validation/metrics/lists.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

/// Height of the surface in the column of cells i: the highest change of sign of the level set, on a straight line.
real surface_height(const FieldSet& fields, const FieldView& phi, int i) {
    const GridView& g = fields.grid;
    for (int j = g.cells[1] - 2; j >= 0; --j) {
        const real below = value_at(phi, g, 0, {i, j, 0}), above = value_at(phi, g, 0, {i, j + 1, 0});
        if (below < 0 && above >= 0) return g.origin[1] + g.spacing[1] * (j + 0.5 + below / (below - above));
    }
    return std::nan("");
}

/// Height of the liquid in the column of cells i: the sum of its fractions.
real column_height(const FieldSet& fields, const FieldView& fraction, int i) {
    const GridView& g = fields.grid;
    real sum = 0;
    for (int j = 0; j < g.cells[1]; ++j) sum += value_at(fraction, g, 0, {i, j, 0});
    return g.origin[1] + g.spacing[1] * sum;
}

/// Amplitude of cos(k x) in the surface: 2/n sum eta cos(k x). The mean level drops out, and so do the other modes.
real mode_amplitude(const FieldSet& fields, const scene::Scene& scene, real) {
    const FieldView *fraction = fields.find("", "fraction"), *phi = fields.find("", "level_set"), *columns = fields.find("", "surface");
    if (!phi && !columns) throw BadInput("the solver shows no field \"level_set\" and no \"surface\"");
    const GridView& g = fields.grid;
    const scene::Table& wave = scene.root().tables("liquid").at(0);
    const real k = 2 * pi / wave.number("wavelength");
    real sum = 0;
    for (int i = 0; i < g.cells[0]; ++i) {
        const real x = g.origin[0] + g.spacing[0] * (i + 0.5);
        const real height = fraction ? column_height(fields, *fraction, i)
                            : phi    ? surface_height(fields, *phi, i)
                                     : columns->data[0][static_cast<std::size_t>(i)];
        sum += (height - wave.number("level")) * std::cos(k * x);
    }
    return 2 * sum / g.cells[0];
}

/// The reference's curve at our times.
Curve exact_at(const Curve& exact, const std::vector<real>& times) {
    Curve c{.label = exact.label, .x = {}, .y = {}};
    for (const real t : times)
        if (t <= exact.x.back()) c.x.push_back(t), c.y.push_back(cubic(exact, t));
    return c;
}

real history_error(const Curve& ours, const Reference& ref) {
    const Curve exact = exact_at(ref.curve("amplitude"), ours.x);
    real sum = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) sum += (ours.y[i] - exact.y[i]) * (ours.y[i] - exact.y[i]);
    return std::sqrt(sum / static_cast<real>(exact.size())) / ref.number("amplitude");
}

/// Largest difference of the amplitude to the reference after whole periods, each over its start.
real period_error(const Curve& ours, const Reference& ref) {
    const Curve& exact = ref.curve("amplitude");
    const real period = 2 * pi / ref.number("frequency");
    real largest = 0;
    for (int m = 1; m * period <= ours.x.back() * (1 + 1e-9); ++m) {
        const real t = std::min(m * period, ours.x.back());
        largest = std::max(largest, std::abs(cubic(ours, t) / ours.y.front() - cubic(exact, t) / exact.y.front()));
    }
    return largest;
}

/// Rate of exponential growth over the last third of the run, by least squares of the amplitude's logarithm.
real growth(const Curve& ours) {
    real n = 0, t = 0, y = 0, tt = 0, ty = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
        if (ours.x[i] < ours.x.back() * 2 / 3) continue;
        const real log = std::log(std::abs(ours.y[i]));
        n += 1, t += ours.x[i], y += log, tt += ours.x[i] * ours.x[i], ty += ours.x[i] * log;
    }
    return (n * ty - t * y) / (n * tt - t * t);
}

Panel wave_panel(const RunRecord& run, const Reference& ref, const std::string& metric) {
    Curve ours = run.series(metric);
    ours.label = "weir";
    return {.title = "Amplitude of the mode", .x = {"t [s]"}, .y = {"a [m]"}, .curves = {ref.curve("amplitude"), ours}};
}

}  // namespace

std::vector<Metric> wave_metrics() {
    return {
        {.name = "wave.frequency_error",
         .unit = "",
         .doc = "Relative error of the frequency, from zero crossings of the mode's amplitude; the reference is measured the same way.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve ours = run.series("wave.frequency_error");
                 return std::abs(frequency(ours) / frequency(exact_at(ref.curve("amplitude"), ours.x)) - 1);
             },
         .figure = [](const RunRecord& run, const Reference& ref) { return wave_panel(run, ref, "wave.frequency_error"); },
         .observe = mode_amplitude},
        {.name = "wave.decay_error",
         .unit = "",
         .doc = "Relative error of the rate at which the extrema of the amplitude decay; the reference is measured the same way.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 const Curve ours = run.series("wave.decay_error");
                 return std::abs(decay(ours) / decay(exact_at(ref.curve("amplitude"), ours.x)) - 1);
             },
         .observe = mode_amplitude},
        {.name = "wave.period_error",
         .unit = "",
         .doc = "Largest difference of the amplitude to the reference after whole periods, over the first amplitude.",
         .measure = [](const RunRecord& run, const Reference& ref) { return period_error(run.series("wave.period_error"), ref); },
         .figure = [](const RunRecord& run, const Reference& ref) { return wave_panel(run, ref, "wave.period_error"); },
         .observe = mode_amplitude},
        {.name = "wave.growth_error",
         .unit = "",
         .doc = "Relative error of the rate at which the amplitude grows over the last third of the run.",
         .measure = [](const RunRecord& run,
                       const Reference& ref) { return std::abs(growth(run.series("wave.growth_error")) / ref.number("rate") - 1); },
         .observe = mode_amplitude},
        {.name = "wave.decay_a_period",
         .unit = "",
         .doc = "Fraction of the amplitude lost in one period.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return 1 - std::exp(-decay(run.series("wave.decay_a_period")) * 2 * pi / ref.number("frequency"));
             },
         .observe = mode_amplitude},
        {.name = "wave.history_error",
         .unit = "",
         .doc = "Root mean square difference of the amplitude's history to the reference, over the first amplitude.",
         .measure = [](const RunRecord& run, const Reference& ref) { return history_error(run.series("wave.history_error"), ref); },
         .figure = [](const RunRecord& run, const Reference& ref) { return wave_panel(run, ref, "wave.history_error"); },
         .observe = mode_amplitude},
    };
}

}  // namespace weir::validation
