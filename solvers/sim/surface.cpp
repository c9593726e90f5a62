#include "sim/surface.hpp"

#include "sim/owners.hpp"
#include "sim/particle_surface.hpp"
#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sim {

namespace {

/// The uppermost zero of phi(i), i = end-1 .. begin of n, as a fractional index; -1 where all cells are air, or where the liquid extends
/// beyond `end`. There are no values beyond the outermost centres, so a liquid outermost cell counts as full.
template <class Phi>
real uppermost_zero(int begin, int end, int n, const Phi& phi) {
    for (int i = end - 1; i >= begin; --i) {
        const real below = phi(i);
        if (!(below < 0)) continue;
        if (i == n - 1) return n - 0.5;
        const real above = phi(i + 1);
        return above < 0 ? -1 : i + below / (below - above);
    }
    return -1;
}

real coordinate(const Lattice& lattice, int axis, real index) {
    return lattice.first[axis] + index * lattice.spacing[static_cast<std::size_t>(axis)];
}

/// A number computed by the owner of x; with distributed storage all ranks receive it.
template <class F>
real known_at(const FieldSet& fields, const Vec<3>& x, F&& number) {
    if (!fields.cut) return number();
    const int owner = owner_of(*fields.cut, plane_below(Lattice::of_cells(fields.grid), fields.grid.dim - 1, x));
    return of_owners({owner == communicator().rank() ? number() : 0}, {owner})[0];
}

/// Length of [i, i + 1] on which the linear interpolant from a to b is negative.
real negative_part(real a, real b) {
    if (a < 0 && b < 0) return 1;
    if (!(a < 0) && !(b < 0)) return 0;
    return a < 0 ? a / (a - b) : b / (b - a);
}

/// φ at the centres of the cells on the line through x; with distributed storage all ranks receive the owners' values.
class Along {
public:
    Along(const FieldSet& fields, const Vec<3>& x, int axis)
        : phi_(fields.find(level_set_name)->data[0]), lattice_(Lattice::of_cells(fields.grid)), x_(x), axis_(axis) {
        if (!fields.cut) return;
        const int cut_axis = fields.grid.dim - 1;
        std::vector<real> own(static_cast<std::size_t>(size()));
        std::vector<int> owners;
        for (int i = 0; i < size(); ++i) {
            owners.push_back(owner_of(*fields.cut, axis == cut_axis ? i : plane_below(lattice_, cut_axis, x)));
            if (owners.back() == communicator().rank()) own[static_cast<std::size_t>(i)] = at(i);
        }
        known_ = of_owners(own, owners);
    }
    int size() const { return lattice_.n[static_cast<std::size_t>(axis_)]; }
    real operator()(int i) const { return known_.empty() ? at(i) : known_[static_cast<std::size_t>(i)]; }

private:
    real at(int i) const {
        Vec<3> x = x_;
        x[axis_] = coordinate(lattice_, axis_, i);
        return sample(phi_, lattice_, x);
    }
    std::span<const real> phi_;
    Lattice lattice_;
    Vec<3> x_;
    int axis_;
    std::vector<real> known_;
};

/// The cells whose φ this rank reads: its own with distributed storage, otherwise all.
struct OwnCells {
    std::array<int, 3> begin{}, end;
    explicit OwnCells(const FieldSet& fields) : end(Lattice::of_cells(fields.grid).n) {
        if (!fields.cut) return;
        const auto across = static_cast<std::size_t>(fields.grid.dim - 1);
        begin[across] = fields.cut->begin(communicator().rank()), end[across] = fields.cut->end(communicator().rank(), end[across]);
    }
};

/// Maximum over the lines through cell centres.
real front_of_level_set(const FieldSet& fields, std::span<const real> phi, int axis) {
    const auto a = static_cast<std::size_t>(axis), b = (a + 1) % 3, c = (a + 2) % 3;
    const Lattice lattice = Lattice::of_cells(fields.grid);
    const OwnCells cells(fields);
    real farthest = fields.grid.origin[a];
    std::array<int, 3> I{};
    for (I[c] = cells.begin[c]; I[c] < cells.end[c]; ++I[c])
        for (I[b] = cells.begin[b]; I[b] < cells.end[b]; ++I[b]) {
            const real zero = uppermost_zero(cells.begin[a], cells.end[a], lattice.n[a], [&](int i) {
                auto at = I;
                at[a] = i;
                return phi[lattice.linear(at)];
            });
            if (zero >= 0) farthest = std::max(farthest, coordinate(lattice, axis, zero));
        }
    return largest_of_owners(fields, farthest);
}

/// The farthest particle plus its radius, half a spacing, limited by the distance to solids.
real front_of_particles(const FieldSet& fields, int axis, const Room& room) {
    const auto& position = fields.find(particle_set_name, "position")->data;
    const auto a = static_cast<std::size_t>(axis);
    const real own = 0.5 * fields.grid.spacing[a], wall = upper_corner(fields.grid)[axis];
    real farthest = fields.grid.origin[a];
    for (std::size_t m = 0; m < position[a].size(); ++m) {
        const real at = position[a][m];
        if (std::min(at + own, wall) <= farthest) continue;
        Vec<3> x{};
        for (std::size_t d = 0; d < position.size(); ++d) x[d] = position[d][m];
        farthest = std::max(farthest, std::min(at + (room ? std::clamp(room(x), 0.0, own) : own), wall));
    }
    return farthest;
}

/// Columns of water, each with one depth and one surface.
struct WaterColumns {
    const FieldView *depth, *surface;
    explicit operator bool() const { return depth && surface; }
};
WaterColumns columns_of(const FieldSet& fields) { return {fields.find(column_depth_name), fields.find(surface_height_name)}; }

/// f(I) for the columns that this rank reads.
template <class F>
void for_each_own_column(const FieldSet& fields, F&& f) {
    const OwnCells cells(fields);
    std::array<int, 3> I{};
    for (I[2] = cells.begin[2]; I[2] < cells.end[2]; ++I[2])
        for (I[0] = cells.begin[0]; I[0] < cells.end[0]; ++I[0]) f(I);
}

/// Maximum of those columns and of `least`.
real largest(const FieldSet& fields, std::span<const real> values, real least) {
    const Lattice lattice = Lattice::of_cells(fields.grid);
    for_each_own_column(fields, [&](const std::array<int, 3>& I) { least = std::max(least, values[lattice.linear(I)]); });
    return largest_of_owners(fields, least);
}

/// Films thinner than this part of the deepest water are not the front: positivity-preserving schemes spread traces ahead of it.
constexpr real film = 1e-3;

real front_of_columns(const FieldSet& fields, const WaterColumns& water, int axis) {
    const Lattice lattice = Lattice::of_cells(fields.grid);
    const auto& depth = water.depth->data[0];
    const real least = film * largest(fields, depth, -infinity);
    real farthest = fields.grid.origin[static_cast<std::size_t>(axis)];
    for_each_own_column(fields, [&](const std::array<int, 3>& I) {
        const std::size_t c = lattice.linear(I);
        if (depth[c] <= least) return;
        const real reaches = axis == 1 ? water.surface->data[0][c] : coordinate(lattice, axis, I[static_cast<std::size_t>(axis)] + 0.5);
        farthest = std::max(farthest, reaches);
    });
    return largest_of_owners(fields, farthest);
}

}  // namespace

bool has_surface(const FieldSet& fields) {
    return fields.find("", surface_height_name) || fields.find(level_set_name) || columns_of(fields) ||
           fields.find(particle_set_name, "position");
}

real highest_liquid(const FieldSet& fields, const Vec<3>& x, int axis) {
    if (const WaterColumns water = columns_of(fields)) {
        return known_at(fields, x, [&] {
            const Lattice lattice = Lattice::of_cells(fields.grid);
            const real depth = sample(water.depth->data[0], lattice, x);
            return depth > 0 ? sample(water.surface->data[0], lattice, x) : fields.grid.origin[static_cast<std::size_t>(axis)];
        });
    }
    const FieldView* level_set = fields.find(level_set_name);
    if (const FieldView* height = fields.find("", surface_height_name); height && axis == 1)
        return known_at(fields, x, [&] { return sample(*height, fields.grid, 0, x); });
    if (!level_set) return highest_of_particles(fields, x, axis);
    const Along phi(fields, x, axis);
    const real zero = uppermost_zero(0, phi.size(), phi.size(), phi);
    return zero < 0 ? fields.grid.origin[static_cast<std::size_t>(axis)] : coordinate(Lattice::of_cells(fields.grid), axis, zero);
}

real liquid_depth(const FieldSet& fields, const Vec<3>& x, int axis) {
    if (const WaterColumns water = columns_of(fields))
        return known_at(fields, x, [&] { return sample(water.depth->data[0], Lattice::of_cells(fields.grid), x); });
    const FieldView* level_set = fields.find(level_set_name);
    if (const FieldView* height = fields.find("", surface_height_name); height && axis == 1)
        return known_at(fields, x, [&] { return std::max(0.0, sample(*height, fields.grid, 0, x) - fields.grid.origin[1]); });
    if (!level_set) return depth_of_particles(fields, x, axis);
    const Along phi(fields, x, axis);
    const int last = phi.size() - 1;
    real cells = 0.5 * (phi(0) < 0) + 0.5 * (phi(last) < 0);
    for (int i = 0; i < last; ++i) cells += negative_part(phi(i), phi(i + 1));
    return cells * Lattice::of_cells(fields.grid).spacing[static_cast<std::size_t>(axis)];
}

real front(const FieldSet& fields, int axis, const Room& room) {
    if (const WaterColumns water = columns_of(fields)) return front_of_columns(fields, water, axis);
    const auto a = static_cast<std::size_t>(axis);
    real farthest = fields.grid.origin[a];
    if (const FieldView* height = fields.find("", surface_height_name)) {  // a height field: there is liquid below every point
        if (axis != 1) return upper_corner(fields.grid)[axis];
        return largest(fields, height->data[0], farthest);
    }
    if (const FieldView* level_set = fields.find(level_set_name)) return front_of_level_set(fields, level_set->data[0], axis);
    return front_of_particles(fields, axis, room);
}

}  // namespace weir::sim
