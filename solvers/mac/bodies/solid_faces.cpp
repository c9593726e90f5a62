// Placement of solids on the grid: distances at corners, open fractions of faces, and solid cells.
#include "mac/bodies/solid_faces.hpp"

#include "core/parallel.hpp"
#include "mac/bodies/parted_cells.hpp"
#include "mac/grid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;

namespace {

/// Open fraction of the face on the lower side along `a` of cell I, from the distances at its corners.
template <int D, class Distance>
real fraction(const Grid<real, D>& corner, const Distance& distance, const MacVelocity<D>& u, int a, const Index<D>& I) {
    const Index<D> eb = e<D>((a + 1) % D);
    std::array<real, 1 << (D - 1)> at{corner(I), corner(I + eb)};
    if constexpr (D == 3) {
        const Index<D> ec = e<D>((a + 2) % D);
        at[2] = corner(I + eb + ec), at[3] = corner(I + ec);
    }
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = u.origin[d] + u.h[d] * I[d];
    const real open = geometry::open_fraction<D>(distance, at, x, u.h, a);
    return open < least_open_fraction ? 0 : open;
}

/// Open fractions of `count` faces of a row: 1 where all corners are farther from solids than `touching`, 0 elsewhere; velocities are zero.
/// Returns whether all fractions are 1.
template <int D>
bool open_row(const Grid<real, D>& corner, int a, const Index<D>& I, int count, real touching, real* open, real* velocity) {
    std::array<const real*, 1 << (D - 1)> at;
    at[0] = &corner(I), at[1] = &corner(I + e<D>((a + 1) % D));
    if constexpr (D == 3) at[2] = &corner(I + e<D>((a + 2) % D)), at[3] = &corner(I + e<D>((a + 1) % D) + e<D>((a + 2) % D));
    real least = infinity;
#pragma omp simd reduction(min : least)
    for (int i = 0; i < count; ++i) {
        real d = at[0][i] < at[1][i] ? at[0][i] : at[1][i];
        for (std::size_t k = 2; k < at.size(); ++k) d = at[k][i] < d ? at[k][i] : d;
        least = d < least ? d : least;
        open[i] = d > touching ? 1 : 0;
        velocity[i] = 0;
    }
    return least > touching;
}

template <int D>
Index<D> corner_of_cell(Index<D> I, std::size_t corner) {
    for (int d = 0; d < D; ++d) I[d] += static_cast<int>(corner >> d & 1);
    return I;
}

/// f(I, count) for every row along x of a box, in the planes of q that this rank stores, threaded over the slowest axis.
template <class T, int D, class F>
void for_each_held_row(const Grid<T, D>& q, const Index<D>& lo, const Index<D>& hi, F&& f) {
    Index<D> ends = hi;
    ends[0] = lo[0] + 1;
    if (lo[0] < hi[0]) for_each_held(q, lo, ends, [&](const Index<D>& I) { f(I, hi[0] - lo[0]); });
}

}  // namespace

template <int D>
SolidPlacement<D>::SolidPlacement(geometry::Solids<D> solids, MacState<D>& state) : solids_(std::move(solids)) {
    if (!any()) return;
    state.allocate_solids();
    corner_ = Grid<real, D>(state.extent() + Index<D>::constant(1));
    open(state, state.own().distributed() ? state.own().slab->ghost_planes() : 0);
    place(state, 0);
    placed_ = false;  // data derived from the solids have not been updated yet
}

/// Allocates ghost planes. Cells depend on their faces, and faces on their corners: each needs one plane more.
template <int D>
void SolidPlacement<D>::open(MacState<D>& s, int planes) {
    known_ = planes;
    const bool ring = s.sides.periodic(D - 1);
    s.cells.store().open(planes, ring);
    for (std::size_t a = 0; a < D; ++a) s.solid.open[a].store().open(planes + 1, ring), s.solid.velocity[a].store().open(planes + 1, ring);
    corner_.store().open(planes + 2, ring);
}

template <int D>
void SolidPlacement<D>::fill_ghosts(MacState<D>& s, int planes, const std::function<void()>& see) {
    if (!any() || !corner_.store().windowed() || planes <= known_) return;
    const Grid<poisson::Cell, D> before = s.cells;
    std::vector<char> held(static_cast<std::size_t>(s.cells.extent()[D - 1]));
    for (std::size_t k = 0; k < held.size(); ++k) held[k] = s.cells.store().holds(static_cast<int>(k));
    open(s, planes);
    placed_ = false;
    place(s, time_);
    placed_ = false;
    if (see) see();
    for_each_held(s.cells, Index<D>{}, s.cells.extent(), [&](const Index<D>& I) {
        if (held[static_cast<std::size_t>(I[D - 1])]) s.cells(I) = before(I);
    });
}

template <int D>
void SolidPlacement<D>::place(MacState<D>& s, real t) {
    if (!any()) return;
    solids_.set_time(time_ = t);
    find_changed(s);
    for (std::size_t box = 0; box < changed_.size(); ++box) {
        place_corners(s, box);
        place_faces(s, box);
        close_parted_cells(s, box);
        place_cells(s, box);
    }
    extends_ = false;
    if (s.own().distributed() && moving()) rate_ = find_rate(s);
}

/// Signed distances at the corners of a box, as far as they are used. The two ends of a periodic axis get the same bits, so that face
/// fractions agree there.
template <int D>
void SolidPlacement<D>::place_corners(const MacState<D>& s, std::size_t box) {
    solids_.find_near(changed_[box].region(s.u.origin, s.u.h), 2 * norm(s.u.h), near_[box]);
    const real far = 2 * reach(s.u.h, solids_.steepest(near_[box]));
    for_each_held(corner_, changed_[box].lo, changed_[box].hi + Index<D>::constant(1), [&](const Index<D>& I) {
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = s.u.origin[d] + s.u.h[d] * (I[d] == s.u.cells[d] && s.sides.periodic(d) ? 0 : I[d]);
        corner_(I) = solids_.distance(x, near_[box], far);
    });
}

template <int D>
void SolidPlacement<D>::place_faces(MacState<D>& s, std::size_t box) const {
    const Index<D>&lo = changed_[box].lo, hi = changed_[box].hi;
    const real touching = geometry::touching * *std::min_element(s.u.h.begin(), s.u.h.end());
    const auto distance = [&](const Vec<D>& x) { return solids_.distance(x, near_[box]); };
    for (int a = 0; a < D; ++a) {
        auto &open = s.solid.open[static_cast<std::size_t>(a)], &velocity = s.solid.velocity[static_cast<std::size_t>(a)];
        for_each_held_row(open, lo, hi + e<D>(a), [&](Index<D> I, int count) {
            real *w = &open(I), *v = &velocity(I);
            const bool all_open = open_row(corner_, a, I, count, touching, w, v);
            for (int i = 0; !all_open && i < count; ++i, ++I[0]) {
                if (w[i] == 1) continue;
                w[i] = fraction(corner_, distance, s.u, a, I);
                if (w[i] < 1) v[i] = solids_.velocity(s.u.face_centre(a, I), near_[box])[a];
            }
        });
    }
}

/// Closes all faces of cells divided by a thin solid, so that it blocks the flow at any thickness. Free bodies are excluded: each cell that
/// closes would disturb their motion.
template <int D>
void SolidPlacement<D>::close_parted_cells(MacState<D>& s, std::size_t box) const {
    const auto& near = near_[box];
    const auto is_free = [&](std::size_t i) { return solids_[i].free; };
    if (std::all_of(near.begin(), near.end(), is_free)) return;
    const bool mixed = std::any_of(near.begin(), near.end(), is_free);
    const Vec<D>& h = s.u.h;
    const auto distance = [&](const Vec<D>& x) {
        real d = infinity;
        for (const std::size_t i : near)
            if (!solids_[i].free) d = std::min(d, solids_.distance(i, x));
        return d;
    };
    const real steepest = solids_.steepest(near), beside = 0.5 * steepest * *std::max_element(h.begin(), h.end());
    changed_[box].rows([&](Index<D> I, int count) {
        if (!s.solid.open[0].store().holds(I[D - 1])) return;
        std::array<const real*, 1 << D> row;
        for (std::size_t c = 0; c < row.size(); ++c) row[c] = &corner_(corner_of_cell(I, c));
        for (int i = 0; i < count; ++i, ++I[0]) {
            Corners<D> at;
            for (std::size_t c = 0; c < row.size(); ++c) at[c] = row[c][i];
            const auto [least, most] = std::minmax_element(at.begin(), at.end());
            if (*least > beside || *most <= 0) continue;
            Vec<D> x;
            for (int d = 0; d < D; ++d) x[d] = s.u.origin[d] + h[d] * I[d];
            for (std::size_t c = 0; mixed && c < at.size(); ++c) at[c] = distance(corner_of(x, h, c));
            if (is_parted<D>(distance, at, x, h, steepest)) close(s, box, I);
        }
    });
}

template <int D>
void SolidPlacement<D>::close(MacState<D>& s, std::size_t box, const Index<D>& I) const {
    for (int a = 0; a < D; ++a)
        for (const Index<D>& F : {I, I + e<D>(a)}) {
            auto& open = s.solid.open[static_cast<std::size_t>(a)];
            if (!open.store().holds(F[D - 1])) continue;
            open(F) = 0;
            s.solid.velocity[static_cast<std::size_t>(a)](F) = solids_.velocity(s.u.face_centre(a, F), near_[box])[a];
        }
}

template <int D>
void SolidPlacement<D>::place_cells(MacState<D>& s, std::size_t box) const {
    const Index<D>&lo = changed_[box].lo, hi = changed_[box].hi;
    const auto passes = [&](int a, int end) { return s.sides.periodic(a) || s.sides.open(a, end); };
    for_each_held_row(s.cells, lo, hi, [&](const Index<D>& I, int count) {
        std::array<const real*, 2 * D> w;
        for (int a = 0; a < D; ++a) {
            const auto& open = s.solid.open[static_cast<std::size_t>(a)];
            w[static_cast<std::size_t>(2 * a)] = &open(I), w[static_cast<std::size_t>(2 * a + 1)] = &open(I + e<D>(a));
        }
        Cell* cell = &s.cells(I);
        for (int i = 0; i < count; ++i) {
            bool open = false;
            for (int a = 0; a < D; ++a) {
                const int at = a == 0 ? I[0] + i : I[a];
                const bool lower = at > 0 || passes(a, 0), upper = at + 1 < s.u.cells[a] || passes(a, 1);
                open |= (lower && w[static_cast<std::size_t>(2 * a)][i] > 0) || (upper && w[static_cast<std::size_t>(2 * a + 1)][i] > 0);
            }
            cell[i] = open ? Cell::fluid : Cell::solid;
        }
    });
}

/// Cells with a corner in the bounding ball of a solid.
template <int D>
CellBox<D> SolidPlacement<D>::cells_of(const MacState<D>& s, std::size_t solid) const {
    const geometry::Ball<D>& ball = solids_.ball(solid);
    CellBox<D> box;
    for (int d = 0; d < D; ++d) {
        const auto line = [&](real x) { return std::clamp((x - s.u.origin[d]) / s.u.h[d], -1e6, 1e6); };
        box.lo[d] = static_cast<int>(std::ceil(line(ball.middle[d] - ball.radius))) - 1;
        box.hi[d] = static_cast<int>(std::floor(line(ball.middle[d] + ball.radius))) + 1;
    }
    return box;
}

/// The boxes to update: everything at first, and where a moving solid has no bounding ball.
template <int D>
void SolidPlacement<D>::find_changed(const MacState<D>& s) {
    changed_.clear();
    bool everything = !placed_;
    for (std::size_t i = 0; i < solids_.count(); ++i) everything = everything || solids_[i].motion.moves();
    held_.resize(solids_.count());
    for (std::size_t i = 0; i < solids_.count(); ++i) {
        if (!solids_[i].free) continue;
        const CellBox<D> now = cells_of(s, i);
        CellBox<D> both = now;
        for (int d = 0; placed_ && d < D; ++d)
            both.lo[d] = std::min(both.lo[d], held_[i].lo[d]), both.hi[d] = std::max(both.hi[d], held_[i].hi[d]);
        held_[i] = now;
        if (everything) continue;
        Index<D> margin;  // a cell's centre lies half a cell inside its outer edge
        for (int d = 0; d < D; ++d) margin[d] = static_cast<int>(reach(s.u.h, solids_[i].shape->steepest()) / s.u.h[d] + 0.5);
        changed_.push_back(both.grown(margin, s.extent()));
    }
    if (everything) changed_.push_back({Index<D>{}, s.extent()});
    if (near_.size() < changed_.size()) near_.resize(changed_.size());
    for (auto& list : near_) list.reserve(solids_.count());
    placed_ = true;
}

template <int D>
Vec<D> pressure_force(const MacState<D>& s) {
    Vec<D> force{};
    if (!s.solid.any()) return force;
    for (int a = 0; a < D; ++a) {
        const auto& open = s.solid.open[static_cast<std::size_t>(a)];
        const real area = s.u.cell_volume() / s.u.h[a];
        force[a] = area * sum_over(s.extent(), [&](const Index<D>& I) {
                       return s.cells(I) == Cell::fluid ? s.p(I) * (open(I) - open(I + e<D>(a))) : 0;
                   });
    }
    return force;
}

template class SolidPlacement<2>;
template class SolidPlacement<3>;
template Vec<2> pressure_force(const MacState<2>&);
template Vec<3> pressure_force(const MacState<3>&);

}  // namespace weir::mac
