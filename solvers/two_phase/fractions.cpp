#include "two_phase/fractions.hpp"

#include "mac/grid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

using Kind = EndRule::Kind;

template <int D>
FractionGhosts<D>::FractionGhosts(const geometry::Sides<D>& sides, int component, const EnteringFractions<D>& entering)
    : entering_(entering) {
    boundary_.node_axis = component;
    for (int axis = 0; axis < D; ++axis)
        for (auto& rule : boundary_.end[static_cast<std::size_t>(axis)]) rule.kind = sides.periodic(axis) ? Kind::periodic : Kind::neumann;
    if (component >= 0 && !sides.periodic(component)) mirrored_axis_ = component;
}

template <int D>
void FractionGhosts<D>::fill_all(Padded<D>& to, const Grid<real, D>& from) const {
    fill(to, from, boundary_);
    mirror_about_sides(to);
    set_entering(to);
}

template <int D>
void FractionGhosts<D>::fill_outer(Padded<D>& q) const {
    fill_ghosts(q, boundary_);
    mirror_about_sides(q);
    set_entering(q);
}

template <int D>
void FractionGhosts<D>::set_entering(Padded<D>& q) const {
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto& given = entering_[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)];
            if (!given) continue;
            Index<D> lo = Index<D>::constant(-ghost_layers);
            Extent<D> hi = q.extent().wider(ghost_layers) + Index<D>::constant(ghost_layers);
            (end == 0 ? hi[a] : lo[a]) = end == 0 ? 0 : q.extent()[a];
            for_each_in(lo, hi, [&](const Index<D>& I) { q(I) = *given; });
        }
}

/// q(−k) = q(k), q(n + k) = q(n − k) for nodes 0 and n on the sides.
template <int D>
void FractionGhosts<D>::mirror_about_sides(Padded<D>& q) const {
    const int a = mirrored_axis_;
    if (a < 0) return;
    Index<D> lo = Index<D>::constant(-ghost_layers);
    Extent<D> hi = q.extent().wider(ghost_layers) + Index<D>::constant(ghost_layers);
    if (a == D - 1) hi.own = {};
    lo[a] = 0, hi[a] = 1;
    const int n = q.extent()[a] - 1;
    for_each_in(lo, hi, [&](const Index<D>& line) {
        Index<D> from = line, to = line;
        const auto copy = [&](int source, int target) {
            if (a == D - 1 && !(q.holds(source) && q.holds(target))) return;
            from[a] = source, to[a] = target;
            q(to) = q(from);
        };
        for (int k = 1; k <= ghost_layers; ++k) copy(std::min(k, n), -k), copy(std::max(n - k, 0), n + k);
    });
}

template <int D>
Index<D> Around<D>::operator()(Index<D> I) const {
    for (int d = 0; d < D; ++d) {
        const int n = cells_[d];
        while (I[d] < 0 || I[d] >= n) {
            if (periodic_[static_cast<std::size_t>(d)])
                I[d] += I[d] < 0 ? n : -n;
            else
                I[d] = I[d] < 0 ? -1 - I[d] : 2 * n - 1 - I[d];
        }
    }
    return I;
}

template <int D>
bool Around<D>::wrap(Index<D>& I) const {
    for (int d = 0; d < D; ++d) {
        if (I[d] >= 0 && I[d] < cells_[d]) continue;
        if (!periodic_[static_cast<std::size_t>(d)]) return false;
        I[d] += I[d] < 0 ? cells_[d] : -cells_[d];
    }
    return true;
}

namespace {

/// The offsets of the 3^D − 1 neighbours of a cell, in the order of their indices.
template <int D>
std::vector<Index<D>> neighbours() {
    std::vector<Index<D>> list;
    for (int k = 0; k < block_cells<D>; ++k)
        if (const Index<D> by = block_offset<D>(k); by != Index<D>{}) list.push_back(by);
    return list;
}

/// Less than nothing, more than all, or too little of one phase to matter: what the cell gives away.
real dust_of(real f) { return f < dust ? f : f > 1 - dust ? f - 1 : 0; }

/// Distance from one half below which a cell takes dust.
constexpr real takes_below = 0.5 - 1e-6;

template <int D>
struct Dust {
    const Padded<D>& before;
    const Around<D>& around;
    const Grid<poisson::Cell, D>& cells;
    const std::vector<Index<D>>& offsets;

    /// K becomes its index within the domain. False: it lies beyond a side, or in a solid.
    bool takes_part(Index<D>& K) const { return around.wrap(K) && cells(K) != poisson::Cell::solid; }
    /// The neighbour of I, within the domain, that is closest to one half; the first of several. False: none takes dust.
    bool receiver(const Index<D>& I, Index<D>& J) const {
        real closest = takes_below;
        for (const Index<D>& by : offsets) {
            Index<D> K = I + by;
            const real distance = std::abs(before(K) - 0.5);  // ghosts have the fractions of their images
            if (distance < closest && takes_part(K)) closest = distance, J = K;
        }
        return closest < takes_below;
    }
    /// f(K, liquid that cell I receives from K, which loses as much): I gives its own dust away, or receives that of neighbours.
    template <class F>
    void for_each_exchange(const Index<D>& I, F&& f) const {
        Index<D> J;
        if (const real own = dust_of(before(I)); own != 0) {
            if (receiver(I, J)) f(J, -own);
            return;
        }
        if (std::abs(before(I) - 0.5) >= takes_below) return;
        for (const Index<D>& by : offsets) {
            Index<D> K = I + by;
            const real given = dust_of(before(K));
            if (given != 0 && takes_part(K) && receiver(K, J) && J == I) f(K, given);
        }
    }
    real change(const Index<D>& I) const {
        real sum = 0;
        for_each_exchange(I, [&](const Index<D>&, real received) { sum += received; });
        return sum;
    }
    /// The value that a fluid (0: the liquid) carries in cell I after the exchange. The fluid that vanishes from a cell leaves with all
    /// that it carries; the other one comes with what it has where it comes from. What one cell gains the other loses.
    real value(const Index<D>& I, const Padded<D>& carried, int phase) const {
        const real part = phase == 0 ? before(I) : 1 - before(I);
        real content = part * carried(I), fills = part;
        const bool gives = dust_of(before(I)) != 0;
        for_each_exchange(I, [&](const Index<D>& K, real liquid) {
            const real received = phase == 0 ? liquid : -liquid;
            const Index<D>&giver = gives ? I : K, &taker = gives ? K : I;
            const bool vanishes = (before(giver) < 0.5) == (phase == 0);
            content += received * carried(vanishes ? giver : taker);
            fills += received;
        });
        return fills == part || std::abs(fills) < pure ? carried(I) : content / fills;
    }
};

/// The distance from one half of the closest of cell i − 1 and the 3^(D − 1) cells around it across the row.
template <int D>
void find_closest(const real* f, const Strides<D>& stride, int count, real* closest) {
    std::fill_n(closest, count + 2, infinity);
    for (int k = 0; k < block_cells<D>; k += 3) {
        const Index<D> by = block_offset<D>(k);
        const real* row = f - 1;
        for (int d = 1; d < D; ++d) row += by[d] * stride[static_cast<std::size_t>(d)];
#pragma omp simd
        for (int i = 0; i < count + 2; ++i) {
            const real distance = std::abs(row[i] - 0.5);
            closest[i] = distance < closest[i] ? distance : closest[i];
        }
    }
}

/// Marks the cells of a row whose dust may move: they take or have some, and a cell around takes some. Returns whether there are any.
template <int D>
bool mark_candidates(const real* f, const Strides<D>& stride, int count, real* mark) {
    alignas(64) real closest[row_block + 2];
    find_closest<D>(f, stride, count, closest);
    real most = 0;
#pragma omp simd reduction(max : most)
    for (int i = 0; i < count; ++i) {
        const real side = closest[i] < closest[i + 2] ? closest[i] : closest[i + 2];
        const real near = side < closest[i + 1] ? side : closest[i + 1];
        const bool gives = (f[i] < dust && f[i] != 0) || (f[i] > 1 - dust && f[i] != 1);
        mark[i] = near < takes_below && (gives || std::abs(f[i] - 0.5) < takes_below) ? 1 : 0;
        most = most < mark[i] ? mark[i] : most;
    }
    return most > 0;
}

}  // namespace

template <int D>
void hand_on_dust(const Padded<D>& before, const Around<D>& around, const Grid<poisson::Cell, D>& cells, Grid<real, D>& f,
                  const CarriedByDust<D>* carried) {
    static const std::vector<Index<D>> offsets = neighbours<D>();
    const Dust<D> all{before, around, cells, offsets};
    const Strides<D> stride = strides_of(before);
    for_each_row(Index<D>{}, f.extent(), [&](const Index<D>& first, int count) {
        alignas(64) real mark[row_block];
        if (!mark_candidates<D>(before.at(first), stride, count, mark)) return;
        Index<D> I = first;
        for (int i = 0; i < count; ++i, ++I[0])
            if (mark[i] > 0 && cells(I) != poisson::Cell::solid) {
                for (std::size_t phase = 0; carried && phase < 2; ++phase)
                    carried->values[phase](I) = all.value(I, carried->before[phase], static_cast<int>(phase));
                f(I) += all.change(I);
            }
    });
}

namespace {

constexpr int sub_cells_2d = 16, sub_cells_3d = 8;  // along each axis: a circle of ten cells' radius then has its area to 1e-5

/// Returns whether the corners of a box around x with sides h are all in a shape, or on its surface.
template <int D>
bool is_box_inside(const geometry::Shape<D>& shape, const Vec<D>& x, const Vec<D>& h) {
    const real round_off = 1e-9 * norm(h);
    for (int code = 0; code < (1 << D); ++code) {
        Vec<D> corner = x;
        for (int a = 0; a < D; ++a) corner[a] += ((code >> a & 1) ? 0.5 : -0.5) * h[a];
        if (shape.distance(corner) > round_off) return false;
    }
    return true;
}

/// The fraction of a box around x with sides h below the plane that approximates the shape's surface.
template <int D>
real fraction_near(const geometry::Shape<D>& shape, const Vec<D>& x, const Vec<D>& h) {
    const real d = shape.distance(x);
    Vec<D> m;
    real steep = 0, square = 0;
    for (int a = 0; a < D; ++a) {
        const Vec<D> by = 0.25 * h[a] * Vec<D>::unit(a);
        m[a] = 2 * (shape.distance(x + by) - shape.distance(x - by));
        steep += std::abs(m[a]), square += m[a] * m[a] / (h[a] * h[a]);
    }
    if (steep == 0) return d < 0 ? 1 : 0;
    // Beside an edge or a corner differences mix both faces, so that their gradient is shorter: one plane would cut the box in the corner
    // of a tank, which is full.
    if (d < 0 && square < 0.9 && is_box_inside(shape, x, h)) return 1;
    real middle = 0;
    for (int a = 0; a < D; ++a) middle += 0.5 * m[a];
    return volume_below(m, middle - d);
}

}  // namespace

template <int D>
void start_fractions(const geometry::Shape<D>& liquid, const MacVelocity<D>& grid, Grid<real, D>& f) {
    const int sub = D == 2 ? sub_cells_2d : sub_cells_3d;
    const Vec<D> h = grid.h / sub;
    const real reach = 0.5 * liquid.steepest() * norm(grid.h);
    for_each_cell(f.extent(), [&](const Index<D>& I) {
        const real d = liquid.distance(grid.cell_centre(I));
        if (std::abs(d) > reach) {
            f(I) = d < 0 ? 1 : 0;
            return;
        }
        real sum = 0;
        const Vec<D> corner = grid.cell_centre(I) - 0.5 * grid.h;
        for (int code = 0; code < (D == 2 ? sub * sub : sub * sub * sub); ++code) {
            Vec<D> x = corner;
            for (int a = 0, rest = code; a < D; ++a, rest /= sub) x[a] += h[a] * (rest % sub + 0.5);
            sum += fraction_near(liquid, x, h);
        }
        f(I) = sum / std::pow(sub, D);
        if (f(I) < dust) f(I) = 0;
        if (f(I) > 1 - dust) f(I) = 1;
    });
}

#define WEIR_INSTANTIATE(D)                                                                                       \
    template class FractionGhosts<D>;                                                                             \
    template class Around<D>;                                                                                     \
    template void hand_on_dust(const Padded<D>&, const Around<D>&, const Grid<poisson::Cell, D>&, Grid<real, D>&, \
                               const CarriedByDust<D>*);                                                          \
    template void start_fractions(const geometry::Shape<D>&, const MacVelocity<D>&, Grid<real, D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
