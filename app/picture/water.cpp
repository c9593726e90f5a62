#include "app/picture/media.hpp"
#include "core/parallel.hpp"

namespace weir::picture {

namespace {

/// Kernel radius [cells]. Neighbouring markers (half a cell apart with 8 a cell) overlap well, and a single one is a small drop.
constexpr real reach = 1.2;
/// The sum of kernels that counts as surface. Inside, 8 markers a cell sum to 8 (16/315) 4 pi R^3 = 8.8; at a plane surface half of that.
/// A quarter keeps thin sheets and drops of a few markers visible and moves a plane outwards by less than half a cell.
constexpr real surface_value = 2.2;
/// Samples a cell along each axis.
constexpr int refinement = 2;

void splat(Volume& volume, const Vec<3>& x, real radius) {
    const auto& l = volume.lattice;
    std::array<int, 3> lower, upper;
    for (std::size_t a = 0; a < 3; ++a) {
        lower[a] = std::max(0, static_cast<int>(std::ceil((x[a] - radius - l.first[a]) / l.spacing[a])));
        upper[a] = std::min(l.n[a] - 1, static_cast<int>(std::floor((x[a] + radius - l.first[a]) / l.spacing[a])));
    }
    std::array<int, 3> I;
    for (I[2] = lower[2]; I[2] <= upper[2]; ++I[2])
        for (I[1] = lower[1]; I[1] <= upper[1]; ++I[1])
            for (I[0] = lower[0]; I[0] <= upper[0]; ++I[0]) {
                const Vec<3> d = l.position(I) - x;
                const real q = 1 - dot(d, d) / (radius * radius);
                if (q > 0) volume.values[l.linear(I)] += q * q * q;
            }
}

/// [1 2 1]/4 along each axis: the bumps of single markers vanish, the shape of the water stays.
void smooth(Volume& volume) {
    const auto& n = volume.lattice.n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::vector<real> out(volume.values.size());
        parallel_for(0, n[2], [&](int k) {
            for (int j = 0; j < n[1]; ++j)
                for (int i = 0; i < n[0]; ++i) {
                    std::array<int, 3> I{i, j, k}, before = I, after = I;
                    before[axis] = std::max(0, I[axis] - 1);
                    after[axis] = std::min(n[axis] - 1, I[axis] + 1);
                    out[volume.lattice.linear(I)] = 0.25 * volume.values[volume.lattice.linear(before)] +
                                                    0.5 * volume.values[volume.lattice.linear(I)] +
                                                    0.25 * volume.values[volume.lattice.linear(after)];
                }
        });
        volume.values.swap(out);
    }
}

}  // namespace

Water::Water(const View& view) {
    const GridView& grid = view.frame.grid;
    cell_ = grid.spacing[0];
    for (std::size_t a = 0; a < 3; ++a) {
        density_.lattice.n[a] = refinement * grid.cells[a] + 1;
        density_.lattice.spacing[a] = grid.spacing[a] / refinement;
        density_.lattice.first[a] = density_.box.min[a] = grid.origin[a];
    }
    density_.box.max = sim::upper_corner(grid);
    const auto& n = density_.lattice.n;
    density_.values.assign(static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]), 0);
    const auto& x = view.frame.particles.at("markers").at("position");
    for (std::size_t m = 0; m < x[0].size(); ++m) splat(density_, {{x[0][m], x[1][m], x[2][m]}}, reach * cell_);
    smooth(density_);
}

real Water::next_surface(const Ray& ray, real from, real to) const {
    const real step = 0.4 * cell_;
    real before = density_.at(ray.at(from)) - surface_value;
    for (real s = from + step; s < to + step; s += step) {
        const real at = std::min(s, to), value = density_.at(ray.at(at)) - surface_value;
        if ((value > 0) != (before > 0)) {
            real low = at - step, high = at;
            for (int i = 0; i < 12; ++i) {  // bisection
                const real middle = 0.5 * (low + high);
                ((density_.at(ray.at(middle)) - surface_value > 0) == (before > 0) ? low : high) = middle;
            }
            return high;
        }
        before = value;
    }
    return infinity;
}

Vec<3> Water::normal(const Vec<3>& x) const {
    const Vec<3> g = density_.gradient(x, 0.5 * cell_);
    const real length = norm(g);
    return length > 0 ? -g / length : Vec<3>{{0, 1, 0}};
}

/// Sky reflected by Fresnel's share (Schlick 1994), and the stage behind, dimmed by the water in between. Rays are not bent: shapes stay
/// readable.
Colour Water::look(const Ray& ray, const Stage& stage) const {
    const auto behind =
        stage.trace(ray, [&](const Vec<3>& x) { return density_.at(x + 0.3 * cell_ * Vec<3>::unit(1)) > surface_value ? 0.75 : 1.0; });
    const auto span = density_.box.span(ray);
    if (!span) return behind.colour;
    const real last = std::min(span->second, behind.distance);
    // against the glass of the domain the water begins at the box itself
    const bool at_glass = density_.at(ray.at(span->first + 1e-6)) > surface_value;
    const real first = at_glass ? span->first : next_surface(ray, span->first, last);
    if (first >= last) return behind.colour;
    real thickness = 0, s = first + 0.05 * cell_;
    for (int layer = 0; layer < 6 && s < last; ++layer) {
        const bool wet = density_.at(ray.at(s)) > surface_value;
        const real next = std::min(next_surface(ray, s, last), last);
        if (wet) thickness += next - s;
        s = next + 0.05 * cell_;
    }
    const Vec<3> extent = density_.box.max - density_.box.min;
    const real depth = thickness / (0.35 * std::max({extent[0], extent[1], extent[2]}));
    const Colour deep = hex(0x0d4f86), tint = {{std::exp(-4.0 * depth), std::exp(-1.5 * depth), std::exp(-0.8 * depth)}};
    Colour colour = times(tint, behind.colour) + times(Colour{{1, 1, 1}} - tint, deep);
    if (at_glass) return mix(colour, deep, 0.15);
    const Vec<3> n = normal(ray.at(first)), reflected = ray.direction - (2 * dot(ray.direction, n)) * n;
    const real facing = std::clamp(-dot(ray.direction, n), 0.0, 1.0), fresnel = 0.02 + 0.98 * std::pow(1 - facing, 5);
    colour = (0.8 + 0.2 * std::max(0.0, dot(n, Stage::light()))) * colour;
    colour = mix(colour, stage.sky(reflected), std::min(0.75, fresnel));
    return colour + (0.9 * std::pow(std::max(0.0, dot(reflected, Stage::light())), 60)) * hex(0xfffaf0);
}

}  // namespace weir::picture
