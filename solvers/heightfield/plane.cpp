#include "heightfield/plane.hpp"

#include "heightfield/sides.hpp"

namespace weir::heightfield {

bool holds_own_rows(const scene::Scene&, const Partition& cut) { return !cut.empty() && !communicator().holds_whole(); }

Plane::Plane(const scene::Scene& scene, const Partition& rows) : Plane(scene) {
    const bool periodic = Sides(scene)(1, 0).kind == SideKind::periodic;
    own = OwnPlanes(slab_of(rows, holds_own_rows(scene, rows) ? rows_beside : 0, periodic));
}

std::vector<PlaneRange> rows_near(const Plane& plane) {
    if (!plane.own.distributed()) return {{0, plane.nz}};
    const std::vector<char> near = planes_near(plane.own.slab, plane.nz, rows_beside, plane.own.slab->ring());
    std::vector<PlaneRange> runs;
    for (int k = 0; k < plane.nz; ++k) {
        if (near[static_cast<std::size_t>(k)] == 0) continue;
        if (runs.empty() || runs.back().end != k) runs.push_back({k, k});
        runs.back().end = k + 1;
    }
    return runs;
}

std::vector<PlaneRange> rows_stored(const Plane& plane) {
    if (!plane.own.distributed_storage()) return {{0, plane.nz}};
    return rows_near(plane);
}

std::int64_t first_of_ranks(const Plane& plane, std::int64_t column) {
    if (!plane.own.distributed()) return column;
    std::int64_t first = -1;
    for (const std::int64_t found : of_ranks(column))
        if (found >= 0 && (first < 0 || found < first)) first = found;
    return first;
}

}  // namespace weir::heightfield
