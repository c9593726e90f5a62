#include "free_surface/extrapolate.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"

#include <cstring>

namespace weir::free_surface {

namespace {
constexpr std::uint8_t queued = 255;
}

/// The neighbour of face I among the faces along a; across a periodic boundary face n is face 0.
template <int D>
bool Extrapolation<D>::step(Index<D>& I, int a, int axis, int by) const {
    const int i = I[axis] + by, n = frame_.cells[axis] + (axis == a ? 1 : 0);
    if (frame_.periodic(axis)) {
        I[axis] = ((i % frame_.cells[axis]) + frame_.cells[axis]) % frame_.cells[axis];
        return true;
    }
    if (i < 0 || i >= n) return false;
    I[axis] = i;
    return true;
}

template <int D>
void Extrapolation<D>::find_band_rows(const LevelSet<D>& surface, int layers) {
    std::fill(band_rows_.begin(), band_rows_.end(), Segment{frame_.cells[0], 0});
    for (std::size_t i = 0; i < surface.layer_end(layers); ++i) {
        Index<D> I = surface.band()[i];
        const int x = I[0];
        I[0] = 0;
        band_rows_[surface.phi.linear(I) / static_cast<std::size_t>(frame_.cells[0])].join({x, x + 1});
    }
}

/// f(i) for the marks 1 within an extent of a row.
template <class F>
static void for_each_mark(const std::uint8_t* row, const Segment& extent, F&& f) {
    for (const std::uint8_t *at = row + extent.begin, *end = row + extent.end;
         (at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)))) != nullptr; ++at)
        f(static_cast<int>(at - row));
}

/// Finds the first layer: unknown faces with a known neighbour. Searches the band's first `layers`, row by row.
template <int D>
void Extrapolation<D>::start_front(Grid<std::uint8_t, D>& mark, int a, const LevelSet<D>& surface, int layers) {
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    const auto start_row = [&](Index<D> I) {
        if (!is_near(I[D - 1])) return;
        // across a periodic boundary face n is face 0: the cell beyond either is that at the other end
        const bool ring = frame_.periodic(a);
        const bool has_above = a == 0 || ring || I[a] < frame_.cells[a], has_below = a == 0 || ring || I[a] > 0;
        const auto row_at = [&](int i) {
            Index<D> J = I;
            if (a > 0) J[a] = ring ? (i + frame_.cells[a]) % frame_.cells[a] : i;
            return surface.phi.linear(J);
        };
        const std::size_t above = has_above ? row_at(I[a]) : 0, below = has_below && a > 0 ? row_at(I[a] - 1) : above;
        Segment extent{frame_.cells[0], 0};
        if (has_above) extent.join(band_rows_[above / n]);
        if (has_below) extent.join(band_rows_[below / n]);
        if (extent.empty()) return;
        if (a == 0) ++extent.end;
        if (a == 0 && ring && (extent.begin == 0 || extent.end > frame_.cells[0])) extent = {0, frame_.cells[0] + 1};
        const std::uint8_t *over = surface.layer().data() + above, *under = surface.layer().data() + below;
        std::uint8_t* face = mark.data() + mark.linear(I);
        std::uint8_t* joins = joins_.data();
        const auto near = [&](const std::uint8_t* of, int i) { return of[i] >= 1 && of[i] <= layers; };
        std::fill(joins + extent.begin, joins + extent.end, std::uint8_t{0});
        const auto see = [&](const std::uint8_t* other, int from, int to) {
            for (int i = from; i < to; ++i) joins[i] = static_cast<std::uint8_t>(joins[i] | (other[i] == 1));
        };
        const int last = mark.extent()[0] - 1;
        see(face - 1, std::max(extent.begin, 1), extent.end);
        see(face + 1, extent.begin, std::min(extent.end, last));
        for (const int end : {0, last}) {  // around a periodic axis
            if (!frame_.periodic(0) || end < extent.begin || end >= extent.end) continue;
            for (const int by : {-1, 1}) {
                Index<D> J = I;
                J[0] = end;
                if (step(J, a, 0, by)) joins[end] = static_cast<std::uint8_t>(joins[end] | (face[J[0]] == 1));
            }
        }
        for (int d = 1; d < D; ++d)
            for (const int by : {-1, 1})
                if (Index<D> J = I; step(J, a, d, by)) see(mark.data() + mark.linear(J), extent.begin, extent.end);
        for (int i = extent.begin; i < extent.end; ++i) {
            const bool wanted = a > 0  ? (has_above && near(over, i)) || (has_below && near(under, i))
                                : ring ? near(over, i % last) || near(over, (i + last - 1) % last)
                                       : (i <= last - 1 && near(over, i)) || (i > 0 && near(over, i - 1));
            joins[i] = static_cast<std::uint8_t>(joins[i] & (face[i] == 0) & wanted);
        }
        for_each_mark(joins, extent, [&](int i) {
            I[0] = i;
            face[i] = queued;
            front_.push_back(I);
        });
    };
    Index<D> I{};
    const Index<D>& extent = mark.extent();
    for (int k = 0; k < (D == 2 ? 1 : extent[D - 1]); ++k)
        for (int j = 0; j < extent[1]; ++j) {
            I[D - 1] = k, I[1] = j;
            start_row(I);
        }
}

template <int D>
void Extrapolation<D>::join_front(Grid<std::uint8_t, D>& mark, int a, const Index<D>& face) {
    if (!is_near(face[D - 1])) return;
    auto& m = mark(face);
    if (m != 0) return;
    for (int axis = 0; axis < D; ++axis)
        for (const int by : {-1, 1}) {
            Index<D> J = face;
            if (!step(J, a, axis, by) || mark(J) != 1) continue;
            m = queued;
            front_.push_back(face);
            return;
        }
}

/// The next front: all unvisited faces beside this one.
template <int D>
void Extrapolation<D>::grow_front(Grid<std::uint8_t, D>& mark, int a) {
    next_.clear();
    for (const Index<D>& I : front_) {
        std::uint8_t* own = &mark(I);
        for (int axis = 0; axis < D; ++axis)
            for (const int by : {-1, 1}) {
                Index<D> J = I;
                J[axis] += by;
                std::uint8_t* other = own + by * mark.stride(axis);
                if (J[axis] <= 0 || J[axis] >= frame_.cells[axis]) {
                    J = I;
                    if (!step(J, a, axis, by)) continue;
                    other = &mark(J);
                }
                if (!is_near(J[D - 1]) || *other != 0) continue;
                *other = queued;
                next_.push_back(J);
            }
    }
    front_.swap(next_);
}

/// The slope of u from the face behind J to J; the next face is extrapolated linearly (Aslam 2004). Linear extrapolation is used up to the
/// second layer, which is as far as cells beside the surface read, and only where the flow is smooth: the smaller of the last two
/// differences (minmod), and at most 0.3 |u|. It implies that liquid arriving there accelerates by u du/dx. In a jet, whose tip is in free
/// flight, the arriving tip would gain that energy. So the slope is limited by the forces on a surface, gravity and tension. No wave
/// reaches that limit (u du/dx = (k a)² g). The front of a dam break does, and loses volume with a limit of a tenth of it.
template <int D>
real Extrapolation<D>::slope(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, Index<D> J, int a, int axis, int by,
                             int layer) const {
    const real here = u(J);
    const auto finished_behind = [&] { return step(J, a, axis, -by) && mark(J) != 0 && mark(J) <= layer; };
    if (layer > 2 || !finished_behind()) return 0;
    const real behind = u(J);
    if (!finished_behind()) return 0;
    return smooth_change(here, behind, u(J), axis);
}

template <int D>
real Extrapolation<D>::smooth_change(real here, real behind, real further, int axis) const {
    const real last = here - behind, before = behind - further;
    if (last * before <= 0) return 0;
    const real speed = std::abs(here), most = std::min(0.3 * speed, steepest_ * frame_.h[axis] / std::max(speed, 1e-300));
    return std::clamp(std::abs(last) < std::abs(before) ? last : before, -most, most);
}

/// Where three faces on either side along an axis are inside the domain, neighbours are read by stride; otherwise by index.
template <int D>
real Extrapolation<D>::value(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, const Grid<real, D>& phi, const Index<D>& I, int a,
                             int layer) const {
    const auto phi_at = [&](const Index<D>& face) { return phi(frame_.near(face, a, -1)) + phi(frame_.near(face, a, 0)); };
    const std::size_t own = mark.linear(I);
    const real *below = &phi(frame_.near(I, a, -1)), *above = &phi(frame_.near(I, a, 0)), here = *below + *above;
    real weights = 0, sum = 0, plain = 0;
    int count = 0;
    for (int axis = 0; axis < D; ++axis) {
        real plain_axis = 0, weights_axis = 0, sum_axis = 0;  // added axis by axis, the two sides as a pair: mirror symmetric
        const bool inner = I[axis] >= 3 && I[axis] + 3 < mark.extent()[axis];
        for (const int by : {-1, 1}) {
            real there, speed, change = 0;
            if (inner) {
                const std::ptrdiff_t next = by * mark.stride(axis), cells = by * phi.stride(axis);
                const std::uint8_t* m = mark.data() + own + next;
                const auto finished = [&](std::ptrdiff_t at) { return m[at] != 0 && m[at] <= layer; };
                if (!finished(0)) continue;
                const real* v = u.data() + own + next;
                there = below[cells] + above[cells], speed = *v;
                if (layer <= 2 && here > there && finished(next) && finished(2 * next))
                    change = smooth_change(v[0], v[next], v[2 * next], axis);
            } else {
                Index<D> J = I;
                if (!step(J, a, axis, by) || mark(J) == 0 || mark(J) > layer) continue;
                there = phi_at(J), speed = u(J);
                change = slope(u, mark, J, a, axis, -by, layer);
            }
            const real w = std::max(0.0, here - there) * frame_.inv_h[axis] * frame_.inv_h[axis];
            weights_axis += w;
            sum_axis += w * (speed + change);
            plain_axis += speed;
            ++count;
        }
        weights += weights_axis;
        sum += sum_axis;
        plain += plain_axis;
    }
    // inside solids, and where φ is flat, ∇φ is meaningless: plain mean of the finished neighbours
    return weights * h_min_ > 1e-9 ? sum / weights : plain / count;
}

/// f(index in the front) for the faces that this rank owns.
template <int D>
template <class F>
void Extrapolation<D>::for_each_own(F&& f) {
    if (!frame_.own().distributed()) return parallel_for(0, static_cast<int>(front_.size()), f);
    own_.clear();
    for (std::size_t i = 0; i < front_.size(); ++i)
        if (frame_.own().contains(front_[i][D - 1])) own_.push_back(static_cast<int>(i));
    parallel_for(0, static_cast<int>(own_.size()), [&](int i) { f(own_[static_cast<std::size_t>(i)]); });
}

/// In parallel, exchanges the marks of known faces: as far as layers reach this rank's planes, plus the stencil of a slope.
template <int D>
void Extrapolation<D>::refresh_marks(FaceMarks<D>& marks, int layers) {
    constexpr int slope_reach = 3;
    const int ghost_planes = layers + slope_reach;
    const bool ring = frame_.periodic(D - 1);
    for (std::size_t last = 0; last < 2; ++last)
        near_of_[last] = planes_near(frame_.own().slab, frame_.cells[D - 1] + static_cast<int>(last), ghost_planes, ring);
    if (!frame_.own().distributed()) return;
    std::array<Planes, D> all;
    for (std::size_t a = 0; a < D; ++a) {
        marks[a].store().open(ghost_planes + 1, ring);
        all[a] = planes_of(marks[a]);
    }
    communicator().refresh(frame_.own().partition(), all, ghost_planes + 1, ring);
}

template <int D>
void Extrapolation<D>::operator()(MacVelocity<D>& u, FaceMarks<D>& marks, const LevelSet<D>& surface, const FaceLists<D>& in_solids,
                                  int layers) {
    const int near = std::min(3, surface.layers()), behind = frame_.periodic(D - 1) ? 4 : 3;  // planes that a slope reads
    refresh_marks(marks, layers);
    refresh_faces(u, frame_, behind);
    find_band_rows(surface, near);
    for (int a = 0; a < D; ++a) {
        auto& mark = marks[static_cast<std::size_t>(a)];
        near_.swap(near_of_[a == D - 1 ? 1 : 0]);
        front_.clear();
        start_front(mark, a, surface, near);
        for (const Index<D>& face : in_solids[static_cast<std::size_t>(a)]) join_front(mark, a, face);
        for (int layer = 1; layer <= layers && (frame_.own().distributed() || !front_.empty()); ++layer) {  // another rank may have a front
            if (layer > 1) refresh(u[a], frame_.periodic(D - 1), layer == 2 ? behind : 1);
            resize_scratch(value_, front_.size());
            for_each_own([&](int i) {
                const auto at = static_cast<std::size_t>(i);
                value_[at] = value(u[a], mark, surface.phi, front_[at], a, layer);
            });
            for (std::size_t i = 0; i < front_.size(); ++i) {
                if (frame_.own().contains(front_[i][D - 1])) u[a](front_[i]) = value_[i];
                mark(front_[i]) = static_cast<std::uint8_t>(layer + 1);
            }
            if (layer < layers) grow_front(mark, a);
        }
        near_.swap(near_of_[a == D - 1 ? 1 : 0]);
    }
}

template <int D>
void still_air(MacVelocity<D>& u, const FaceMarks<D>& known) {
    for (int a = 0; a < D; ++a) {
        const auto& marks = known[static_cast<std::size_t>(a)];
        Index<D> rows = marks.extent();  // ghost planes included: they are read before the next halo exchange
        rows[0] = 1;
        for_each_held(marks, Index<D>{}, rows, [&](const Index<D>& I) {
            if (!u[a].store().holds(I[D - 1])) return;
            const std::uint8_t* mark = &marks(I);
            real* face = &u[a](I);
#pragma omp simd
            for (int i = 0; i < marks.extent()[0]; ++i) face[i] = mark[i] ? face[i] : 0;
        });
    }
}

template void still_air<2>(MacVelocity<2>&, const FaceMarks<2>&);
template void still_air<3>(MacVelocity<3>&, const FaceMarks<3>&);
template class Extrapolation<2>;
template class Extrapolation<3>;

}  // namespace weir::free_surface
