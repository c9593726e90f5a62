// Distributed surface reconstruction. Each rank samples the lattice on its own planes, from the particles read there or from its planes of
// the grid, contours its own layers and postprocesses their points.
#include "parallel/load_balance.hpp"
#include "parallel/ownership.hpp"
#include "surfaces/reconstruction.hpp"

#include <algorithm>
#include <cmath>

namespace weir::surfaces {

/// The partition of the grid; for a grid stored whole on all ranks, equal numbers of planes.
void Reconstruction::cut_by_planes(const FieldSet& fields) {
    const auto axis = static_cast<std::size_t>(samples_.slowest());
    const int planes = samples_.n[axis];
    if (!fields.cut) {
        cut_ = equal_partition(planes, communicator().ranks());
        return;
    }
    const Partition& grid = *fields.cut;
    cut_.at = {0};
    for (int rank = 1; rank < grid.ranks(); ++rank) {
        const real x = fields.grid.origin[axis] + fields.grid.spacing[axis] * grid.begin(rank);
        const bool of_cells = options_.method == Method::level_set;  // sample k is the centre of cell k - 1
        const real plane = of_cells ? grid.begin(rank) + 1 : std::floor((x - samples_.first[axis]) / samples_.spacing[axis]);
        cut_.at.push_back(static_cast<int>(std::clamp(plane, 0.0, real(planes))));
    }
    cut_.at.push_back(planes);
}

/// A partition with equal numbers of particles.
void Reconstruction::cut_by_particles(const Components& position) {
    const auto axis = static_cast<std::size_t>(samples_.slowest());
    const int planes = samples_.n[axis], ranks = communicator().ranks();
    std::vector<std::int64_t> own(static_cast<std::size_t>(planes), 0), work = own;
    for (const real x : position[axis]) ++own[samples_.between(axis, x).low];
    const std::vector<std::int64_t> all = of_all_ranks(own);
    for (std::size_t i = 0; i < all.size(); ++i) work[i % work.size()] += all[i];
    cut_ = planes < ranks ? equal_partition(planes, ranks) : load_balanced_partition(work, ranks);
}

/// Sends particles to the ranks that read their cells or the cells of their images.
void Reconstruction::share_particles(const Components& position) {
    const auto axis = static_cast<std::size_t>(samples_.slowest());
    std::vector<std::vector<int>> readers;  // per plane of cells
    for (int rank = 0; rank < cut_.ranks(); ++rank) {
        const PlaneRange read = field_.cells_read(samples_, {cut_.begin(rank), cut_.end(rank, samples_.n[axis])});
        readers.resize(std::max(readers.size(), static_cast<std::size_t>(read.end)));
        for (int plane = read.begin; plane < read.end; ++plane) readers[static_cast<std::size_t>(plane)].push_back(rank);
    }
    const auto of_place = [&](real x) -> std::span<const int> {
        const auto plane = static_cast<std::size_t>(field_.cell_plane(x));
        return plane < readers.size() ? std::span<const int>(readers[plane]) : std::span<const int>();
    };
    received_ = receive_particles(position, velocity_, domain_, axis, band(), of_place);
    const auto views = [](const std::array<std::vector<real>, 3>& lists, std::size_t count) {
        return Components(lists.begin(), lists.begin() + static_cast<std::ptrdiff_t>(count));
    };
    gather(views(received_.x, position.size()), domain_, band(), cloud_);
    for (auto& list : received_.x) std::vector<real>().swap(list);
    velocity_ = views(received_.v, velocity_.size());
}

/// A cell field, on own planes and on the ghost planes that are read.
PlaneStore<real> Reconstruction::with_planes_beside(const FieldSet& fields, const FieldView& field) const {
    constexpr int ghost_planes = 2;
    const auto axis = static_cast<std::size_t>(samples_.slowest());
    const int rank = communicator().rank(), planes = fields.grid.cells[axis], begin = fields.cut->begin(rank);
    const std::size_t plane = field.data[0].size() / static_cast<std::size_t>(planes), first = plane * static_cast<std::size_t>(begin);
    PlaneStore<real> known(slab_of(*fields.cut, ghost_planes), 0, plane, planes, 0, 0.0);
    std::copy_n(field.data[0].data() + first, plane * static_cast<std::size_t>(fields.cut->end(rank, planes) - begin),
                known.data() + first);
    communicator().refresh(*fields.cut, {known.data(), plane * sizeof(real), planes, 0, known.held()}, ghost_planes, false);
    return known;
}

/// The velocity at points that smoothing has moved beyond the subdomain boundary is computed by the owner.
void Reconstruction::add_velocity_elsewhere(const std::function<Vec<3>(const Vec<3>&)>& velocity_at) {
    struct Asked {
        Vec<3> x;
        std::size_t point;
        int rank;
    };
    ListsOfRanks<Asked> asked(static_cast<std::size_t>(cut_.ranks())), answered = asked;
    for (std::size_t at = piece_.begin; at < piece_.end; ++at) {
        const Vec<3>& x = mesh_.points[at];
        if (samples_.is_near(x)) continue;
        asked[static_cast<std::size_t>(owner_of(cut_, samples_.layer_of(x)))].push_back({x, at, communicator().rank()});
    }
    for (const auto& list : exchange_lists(std::move(asked)))
        for (const Asked& one : list) answered[static_cast<std::size_t>(one.rank)].push_back({velocity_at(one.x), one.point, one.rank});
    for (const auto& list : exchange_lists(std::move(answered)))
        for (const Asked& one : list) mesh_.velocity[one.point] = one.x;
}

/// Removes adjacent layers; corners and ends become global point indices.
void Reconstruction::keep_own_part() {
    mesh_.first = begins_of_ranks(piece_.points())[static_cast<std::size_t>(communicator().rank())];
    const auto keep = [](auto& list, std::size_t begin, std::size_t end) {
        if (list.empty()) return;
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(end), list.end());
        list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(begin));
    };
    for (auto* list : {&mesh_.points, &mesh_.normals, &mesh_.velocity}) keep(*list, piece_.begin, piece_.end);
    keep(mesh_.thickness, piece_.begin, piece_.end);
    keep(mesh_.corners, piece_.cells_begin, piece_.cells_end), keep(mesh_.lines, piece_.cells_begin, piece_.cells_end);
    const int further = static_cast<int>(mesh_.first) - static_cast<int>(piece_.begin);
    const auto renumber = [&](auto& list) {
        for (auto& cell : list)
            for (int& point : cell) point += further;
    };
    renumber(mesh_.corners), renumber(mesh_.lines);
}

}  // namespace weir::surfaces
