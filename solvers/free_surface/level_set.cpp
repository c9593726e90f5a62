#include "free_surface/level_set.hpp"

#include "core/parallel.hpp"
#include "core/scratch.hpp"
#include "free_surface/marker_lanes.hpp"
#include "parallel/plane_checkpoint.hpp"

#include <cstring>

namespace weir::free_surface {

/// Relative to a cell's width: a marker closer to the surface may be on either side of it.
constexpr real sure_side = 0.1;

template <int D>
LevelSet<D>::LevelSet(const Frame<D>& frame, int reach)
    : phi(frame.cells),
      frame_(frame),
      layers_(reach + 4),
      reach_(reach),
      diagonal_(norm(frame.h)),
      layer_(frame.cells),
      inside_(frame.cells) {
    phi.fill(cap());
    layer_start_.assign(static_cast<std::size_t>(layers_) + 1, 0);
}

/// f(I) for open cells with a closed neighbour, in the order of the grid; also for some cells at the ends of lines without one.
template <int D>
template <class F>
void LevelSet<D>::for_each_open_beside_closed(const std::vector<char>& planes, F&& f) const {
    const Grid<std::uint8_t, D>& closed = closed_;
    const auto n = static_cast<std::size_t>(frame_.cells[0]);
    const auto has_closed = [&](std::size_t line) { return std::memchr(&closed[line], 1, n) != nullptr; };
    for (std::size_t line = 0; line < closed.size(); line += n) {
        std::array<const std::uint8_t*, 2 * D> beside{};  // lines of cells next to this one, and itself
        std::size_t count = 0;
        Index<D> I = frame_.index_of(line);
        if (!planes.empty() && planes[static_cast<std::size_t>(I[D - 1])] == 0) continue;
        if (has_closed(line)) beside[count++] = &closed[line];
        for (int d = 1; d < D; ++d)
            for (const int by : {-1, 1})
                if (Index<D> J = I; frame_.step(J, d, by) && has_closed(closed.linear(J))) beside[count++] = &closed(J);
        for (std::size_t i = 0; count > 0 && i < n; ++i) {
            if (closed[line + i]) continue;
            bool found = i == 0 || i + 1 == n || closed[line + i - 1] || closed[line + i + 1];
            for (std::size_t k = 0; k < count; ++k) found = found || beside[k][i];
            I[0] = static_cast<int>(i);
            if (found) f(I);
        }
    }
}

/// Depth of the extrapolation into solids [cells]: the width of the interpolation stencil.
static constexpr int skin_layers = 3;

template <int D>
void LevelSet<D>::set_closed(const Grid<std::uint8_t, D>& closed, const std::array<std::vector<Index<D>>, D>* faces) {
    const bool distributed = closed.store().windowed();
    uncover(closed);
    closed_ = closed;
    if (distributed) {
        find_near();
        refresh(closed_, frame_.periodic(D - 1), wide() + 1);
    }
    find_skin(planes_near(frame_.own().slab, frame_.cells[D - 1], skin_layers, frame_.periodic(D - 1)));
    if (communicator().several()) share_skin(distributed);
    walls_.find(frame_, closed_, skin_, faces, wide() + 1);
}

/// Cells uncovered by a thin solid get the mean distance of both its sides: extrapolation from the wet side alone would create liquid.
template <int D>
void LevelSet<D>::uncover(const Grid<std::uint8_t, D>& closed) {
    if (!walls_.any()) return;
    const bool ring = frame_.periodic(D - 1);
    refresh(phi, ring, ThinWalls<D>::thickest + 1);
    std::vector<std::pair<std::size_t, real>> left;
    for (const Index<D>& I : skin_)
        if (frame_.own().contains(I[D - 1]) && closed(I) == 0)
            if (const real both = walls_.on_both_sides(closed_, phi, I); both > phi(I)) left.emplace_back(phi.linear(I), both);
    for (const auto& [cell, both] : left) phi[cell] = both;
    refresh(phi, ring, wide());
}

/// The linear fit of the distances at a cell's corners.
template <int D>
void LevelSet<D>::set_open_parts(const SolidPlacement<D>& solids) {
    if (open_part_.empty()) open_part_ = Grid<real, D>(frame_.cells, 1);
    const bool ring = frame_.periodic(D - 1), distributed = closed_.store().windowed();
    if (distributed) open_part_.store().open(wide() + 1, ring);
    for (const CellBox<D>& box : solids.changed())
        for_each_held(open_part_, box.lo, box.hi, [&](const Index<D>& I) {
            if (distributed && (!frame_.own().contains(I[D - 1]) || !solids.holds_corners(I[D - 1]))) return;
            real mean = 0, least = infinity;
            Vec<D> slope{};
            for (unsigned corner = 0; corner < 1U << D; ++corner) {
                Index<D> J = I;
                for (int d = 0; d < D; ++d) J[d] += static_cast<int>(corner >> d & 1U);
                const real distance = solids.corner_distance(J);
                least = std::min(least, distance);
                mean += distance / (1 << D);
                for (int d = 0; d < D; ++d) slope[d] += (corner >> d & 1U ? distance : -distance) / (1 << (D - 1));
            }
            open_part_(I) = least >= 0 ? 1 : fraction_below_plane<D>(-mean, -1.0 * slope);
        });
    if (distributed) refresh(open_part_, ring, wide() + 1);
}

/// Finds skin_: closed cells beside open ones in these planes (empty: all planes), and further layers behind them.
template <int D>
void LevelSet<D>::find_skin(const std::vector<char>& planes) {
    skin_.clear();
    std::size_t first = 0;
    constexpr std::uint8_t mark = 253;
    Grid<std::uint8_t, D>& seen = layer_;  // free for use here: redistance() recomputes it
    const auto add_neighbours = [&](const Index<D>& I) {
        for_each_beside(frame_, I, [&](const Index<D>& J) {
            if (closed_(J) && seen(J) != mark) seen(J) = mark, skin_.push_back(J);
        });
    };
    for_each_open_beside_closed(planes, add_neighbours);
    skin_end_.assign(1, skin_.size());
    for (int layer = 1; layer < skin_layers; ++layer) {
        const std::size_t last = skin_.size();
        for (; first < last; ++first) add_neighbours(Index<D>(skin_[first]));
        skin_end_.push_back(skin_.size());
    }
    for (const Index<D>& J : skin_) seen(J) = 0;
}

/// In parallel all ranks get the whole skin, in the order of one process, from the parts of each rank's planes (with distributed storage,
/// `alone`).
template <int D>
void LevelSet<D>::share_skin(bool distributed) {
    std::vector<std::size_t> rim, near;
    for_each_open_beside_closed(planes_near(frame_.own().slab, frame_.cells[D - 1], 0, false), [&](const Index<D>& I) {
        bool beside = false;
        for_each_beside(frame_, I, [&](const Index<D>& J) { beside = beside || closed_(J); });
        if (beside) rim.push_back(phi.linear(I));
    });
    for (const Index<D>& I : skin_)
        if (frame_.own().contains(I[D - 1])) near.push_back(phi.linear(I));
    std::sort(near.begin(), near.end());
    if (distributed) rim = of_all_ranks(rim), near = of_all_ranks(near);
    skin_of_ranks_.find(frame_, std::move(rim), near, skin_layers, skin_, skin_end_);
}

static constexpr std::uint8_t continued = 254;  // not a layer of the band

/// Layer by layer, each from layers further out: independent of the order of cells.
template <int D>
void LevelSet<D>::continue_into_solids() {
    if (skin_.empty()) return;
    if (frame_.own().distributed()) return skin_of_ranks_.continue_into(phi, skin_);
    for (const Index<D>& I : skin_) layer_(I) = 0;
    std::size_t first = 0;
    for (const std::size_t last : skin_end_) {
        continue_layer(first, last);
        for (; first < last; ++first) layer_(skin_[first]) = continued;
    }
    for (const Index<D>& I : skin_) layer_(I) = 0;
}

/// The mean of the neighbours that are open or in a previous layer.
template <int D>
void LevelSet<D>::continue_layer(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
        real sum = 0;
        int count = 0;
        for (int d = 0; d < D; ++d) {
            real pair = 0;  // the two sides are added first: mirror symmetric
            for (const int by : {-1, 1}) {
                Index<D> J = skin_[i];
                if (!frame_.step(J, d, by) || (closed_(J) && layer_(J) != continued)) continue;
                pair += phi(J);
                ++count;
            }
            sum += pair;
        }
        if (count > 0) phi(skin_[i]) = sum / count;
    }
}

template <int D>
void LevelSet<D>::find_own() {
    if (!frame_.own().distributed()) return;
    own_.clear();
    for (std::size_t i = 0; i < band_.size(); ++i)
        if (frame_.own().contains(band_[i][D - 1])) own_.push_back(static_cast<int>(i));
}

template <int D>
void LevelSet<D>::advect(const MacVelocity<D>& u, real dt, int reach) {
    const real near = (reach_ + 2) * frame_.h_max();  // points beyond cannot reach the surface
    resize_scratch(value_, band_.size());
    find_own();
    refresh(phi, frame_.periodic(D - 1), reach);
    for_each_own(0, band_.size(), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        real& to = value_[static_cast<std::size_t>(i)];
        to = phi(I);
        if (std::abs(to) < near) to = departed(u, I, dt);
    });
    for_each_own(0, band_.size(), [&](int i) { phi(band_[static_cast<std::size_t>(i)]) = value_[static_cast<std::size_t>(i)]; });
    refresh(phi, frame_.periodic(D - 1), reach);  // markers in the first ghost plane read the cells around them and their departure points
}

namespace {

/// Linear interpolation of component a at d [cells] from the centre of cell I, at most half a cell away; both neighbours of I must be
/// inside.
template <int D>
real face_near(const Grid<real, D>& u, int a, const Index<D>& I, const Vec<D>& d) {
    std::array<std::ptrdiff_t, 3> stride{};
    std::array<real, 3> f{};
    const real* at = &u(I);
    for (int axis = 0; axis < D; ++axis) {
        const auto s = static_cast<std::size_t>(axis);
        stride[s] = u.stride(axis);
        f[s] = axis == a ? 0.5 + d[axis] : d[axis] < 0 ? 1 + d[axis] : d[axis];
        if (axis != a && d[axis] < 0) at -= stride[s];
    }
    const auto row = [&](const real* q) { return q[0] + f[0] * (q[1] - q[0]); };
    const auto plane = [&](const real* q) {
        const real lower = row(q);
        return lower + f[1] * (row(q + stride[1]) - lower);
    };
    if constexpr (D == 2) return plane(at);
    const real below = plane(at);
    return below + f[2] * (plane(at + stride[2]) - below);
}

}  // namespace

/// φ at the point where cell I's centre was dt ago. Inside the domain the trace starts at the mean of the cell's faces and stays near them,
/// so no cell search is needed.
template <int D>
real LevelSet<D>::departed(const MacVelocity<D>& u, const Index<D>& I, real dt) const {
    bool inner = true;
    for (int d = 0; d < D; ++d) inner = inner && I[d] >= 2 && I[d] + 2 < frame_.cells[d];
    Vec<D> half, moved;
    for (int a = 0; a < D && inner; ++a) {
        const real* face = &u[a](I);
        half[a] = -0.5 * dt * frame_.inv_h[a] * (0.5 * (face[0] + face[u[a].stride(a)]));
        inner = std::abs(half[a]) <= 0.5;
    }
    for (int a = 0; a < D && inner; ++a) {
        moved[a] = -dt * frame_.inv_h[a] * face_near(u[a], a, I, half);
        inner = std::abs(moved[a]) <= 1;
    }
    if (inner) return sees_walls(I) ? cubic_on_this_side(I, moved) : cubic_near(I, moved);
    const Vec<D> from = trace(u, frame_, frame_.centre(I), -dt, Trace::rk2);
    if (!sees_walls(I)) return cubic(from);
    for (int a = 0; a < D; ++a) {
        moved[a] = (from[a] - frame_.centre(I)[a]) * frame_.inv_h[a];
        if (frame_.periodic(a)) moved[a] -= frame_.cells[a] * std::rint(moved[a] / frame_.cells[a]);
    }
    return cubic_on_this_side(I, moved);
}

/// φ at d [cells] from the centre of cell I beside a thin wall, limited to the range of a stencil of radius two.
template <int D>
real LevelSet<D>::cubic_on_this_side(const Index<D>& I, Vec<D> d) const {
    constexpr int most = Around<D>::most - 1;
    real furthest = 0;
    for (int a = 0; a < D; ++a) {
        d[a] = std::clamp<real>(d[a], -most, most);
        furthest = std::max(furthest, std::abs(d[a]));
    }
    if (furthest == 0) return phi(I);
    Around<D> around;
    walls_.look(closed_, phi, I, furthest > 1 ? most + 1 : 2, around);
    return around.cubic(d);
}

template <int D>
bool LevelSet<D>::look(const Index<D>& I, int reach, Around<D>& to) const {
    if (!sees_walls(I)) return false;
    walls_.look(closed_, phi, I, reach, to);
    return true;
}

template <int D>
real LevelSet<D>::at(const Vec<D>& x) const {
    const Index<D> I = frame_.cell_of(x);
    Around<D> around;
    if (!look(I, 1, around)) return sample_cells(phi, Stencil<D>(frame_, x));
    Vec<D> d = x - frame_.centre(I);
    for (int a = 0; a < D; ++a) d[a] = std::clamp<real>(d[a] * frame_.inv_h[a], -1, 1);
    return around.linear(d);
}

template <int D>
bool LevelSet<D>::passes(const Index<D>& I, int axis, int by) const {
    Index<D> J = I;
    return sees_walls(I) ? walls_.passes(closed_, I, axis, by, J) : frame_.step(J, axis, by);
}

/// φ at d [cells] from the centre of cell I, at most one cell away; two cells on either side of I must be inside. As cubic(), with four
/// samples along x in one vector.
template <int D>
real LevelSet<D>::cubic_near(const Index<D>& I, const Vec<D>& d) const {
    using Quad = simd::Pack<real, 4>;
    std::array<std::array<real, 4>, D> w;
    const real* at = &phi(I);
    for (int axis = 0; axis < D; ++axis) {
        w[static_cast<std::size_t>(axis)] = catmull_rom(d[axis] < 0 ? 1 + d[axis] : d[axis]);
        at -= (d[axis] < 0 ? 2 : 1) * phi.stride(axis);
    }
    const auto plane = [&](const real* q) {
        Quad sum{};
        for (std::size_t j = 0; j < 4; ++j, q += phi.stride(1)) {
            sum += w[1][j] * simd::load<Quad>(q);
        }
        return sum;
    };
    Quad sum;
    if constexpr (D == 2) {
        sum = plane(at);
    } else {
        sum = Quad{};
        for (std::size_t k = 0; k < 4; ++k, at += phi.stride(2)) sum += w[2][k] * plane(at);
    }
    return ((w[0][0] * sum[0] + w[0][1] * sum[1]) + w[0][2] * sum[2]) + w[0][3] * sum[3];
}

/// Catmull–Rom along each axis in turn, at any point.
template <int D>
real LevelSet<D>::cubic(const Vec<D>& x) const {
    std::array<std::array<std::ptrdiff_t, 4>, D> at;
    std::array<std::array<real, 4>, D> w;
    for (int d = 0; d < D; ++d) {
        const auto axis = static_cast<std::size_t>(d);
        const real s = (x[d] - frame_.origin[d]) * frame_.inv_h[d] - 0.5, floor = std::floor(s), f = s - floor;
        for (int k = 0; k < 4; ++k) {
            Index<D> I{};
            I[d] = static_cast<int>(floor);
            at[axis][static_cast<std::size_t>(k)] = phi.stride(d) * frame_.near(I, d, k - 1)[d];
        }
        w[axis] = catmull_rom(f);
    }
    const auto plane = [&](const real* base) {
        real sum = 0;
        for (std::size_t j = 0; j < 4; ++j) {
            const real* row = base + at[1][j];
            sum += w[1][j] * (w[0][0] * row[at[0][0]] + w[0][1] * row[at[0][1]] + w[0][2] * row[at[0][2]] + w[0][3] * row[at[0][3]]);
        }
        return sum;
    };
    if constexpr (D == 2) {
        return plane(phi.data());
    } else {
        real sum = 0;
        for (std::size_t k = 0; k < 4; ++k) sum += w[2][k] * plane(phi.data() + at[2][k]);
        return sum;
    }
}

template <int D>
std::size_t LevelSet<D>::correct_with_particles(const Markers<D>& markers, const Grid<real, D>* part) {
    const real h = frame_.h_min();
    const real radius = (D == 2 ? 0.28 : 0.31) * h;  // sphere of a marker's volume: (V_marker / V_unit sphere)^(1/D) at 2^D per cell
    const real margin = sure_side * h;               // Enright et al. 2002: closer to the surface the side is uncertain
    refill_scratch<std::uint8_t>(escaped_, markers.count(), 0);
    const auto [first, last] = markers.own(frame_);
    const auto find_escaped = [&](const Index<D>& I, std::size_t begin, std::size_t end) {
        if (phi(I) < -diagonal_ || walls_.is_between(I)) return;  // inside a wall a marker has no side
        CellNodes<D> nodes;
        Around<D> around;
        if (look(I, 1, around))
            nodes.look_at(around);
        else
            nodes.look_at(phi, frame_, I);
        for (std::size_t p = begin; p < end; p += marker_lanes) {
            const int count = static_cast<int>(std::min<std::size_t>(marker_lanes, end - p));
            const Hats<D, false> hats(from_centre(frame_, I, load_positions(markers, p, count)));
            const Lanes distance = nodes.template at<-1>(hats);
            for (int l = 0; l < count; ++l) escaped_[p + static_cast<std::size_t>(l)] = distance[l] > margin;
        }
    };
    markers.for_each_held_cell(frame_, find_escaped);  // the spheres of ghost markers reach this rank's cells
    if (!frame_.cubic()) for_each_escaped([&](std::size_t p) { escaped_[p] = escaped_across(markers.position(p)); });
    std::size_t count = 0;
    for_each_escaped([&, begin = first, end = last](std::size_t p) {
        if (p >= begin && p < end) ++count;
        if (part && (*part)(frame_.cell_of(markers.position(p))) < 0.5 / Markers<D>::per_cell) return;
        join_sphere(markers.position(p), radius);
    });
    return count;
}

/// f(p) for each escaped marker, in order.
template <int D>
template <class F>
void LevelSet<D>::for_each_escaped(F&& f) const {
    const std::uint8_t *first = escaped_.data(), *end = first + escaped_.size();
    for (auto* at = first; at < end; ++at) {
        at = static_cast<const std::uint8_t*>(std::memchr(at, 1, static_cast<std::size_t>(end - at)));
        if (!at) return;
        f(static_cast<std::size_t>(at - first));
    }
}

template <int D>
std::size_t LevelSet<D>::count_airborne(const Markers<D>& markers) const {
    std::size_t count = 0;
    const auto [first, last] = markers.own(frame_);
    for_each_escaped([&, begin = first, end = last](std::size_t p) {
        if (p >= begin && p < end) count += at(markers.position(p)) > 0;
    });
    return count;
}

template <int D>
bool LevelSet<D>::escaped_across(const Vec<D>& x) const {
    return at(x) > sure_side * width_at(frame_.cell_of(x));
}

template <int D>
void LevelSet<D>::join_sphere(const Vec<D>& x, real radius) {
    const Index<D> I = frame_.cell_of(x);
    Around<D> around;
    const bool beside_wall = look(I, 1, around);
    for (int corner = 0; corner < (D == 2 ? 9 : 27); ++corner) {
        Index<D> J = I, unwrapped = I;
        bool inside = !beside_wall || around.reached[static_cast<std::size_t>(corner)] != 0;
        for (int d = 0, rest = corner; d < D; ++d, rest /= 3) {
            const int by = rest % 3 - 1;
            unwrapped[d] += by;
            inside &= by == 0 || frame_.step(J, d, by);
        }
        if (inside) phi(J) = std::min(phi(J), norm(frame_.centre(unwrapped) - x) - radius);
    }
}

template <int D>
void LevelSet<D>::dilate(real shift) {
    parallel_for(0, static_cast<int>(band_.size()), [&](int i) {
        const Index<D>& I = band_[static_cast<std::size_t>(i)];
        if (phi.store().holds(I[D - 1])) phi(I) -= shift;
    });
}

template <int D>
real LevelSet<D>::regain(real missing) {
    const real surface = area();
    if (surface == 0) return 0;
    const real most = 0.02 * frame_.h_min(), shift = std::clamp(missing / surface, -most, most);
    dilate(shift);
    return shift;
}

/// With the layers: the set of cells in the band is part of the state; their order follows from the cells beside the surface.
template <int D>
void LevelSet<D>::save(Checkpoint& to) const {
    put_planes(to, "surface.phi", phi);
    put_planes(to, "surface.layer", layer_);
}

template <int D>
void LevelSet<D>::restore(const Checkpoint& from) {
    get_planes(from, "surface.phi", phi);
    get_planes(from, "surface.layer", layer_);
    find_near();
    refresh(phi, frame_.periodic(D - 1), layers_);
    refresh(layer_, frame_.periodic(D - 1), wide());
    collect_surface();
    const auto plane = static_cast<std::size_t>(layer_.stride(D - 1));
    for (std::size_t i = 0; i < layer_.size(); ++i)
        if (is_near(static_cast<int>(i / plane)) && layer_[i] > 1) layer_[i] = 0;  // join_layers() finds them again
    join_layers();
    find_inside();
}

template <int D>
std::size_t LevelSet<D>::bytes() const {
    return phi.bytes() + layer_.bytes() + inside_.bytes() + closed_.bytes() + skin_of_ranks_.bytes() + walls_.bytes() + open_part_.bytes() +
           (band_.capacity() + skin_.capacity()) * sizeof(Index<D>) + value_.capacity() * sizeof(real) + escaped_.capacity() +
           own_.capacity() * sizeof(int);
}

template class LevelSet<2>;
template class LevelSet<3>;

}  // namespace weir::free_surface
