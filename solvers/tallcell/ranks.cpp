// Communication of a scene with tall cells distributed over several ranks. Each rank owns the planes of its slab, and in them whole lines
// of columns with their knots and pressure; coarse multigrid levels are replicated (multigrid.hpp).
#include "tallcell/solver.hpp"

namespace weir::tallcell {

Partition partition_of_columns(const scene::Scene& scene, int ranks) {
    if (scene.dim() == 2 || up_axis<3>(gravity_of<3>(scene)) == 2) return {};
    const int lines = scene.index<3>("grid.cells")[2];
    const bool pairs = lines >= 2 * ranks;  // pairs of lines are one line on the next multigrid level: each rank gets at least one pair,
                                            // otherwise work is replicated
    return lines >= ranks && !pairs ? Partition{} : equal_partition(lines, ranks);
}

bool holds_own_planes(const scene::Scene&, const Partition& cut) { return !cut.empty() && !communicator().holds_whole(); }

/// Halo exchange of the velocity, as deep as the motion of the step plus the two samples at the end of a trajectory; runs of one ghost line
/// move too.
template <int D>
void TallCells<D>::refresh_velocity(real dt) {
    whole_ = !own().distributed();
    if (!own().distributed()) return;
    const auto timed = passes_.time("exchange");
    const int planes = frame_.cells[D - 1];
    const real cells = dt * max_magnitude(state_.u[D - 1]) * frame_.inv_h[D - 1];
    reach_ = cells < planes ? std::min(planes, static_cast<int>(std::ceil(cells)) + 3) : planes;
    refresh_faces(state_.u, frame_, reach_);
    solids_.fill_ghosts(state_, reach_);
}

/// The heights of cells, and ghost planes, where the level set is valid since redistance(); or the planes of all ranks where whole fields
/// are read.
template <int D>
void TallCells<D>::synchronize() {
    if (whole_) return;
    pressure_.write_heights(tall_);
    std::vector<Grid<real, D>*> shown{&state_.p, &tall_};
    for (int a = 0; a < D; ++a) shown.push_back(&state_.u[a]);
    if (own().distributed_storage()) {
        std::vector<Planes> all;
        for (auto* grid : shown) all.push_back(planes_of(*grid));
        communicator().refresh(own().partition(), all, 2, frame_.periodic(D - 1));
    } else {
        for (auto* grid : shown) gather(*grid);
        surface_.gather_whole();
    }
    whole_ = true;
}

/// Separate from the other passes, because the compiler's code for these depends on the size of the file.
///
/// f(first, count) for the faces of u along a from row `from` upwards, in contiguous pieces; in parallel for this rank's planes and
/// `beside` ghost planes on each side.
template <int D, class F>
static void for_each_kept(const Grid<real, D>& u, int up, int from, int beside, bool ring, F&& f) {
    Index<D> lo{}, hi = u.extent();
    lo[up] = from;
    const int x = lo[0], count = hi[0] - x;
    hi[0] = x + 1;
    const std::vector<char> near = planes_near(u.own().slab, u.extent()[D - 1], beside, ring);
    const int last = hi[D - 1] - 1;  // around a periodic axis faces there are those of plane 0
    for_each_in(lo, replicated(hi), [&](const Index<D>& I) {
        if (near.empty() || near[static_cast<std::size_t>(I[D - 1])] || (ring && I[D - 1] == last && near[0] && u.store().holds(last)))
            f(u.linear(I), static_cast<std::size_t>(count));
    });
}

template <int D>
void Transport<D>::keep(const MacVelocity<D>& u, int beside) {
    const bool ring = frame_.periodic(D - 1);
    for (int a = 0; a < D; ++a) {
        before_[a].store().open(beside, ring);
        for_each_kept(u[a], up_, kept_from_, beside, ring, [&](std::size_t first, std::size_t count) {
            std::copy(u[a].data() + first, u[a].data() + first + count, before_[a].data() + first);
        });
    }
}

#define WEIR_INSTANTIATE(D)                                \
    template void TallCells<D>::refresh_velocity(real dt); \
    template void TallCells<D>::synchronize();             \
    template void Transport<D>::keep(const MacVelocity<D>&, int);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::tallcell
