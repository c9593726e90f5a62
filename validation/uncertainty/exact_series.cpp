#include "validation/uncertainty/exact_series.hpp"

#include "scene/formula.hpp"
#include "validation/harness/named_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace weir::validation {
namespace {

constexpr int samples_of_series = 1000;
constexpr int samples_of_integral = 100, points_of_integral = 64;  // in time; along each axis

using OfTime = std::function<real(real t)>;

RecordedSeries sampled_in_time(const RecordedSeries& series, int count, const OfTime& value) {
    RecordedSeries exact{.name = series.name, .unit = series.unit, .integral = series.integral};
    const real first = series.curve.x.front(), last = series.curve.x.back();
    for (int i = 0; i <= count; ++i) {
        exact.curve.x.push_back(i == count ? last : first + (last - first) * i / count);
        exact.curve.y.push_back(value(exact.curve.x.back()));
    }
    return exact;
}

/// "velocity_x#3" of a probe: the field, its component and the number of the sample on the line.
struct Column {
    std::string field{};
    std::size_t component = 0, sample = 0;
};

Column column_of(std::string name) {
    Column column;
    if (const auto hash = name.find('#'); hash != std::string::npos)
        column.sample = std::stoul(name.substr(hash + 1)), name = name.substr(0, hash);
    const std::size_t size = name.size();
    if (size > 2 && name[size - 2] == '_' && name.back() >= 'x' && name.back() <= 'z')
        column.component = static_cast<std::size_t>(name.back() - 'x'), name = name.substr(0, size - 2);
    column.field = name;
    return column;
}

Vec<3> position_of(const scene::Table& probe, std::size_t sample) {
    if (probe.text("kind") != "line") return probe.vec<3>("at");
    const Vec<3> from = probe.vec<3>("from"), to = probe.vec<3>("to");
    const auto last = static_cast<real>(std::max<std::int64_t>(1, probe.integer("count") - 1));
    return from + (to - from) * (static_cast<real>(sample) / last);
}

/// The value of a column of a probe; empty where the reference lacks it.
OfTime of_probe(const std::string& probe_name, const std::string& column_name, const scene::Scene& scene, const Reference& reference) {
    for (const scene::Table& probe : scene.root().tables("probes")) {
        if (probe.text("name") != probe_name) continue;
        const std::string& kind = probe.text("kind");
        if (kind != "point" && kind != "line" && kind != "gauge") return {};
        const Column column = column_of(column_name);
        const Vec<3> at = position_of(probe, column.sample);
        if (const auto found = reference.vectors.find(column.field); found != reference.vectors.end())
            return [=, field = found->second](real t) { return field(at, t)[static_cast<int>(column.component)]; };
        if (const auto found = reference.scalars.find(column.field); found != reference.scalars.end())
            return [=, field = found->second](real t) { return field(at, t); };
    }
    return {};
}

/// The integral of f over the domain, by the midpoint rule.
real over_domain(const scene::Scene& scene, const std::function<real(const Vec<3>&)>& f) {
    const Vec<3> origin = scene.vec<3>("grid.origin"), size = scene.vec<3>("grid.size");
    const int deep = scene.dim() == 3 ? points_of_integral : 1;
    const real volume = size[0] * size[1] * (scene.dim() == 3 ? size[2] : 1);
    real sum = 0;
    for (int k = 0; k < deep; ++k)
        for (int j = 0; j < points_of_integral; ++j)
            for (int i = 0; i < points_of_integral; ++i)
                sum += f({origin[0] + size[0] * (i + 0.5) / points_of_integral, origin[1] + size[1] * (j + 0.5) / points_of_integral,
                          scene.dim() == 3 ? origin[2] + size[2] * (k + 0.5) / deep : 0});
    return volume * sum / (static_cast<real>(points_of_integral) * points_of_integral * deep);
}

OfTime of_integral(const std::string& name, const scene::Scene& scene, const Reference& reference) {
    const auto found = reference.vectors.find("velocity");
    const bool energy = name == "kinetic_energy", along_x = name == "momentum_x";
    if (found == reference.vectors.end() || (!energy && !along_x && name != "momentum_y")) return {};
    const real density = scene.number("fluid.density");
    return [=, &scene, velocity = found->second](real t) {
        return density * over_domain(scene, [&](const Vec<3>& x) {
                   const Vec<3> u = velocity(x, t);
                   return energy ? 0.5 * (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]) : u[along_x ? 0 : 1];
               });
    };
}

}  // namespace

std::optional<RecordedSeries> exact_series(const RecordedSeries& series, const scene::Scene& scene, const Reference& reference) {
    const auto dot = series.name.find('.');
    if (dot == std::string::npos) {
        const OfTime value = of_integral(series.name, scene, reference);
        if (!value) return std::nullopt;
        return sampled_in_time(series, samples_of_integral, value);
    }
    const OfTime value = of_probe(series.name.substr(0, dot), series.name.substr(dot + 1), scene, reference);
    if (!value) return std::nullopt;
    return sampled_in_time(series, samples_of_series, value);
}

RecordedSeries series_from_curve(const RecordedSeries& series, const Curve& curve) {
    return sampled_in_time(series, samples_of_series, [&](real t) { return interpolate(curve, std::min(t, curve.x.back())); });
}

RecordedSeries series_from_formula(const RecordedSeries& series, const std::string& formula) {
    const scene::Formula f(formula, {"t"});
    return sampled_in_time(series, samples_of_series, [&](real t) { return f({&t, 1}); });
}

}  // namespace weir::validation
