// The surface that a scene names for its frames, made once more of the last fields: volume, distance, shape, and whether it is closed.
#include "surfaces/measure.hpp"
#include "surfaces/reconstruction.hpp"
#include "surfaces/triangle.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {

namespace {

using namespace surfaces;

/// Nearer to an edge or a corner of the liquid than this, in spacings, nothing is claimed of distances: a kernel has a radius of two.
constexpr real away_from_edges = 2;

SurfaceMesh mesh_of(const RunRecord& run) {
    const auto maker = reconstruction_of(*run.scene);
    if (!maker) throw BadInput("this metric measures the surface that a scene names in output.surface");
    return maker->make(run.fields, run.time);
}

real spacing_of(const RunRecord& run) { return run.fields.grid.spacing[0]; }

/// Ericson 2005, section 5.1.5.
real distance_to_triangle(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    const Vec<3> ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const real d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d1 <= 0 && d2 <= 0) return norm(ap);
    if (d3 >= 0 && d4 <= d3) return norm(bp);
    if (d6 >= 0 && d5 <= d6) return norm(cp);
    const real vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - (d1 / (d1 - d3)) * ab);
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - (d2 / (d2 - d6)) * ac);
    if (va <= 0 && d4 >= d3 && d5 >= d6) return norm(bp - ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b));
    const real whole = va + vb + vc;
    return norm(ap - (vb / whole) * ab - (vc / whole) * ac);
}

real distance_to_line(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b) {
    const Vec<3> ab = b - a;
    return norm(p - a - std::clamp(dot(p - a, ab) / dot(ab, ab), 0.0, 1.0) * ab);
}

/// The nearest point of a mesh, among the triangles or lines in cells around: farther than a cell is as far as a cell.
class Nearest {
public:
    Nearest(const SurfaceMesh& mesh, const GridView& grid) : mesh_(mesh), grid_(grid) {
        cells_.resize(static_cast<std::size_t>(grid.cells[0]) * static_cast<std::size_t>(grid.cells[1]) *
                      static_cast<std::size_t>(grid.cells[2]));
        for (std::size_t t = 0; t < mesh.corners.size(); ++t)
            cells_[number(cell((corner(mesh, mesh.corners[t], 0) + corner(mesh, mesh.corners[t], 1) + corner(mesh, mesh.corners[t], 2)) /
                               3.0))]
                .push_back(t);
        for (std::size_t l = 0; l < mesh.lines.size(); ++l)
            cells_[number(cell(0.5 * (end(mesh, mesh.lines[l], 0) + end(mesh, mesh.lines[l], 1))))].push_back(l);
    }
    real distance(const Vec<3>& x) const {
        const std::array<int, 3> at = cell(x);
        real nearest = infinity;
        std::array<int, 3> I;
        for (I[2] = at[2] - 2; I[2] <= at[2] + 2; ++I[2])
            for (I[1] = at[1] - 2; I[1] <= at[1] + 2; ++I[1])
                for (I[0] = at[0] - 2; I[0] <= at[0] + 2; ++I[0]) {
                    if (!inside(I)) continue;
                    for (const std::size_t t : cells_[number(I)]) {
                        if (!mesh_.lines.empty()) {
                            nearest = std::min(nearest, distance_to_line(x, end(mesh_, mesh_.lines[t], 0), end(mesh_, mesh_.lines[t], 1)));
                            continue;
                        }
                        const auto& c = mesh_.corners[t];
                        nearest = std::min(nearest, distance_to_triangle(x, corner(mesh_, c, 0), corner(mesh_, c, 1), corner(mesh_, c, 2)));
                    }
                }
        return nearest;
    }

private:
    std::array<int, 3> cell(const Vec<3>& x) const {
        std::array<int, 3> I{};
        for (std::size_t a = 0; a < static_cast<std::size_t>(grid_.dim); ++a)
            I[a] = std::clamp(static_cast<int>(std::floor((x[a] - grid_.origin[a]) / grid_.spacing[a])), 0, grid_.cells[a] - 1);
        return I;
    }
    bool inside(const std::array<int, 3>& I) const {
        for (std::size_t a = 0; a < 3; ++a)
            if (I[a] < 0 || I[a] >= grid_.cells[a]) return false;
        return true;
    }
    std::size_t number(const std::array<int, 3>& I) const {
        return static_cast<std::size_t>(I[0]) +
               static_cast<std::size_t>(grid_.cells[0]) *
                   (static_cast<std::size_t>(I[1]) + static_cast<std::size_t>(grid_.cells[1]) * static_cast<std::size_t>(I[2]));
    }
    const SurfaceMesh& mesh_;
    const GridView& grid_;
    std::vector<std::vector<std::size_t>> cells_;
};

/// Points of the exact surface: centres of cells that it passes, moved onto it along the gradient of the distance.
std::vector<Vec<3>> exact_points(const RunRecord& run, const Reference& ref) {
    const GridView& grid = run.fields.grid;
    const ScalarField& depth = ref.scalar("depth");
    const real h = grid.spacing[0], eps = 1e-4 * h;
    std::vector<Vec<3>> points;
    for (int k = 0; k < grid.cells[2]; ++k)
        for (int j = 0; j < grid.cells[1]; ++j)
            for (int i = 0; i < grid.cells[0]; ++i) {
                Vec<3> x{{grid.origin[0] + h * (i + 0.5), grid.origin[1] + h * (j + 0.5), grid.origin[2] + h * (k + 0.5)}};
                if (grid.dim == 2) x[2] = 0;
                if (std::abs(depth(x, 0)) > h) continue;
                Vec<3> g{};
                for (int a = 0; a < grid.dim; ++a)
                    g[a] = (depth(x + eps * Vec<3>::unit(a), 0) - depth(x - eps * Vec<3>::unit(a), 0)) / (2 * eps);
                points.push_back(x - (depth(x, 0) / std::max(dot(g, g), 1e-6)) * g);
            }
    return points;
}

/// Both ways, in spacings: from the mesh's points to the liquid's surface, and from that to the mesh's triangles.
real hausdorff(const RunRecord& run, const Reference& ref) {
    const SurfaceMesh mesh = mesh_of(run);
    const real h = spacing_of(run);
    const auto counts = [&](const Vec<3>& x) { return ref.scalar("from_edges")(x, 0) > away_from_edges * h; };
    real worst = 0;
    for (const Vec<3>& x : mesh.points)
        if (counts(x)) worst = std::max(worst, std::abs(ref.scalar("depth")(x, 0)));
    const Nearest nearest(mesh, run.fields.grid);
    for (const Vec<3>& x : exact_points(run, ref))
        if (counts(x)) worst = std::max(worst, nearest.distance(x));
    return worst / h;
}

/// Of the upper side of a liquid at rest, away from the walls, in spacings. Its level: twice the mean height of the particles, which are
/// spread evenly from the floor up.
struct Rest {
    real shift = 0, rough = 0;
};
Rest at_rest(const RunRecord& run) {
    const SurfaceMesh mesh = mesh_of(run);
    const GridView& grid = run.fields.grid;
    const auto& y = needed_field(run.fields, particle_set_name, "position").data[1];
    real level = 0;
    for (const real one : y) level += 2 * (one - grid.origin[1]) / static_cast<real>(y.size());
    real sum = 0, squares = 0, count = 0;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const Vec<3>& x = mesh.points[i];
        bool middle = mesh.normals[i][1] > 0.5 && x[1] - grid.origin[1] > 0.5 * level;
        for (const std::size_t a : {std::size_t{0}, std::size_t{2}})
            middle =
                middle && std::min(x[a] - grid.origin[a], grid.origin[a] + grid.spacing[a] * grid.cells[a] - x[a]) > 1.5 * grid.spacing[a];
        if (!middle) continue;
        const real off = (x[1] - grid.origin[1] - level) / grid.spacing[1];
        sum += off, squares += off * off, ++count;
    }
    if (count == 0) return {infinity, infinity};
    return {std::abs(sum / count), std::sqrt(std::max(0.0, squares / count - sum / count * sum / count))};
}

}  // namespace

std::vector<Metric> surface_metrics() {
    return {
        {.name = "surface.volume_error",
         .unit = "",
         .doc = "|volume inside the surface / volume of the liquid - 1|, in 2D of areas.",
         .measure = [](const RunRecord& run, const Reference& ref) { return std::abs(volume(mesh_of(run)) / ref.number("volume") - 1); }},
        {.name = "surface.hausdorff",
         .unit = "",
         .doc =
             "Largest distance between the surface and that of the liquid, both ways, in particle spacings, two of them away from edges.",
         .measure = hausdorff},
        {.name = "surface.open_edges",
         .unit = "",
         .doc = "Edges that are not the side of exactly two triangles; of lines, points that do not end one and begin another.",
         .measure = [](const RunRecord& run, const Reference&) { return static_cast<real>(topology(mesh_of(run)).open_edges); }},
        {.name = "surface.euler",
         .unit = "",
         .doc = "Points - edges + triangles: 2 for a surface without holes, 0 for lines.",
         .quantity = Quantity::value,
         .measure = [](const RunRecord& run, const Reference&) { return static_cast<real>(topology(mesh_of(run)).euler); }},
        {.name = "surface.smallest_triangle",
         .unit = "",
         .doc = "Area of the smallest triangle, in squares of the distance between samples.",
         .quantity = Quantity::value,
         .measure =
             [](const RunRecord& run, const Reference&) {
                 const auto options = options_of(*run.scene);
                 if (!options) throw BadInput("surface.smallest_triangle needs a scene with a reconstructed surface");
                 const real step = options->cell * spacing_of(run);
                 return smallest_triangle(mesh_of(run)) / (step * step);
             }},
        {.name = "surface.shift",
         .unit = "",
         .doc = "|mean height of the surface of a liquid at rest - twice the mean height of its particles|, in spacings.",
         .measure = [](const RunRecord& run, const Reference&) { return at_rest(run).shift; }},
        {.name = "surface.roughness",
         .unit = "",
         .doc = "Root mean square of that height about its mean, in spacings.",
         .measure = [](const RunRecord& run, const Reference&) { return at_rest(run).rough; }},
    };
}

}  // namespace weir::validation
