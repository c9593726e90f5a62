#include "app/picture/media.hpp"
#include "app/picture/quality.hpp"
#include "core/parallel.hpp"

namespace weir::picture {

namespace {

Volume volume_of(const GridView& grid, std::vector<real> values) {
    Volume volume{sim::Lattice::of_cells(grid), {}, std::move(values)};
    for (std::size_t a = 0; a < 3; ++a) volume.box.min[a] = grid.origin[a];
    volume.box.max = sim::upper_corner(grid);
    return volume;
}

/// Greatest value, apart from the most extreme 0.2%.
real dense_value(std::vector<real> values) {
    const auto at = static_cast<std::ptrdiff_t>(0.998 * static_cast<real>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return std::max(*(values.begin() + at), 1e-300);
}

}  // namespace

Smoke::Smoke(const View& view, const Vec<3>& towards_light)
    : density_(volume_of(view.frame.grid, scalar_field(view.frame, view.field))), light_(density_) {
    const GridView& grid = view.frame.grid;
    step_ = 0.5 * std::min({grid.spacing[0], grid.spacing[1], grid.spacing[2]});
    // the densest smoke hides what is behind an eighth of the domain: opaque enough to have a shape, thin enough to have an inside
    const Vec<3> extent = density_.box.max - density_.box.min;
    const real least = *std::min_element(density_.values.begin(), density_.values.end());  // a temperature's surroundings are not smoke
    const real base = view.range.low.value_or(view.field == "temperature" ? least : 0);
    const real dense = view.range.high.value_or(dense_value(density_.values)) - view.range.low.value_or(0);
    const real scale = 3.0 / (std::min({extent[0], extent[1], extent[2]}) / 4) / std::max(dense, 1e-300);
    for (auto& value : density_.values) value = scale * std::max(0.0, value - base);
    const auto& n = density_.lattice.n;
    parallel_for(0, n[2], [&](int k) {
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i) {
                const Ray to_light{density_.lattice.position({i, j, k}), towards_light};
                real depth = 0;
                const auto span = density_.box.span(to_light);
                for (real s = step_; span && s < span->second; s += 2 * step_) depth += 2 * step_ * density_.at(to_light.at(s));
                light_.values[density_.lattice.linear({i, j, k})] = std::exp(-depth);
            }
    });
}

Colour Smoke::look(const Ray& ray, const Stage& stage) const {
    const auto shade = [&](const Vec<3>& x) {  // the floor stands just outside the volume
        Vec<3> inside = x;
        for (int a = 0; a < 3; ++a) inside[a] = std::clamp(x[a], density_.box.min[a], density_.box.max[a]);
        return 0.25 + 0.75 * light_at(inside);
    };
    const auto behind = stage.trace(ray, shade);
    const auto span = density_.box.span(ray);
    Colour collected{};
    real through = 1;
    if (span)
        for (real s = span->first + 0.5 * step_; s < std::min(span->second, behind.distance) && through > 0.005; s += step_) {
            const Vec<3> x = ray.at(s);
            const real sigma = density_.at(x);
            if (sigma <= 0) continue;
            const real stopped = 1 - std::exp(-sigma * step_);
            const real lit = light_at(x);
            collected += (through * stopped) * (mix(hex(0x3a4250), hex(0xfff6e8), 0.12 + 0.88 * lit));
            through *= 1 - stopped;
        }
    return collected + through * behind.colour;
}

Colour Smoke::look_among(const Ray& ray, const Surroundings& around) const {
    const Surroundings::Hit behind = around.first(ray);
    Colour share{};
    if (behind.lit) {
        const Vec<3> x = ray.at(behind.distance);
        real depth = 0;  // of the smoke between there and the sun
        const Ray to_sun{x, Surroundings::to_sun()};
        if (const auto span = density_.box.span(to_sun))
            for (real s = span->first + step_; s < span->second; s += 2 * step_) depth += 2 * step_ * density_.at(to_sun.at(s));
        if (!around.in_shadow(x)) share = std::exp(-depth) * Colour{{1, 1, 1}};
    }
    Colour collected{};
    real through = 1;
    if (const auto span = density_.box.span(ray))
        for (real s = span->first + 0.5 * step_; s < std::min(span->second, behind.distance) && through > 0.005; s += step_) {
            const Vec<3> x = ray.at(s);
            const real sigma = density_.at(x);
            if (sigma <= 0) continue;
            const real stopped = 1 - std::exp(-sigma * step_);
            collected += (through * stopped) * (0.42 * hex(0x9fb4cc) + (0.36 * light_at(x)) * Surroundings::sun());
            through *= 1 - stopped;
        }
    return collected + through * around.shade(behind, ray, share);
}

}  // namespace weir::picture
