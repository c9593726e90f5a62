#include "waves/sheet.hpp"

namespace weir::waves {

Box::Box(const scene::Scene& scene) : dim(scene.dim()) {
    const auto& n = scene.root().numbers("grid.cells");
    const auto& size = scene.root().numbers("grid.size");
    const auto& lower = scene.root().numbers("grid.origin");
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
        cells[a] = static_cast<int>(n[a]);
        spacing[a] = size[a] / n[a];
        origin[a] = lower[a];
    }
}

Partition partition_of_box(const Box& box, int ranks) {
    const int planes = box.dim == 3 ? box.nz() : box.ny();
    return planes >= ranks ? equal_partition(planes, ranks) : Partition{};
}

bool holds_own_planes(const scene::Scene&, const Partition& cut) { return !cut.empty() && !communicator().holds_whole(); }

Box::Box(const scene::Scene& scene, const Partition& planes) : Box(scene) {
    own = OwnPlanes(slab_of(planes, holds_own_planes(scene, planes) ? 1 : 0));
}

Sheet::Sheet(const Box& box, const Wanted& wanted) : height(box.of_sheet()) {
    if (wanted.sideways) {
        moved_x = Values(box.of_sheet());
        jacobian = Values(box.of_sheet(), 1);
        if (box.dim == 3) moved_z = Values(box.of_sheet());
    }
    if (wanted.velocity)
        for (int a = 0; a < box.dim; ++a) velocity[static_cast<std::size_t>(a)] = Values(box.of_sheet());
}

std::size_t Sheet::bytes() const {
    std::size_t total = height.bytes() + moved_x.bytes() + moved_z.bytes() + jacobian.bytes();
    for (const Values& v : velocity) total += v.bytes();
    return total;
}

}  // namespace weir::waves
