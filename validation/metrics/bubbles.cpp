// Bubbles and drops of solvers that show liquid fractions: how round they are, and how they swing between long and high.
#include "validation/harness/fitting.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace weir::validation {
namespace {

/// Length of the zero contour of a level set, and the area that it encloses.
struct Outline {
    real length = 0, area = 0;
    /// A segment with the negative side on its left.
    void add(const Vec<2>& a, const Vec<2>& b) {
        length += norm(b - a);
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    }
};

/// Marching squares: adds the segment in the square whose corners, in order around it, are x with values phi; the saddle as two segments.
void add_square(const std::array<Vec<2>, 4>& x, const std::array<real, 4>& phi, Outline& outline) {
    std::vector<Vec<2>> leaving, entering;  // where the way around the square leaves the negative side, and enters it
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t j = (i + 1) % 4;
        if ((phi[i] < 0) == (phi[j] < 0)) continue;
        const Vec<2> at = x[i] + phi[i] / (phi[i] - phi[j]) * (x[j] - x[i]);
        (phi[i] < 0 ? leaving : entering).push_back(at);
    }
    for (std::size_t i = 0; i < leaving.size(); ++i) outline.add(leaving[i], entering[i]);
}

/// Circumference of the circle of the same area over the length of the outline (Hysing et al. 2009, eq. 7); 1 for a circle.
real circularity(const FieldSet& fields, const scene::Scene&, real) {
    const FieldView& phi = needed_field(fields, "", "level_set");
    const GridView& g = fields.grid;
    if (g.dim != 2) throw BadInput("bubble.least_circularity is defined in two dimensions");
    Outline outline;
    for (int j = 0; j + 1 < g.cells[1]; ++j)
        for (int i = 0; i + 1 < g.cells[0]; ++i) {
            std::array<Vec<2>, 4> x;
            std::array<real, 4> at;
            for (std::size_t k = 0; k < 4; ++k) {
                const int p = i + (k == 1 || k == 2 ? 1 : 0), q = j + (k >= 2 ? 1 : 0);
                x[k] = {{g.spacing[0] * p, g.spacing[1] * q}};
                at[k] = value_at(phi, g, 0, {p, q, 0});
            }
            add_square(x, at, outline);
        }
    return 2 * std::sqrt(pi * std::abs(outline.area)) / outline.length;
}

/// ∫ f (x² − mean of y² and z²) dV about the middle of the domain [m^(D+2)]: of a cube it is 0, so that of the gas is its negative.
real quadrupole(const FieldSet& fields, const scene::Scene&, real) {
    const FieldView& f = needed_field(fields, "", "fraction");
    const Vec<3> centre = middle(fields.grid);
    real sum = 0;
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) {
        const Vec<3> d = x - centre;
        const real across = fields.grid.dim == 2 ? d[1] * d[1] : 0.5 * (d[1] * d[1] + d[2] * d[2]);
        sum += f.data[0][i] * (d[0] * d[0] - across);
    });
    return sum * cell_volume(fields.grid);
}

/// Lower end and inner width of the neck of a bottle that stands on its head: the first solid, boxes without boxes, the last of which is
/// the neck's inside.
struct Neck {
    real mouth = infinity, width = 0;  // [m]
    explicit Neck(const scene::Scene& scene) {
        const scene::Table& bottle = scene.root().tables("solids").at(0);
        for (const auto& box : bottle.table("from").tables("of")) mouth = std::min(mouth, box.numbers("min").at(1));
        const scene::Table& inside = bottle.tables("minus").back();
        width = inside.numbers("max").at(0) - inside.numbers("min").at(0);
    }
};

/// Liquid below the mouth [m^2].
real poured(const FieldSet& fields, const scene::Scene& scene, real) {
    const FieldView& f = needed_field(fields, "", "fraction");
    const Neck neck(scene);
    real sum = 0;
    for_each_sample(fields.grid, -1, [&](const Vec<3>& x, real, std::size_t i) { sum += x[1] < neck.mouth ? f.data[0][i] : 0; });
    return sum * cell_volume(fields.grid);
}

/// The part of a curve from `from` on.
Curve later(const Curve& c, real from) {
    Curve part{.label = c.label, .x = {}, .y = {}};
    for (std::size_t i = 0; i < c.size(); ++i)
        if (c.x[i] >= from) part.x.push_back(c.x[i]), part.y.push_back(c.y[i]);
    return part;
}

/// C of Wallis 1969 (eq. 11.101) for equal fluxes j of liquid out and gas in: sqrt(j_l*) + sqrt(j_g*) = C, j* = j sqrt(rho/(g d (rho_l -
/// rho_g))).
real flooding_constant(const RunRecord& run, const Reference&) {
    const Neck neck(*run.scene);
    const Curve out = later(run.series("bottle.flooding"), 0.5 * run.time);
    const real liquid = run.scene->number("fluid.density"), gas = run.scene->number("gas.density");
    const real g = norm(needed_effect(*run.scene, "gravity").vec<2>("g")), j = slope(out.x, out.y) / neck.width;
    const auto root = [&](real rho) { return std::sqrt(std::max(j, 0.0) * std::sqrt(rho / (g * neck.width * (liquid - gas)))); };
    return root(liquid) + root(gas);
}

/// The figure of an observed metric.
auto over_time(const char* metric, const char* title, const char* y) {
    return [=](const RunRecord& run, const Reference&) {
        Curve c = run.series(metric);
        c.label = "weir";
        return Panel{.title = title, .x = {"t [s]"}, .y = {y}, .curves = {c}};
    };
}

}  // namespace

std::vector<Metric> bubble_metrics() {
    return {
        {.name = "bubble.least_circularity",
         .unit = "",
         .doc = "Over the run, least circumference of the circle of a bubble's area over the length of its outline, the zero contour of "
                "the level set.",
         .quantity = Quantity::value,
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const std::vector<real> all = run.series("bubble.least_circularity").y;
                 return *std::min_element(all.begin(), all.end());
             },
         .figure = over_time("bubble.least_circularity", "Circularity", "circularity"),
         .observe = circularity},
        {.name = "swing.frequency_error",
         .unit = "",
         .doc =
             "Relative error of the frequency at which a drop or a bubble is longer than high, from the zero crossings of its quadrupole.",
         .measure =
             [](const RunRecord& run, const Reference& ref) {
                 return std::abs(frequency(run.series("swing.frequency_error")) / ref.number("frequency") - 1);
             },
         .figure = over_time("swing.frequency_error", "Quadrupole", "[m^(D+2)]"),
         .observe = quadrupole},
        {.name = "bottle.flooding",
         .unit = "",
         .doc = "Flooding constant of Wallis of the neck of a bottle on its head, from the liquid below its mouth over the last half of "
                "the run.",
         .quantity = Quantity::value,
         .measure = flooding_constant,
         .figure = over_time("bottle.flooding", "Liquid out of the bottle", "[m^2]"),
         .observe = poured},
    };
}

}  // namespace weir::validation
