#include "heightfield/plane.hpp"

#include "heightfield/sides.hpp"

namespace weir::heightfield {

bool holds_own_rows(const scene::Scene&, const Partition& cut) { return !cut.empty() && !communicator().holds_whole(); }

HeldPlanes held_rows(const scene::Scene& scene) {
    const Partition cut = partition_of_rows(Plane(scene), communicator().ranks());
    return HeldPlanes(cut, holds_own_rows(scene, cut), rows_beside, Sides(scene)(1, 0).kind == SideKind::periodic);
}

std::vector<PlaneRange> rows_near(const Plane& plane) {
    if (!is_distributed()) return {{0, plane.nz}};
    const std::vector<char> near = planes_near(plane.nz, rows_beside, detail::own_share.ring);
    std::vector<PlaneRange> runs;
    for (int k = 0; k < plane.nz; ++k) {
        if (near[static_cast<std::size_t>(k)] == 0) continue;
        if (runs.empty() || runs.back().end != k) runs.push_back({k, k});
        runs.back().end = k + 1;
    }
    return runs;
}

std::int64_t first_of_ranks(std::int64_t column) {
    if (!is_distributed()) return column;
    std::int64_t first = -1;
    for (const std::int64_t found : of_ranks(column))
        if (found >= 0 && (first < 0 || found < first)) first = found;
    return first;
}

}  // namespace weir::heightfield
