#include "sim/solid_cells.hpp"

#include "core/grid.hpp"
#include "rigid/bodies.hpp"

#include <memory>

namespace weir::sim {

namespace {

template <int D>
auto marker(const scene::Scene& scene) {
    const auto shown = std::make_shared<rigid::ShownSolids<D>>(scene, false);
    return [shown](const FieldSet& fields, real t) {
        const GridView& grid = fields.grid;
        const geometry::Solids<D>& solids = shown->at(t, [&](const char* field, std::size_t component, std::size_t body) {
            return fields.find(rigid::body_set_name, field)->data[component][body];
        });
        Index<D> cells;
        for (int a = 0; a < D; ++a) cells[a] = grid.cells[static_cast<std::size_t>(a)];
        Grid<std::uint8_t, D> inside(cells);
        for_each_cell(cells, [&](const Index<D>& I) {
            Vec<D> x;
            for (int a = 0; a < D; ++a) {
                const auto at = static_cast<std::size_t>(a);
                x[a] = grid.origin[at] + grid.spacing[at] * (I[a] + 0.5);
            }
            inside(I) = solids.distance(x) < 0;
        });
        return std::vector<std::uint8_t>(inside.values().begin(), inside.values().end());
    };
}

}  // namespace

std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t)> solid_cells(const scene::Scene& scene) {
    if (scene.root().tables("solids").empty() && scene.root().tables("bodies").empty()) return {};
    if (scene.dim() == 2) return marker<2>(scene);
    return marker<3>(scene);
}

}  // namespace weir::sim
