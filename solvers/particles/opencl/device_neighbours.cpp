// Sorting by cells, and the neighbour list, on a device.
#include "core/error.hpp"
#include "particles/opencl/device_fluid.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {
constexpr int scan_items = 8;  // SCAN_ITEMS of sort.cl
}  // namespace

template <int D>
void DeviceFluid<D>::find_neighbours(const Memory& positions) {
    if (count() == 0) return;
    if (device_is_old_) upload();
    const CellGrid grid = cover(positions);
    sorted_count_ = count();
    sort(positions, grid);
    run("load_sorted", {count(), stride_, state_params, positions, order, cell_, a, sorted_cell_});
    build_list(grid);
    meet_solids();
}

/// The box of all particles defines the cells, as on the processor's path.
template <int D>
CellGrid DeviceFluid<D>::cover(const Memory& positions) {
    const auto group = static_cast<std::size_t>(group_);
    const std::size_t groups = std::min(device_reduction_groups, (static_cast<std::size_t>(count()) + group - 1) / group);
    device_->launch("range", groups * group, group, {count(), stride_, positions, parts_});
    device_->download(host_parts_.data(), parts_, groups * 2 * D * sizeof(double));
    Box box;
    for (std::size_t axis = 0; axis < D; ++axis) {
        real &lo = box.lo[axis], &hi = box.hi[axis];
        lo = infinity, hi = -infinity;
        for (std::size_t g = 0; g < groups; ++g) {
            lo = std::min(lo, host_parts_[g * 2 * D + 2 * axis]);
            hi = std::max(hi, host_parts_[g * 2 * D + 2 * axis + 1]);
        }
        if (!std::isfinite(lo) || !std::isfinite(hi)) throw NumericalFailure("position", "a particle's position is not finite");
    }
    return host_.domain.frame().cover(box, count(), support_);
}

template <int D>
void DeviceFluid<D>::sort(const Memory& positions, const CellGrid& grid) {
    const int cells = grid.cells[0] * grid.cells[1] * grid.cells[2];
    const auto starts = static_cast<std::size_t>(cells) + 1;
    if (starts > cells_room_) {
        cells_room_ = starts + starts / 4;
        start_ = device_->alloc(cells_room_ * sizeof(int));
        members_ = device_->alloc(cells_room_ * sizeof(int));
    }
    const std::array<double, 4> corner{grid.origin[0], grid.origin[1], grid.origin[2], grid.per_cell};
    const std::array<int, 4> n{grid.cells[0], grid.cells[1], grid.cells[2], 0};
    device_->fill_zero(members_, starts * sizeof(int));
    run("find_cells", {count(), stride_, corner, n, positions, cell_, members_});
    exclusive_sums(cells + 1, members_, start_);
    run("scatter", {count(), cell_, start_, members_, order});
    device_->launch("sort_cells", static_cast<std::size_t>(cells), device_group, {cells, start_, order});
}

template <int D>
void DeviceFluid<D>::exclusive_sums(int count, const Memory& in, const Memory& out) {
    const auto group = static_cast<std::size_t>(group_), entries = static_cast<std::size_t>(count);
    const std::size_t blocks = (entries + group * scan_items - 1) / (group * scan_items);
    if (blocks_.bytes < blocks * sizeof(int)) blocks_ = device_->alloc((blocks + blocks / 4) * sizeof(int));
    device_->launch("scan_blocks", blocks * group, group, {count, in, out, blocks_});
    if (blocks == 1) return;
    device_->launch("scan_sums", group, group, {static_cast<int>(blocks), blocks_});
    device_->launch("scan_add", entries, group, {count, out, blocks_});
}

template <int D>
void DeviceFluid<D>::build_list(const CellGrid& grid) {
    const std::array<double, 4> corner{grid.origin[0], grid.origin[1], grid.origin[2], grid.per_cell};
    const std::array<int, 4> n{grid.cells[0], grid.cells[1], grid.cells[2], 1};
    const auto radius = static_cast<float>(support_);
    for (;;) {
        int needed = 0;
        device_->fill_zero(needed_, sizeof needed);
        run("find_neighbours",
            {count(), stride_, room_, radius * radius, state_params, corner, n, a, sorted_cell_, start_, neighbours, list, needed_});
        device_->download(&needed, needed_, sizeof needed);
        if (needed == 0) return;
        grow_list(needed);
    }
}

template <int D>
void DeviceFluid<D>::grow_list(int needed) {
    const auto room = static_cast<std::size_t>(needed) + static_cast<std::size_t>(needed) / 4;
    const std::size_t bytes = room * static_cast<std::size_t>(stride_) * sizeof(int);
    const auto& info = device_->info();
    if (bytes > info.largest || device_->allocated() - list.bytes + bytes > info.memory)
        throw NumericalFailure("neighbours", "the neighbour list needs " + std::to_string(bytes >> 20) + " MiB, more than " + info.name +
                                                 " has available: too many particles are closer than the support");
    list = {};
    list = device_->alloc(bytes);
    room_ = static_cast<int>(room);
    ++growths_;
}

template void DeviceFluid<2>::find_neighbours(const Memory&);
template void DeviceFluid<3>::find_neighbours(const Memory&);
template void DeviceFluid<2>::exclusive_sums(int, const Memory&, const Memory&);
template void DeviceFluid<3>::exclusive_sums(int, const Memory&, const Memory&);

}  // namespace weir::particles
