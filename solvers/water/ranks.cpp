// Communication of a scene with liquid distributed over several ranks. Each rank owns the planes of cells of its slab and the markers in
// them, and has ghost markers of one plane on each side.
#include "core/error.hpp"
#include "water/solver.hpp"

namespace weir::water {

/// Halo exchange of the velocity: as deep as the motion of the step plus the stencil at the end of a trajectory, and one plane for ghost
/// markers.
template <int D>
void Water<D>::refresh_velocity(real dt) {
    whole_ = !own().distributed();
    if (!own().distributed()) return;
    const auto timed = passes_.time("exchange");
    const int planes = frame_.cells[D - 1];
    real fastest = max_magnitude(state_.u[D - 1]);
    for (const auto& emitter : emitters_) fastest = larger_or_nan(fastest, std::abs(emitter.velocity[D - 1]));
    const real cells = dt * fastest * frame_.inv_h[D - 1];
    reach_ = cells < planes ? std::min(planes, static_cast<int>(std::ceil(cells)) + 3) : planes;
    refresh_faces(state_.u, frame_, reach_);
    fill_solid_ghosts();
}

/// Extends solids into ghost planes as far as liquid moves, with distributed storage.
template <int D>
void Water<D>::fill_solid_ghosts() {
    if (!own().distributed() || !solids_.any() || near_solid_.store().reaches(reach_)) return;
    solids_.fill_ghosts(state_, reach_, [&] {
        for (auto* bytes : {&closed_, &near_solid_}) bytes->store().open(reach_, frame_.periodic(D - 1));
        mark_closed();
    });
}

/// Removes markers beyond open sides; in parallel also migrates markers. Returns how many there were, and how many have left.
template <int D>
std::array<std::int64_t, 2> Water<D>::migrate_markers() {
    if (!own().distributed()) {
        const std::size_t all = markers_.count(), departed = remove_departed(markers_, frame_, state_.sides);
        return {static_cast<std::int64_t>(all), static_cast<std::int64_t>(departed)};
    }
    bool open = false;
    for (int a = 0; a < D; ++a) open = open || state_.sides.open(a, 0) || state_.sides.open(a, 1);
    const auto [mine, left] = markers_.migrate(frame_, open);
    if (!open) return {mine, 0};
    return {sum_of_ranks(own(), mine), sum_of_ranks(own(), left)};
}

/// Checks that one process would make on whole fields after each step.
template <int D>
void Water<D>::check_own() const {
    const auto is_finite = [](const Grid<real, D>& q) {
        const int planes = q.extent()[D - 1], begin = q.own().lower(0), end = q.own().upper(planes);
        const auto plane = static_cast<std::size_t>(q.stride(D - 1));
        auto& most = detail::reduction_scratch(static_cast<std::size_t>(planes));
        for_each_plane(q.extent(), [&](int k) {
            most[static_cast<std::size_t>(k)] = largest_magnitude(q.data() + static_cast<std::size_t>(k) * plane, plane);
        });
        return std::all_of(most.begin() + begin, most.begin() + end, [](real value) { return std::isfinite(value); });
    };
    enum { none, position, pressure, level_set, velocity };
    int broken = none;
    const auto see = [&](bool finite, int what) {
        if (!finite) broken = std::max(broken, what);
    };
    for (int a = 0; a < D; ++a) see(is_finite(state_.u[a]), velocity);
    see(is_finite(state_.p), pressure);
    see(is_finite(surface_.phi), level_set);
    const auto [first, last] = markers_.own(frame_);
    int number = 0;
    markers_.for_each_array([&, begin = first, count = last - first](const std::vector<real>& array) {
        see(std::isfinite(largest_magnitude(array.data() + begin, count)), number++ < D ? position : velocity);
    });
    broken = communicator().largest(broken);
    if (broken == none) return;
    const std::string name = broken == position    ? "position"
                             : broken == pressure  ? "pressure"
                             : broken == level_set ? level_set_name
                                                   : "velocity";
    throw NumericalFailure(name, name + " is no longer finite");
}

/// Ghost planes, where the level set is valid since redistance(); or the planes and markers of all ranks where whole fields are read.
template <int D>
void Water<D>::synchronize() {
    if (whole_) return;
    if (own().distributed_storage()) {
        std::vector<Planes> all{planes_of(state_.p)};
        for (int a = 0; a < D; ++a) all.push_back(planes_of(state_.u[a]));
        communicator().refresh(own().partition(), all, 2, frame_.periodic(D - 1));
    } else {
        for (int a = 0; a < D; ++a) gather(state_.u[a]);
        gather(state_.p);
        surface_.gather_whole();
        markers_.gather(frame_, all_markers_);
    }
    whole_ = true;
}

#define WEIR_INSTANTIATE(D)                                           \
    template void Water<D>::refresh_velocity(real);                   \
    template std::array<std::int64_t, 2> Water<D>::migrate_markers(); \
    template void Water<D>::check_own() const;                        \
    template void Water<D>::synchronize();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
