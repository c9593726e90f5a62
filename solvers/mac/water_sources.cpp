// What enters and leaves: emitters, open sides, solids that move; and the repair of the markers' distribution.
#include "mac/water.hpp"

namespace weir::mac {

template <int D>
void Water<D>::place_solids(real t) {
    if (!solids_.any() || (t > 0 && !solids_.moving())) return;
    solids_.place(state_, t);
    for_each_cell(frame_.cells, [&](const Index<D>& I) { closed_(I) = state_.cells(I) == poisson::Cell::solid; });
    surface_.set_closed(closed_);
    mark_near_solids(solids_.solids(), frame_, near_solid_);
}

/// Where a solid closes a face between liquid's side and its own, its velocity stands; between two closed cells the continued velocity
/// of the liquid stands (free slip), or the solid's (no slip).
template <int D>
void Water<D>::set_velocity_in_solids() {
    if (!solids_.any()) return;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        for_each_cell(known_[at].extent(), [&](const Index<D>& I) {
            if (state_.solid.open[at](I) > 0) return;
            const bool inside = closed_(frame_.near(I, a, -1)) && closed_(frame_.near(I, a, 0));
            if (inside && known_[at](I) == 0) return;  // too deep to matter
            if (!inside || solids_.solids()[solids_.solids().nearest(state_.u.face_centre(a, I))].no_slip)
                state_.u[a](I) = state_.solid.velocity[at](I);
        });
    }
}

/// Adds markers to half cells of I that have none, up to `wanted` in the cell; only inside the shape if there is one. With their own
/// velocity, or that of the liquid there.
template <int D>
bool Water<D>::fill_cell(const Index<D>& I, int wanted, const geometry::Shape<D>* inside, const Vec<D>* velocity) {
    const std::size_t cell = surface_.phi.linear(I);
    int occupied = 0, count = markers_.in_cell(cell);
    for (std::size_t p = markers_.begin(cell); p < markers_.end(cell); ++p) {
        int half = 0;
        for (int d = 0; d < D; ++d) half |= (markers_.position(p)[d] > frame_.centre(I)[d]) << d;
        occupied |= 1 << half;
    }
    bool added = false;
    for (int sub = 0; sub < Markers<D>::per_cell && count < wanted; ++sub) {
        if (occupied >> sub & 1) continue;
        const Vec<D> x = Markers<D>::jittered(frame_, I, sub, options_.seed + static_cast<std::uint64_t>(steps_) + 1);
        if (inside && !inside->contains(x)) continue;
        if (solids_.any() && solids_.solids().distance(x) <= 0) continue;
        markers_.add(x, velocity ? *velocity : sample(state_.u, Stencil<D>(frame_, x)));
        ++count;
        added = true;
    }
    return added;
}

/// Markers beyond open sides go; emitters fill their half cells that are empty. The ledger of volume follows the markers.
template <int D>
void Water<D>::pour_and_drain() {
    const auto timed = passes_.time("sort markers");
    volume_target_ -= markers_.volume * static_cast<real>(remove_departed(markers_, frame_, state_.sides));
    markers_.sort(frame_);
    const std::size_t before = markers_.count();
    for (const auto& emitter : emitters_) {
        if (!emitter.works(state_.time)) continue;
        const std::size_t cells = product(frame_.cells);
        for (std::size_t i = 0; i < cells; ++i) {
            const Index<D> I = frame_.index_of(i);
            const real distance = emitter.shape->distance(frame_.centre(I));
            if (distance > norm(frame_.h) || (!closed_.empty() && closed_(I))) continue;
            surface_.phi(I) = std::min(surface_.phi(I), distance);
            fill_cell(I, Markers<D>::per_cell, emitter.shape.get(), &emitter.velocity);
        }
    }
    if (markers_.count() == before) return;
    volume_target_ += markers_.volume * static_cast<real>(markers_.count() - before);
    markers_.sort(frame_);
}

/// Faces inside an emitter move with it.
template <int D>
void Water<D>::impose_emitters() {
    for (const auto& emitter : emitters_) {
        if (!emitter.works(state_.time)) continue;
        for (int a = 0; a < D; ++a)
            for_each_cell(state_.u[a].extent(), [&](const Index<D>& I) {
                if (!emitter.shape->contains(state_.u.face_centre(a, I))) return;
                state_.u[a](I) = emitter.velocity[a];
                known_[static_cast<std::size_t>(a)](I) = 1;
            });
    }
}

/// Every few steps, deep in the liquid: cells with fewer than half of the markers get new ones in their empty half cells, cells with more
/// than three times as many lose the last ones. Neither changes the ledger: the level set says how much liquid there is.
template <int D>
void Water<D>::redistribute_markers() {
    constexpr int every = 4, few = Markers<D>::per_cell / 2, many = 3 * Markers<D>::per_cell;
    if (!options_.reseed || steps_ % every != 0) return;
    const auto timed = passes_.time("redistribute markers");
    const real deep = -1.5 * frame_.h_min();
    bool changed = false, heaps = false;
    const std::size_t cells = product(frame_.cells), before = markers_.count();
    for (std::size_t cell = 0; cell < cells; ++cell) {
        const int count = markers_.in_cell(cell);
        heaps |= count > many;
        if (count >= few || surface_.phi[cell] > deep || (!closed_.empty() && closed_[cell])) continue;
        changed |= fill_cell(frame_.index_of(cell), few, nullptr, nullptr);
    }
    reseeded_ += static_cast<std::int64_t>(markers_.count() - before);
    if (changed) markers_.sort(frame_);
    if (!heaps) return;
    std::size_t cell = 0;
    markers_.retain([&](std::size_t p) {
        while (p >= markers_.end(cell)) ++cell;
        return p < markers_.begin(cell) + many;
    });
    markers_.sort(frame_);
}

#define WEIR_INSTANTIATE(D)                           \
    template void Water<D>::place_solids(real);       \
    template void Water<D>::set_velocity_in_solids(); \
    template void Water<D>::pour_and_drain();         \
    template void Water<D>::impose_emitters();        \
    template void Water<D>::redistribute_markers();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
