#include "sim/solid_cells.hpp"

#include "core/grid.hpp"
#include "geometry/solids.hpp"

#include <memory>

namespace weir::sim {

namespace {

template <int D>
auto marker(const scene::Scene& scene) {
    const auto solids = std::make_shared<geometry::Solids<D>>(scene.root().tables("solids"));
    return [solids](const GridView& grid, real t) {
        solids->set_time(t);
        Index<D> cells;
        for (int a = 0; a < D; ++a) cells[a] = grid.cells[static_cast<std::size_t>(a)];
        Grid<std::uint8_t, D> inside(cells);
        for_each_cell(cells, [&](const Index<D>& I) {
            Vec<D> x;
            for (int a = 0; a < D; ++a) {
                const auto at = static_cast<std::size_t>(a);
                x[a] = grid.origin[at] + grid.spacing[at] * (I[a] + 0.5);
            }
            inside(I) = solids->distance(x) < 0;
        });
        return std::vector<std::uint8_t>(inside.values().begin(), inside.values().end());
    };
}

}  // namespace

std::function<std::vector<std::uint8_t>(const GridView& grid, real t)> solid_cells(const scene::Scene& scene) {
    if (scene.root().tables("solids").empty()) return {};
    if (scene.dim() == 2) return marker<2>(scene);
    return marker<3>(scene);
}

}  // namespace weir::sim
