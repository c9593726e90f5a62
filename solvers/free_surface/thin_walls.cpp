#include "free_surface/thin_walls.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace weir::free_surface {

std::array<real, 4> catmull_rom(real f) {
    return {f * (-0.5 + f * (1 - 0.5 * f)), 1 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2 - 1.5 * f)), f * f * (-0.5 + 0.5 * f)};
}

template <int D>
real Around<D>::cubic(const Vec<D>& d) const {
    std::array<std::array<real, 4>, D> w;
    Index<D> first;
    for (int a = 0; a < D; ++a) {
        first[a] = static_cast<int>(d[a] > 0 ? std::ceil(d[a]) - 1 : std::floor(d[a]));
        w[static_cast<std::size_t>(a)] = catmull_rom(d[a] - first[a]);
        --first[a];
    }
    const auto along = [&](const auto& self, int axis, const real* q) -> real {
        if (axis < 0) return *q;
        real sum = 0;
        for (int k = 0; k < 4; ++k)
            sum += w[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)] * self(self, axis - 1, q + k * stride(axis));
        return sum;
    };
    return along(along, D - 1, &phi[at(first)]);
}

template <int D>
real Around<D>::linear(const Vec<D>& d) const {
    real sum = 0;
    for (int corner = 0; corner < (1 << D); ++corner) {
        Index<D> by{};
        real weight = 1;
        for (int a = 0; a < D; ++a) {
            const bool outer = (corner >> a & 1) != 0;
            weight *= outer ? std::abs(d[a]) : 1 - std::abs(d[a]);
            by[a] = !outer ? 0 : d[a] < 0 ? -1 : 1;
        }
        sum += weight * (*this)(by);
    }
    return sum;
}

template <int D>
void ThinWalls<D>::find(const Frame<D>& frame, const Grid<std::uint8_t, D>& closed, const std::vector<Index<D>>& skin,
                        const std::array<std::vector<Index<D>>, D>* faces, int ghost_planes) {
    frame_ = frame;
    if (marks_.empty()) marks_ = Grid<std::uint8_t, D>(frame.cells);
    const bool ring = frame.periodic(D - 1), distributed = marks_.store().windowed();
    marks_.store().open(ghost_planes, ring);
    if (any_) marks_.fill(0);
    any_ = false;
    // the stencils of this rank's own cells reach walls with both ends within this distance
    const auto near = distributed ? planes_near(frame.own().slab, frame.cells[D - 1], reach_ + thickest - 1, ring) : std::vector<char>();
    const auto is_known = [&](int plane) { return near.empty() || near[static_cast<std::size_t>(plane)] != 0; };
    for (const Index<D>& I : skin) {
        if (!is_known(I[D - 1])) continue;
        for (int axis = 0; axis < D; ++axis)
            for (const int by : {-1, 1})
                if (Index<D> J = I; frame.step(J, axis, -by) && closed(J) == 0) mark_run(closed, I, axis, by);
    }
    for (int a = 0; faces && a < D; ++a)
        for (Index<D> I : (*faces)[static_cast<std::size_t>(a)]) {
            if (I[a] == frame.cells[a]) {
                if (!frame.periodic(a)) continue;
                I[a] = 0;
            }
            Index<D> below = I;
            if (!is_known(I[D - 1]) || !frame.step(below, a, -1) || closed(I) != 0 || closed(below) != 0) continue;
            marks_(I) = static_cast<std::uint8_t>(marks_(I) | (1U << a));
            Index<D> lo = I - Index<D>::constant(reach_), hi = I + Index<D>::constant(reach_);
            --hi[a];
            mark_around(lo, hi);
        }
    if (distributed) refresh(marks_, ring, ghost_planes);
    any_ = sum_of_ranks(frame_.own(), any_) > 0;
}

/// Follows closed cells from the first one inwards: a thin wall, if an open cell follows after a few.
template <int D>
void ThinWalls<D>::mark_run(const Grid<std::uint8_t, D>& closed, const Index<D>& first, int axis, int by) {
    Index<D> I = first;
    int count = 1;
    for (; count <= thickest; ++count) {
        if (!frame_.step(I, axis, by)) return;
        if (closed(I) == 0) break;
    }
    if (count > thickest) return;
    I = first;
    for (int k = 0; k < count; ++k, frame_.step(I, axis, by)) {
        marks_(I) = static_cast<std::uint8_t>(marks_(I) | between);
        mark_around(I - Index<D>::constant(reach_), I + Index<D>::constant(reach_));
    }
}

template <int D>
void ThinWalls<D>::mark_around(const Index<D>& lo, const Index<D>& hi) {
    any_ = true;
    const CellBox<D> box{lo, hi + Index<D>::constant(1)};
    box.in_order([&](Index<D> I) {
        for (int d = 0; d < D; ++d) {
            if (frame_.periodic(d)) I[d] = (I[d] % frame_.cells[d] + frame_.cells[d]) % frame_.cells[d];
            if (I[d] < 0 || I[d] >= frame_.cells[d]) return;
        }
        if (marks_.store().holds(I[D - 1])) marks_(I) = static_cast<std::uint8_t>(marks_(I) | near_wall);
    });
}

template <int D>
real ThinWalls<D>::on_both_sides(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I) const {
    real most = -infinity;
    if (!is_between(I)) return most;
    for (int axis = 0; axis < D; ++axis) {
        std::array<real, 2> end{-infinity, -infinity};
        int cells = 1;
        for (const int by : {-1, 1}) {
            Index<D> J = I;
            for (int k = 0; k < thickest && frame_.step(J, axis, by); ++k, ++cells)
                if (closed(J) == 0) {
                    end[by > 0 ? 1 : 0] = phi(J);
                    break;
                }
        }
        if (cells <= thickest && std::min(end[0], end[1]) > -infinity) most = std::max(most, 0.5 * (end[0] + end[1]));
    }
    return most;
}

template <int D>
bool ThinWalls<D>::passes(const Grid<std::uint8_t, D>& closed, const Index<D>& I, int axis, int by, Index<D>& J) const {
    J = I;
    if (!frame_.step(J, axis, by) || closed(J) != 0) return false;
    return (marks_(by > 0 ? J : I) >> axis & 1) == 0;
}

namespace {

/// One bit for each cell of Around, up to two cells to either side.
__extension__ using Cells = unsigned __int128;

/// The cells of Around with the lowest (side 0) or highest index along an axis.
template <int D>
Cells cells_at_end(const Around<D>& around, int axis, int side) {
    Cells cells = 0;
    for (std::size_t at = 0; at < around.count(); ++at)
        if (static_cast<int>(at) / around.stride(axis) % around.width() == (side == 0 ? 0 : around.width() - 1)) cells |= Cells{1} << at;
    return cells;
}

/// The cells at both ends of each axis, for reach 1 and 2.
template <int D>
const std::array<std::array<Cells, 2>, D>& cells_at_ends(int reach) {
    static const auto all = [] {
        std::array<std::array<std::array<Cells, 2>, D>, 2> ends;
        for (int far = 1; far <= 2; ++far)
            for (int axis = 0; axis < D; ++axis)
                for (int side : {0, 1}) {
                    Around<D> around;
                    around.reach = far;
                    ends[static_cast<std::size_t>(far - 1)][static_cast<std::size_t>(axis)][static_cast<std::size_t>(side)] =
                        cells_at_end(around, axis, side);
                }
        return ends;
    }();
    return all[static_cast<std::size_t>(reach - 1)];
}

}  // namespace

/// The cells connected to the middle through open faces; all cells around I must be inside the domain.
template <int D>
void ThinWalls<D>::flood_inside(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const {
    Cells open = 0, reached = Cells{1} << to.at(Index<D>{});
    std::array<Cells, D> wall{};  // whose lower face along an axis is closed
    const std::uint8_t *cell = &closed(I), *mark = &marks_(I);
    const int r = to.reach, planes = D == 3 ? r : 0;
    std::size_t at = 0;
    for (int k = -planes; k <= planes; ++k)
        for (int j = -r; j <= r; ++j) {
            const std::ptrdiff_t row = j * closed.stride(1) + (D == 3 ? k * closed.stride(D - 1) : 0);
            for (int i = -r; i <= r; ++i, ++at) {
                open |= Cells{cell[row + i] == 0} << at;
                const std::uint8_t m = mark[row + i];
                if (m & 7)
                    for (std::size_t a = 0; a < D; ++a) wall[a] |= Cells{m >> a & 1U} << at;
            }
        }
    const auto& ends = cells_at_ends<D>(r);
    for (Cells before = 0; before != reached;) {
        before = reached;
        for (std::size_t a = 0; a < D; ++a) {
            const int stride = to.stride(static_cast<int>(a));
            reached |= (reached & ~ends[a][1]) << stride & open & ~wall[a];
            reached |= (reached & ~ends[a][0] & ~wall[a]) >> stride & open;
        }
    }
    for (std::size_t i = 0; i < to.count(); ++i) to.reached[i] = (reached >> i & 1) != 0;
}

/// The same for any cell, over the whole range of Around.
template <int D>
void ThinWalls<D>::flood(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const {
    struct Seen {
        Index<D> cell, by;
    };
    std::array<Seen, std::tuple_size_v<decltype(to.phi)>> queue;
    std::fill_n(to.reached.begin(), to.count(), std::uint8_t{0});
    std::size_t count = 0;
    const auto join = [&](const Index<D>& cell, const Index<D>& by) {
        to.reached[to.at(by)] = 1;
        queue[count++] = {cell, by};
    };
    join(I, Index<D>{});
    for (std::size_t i = 0; i < count; ++i)
        for (int axis = 0; axis < D; ++axis)
            for (const int by : {-1, 1}) {
                Index<D> next = queue[i].by, J;
                next[axis] += by;
                if (std::abs(next[axis]) > to.reach || to.reached[to.at(next)] || !passes(closed, queue[i].cell, axis, by, J)) continue;
                join(J, next);
            }
}

template <int D>
void ThinWalls<D>::look(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I, int reach, Around<D>& to) const {
    to.reach = reach;
    bool inside = reach <= 2;
    for (int d = 0; d < D; ++d) inside = inside && I[d] >= reach && I[d] + reach < frame_.cells[d];
    if (inside)
        flood_inside(closed, I, to);
    else
        flood(closed, I, to);
    bool all = true;
    const CellBox<D> box{Index<D>::constant(-reach), Index<D>::constant(reach + 1)};
    std::size_t at = 0;
    box.in_order([&](const Index<D>& by) {
        if (to.reached[at] != 0) {
            Index<D> J = I + by;
            for (int d = 0; d < D; ++d)
                if (!inside && frame_.periodic(d)) J[d] = (J[d] % frame_.cells[d] + frame_.cells[d]) % frame_.cells[d];
            to.phi[at] = phi(J);
        } else {
            all = false;
        }
        ++at;
    });
    if (!all) continue_into(to);
}

/// Layer by layer the mean of the neighbours further out.
template <int D>
void ThinWalls<D>::continue_into(Around<D>& to) const {
    std::array<std::uint8_t, std::tuple_size_v<decltype(to.reached)>> layer;
    std::copy_n(to.reached.begin(), to.count(), layer.begin());
    const CellBox<D> box{Index<D>::constant(-to.reach), Index<D>::constant(to.reach + 1)};
    for (std::uint8_t now = 2, found = 1; found != 0; ++now) {
        found = 0;
        box.in_order([&](const Index<D>& by) {
            const std::size_t at = to.at(by);
            if (layer[at] != 0) return;
            real sum = 0;
            int known = 0;
            for (int axis = 0; axis < D; ++axis) {
                real pair = 0;  // the two sides are added first: mirror symmetric
                for (const int side : {-1, 1}) {
                    if (std::abs(by[axis] + side) > to.reach) continue;
                    const std::size_t other = at + static_cast<std::size_t>(side * to.stride(axis));
                    if (layer[other] != 0 && layer[other] < now) pair += to.phi[other], ++known;
                }
                sum += pair;
            }
            if (known == 0) return;
            to.phi[at] = sum / known;
            layer[at] = now;
            found = 1;
        });
    }
}

template struct Around<2>;
template struct Around<3>;
template class ThinWalls<2>;
template class ThinWalls<3>;

}  // namespace weir::free_surface
