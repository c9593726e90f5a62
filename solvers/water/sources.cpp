// Sources and sinks of liquid: emitters, open sides; and redistribution of markers.
#include "water/solver.hpp"

namespace weir::water {

namespace {

/// f(I) for I in [lo, hi), serially: lists are filled in a fixed order.
template <int D, class F>
void for_each_serial(const Index<D>& lo, const Index<D>& hi, F&& f) {
    Index<D> I = lo;
    for (int d = 0; d < D; ++d)
        if (hi[d] <= lo[d]) return;
    while (I[D - 1] < hi[D - 1]) {
        f(I);
        for (int d = 0; d < D; ++d) {
            if (++I[d] < hi[d] || d == D - 1) break;
            I[d] = lo[d];
        }
    }
}

/// The half cell that contains a point.
template <int D>
int half_of(const Vec<D>& x, const Vec<D>& centre) {
    int half = 0;
    for (int d = 0; d < D; ++d) half |= (x[d] > centre[d]) << d;
    return half;
}

}  // namespace

/// Adds markers to empty half cells of I, up to `wanted` markers in the cell, with the liquid's velocity.
template <int D>
bool Water<D>::fill_cell(const Index<D>& I, int wanted) {
    const std::size_t cell = surface_.phi.linear(I);
    int occupied = 0, count = markers_.in_cell(cell);
    for (std::size_t p = markers_.begin(cell); p < markers_.end(cell); ++p)
        occupied |= 1 << half_of(markers_.position(p), frame_.centre(I));
    bool added = false;
    for (int sub = 0; sub < Markers<D>::per_cell && count < wanted; ++sub) {
        if (occupied >> sub & 1) continue;
        const Vec<D> x = Markers<D>::jittered(frame_, I, sub, options_.seed + static_cast<std::uint64_t>(steps_) + 1);
        if (solids_.any() && solids_.solids().distance(x) <= 0) continue;
        markers_.add(x, sample(state_.u, Stencil<D>(frame_, x)));
        ++count;
        added = true;
    }
    return added;
}

template <int D>
bool Water<D>::is_free(const Vec<D>& x) const {
    for (int d = 0; d < D; ++d)
        if (x[d] < frame_.origin[d] || x[d] >= frame_.origin[d] + frame_.h[d] * frame_.cells[d]) return false;
    return !solids_.any() || solids_.solids().distance(x) > 0;
}

/// A jittered lattice of half cells moves with the emitter's velocity. Its points become markers as they enter the emitter; when it starts,
/// all points in air inside it do. So the poured volume is area × speed × time, independent of the markers' density and speed. Markers have
/// already moved: the lattice is that at the end of the step, and in the first step points that have left the emitter again count too.
template <int D>
std::int64_t Water<D>::emit(const Emitter<D>& emitter, real dt) {
    std::int64_t emitted = 0;
    const real from = std::max(state_.time, emitter.start), to = std::min(state_.time + dt, emitter.end);
    const real running = to - emitter.start;
    const bool starts = state_.time <= emitter.start;  // this step is the first in which it is open
    // A point lies up to a half cell above its half cell, so the loop starts one cell below the lowest one at a wall.
    for_each_serial(emitter.lo - Index<D>::constant(1), emitter.hi, [&](const Index<D>& I) {
        for (int sub = 0; sub < Markers<D>::per_cell; ++sub) {
            Vec<D> x;
            std::array<std::int64_t, D> k;
            std::uint64_t key = 0;
            for (int d = 0; d < D; ++d) {  // the lattice point whose unjittered position is closest to this half cell
                const real travelled = emitter.velocity[d] * running / (0.5 * frame_.h[d]);
                k[static_cast<std::size_t>(d)] = 2 * I[d] + (sub >> d & 1) - static_cast<std::int64_t>(std::floor(travelled));
                key = key * 0x100000001B3u + static_cast<std::uint64_t>(k[static_cast<std::size_t>(d)]);
            }
            for (int d = 0; d < D; ++d) {
                const real jitter = hashed_random(options_.seed, key, static_cast<std::uint64_t>(d));
                x[d] = frame_.origin[d] + 0.5 * frame_.h[d] * (static_cast<real>(k[static_cast<std::size_t>(d)]) + jitter) +
                       emitter.velocity[d] * running;
            }
            if (!Markers<D>::holds(frame_, frame_.cell_of(x)[D - 1])) continue;
            const Vec<D> earlier = x - (to - from) * emitter.velocity;
            const bool now = emitter.shape->contains(x), before = emitter.shape->contains(earlier) && is_free(earlier);
            const bool enters = now && !before, fills = starts && before && !(surface_.phi(frame_.cell_of(earlier)) < 0);
            if ((enters || fills) && is_free(x)) {
                markers_.add(x, emitter.velocity), emitted += own().contains(frame_.cell_of(x)[D - 1]);
                volume_.add(frame_.cell_of(x), real(1) / Markers<D>::per_cell);
            }
        }
    });
    for_each_serial(emitter.lo, emitter.hi, [&](const Index<D>& I) {
        if (!surface_.phi.store().holds(I[D - 1]) || (!closed_.empty() && !closed_.store().holds(I[D - 1]))) return;
        if (emitter.shape->distance(frame_.centre(I)) < norm(frame_.h) && (closed_.empty() || !closed_(I)))
            surface_.phi(I) = std::min(surface_.phi(I), emitter.shape->distance(frame_.centre(I)));
    });
    return emitted;
}

/// Removes markers beyond open sides; the volume balance decreases by their share, because reseeding changes the number of markers and no
/// marker has a fixed volume. Open emitters add markers.
template <int D>
void Water<D>::apply_sources_and_sinks(real dt) {
    const auto timed = passes_.time("sort markers");
    const auto [all, departed] = migrate_markers();
    if (!keeps_volume_ && departed > 0) volume_target_ *= static_cast<real>(all - departed) / static_cast<real>(all);
    bool emits = false;
    std::int64_t emitted = 0;
    for (const auto& emitter : emitters_)
        if (emitter.works(state_.time, state_.time + dt)) emits = true, emitted += emit(emitter, dt);
    if (emits) volume_target_ += frame_.cell_volume() / Markers<D>::per_cell * static_cast<real>(sum_of_ranks(own(), emitted));
    markers_.sort(frame_);
    if (brush_forcing_) apply_brush_sources();
}

/// Interactive pouring adds a marker to each empty half cell of the brush, so the rate is limited by free space. Draining removes the
/// markers under the brush. Level set and volume balance are updated.
template <int D>
void Water<D>::apply_brush_sources() {
    const auto brush = brush_forcing_->at<D>(state_.time);
    const bool emits = brush.kind == BrushKind::pour;
    if (!emits && brush.kind != BrushKind::drain) return;
    const std::size_t all = markers_.count();
    if (!emits && all == 0) return;
    const real each = emits ? frame_.cell_volume() / Markers<D>::per_cell : volume_target_ / static_cast<real>(all);
    const auto account = [&](const Vec<D>& u, real volume) {
        for (int a = 0; a < D; ++a) brush_forcing_->impulse[a] += state_.rho * volume * u[a];
        brush_forcing_->mass += state_.rho * volume;
        volume_target_ += volume;
    };
    if (emits) {
        for (std::size_t cell = 0; cell < product(frame_.cells); ++cell) {
            const Index<D> I = frame_.index_of(cell);
            const Vec<D> centre = frame_.centre(I);
            if (norm(centre - brush.centre) > brush.radius + norm(frame_.h) || (!closed_.empty() && closed_(I))) continue;
            surface_.phi(I) = std::min(surface_.phi(I), norm(centre - brush.centre) - brush.radius);
            int occupied = 0;
            for (std::size_t p = markers_.begin(cell); p < markers_.end(cell); ++p) occupied |= 1 << half_of(markers_.position(p), centre);
            for (int sub = 0; sub < Markers<D>::per_cell; ++sub) {
                const Vec<D> x = Markers<D>::jittered(frame_, I, sub, options_.seed + static_cast<std::uint64_t>(steps_) + 1);
                if ((occupied >> half_of(x, centre) & 1) || !brush.covers(x) || !is_free(x)) continue;
                markers_.add(x, brush.velocity);
                volume_.add(I, each / frame_.cell_volume());
                account(brush.velocity, each);
            }
        }
    } else {
        markers_.retain([&](std::size_t p) {
            if (!brush.covers(markers_.position(p))) return true;
            Vec<D> u{};
            if (markers_.carries_velocity())
                for (int a = 0; a < D; ++a) u[a] = markers_.v[static_cast<std::size_t>(a)][p];
            volume_.add(frame_.cell_of(markers_.position(p)), -each / frame_.cell_volume());
            account(u, -each);
            return false;
        });
        for_each_cell(frame_.cells, [&](const Index<D>& I) {
            surface_.phi(I) = std::max(surface_.phi(I), brush.radius - norm(frame_.centre(I) - brush.centre));
        });
    }
    if (markers_.count() != all || !emits) markers_.sort(frame_);
}

/// Sets the faces of an emitter's cells: to the velocity of the liquid inside, or to the flux seen by the pressure (emitters.hpp).
template <int D>
void Water<D>::impose_emitters(real dt, real Emitter<D>::Face::*speed) {
    for (const auto& emitter : emitters_) {
        if (!emitter.works(state_.time, state_.time + dt)) continue;
        for (int a = 0; a < D; ++a) {
            auto& known = known_[static_cast<std::size_t>(a)];
            const auto plane = static_cast<std::size_t>(known.stride(D - 1));
            for (const auto& face : emitter.faces[static_cast<std::size_t>(a)]) {
                if (!own().contains(static_cast<int>(face.at / plane))) continue;
                state_.u[a][face.at] = face.*speed;
                known[face.at] = 1;
            }
        }
        sync_periodic(state_.u, state_.sides);
    }
}

/// Sets the velocity of markers inside. With FLIP markers get only differences, and the prescribed change would accumulate.
template <int D>
void Water<D>::carry_emitters_velocity(real dt) {
    for (const auto& emitter : emitters_) {
        if (!emitter.works(state_.time, state_.time + dt)) continue;
        for (const std::size_t cell : emitter.cells) {
            if (!own().contains(frame_.index_of(cell)[D - 1])) continue;
            for (std::size_t p = markers_.begin(cell); p < markers_.end(cell); ++p)
                if (emitter.shape->contains(markers_.position(p)))
                    for (int a = 0; a < D; ++a) markers_.v[static_cast<std::size_t>(a)][p] = emitter.velocity[a];
        }
    }
}

/// Cells without a pressure unknown: inside solids, and those of open emitters.
template <int D>
const Grid<std::uint8_t, D>& Water<D>::not_solved_for(real dt) {
    if (emitters_.empty()) return closed_;
    if (closed_.empty())
        not_solved_for_.fill(0);
    else
        not_solved_for_ = closed_;
    for (const auto& emitter : emitters_)
        if (emitter.works(state_.time, state_.time + dt))
            for (const std::size_t cell : emitter.cells)
                if (not_solved_for_.store().holds(frame_.index_of(cell)[D - 1])) not_solved_for_[cell] = 1;
    return not_solved_for_;
}

/// Reseeding, every few steps: cells deep in the liquid with fewer than half of the markers get new ones in their empty half cells; cells
/// with more than three times as many lose the last ones. The volume balance does not change: the level set defines the volume.
template <int D>
void Water<D>::redistribute_markers() {
    constexpr int every = 4, few = Markers<D>::per_cell / 2, many = 3 * Markers<D>::per_cell;
    if (!options_.reseed || steps_ % every != 0) return;
    const auto timed = passes_.time("redistribute markers");
    const real deep = -1.5 * frame_.h_max();
    bool changed = false, heaps = false;
    const auto row = static_cast<std::size_t>(frame_.cells[0]);
    const std::size_t cells = product(frame_.cells);
    for (std::size_t cell = 0; cell < cells; ++cell) {
        if (cell % row == 0 && !Markers<D>::holds(frame_, frame_.index_of(cell)[D - 1])) {
            cell += row - 1;
            continue;
        }
        const int count = markers_.in_cell(cell);
        heaps |= count > many;
        const bool bare = count == 0 && surface_.phi[cell] < -0.3 * frame_.h_min();  // liquid without markers
        if (count >= few || (surface_.phi[cell] > deep && !bare) || (!closed_.empty() && closed_[cell])) continue;
        const Index<D> I = frame_.index_of(cell);
        const std::size_t before = markers_.count();
        changed |= fill_cell(I, few);
        if (own().contains(I[D - 1])) reseeded_ += static_cast<std::int64_t>(markers_.count() - before);
    }
    if (changed) markers_.sort(frame_);
    if (!heaps) return;
    std::size_t cell = 0, first = 0, end = 0;  // of the cell's markers
    markers_.retain([&](std::size_t p) {
        if (p >= end) cell = markers_.cell_with(p), first = markers_.begin(cell), end = markers_.end(cell);
        return p < first + many;
    });
    markers_.sort(frame_);
}

#define WEIR_INSTANTIATE(D)                                                  \
    template void Water<D>::apply_sources_and_sinks(real);                   \
    template void Water<D>::impose_emitters(real, real Emitter<D>::Face::*); \
    template void Water<D>::carry_emitters_velocity(real);                   \
    template const Grid<std::uint8_t, D>& Water<D>::not_solved_for(real);    \
    template bool Water<D>::is_free(const Vec<D>&) const;                    \
    template void Water<D>::redistribute_markers();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
