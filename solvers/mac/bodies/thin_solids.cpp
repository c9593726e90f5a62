#include "mac/bodies/thin_solids.hpp"

#include "geometry/shape.hpp"
#include "mac/bodies/solid_faces.hpp"
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
std::vector<std::string> remarks(const scene::Scene& scene) {
    std::vector<std::string> list;
    const Index<D> cells = scene.index<D>("grid.cells");
    const Vec<D> size = scene.vec<D>("grid.size"), origin = scene.has("grid.origin") ? scene.vec<D>("grid.origin") : Vec<D>{};
    Vec<D> h;
    for (int d = 0; d < D; ++d) h[d] = size[d] / cells[d];
    const real h_max = *std::max_element(h.begin(), h.end());
    const auto& tables = scene.root().tables("solids");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const Deepest<D> deepest = deepest_point<D>(*geometry::make_shape<D>(tables[i]), origin, cells, h);
        const real thick = -2 * deepest.distance / h_max;  // [cells]
        if (!(thick > 0) || thick >= aligned_cells * (1 - 1e-6)) continue;
        std::string needed = "[";
        for (int d = 0; d < D; ++d)
            needed += (d ? ", " : "") + std::to_string(static_cast<int>(std::ceil(cells[d] * resolved_cells / thick - 1e-6)));
        list.push_back("solids[" + std::to_string(i) + "] is " + scene::number_text(std::round(100 * thick) / 100) +
                       " cells thick at most: it blocks flow, but its surfaces are displaced by up to one cell; from " +
                       scene::number_text(resolved_cells) + " cells on they are exact: grid.cells = " + needed + "]");
    }
    return list;
}

}  // namespace

std::vector<std::string> remarks_on_thin_solids(const scene::Scene& scene) {
    if (!scene.has("solids") || !scene.has("grid.cells") || !scene.has("grid.size")) return {};
    const std::string solver = scene.solver();
    if (solver != "mac" && solver != "mac_water" && solver != "tallcell") return {};
    return scene.dim() == 2 ? remarks<2>(scene) : remarks<3>(scene);
}

}  // namespace weir::mac
