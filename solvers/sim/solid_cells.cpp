#include "sim/solid_cells.hpp"

#include "parallel/grid.hpp"
#include "rigid/bodies.hpp"

#include <memory>

namespace weir::sim {

namespace {

template <int D>
auto marker(const scene::Scene& scene) {
    const auto shown = std::make_shared<rigid::ShownSolids<D>>(scene, false);
    return [shown](const FieldSet& fields, real t, std::size_t begin, std::size_t end) {
        const GridView& grid = fields.grid;
        const geometry::Solids<D>& solids = shown->at(t, [&](const char* field, std::size_t component, std::size_t body) {
            return fields.find(rigid::body_set_name, field)->data[component][body];
        });
        Index<D> lo, hi;
        std::size_t plane = 1;
        for (int a = 0; a < D; ++a) {
            lo[a] = 0, hi[a] = grid.cells[static_cast<std::size_t>(a)];
            if (a < D - 1) plane *= static_cast<std::size_t>(hi[a]);
        }
        lo[D - 1] = static_cast<int>(begin / plane), hi[D - 1] = static_cast<int>(end / plane);
        std::vector<std::uint8_t> inside(end - begin);
        for_each_in(lo, replicated(hi), [&](const Index<D>& I) {
            Vec<D> x;
            std::size_t cell = 0, stride = 1;
            for (int a = 0; a < D; ++a) {
                const auto at = static_cast<std::size_t>(a);
                x[a] = grid.origin[at] + grid.spacing[at] * (I[a] + 0.5);
                cell += stride * static_cast<std::size_t>(I[a]);
                stride *= static_cast<std::size_t>(hi[a]);
            }
            inside[cell - begin] = solids.distance(x) < 0;
        });
        return inside;
    };
}

}  // namespace

std::function<std::vector<std::uint8_t>(const FieldSet& fields, real t, std::size_t begin, std::size_t end)> solid_cells(
    const scene::Scene& scene) {
    if (scene.root().tables("solids").empty() && scene.root().tables("bodies").empty()) return {};
    if (scene.dim() == 2) return marker<2>(scene);
    return marker<3>(scene);
}

}  // namespace weir::sim
