// Two ways to sort particles by cell, on the same cells in the same run: the bitonic network (Batcher 1968), which the report that began
// this work used, and the counting sort of the solvers (kernels/sort.cl). Both end in the same order, which is checked.
#pragma once
#include "backend/device.hpp"
#include "particles/opencl/kernel_text.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>
#include <vector>

namespace weir::bench {

/// Milliseconds by the device's clock.
struct SortTimes {
    double bitonic = 0, counting = 0;
    int launches = 0;  // of the bitonic network
};

inline constexpr const char* sort_text = R"(
/* One column of the network: pairs `apart` from each other, ascending in blocks of `block`. */
__kernel void compare(uint apart, uint block, __global ulong* keys) {
    const uint t = get_global_id(0), i = 2 * apart * (t / apart) + t % apart, j = i + apart;
    const ulong a = keys[i], b = keys[j];
    if ((a > b) == ((i & block) == 0)) {
        keys[i] = b;
        keys[j] = a;
    }
}
/* (cell, particle) as one number; those behind the last particle go to the end. */
__kernel void make_keys(int count, __global const int* cell, __global ulong* keys) {
    const int i = get_global_id(0);
    keys[i] = i < count ? (ulong)cell[i] << 32 | (ulong)i : ULONG_MAX;
}
__kernel void count_members(int count, __global const int* cell, __global int* members) {
    const int i = get_global_id(0);
    if (i < count) atomic_inc(&members[cell[i]]);
}
)";

inline double milliseconds(backend::Device& device) {
    double sum = 0;
    for (const auto& t : device.timings()) sum += 1e3 * t.seconds;
    return sum;
}

inline std::vector<std::uint64_t> by_bitonic(backend::Device& device, const backend::Memory& cell, int count, SortTimes& times) {
    std::size_t size = 2;
    while (size < static_cast<std::size_t>(count)) size *= 2;
    const auto keys = device.alloc(size * 8);
    const std::size_t group = std::min<std::size_t>(128, size / 2);
    device.launch("make_keys", size, group, {count, cell, keys});
    for (std::size_t block = 2; block <= size; block *= 2)
        for (std::size_t apart = block / 2; apart > 0; apart /= 2, ++times.launches)
            device.launch("compare", size / 2, group, {static_cast<unsigned>(apart), static_cast<unsigned>(block), keys});
    times.bitonic = milliseconds(device);
    std::vector<std::uint64_t> sorted(static_cast<std::size_t>(count));
    device.download(sorted.data(), keys, sorted.size() * 8);
    milliseconds(device);
    return sorted;
}

inline std::vector<int> by_counting(backend::Device& device, const backend::Memory& cell, int count, int cells, int group,
                                    SortTimes& times) {
    constexpr int scan_items = 8;  // SCAN_ITEMS of sort.cl
    const auto starts = static_cast<std::size_t>(cells) + 1, local = static_cast<std::size_t>(group),
               items = static_cast<std::size_t>(count);
    const std::size_t blocks = (starts + local * scan_items - 1) / (local * scan_items);
    const auto members = device.alloc(starts * 4), start = device.alloc(starts * 4), sums = device.alloc(blocks * 4);
    const auto order = device.alloc(items * 4);
    device.fill_zero(members, starts * 4);
    device.launch("count_members", items, 128, {count, cell, members});
    device.launch("scan_blocks", blocks * local, local, {cells + 1, members, start, sums});
    if (blocks > 1) {
        device.launch("scan_sums", local, local, {static_cast<int>(blocks), sums});
        device.launch("scan_add", starts, local, {cells + 1, start, sums});
    }
    device.launch("scatter", items, 128, {count, cell, start, members, order});
    device.launch("sort_cells", static_cast<std::size_t>(cells), 128, {cells, start, order});
    times.counting = milliseconds(device);
    std::vector<int> sorted(items);
    device.download(sorted.data(), order, sorted.size() * 4);
    milliseconds(device);
    return sorted;
}

/// Particles eight a cell, in no order. Throws std::logic_error where the two sorts disagree.
inline SortTimes compare_sorts(int device_index, int count) {
    const auto device = backend::open_device(device_index);
    const int cells = count / 8 + 1, group = static_cast<int>(std::min<std::size_t>(256, device->info().group_limit));
    device->compile(particles::program_of({"prelude_opencl.h", "sort.cl"}) + sort_text,
                    "-cl-std=CL1.2 -DWEIR_DIM=3 -DWEIR_KERNEL=1 -DWEIR_GROUP=" + std::to_string(group));
    std::vector<int> cell(static_cast<std::size_t>(count));
    std::mt19937 random(1);
    for (int& c : cell) c = static_cast<int>(random() % static_cast<unsigned>(cells));
    const auto memory = device->alloc(cell.size() * 4);
    device->upload(memory, cell.data(), cell.size() * 4);
    SortTimes best{1e300, 1e300};
    for (int run = 0; run < 3; ++run) {
        SortTimes now;
        const auto keys = by_bitonic(*device, memory, count, now);
        const auto order = by_counting(*device, memory, count, cells, group, now);
        for (std::size_t i = 0; i < keys.size(); ++i)
            if (static_cast<int>(keys[i] & 0xffffffff) != order[i]) throw std::logic_error("the two sorts disagree");
        best = {std::min(best.bitonic, now.bitonic), std::min(best.counting, now.counting), now.launches};
    }
    return best;
}

}  // namespace weir::bench
