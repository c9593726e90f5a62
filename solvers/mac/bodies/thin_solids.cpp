#include "mac/bodies/thin_solids.hpp"

#include "geometry/shape.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "rigid/moments.hpp"
#include "scene/names.hpp"

#include <cmath>

namespace weir::mac {

namespace {

template <int D>
struct Deepest {
    Vec<D> x{};
    real distance = infinity;
};

/// Samples a shape's distance on a grid of half cells; from its minimum, descends with decreasing steps.
template <int D>
Deepest<D> deepest_point(const geometry::Shape<D>& shape, const Vec<D>& origin, const Index<D>& cells, const Vec<D>& h) {
    Deepest<D> best;
    const auto see = [&](const Vec<D>& x) {
        const real distance = shape.distance(x);
        const bool better = distance < best.distance;
        if (better) best = {x, distance};
        return better;
    };
    Index<D> points;
    for (int d = 0; d < D; ++d) points[d] = 2 * cells[d] + 1;
    const int most = 64;  // samples along an axis: enough to find thick solids; thin ones are reached by descent from the nearest sample
    Index<D> stride;
    for (int d = 0; d < D; ++d) stride[d] = std::max(1, points[d] / most);
    CellBox<D> box{Index<D>{}, points};
    for (int d = 0; d < D; ++d) box.hi[d] = (points[d] + stride[d] - 1) / stride[d];
    box.in_order([&](const Index<D>& I) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = origin[d] + 0.5 * h[d] * std::min(I[d] * stride[d], 2 * cells[d]);
        see(x);
    });
    const real shortest = 1e-3 * *std::min_element(h.begin(), h.end());
    real length = 0;
    for (int d = 0; d < D; ++d) length = std::max(length, 0.5 * h[d] * stride[d]);
    for (; length > shortest; length *= 0.5) {
        bool moved = true;
        for (int walk = 0; moved && walk < 8; ++walk) {
            moved = false;
            for (int d = 0; d < D; ++d)
                for (const real by : {-length, length}) {
                    Vec<D> x = best.x;
                    x[d] = std::clamp(x[d] + by, origin[d], origin[d] + cells[d] * h[d]);
                    moved = see(x) || moved;
                }
        }
    }
    return best;
}

template <int D>
struct CellsOf {
    Index<D> cells{};
    Vec<D> origin{}, h{};
    real h_max = 0;
    explicit CellsOf(const scene::Scene& scene) : cells(scene.index<D>("grid.cells")) {
        const Vec<D> size = scene.vec<D>("grid.size");
        if (scene.has("grid.origin")) origin = scene.vec<D>("grid.origin");
        for (int d = 0; d < D; ++d) h[d] = size[d] / cells[d];
        h_max = *std::max_element(h.begin(), h.end());
    }
    /// "from 2 cells on SUBJECT: grid.cells = [...]"
    std::string needed(real thick, const std::string& subject) const {
        std::string list;
        for (int d = 0; d < D; ++d)
            list += (d ? ", " : "") + std::to_string(static_cast<int>(std::ceil(cells[d] * resolved_cells / thick - 1e-6)));
        return "from " + scene::number_text(resolved_cells) + " cells on " + subject + ": grid.cells = [" + list + "]";
    }
};

std::string thickness_text(real thick) { return scene::number_text(std::round(100 * thick) / 100) + " cells thick at most"; }

template <int D>
void remark_on_solids(const scene::Scene& scene, const CellsOf<D>& grid, std::vector<std::string>& list) {
    const auto& tables = scene.root().tables("solids");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const Deepest<D> deepest = deepest_point<D>(*geometry::make_shape<D>(tables[i]), grid.origin, grid.cells, grid.h);
        const real thick = -2 * deepest.distance / grid.h_max;  // [cells]
        if (!(thick > 0) || thick >= aligned_cells * (1 - 1e-6)) continue;
        list.push_back("solids[" + std::to_string(i) + "] is " + thickness_text(thick) +
                       ": it blocks flow, but its surfaces are displaced by up to one cell; " + grid.needed(thick, "they are exact"));
    }
}

/// Searches the bounding box of each body.
template <int D>
void remark_on_bodies(const scene::Scene& scene, const CellsOf<D>& grid, std::vector<std::string>& list) {
    constexpr real found = 0.01;  // accuracy of the search [cells]
    const auto& tables = scene.root().tables("bodies");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const geometry::ShapePtr<D> shape = geometry::make_shape<D>(tables[i]);
        real thick = -2 * shape->distance(shape->centre()) / grid.h_max;  // [cells]
        if (thick >= resolved_cells) continue;
        const rigid::Bounds<D> box = rigid::bounds_of<D>(tables[i]);
        Index<D> cells;
        for (int d = 0; d < D; ++d) cells[d] = static_cast<int>(std::ceil((box.max[d] - box.min[d]) / grid.h[d]));
        thick = std::max(thick, -2 * deepest_point<D>(*shape, box.min, cells, grid.h).distance / grid.h_max);
        if (!(thick > 0) || thick >= resolved_cells - found) continue;
        const std::string name = tables[i].has("name") ? " (" + scene::quote(tables[i].text("name")) + ")" : "";
        list.push_back("bodies[" + std::to_string(i) + "]" + name + " is " + thickness_text(thick) +
                       ": its coupling to the fluid is under-resolved, and it may fall through liquid or jitter; " +
                       grid.needed(thick, "it is resolved"));
    }
}

template <int D>
std::vector<std::string> remarks(const scene::Scene& scene, bool couples_bodies) {
    std::vector<std::string> list;
    const CellsOf<D> grid(scene);
    if (scene.has("solids")) remark_on_solids(scene, grid, list);
    if (couples_bodies && scene.has("bodies")) remark_on_bodies(scene, grid, list);
    return list;
}

}  // namespace

std::vector<std::string> remarks_on_thin_solids(const scene::Scene& scene) {
    if (!scene.has("grid.cells") || !scene.has("grid.size")) return {};
    const std::string solver = scene.solver();
    const bool couples_bodies = solver == "mac" || solver == "mac_water" || solver == "two_phase";
    if (!couples_bodies && solver != "tallcell") return {};
    return scene.dim() == 2 ? remarks<2>(scene, couples_bodies) : remarks<3>(scene, couples_bodies);
}

}  // namespace weir::mac
