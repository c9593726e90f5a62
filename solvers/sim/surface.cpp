#include "sim/surface.hpp"

#include "sim/owners.hpp"
#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sim {

namespace {

/// The uppermost zero of phi(i), i = end-1 .. begin of n, as a fractional index; -1 where all are air, or liquid reaches beyond `end`.
/// Beyond the outermost centres nothing is known, so a liquid outermost cell is full.
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

/// The points that stand for liquid, and how far it reaches beyond them: a marker is a point, a particle's own volume half a spacing.
struct Wet {
    const FieldView* position = nullptr;
    real reach = 0;
};
Wet wet_points(const FieldSet& fields) {
    if (const FieldView* markers = fields.find(marker_set_name, "position")) return {markers, 0};
    return {fields.find(particle_set_name, "position"), 0.5 * fields.grid.spacing[0]};
}

/// A number that is known where x stands; where each rank holds its own planes alone, all get it from the owner of the place.
template <class F>
real known_at(const FieldSet& fields, const Vec<3>& x, F&& number) {
    if (!fields.cut) return number();
    const int owner = owner_of(*fields.cut, plane_below(Lattice::of_cells(fields.grid), fields.grid.dim - 1, x));
    return of_owners({owner == slabs().rank() ? number() : 0}, {owner})[0];
}

/// Whether a distance across the line is no more than half a spacing, but for round-off: on the face between two cells both are near.
bool within_half(real distance, real spacing) { return std::abs(distance) <= 0.5 * spacing * (1 + 1e-9); }

/// Highest marker or particle no farther than half a cell from the line through x along `axis`.
real highest_point(const FieldSet& fields, const Vec<3>& x, int axis) {
    const Wet wet = wet_points(fields);
    const auto& position = wet.position->data;
    real highest = fields.grid.origin[static_cast<std::size_t>(axis)];
    for (std::size_t m = 0; m < position[0].size(); ++m) {
        bool near = true;
        for (std::size_t a = 0; a < position.size(); ++a)
            if (static_cast<int>(a) != axis && !within_half(position[a][m] - x[a], fields.grid.spacing[a])) near = false;
        if (near) highest = std::max(highest, position[static_cast<std::size_t>(axis)][m] + wet.reach);
    }
    return highest;
}

/// Particles near the line, each with its own length and the weights of linear interpolation across: on a lattice these sum to one.
real depth_of_points(const FieldSet& fields, const Vec<3>& x, int axis) {
    const auto& position = wet_points(fields).position->data;
    const auto& spacing = fields.grid.spacing;
    real depth = 0;
    for (std::size_t m = 0; m < position[0].size(); ++m) {
        real weight = 1;
        for (std::size_t a = 0; a < position.size(); ++a)
            if (static_cast<int>(a) != axis) {
                // beyond the outermost layer of a lattice, half a spacing from a side, there is no other to share with
                const real lower = fields.grid.origin[a] + 0.5 * spacing[a],
                           upper = upper_corner(fields.grid)[static_cast<int>(a)] - 0.5 * spacing[a];
                weight *= std::max(
                    0.0, 1 - std::abs(position[a][m] - std::clamp(x[static_cast<int>(a)], lower, std::max(lower, upper))) / spacing[a]);
            }
        depth += weight * spacing[static_cast<std::size_t>(axis)];
    }
    return depth;
}

/// Length of [i, i + 1] on which the line from a to b is negative.
real negative_part(real a, real b) {
    if (a < 0 && b < 0) return 1;
    if (!(a < 0) && !(b < 0)) return 0;
    return a < 0 ? a / (a - b) : b / (b - a);
}

/// φ at the centres of the cells that the line through x meets; where each rank holds its own planes alone, all get what the owners know.
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
            if (owners.back() == slabs().rank()) own[static_cast<std::size_t>(i)] = at(i);
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

/// The cells whose φ this rank is to look at: its own where each holds its own planes alone, else all.
struct OwnCells {
    std::array<int, 3> begin{}, end;
    explicit OwnCells(const FieldSet& fields) : end(Lattice::of_cells(fields.grid).n) {
        if (!fields.cut) return;
        const auto across = static_cast<std::size_t>(fields.grid.dim - 1);
        begin[across] = fields.cut->begin(slabs().rank()), end[across] = fields.cut->end(slabs().rank(), end[across]);
    }
};

/// Of lines through cell centres.
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

/// Columns of water, each with one depth and one surface.
struct WaterColumns {
    const FieldView *depth, *surface;
    explicit operator bool() const { return depth && surface; }
};
WaterColumns columns_of(const FieldSet& fields) { return {fields.find(column_depth_name), fields.find(surface_height_name)}; }

/// f(I) for the columns that this rank is to look at.
template <class F>
void for_each_own_column(const FieldSet& fields, F&& f) {
    const OwnCells cells(fields);
    std::array<int, 3> I{};
    for (I[2] = cells.begin[2]; I[2] < cells.end[2]; ++I[2])
        for (I[0] = cells.begin[0]; I[0] < cells.end[0]; ++I[0]) f(I);
}

/// Of those columns, and `least`.
real largest(const FieldSet& fields, std::span<const real> values, real least) {
    const Lattice lattice = Lattice::of_cells(fields.grid);
    for_each_own_column(fields, [&](const std::array<int, 3>& I) { least = std::max(least, values[lattice.linear(I)]); });
    return largest_of_owners(fields, least);
}

/// Films thinner than this part of the deepest water are no front: a scheme that keeps depths positive lets traces run ahead.
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
    return fields.find("", surface_height_name) || fields.find(level_set_name) || columns_of(fields) || wet_points(fields).position;
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
    if (!level_set) return highest_point(fields, x, axis);
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
    if (!level_set) return depth_of_points(fields, x, axis);
    const Along phi(fields, x, axis);
    const int last = phi.size() - 1;
    real cells = 0.5 * (phi(0) < 0) + 0.5 * (phi(last) < 0);
    for (int i = 0; i < last; ++i) cells += negative_part(phi(i), phi(i + 1));
    return cells * Lattice::of_cells(fields.grid).spacing[static_cast<std::size_t>(axis)];
}

real front(const FieldSet& fields, int axis) {
    if (const WaterColumns water = columns_of(fields)) return front_of_columns(fields, water, axis);
    const auto a = static_cast<std::size_t>(axis);
    real farthest = fields.grid.origin[a];
    if (const FieldView* height = fields.find("", surface_height_name)) {  // there is liquid below every point
        if (axis != 1) return upper_corner(fields.grid)[axis];
        return largest(fields, height->data[0], farthest);
    }
    if (const FieldView* level_set = fields.find(level_set_name)) return front_of_level_set(fields, level_set->data[0], axis);
    const Wet wet = wet_points(fields);
    for (const real x : wet.position->data[a]) farthest = std::max(farthest, x + wet.reach);
    return farthest;
}

}  // namespace weir::sim
