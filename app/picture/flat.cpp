// 2D pictures: smoke, colour maps of fields, water from its markers, solids in front.
#include "app/picture/liquid.hpp"
#include "app/picture/view.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/solids.hpp"
#include "sim/sampling.hpp"
#include "surfaces/reconstruction.hpp"

namespace weir::picture {

namespace {

/// Pixels of the canvas against places in the domain.
struct Plane {
    real x0, y1, metre;  // left, top [m]; metres a pixel
    int width, height;
    Plane(const GridView& grid, int size) {
        const Vec<3> upper = sim::upper_corner(grid);
        const real wide = upper[0] - grid.origin[0], high = upper[1] - grid.origin[1];
        metre = std::max(wide, high) / (size * oversampling);
        width = oversampling * std::max(1, static_cast<int>(wide / metre / oversampling));
        height = oversampling * std::max(1, static_cast<int>(high / metre / oversampling));
        x0 = grid.origin[0];
        y1 = upper[1];
    }
    Vec<2> place(int x, int y) const { return {{x0 + (x + 0.5) * metre, y1 - (y + 0.5) * metre}}; }
};

/// Percentile that ignores a few extreme cells, so that one spike does not darken the rest.
real robust_max(std::vector<real> values) {
    if (values.empty()) return 1;
    for (auto& value : values) value = std::isfinite(value) ? std::abs(value) : 0;
    const auto at = static_cast<std::ptrdiff_t>(0.995 * static_cast<real>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    const real value = *(values.begin() + at);
    return value > 0 ? value : std::max(1e-300, *std::max_element(values.begin(), values.end()));
}

/// Markers spread over pixels with a smooth kernel of one cell's radius: where their sum passes a threshold is water.
struct Splats {
    std::vector<real> weight, speed;
    real slowest = 0, fastest = 1;
    const char* colours = nullptr;  // of a field that the markers carry; null: of their speed
    Splats(const View& view, const Plane& plane)
        : weight(static_cast<std::size_t>(plane.width) * static_cast<std::size_t>(plane.height)), speed(weight.size()) {
        const auto& x = view.frame.particles.at("markers").at("position");
        const auto* field = marker_field(view.frame, view.field);
        const auto speeds = field ? *field : marker_speeds(view.frame);
        fastest = view.range.high.value_or(field ? *std::max_element(speeds.begin(), speeds.end()) : robust_max(speeds));
        slowest = view.range.low.value_or(field ? *std::min_element(speeds.begin(), speeds.end()) : 0);
        if (field) colours = view.field == "temperature" ? "inferno" : "viridis";
        if (view.frame.particles.at("markers").count(from_level_set)) {
            fill_liquid(view, plane);
            return;
        }
        const real radius = view.frame.grid.spacing[0] / plane.metre;  // pixels
        for (std::size_t m = 0; m < speeds.size(); ++m)
            add((x[0][m] - plane.x0) / plane.metre, (plane.y1 - x[1][m]) / plane.metre, radius, speeds[m], plane);
    }
    /// Without markers: by the distance to the level set, as wide a rim as that of markers.
    void fill_liquid(const View& view, const Plane& plane) {
        const auto &phi = view.frame.cells.at(level_set_name)[0], speeds = scalar_field(view.frame, "speed");
        const auto lattice = sim::Lattice::of_cells(view.frame.grid);
        const real h = view.frame.grid.spacing[0];
        parallel_for(0, plane.height, [&](int y) {
            for (int px = 0; px < plane.width; ++px) {
                const Vec<2> at = plane.place(px, y);
                const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(px);
                weight[i] = std::clamp(0.5 - 1.8 * sim::sample(phi, lattice, {{at[0], at[1], 0}}) / h, 0.0, 4.0);
                speed[i] = weight[i] * sim::sample(speeds, lattice, {{at[0], at[1], 0}});
            }
        });
    }
    void add(real cx, real cy, real radius, real value, const Plane& plane) {
        const int x0 = std::max(0, static_cast<int>(cx - radius)), x1 = std::min(plane.width - 1, static_cast<int>(cx + radius));
        const int y0 = std::max(0, static_cast<int>(cy - radius)), y1 = std::min(plane.height - 1, static_cast<int>(cy + radius));
        for (int y = y0; y <= y1; ++y)
            for (int px = x0; px <= x1; ++px) {
                const real d2 = ((px + 0.5 - cx) * (px + 0.5 - cx) + (y + 0.5 - cy) * (y + 0.5 - cy)) / (radius * radius);
                if (d2 >= 1) continue;
                const real w = (1 - d2) * (1 - d2);
                const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(px);
                weight[i] += w;
                speed[i] += w * value;
            }
    }
    /// With 4 markers a cell the sum is about 4 pi/3 inside: half the value of a single marker's centre is a thin drop still.
    Colour colour(std::size_t i) const {
        const Colour air = hex(0xf3f5f7);
        if (weight[i] < 0.5) return air;
        const real s = (speed[i] / weight[i] - slowest) / std::max(fastest - slowest, 1e-300);
        if (colours) return mix(air, colour_of(colours, s), std::clamp((weight[i] - 0.5) / 0.3, 0.0, 1.0));
        const Colour water = colour_of("water", 0.08 + 0.8 * s);
        return mix(hex(0xdff1fb), water, std::clamp((weight[i] - 0.5) / 0.9, 0.0, 1.0));  // a light rim: the surface
    }
};

/// Colours of a cell field: smoke as light grey on dark, signed fields in two hues, others from dark to bright.
class FieldColours {
public:
    explicit FieldColours(const View& view)
        : name_(view.field), values_(scalar_field(view.frame, view.field)), lattice_(sim::Lattice::of_cells(view.frame.grid)) {
        const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
        const bool crosses = *low < 0 && *high > 0;
        signed_ = name_ == "vorticity" || (crosses && name_ != "temperature");
        const bool from_nothing = name_ == "speed" || name_ == "smoke";
        upper_ = view.range.high.value_or(signed_ || from_nothing ? robust_max(values_) : *high);
        lower_ = view.range.low.value_or(signed_ ? -upper_ : from_nothing ? 0 : *low);
    }
    Colour operator()(const Vec<2>& x) const {
        const real value = sim::sample(values_, lattice_, {{x[0], x[1], 0}});
        const real s = (value - lower_) / std::max(upper_ - lower_, 1e-300);
        if (name_ == "smoke") return mix(hex(0x10131a), hex(0xf2f0ea), 1 - std::exp(-2.5 * std::max(0.0, s)));
        return colour_of(signed_ ? "coolwarm" : name_ == "temperature" ? "inferno" : "viridis", s);
    }

private:
    std::string name_;
    std::vector<real> values_;
    sim::Lattice lattice_;
    bool signed_ = false;
    real lower_ = 0, upper_ = 1;
};

/// Water below a line of points; where it is folded over, below its highest.
void draw_below_line(const View& view, const Plane& plane, Canvas& canvas) {
    const auto& x = view.frame.particles.at(surface_set_name).at("position");
    std::vector<real> top(static_cast<std::size_t>(plane.width), -infinity);
    for (std::size_t i = 0; i + 1 < x[0].size(); ++i) {
        const auto [left, right] = std::minmax(x[0][i], x[0][i + 1]);
        const int from = std::max(0, static_cast<int>((left - plane.x0) / plane.metre)),
                  to = std::min(plane.width - 1, static_cast<int>((right - plane.x0) / plane.metre));
        for (int column = from; column <= to; ++column) {
            const real s = right > left ? std::clamp((plane.place(column, 0)[0] - x[0][i]) / (x[0][i + 1] - x[0][i]), 0.0, 1.0) : 0;
            top[static_cast<std::size_t>(column)] = std::max(top[static_cast<std::size_t>(column)], (1 - s) * x[1][i] + s * x[1][i + 1]);
        }
    }
    for (int column = 0; column < plane.width; ++column) {  // half a cell beyond the outermost points
        const bool left = column < plane.width / 2;
        if (real& y = top[static_cast<std::size_t>(column)]; y == -infinity) y = left ? x[1].front() : x[1].back();
    }
    const Colour air = hex(0xf3f5f7), rim = hex(0x9ccbe8), water = colour_of("water", 0.3);
    for (int y = 0; y < plane.height; ++y)
        for (int column = 0; column < plane.width; ++column) {
            const real below = (top[static_cast<std::size_t>(column)] - plane.place(column, y)[1]) / plane.metre;  // pixels
            canvas.at(column, y) = below < 0 ? air : below < 3 * oversampling ? rim : water;
        }
}

void draw_solids(const View& view, const Plane& plane, Canvas& canvas) {
    rigid::ShownSolids<2> shown(view.scene);
    if (shown.empty()) return;
    const geometry::Solids<2>& solids = shown.at(view.frame.time, bodies_of(view.frame));
    const std::size_t bodies = solids.count() - view.scene.root().tables("bodies").size();  // the first of them
    parallel_for(0, plane.height, [&](int y) {
        for (int x = 0; x < plane.width; ++x) {
            const Vec<2> at = plane.place(x, y);
            const real depth = -solids.distance(at) / plane.metre;  // pixels
            if (depth <= 0) continue;
            const Colour inside = solids.nearest(at) < bodies ? hex(0x8d939c) : hex(0xe0a43a);
            canvas.at(x, y) = depth < 3 * oversampling ? hex(0x2b2f36) : inside;
        }
    });
}

/// The line of the liquid's surface, two pixels wide, away from the sides of the domain, which it follows.
void draw_surface(const View& view, const Plane& plane, Canvas& canvas) {
    const FieldSet fields = fields_of(view.frame, view.scene);
    surfaces::Reconstruction maker(options_for(view, fields), view.scene);
    const SurfaceMesh& mesh = maker.make(fields, view.frame.time);
    const Colour ink = hex(0x0b2f4a);
    for (const auto& [from, to] : mesh.lines) {
        const Vec<3>&a = mesh.points[static_cast<std::size_t>(from)], &b = mesh.points[static_cast<std::size_t>(to)];
        const int steps = 1 + static_cast<int>(norm(b - a) / plane.metre);
        for (int s = 0; s <= steps; ++s) {
            const Vec<3> x = a + (real(s) / steps) * (b - a);
            const int px = static_cast<int>((x[0] - plane.x0) / plane.metre), py = static_cast<int>((plane.y1 - x[1]) / plane.metre);
            for (int y = py - oversampling; y < py + oversampling; ++y)
                for (int column = px - oversampling; column < px + oversampling; ++column)
                    if (column >= 0 && column < plane.width && y >= 0 && y < plane.height) canvas.at(column, y) = ink;
        }
    }
}

/// Lines around the grid cells that hold liquid. A solver with tall cells says in "cell_height" how high each is, counted from its bottom.
void draw_grid(const View& view, const Plane& plane, Canvas& canvas) {
    const auto found = view.frame.cells.find("cell_height");
    if (found == view.frame.cells.end()) throw BadInput("this run has no field \"cell_height\": only tall cells have a grid to draw");
    const std::vector<real>& height = found->second[0];
    const GridView& grid = view.frame.grid;
    const auto nx = static_cast<std::size_t>(grid.cells[0]);
    const Colour dark = hex(0x1d3f5e), light = hex(0xbfe2f7);
    const auto dot = [&](int x, int y) {
        if (x < 0 || x >= plane.width || y < 0 || y >= plane.height) return;
        Colour& pixel = canvas.at(x, y);
        pixel = mix(pixel, pixel[1] < 0.25 ? light : dark, 0.5);
    };
    const auto left = [&](int i) { return static_cast<int>(i * grid.spacing[0] / plane.metre); };
    const auto top = [&](int j) { return plane.height - 1 - static_cast<int>(j * grid.spacing[1] / plane.metre); };
    for (int i = 0; i < grid.cells[0]; ++i)
        for (int j = 0; j < grid.cells[1];) {
            const int rows =
                static_cast<int>(std::lround(height[static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(j)] / grid.spacing[1]));
            if (rows == 0) {
                ++j;
                continue;
            }
            for (int x = left(i); x <= left(i + 1); ++x) dot(x, top(j)), dot(x, top(j + rows));
            for (int y = top(j + rows); y <= top(j); ++y) dot(left(i), y), dot(left(i + 1), y);
            j += rows;
        }
}

}  // namespace

Canvas draw_2d(const View& view) {
    const Plane plane(view.frame.grid, view.size);
    Canvas canvas(plane.width, plane.height);
    if (view.field == "water" && view.frame.particles.count("markers") == 0) {
        draw_below_line(view, plane, canvas);
    } else if (view.field == "water" || marker_field(view.frame, view.field)) {
        const Splats splats(view, plane);
        for (int y = 0; y < plane.height; ++y)
            for (int x = 0; x < plane.width; ++x)
                canvas.at(x, y) =
                    splats.colour(static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x));
    } else {
        const FieldColours colours(view);
        parallel_for(0, plane.height, [&](int y) {
            for (int x = 0; x < plane.width; ++x) canvas.at(x, y) = colours(plane.place(x, y));
        });
    }
    if (view.field == "water" && (!view.surface.empty() || view.scene.has("output.surface"))) draw_surface(view, plane, canvas);
    if (view.grid) draw_grid(view, plane, canvas);
    draw_solids(view, plane, canvas);
    return canvas.smaller(oversampling);
}

}  // namespace weir::picture
