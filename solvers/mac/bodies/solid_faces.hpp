// Solids on the staggered grid: open fractions and normal velocities of faces, and extrapolation of fields into solids so that
// interpolation near them reads meaningful values.
#pragma once
#include "geometry/solids.hpp"
#include "mac/grid/state.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace weir::mac {

/// Faces with a smaller open fraction are closed. Fractions near zero make the pressure matrix arbitrarily ill-conditioned; closing them
/// moves the surface by at most this part of a cell (Ng, Min & Gibou 2009 give no remedy; Batty et al. 2007 clamp likewise).
inline constexpr real least_open_fraction = 0.01;

/// Faces with a smaller open fraction take part in the flux, but their projected velocity is unreliable: it is the residual flux of larger
/// faces divided by this fraction, and may be arbitrarily large. They get the extrapolated velocity instead.
inline constexpr real least_trusted_fraction = 0.1;

/// Cells from `lo` to before `hi`.
template <int D>
struct CellBox {
    Index<D> lo{}, hi{};
    bool holds(const Index<D>& I) const {
        for (int d = 0; d < D; ++d)
            if (I[d] < lo[d] || I[d] >= hi[d]) return false;
        return true;
    }
    /// The faces of the box along an axis.
    CellBox faces(int a) const { return {lo, hi + e<D>(a)}; }
    /// The region of the box in space.
    geometry::Region<D> region(const Vec<D>& origin, const Vec<D>& h) const {
        geometry::Region<D> r;
        for (int d = 0; d < D; ++d) r.min[d] = origin[d] + h[d] * lo[d], r.max[d] = origin[d] + h[d] * hi[d];
        return r;
    }
    /// The box enlarged by `by` cells on all sides, clipped to the grid.
    CellBox grown(const Index<D>& by, const Index<D>& cells) const {
        CellBox b;
        for (int d = 0; d < D; ++d) b.lo[d] = std::clamp(lo[d] - by[d], 0, cells[d]), b.hi[d] = std::clamp(hi[d] + by[d], 0, cells[d]);
        return b;
    }
    /// f(I, count) for its rows along the first axis, in order.
    template <class F>
    void rows(F&& f) const {
        if (lo[0] >= hi[0]) return;
        CellBox first = *this;
        first.hi[0] = lo[0] + 1;
        first.in_order([&](const Index<D>& I) { f(I, hi[0] - lo[0]); });
    }
    /// f(I) in the order of the grid, serially.
    template <class F>
    void in_order(F&& f) const {
        for (int d = 0; d < D; ++d)
            if (lo[d] >= hi[d]) return;
        for (Index<D> I = lo; I[D - 1] < hi[D - 1];) {
            f(I);
            for (int a = 0; a < D; ++a) {
                if (++I[a] < hi[a] || a == D - 1) break;
                I[a] = lo[a];
            }
        }
    }
};

template <int D>
class SolidPlacement {
public:
    SolidPlacement(geometry::Solids<D> solids, MacState<D>& state);
    bool any() const { return !solids_.empty(); }
    bool moving() const { return solids_.moving(); }
    const geometry::Solids<D>& solids() const { return solids_; }
    geometry::Solids<D>& solids() { return solids_; }

    /// Computes open fractions, face velocities and cell flags at time t; those far from any moving solid stay unchanged.
    void place(MacState<D>& s, real t);
    /// In parallel (MPI), computes them on `planes` ghost planes from here on. `see` reads the cell flags while they contain only solids.
    /// Afterwards cells that were stored before get back their flags: liquid, air, and cells treated as solid.
    void fill_ghosts(MacState<D>& s, int planes, const std::function<void()>& see = {});
    /// The updated region: boxes of cells that extend farther from the solids than reach().
    const std::vector<CellBox<D>>& changed() const { return changed_; }
    /// A cell whose centre is this far from the solids contains no point within a hundredth of a cell of them; `steepest` bounds the
    /// gradient of distances. It exceeds half the diagonal of a face: a solid this far away is never the nearest one of a face cut by
    /// another solid.
    static real reach(const Vec<D>& h, real steepest) { return 0.5 * steepest * norm(h) + 0.01 * *std::min_element(h.begin(), h.end()); }
    /// The solids closer to one of these boxes than two cell diagonals; a complete list.
    std::span<const std::size_t> near(std::size_t box) const { return near_[box]; }
    /// Distance from the lower corner of a cell, at most twice reach(); as of the last update near solids.
    real corner_distance(const Index<D>& I) const { return corner_(I); }
    /// Returns whether both planes of corners of this plane of cells are stored here.
    bool holds_corners(int plane) const { return corner_.store().holds(plane) && corner_.store().holds(plane + 1); }
    /// u·n = u_solid·n on closed faces.
    void set_faces(MacState<D>& s) const;
    /// Updates the velocities of solids whose motion has changed since the placement.
    void see_velocities(const MacState<D>& s);
    /// Extrapolates s.before by one face into free-slip solids: tangential velocity from the flow beside, normal velocity of the solid.
    void extend_velocity(MacState<D>& s);
    /// Extrapolates a field's `before` by one cell into solids: the mean of the neighbours that are not solid.
    void extend_field(const MacState<D>& s, Padded<D>& before, int beyond = 0) const;
    /// Maximum of |velocity| / h over solid faces now [1/s]; 0 where all moving solids are free bodies, which limit their own step.
    real max_rate(const MacState<D>& s) const;
    std::size_t bytes() const { return corner_.bytes() + extended_.capacity() * sizeof(Extended); }

private:
    struct Extended {
        int axis;
        Index<D> face;
        Vec<D> normal, velocity;  // of the solid at the face
        real value;
    };
    void open(MacState<D>& s, int planes);
    void find_changed(const MacState<D>& s);
    void place_corners(const MacState<D>& s, std::size_t box);
    void place_faces(MacState<D>& s, std::size_t box) const;
    void close_parted_cells(MacState<D>& s, std::size_t box) const;
    void close(MacState<D>& s, std::size_t box, const Index<D>& I) const;
    void place_cells(MacState<D>& s, std::size_t box) const;
    CellBox<D> cells_of(const MacState<D>& s, std::size_t solid) const;
    void find_extended(const MacState<D>& s);
    real find_rate(const MacState<D>& s) const;

    geometry::Solids<D> solids_;
    Grid<real, D> corner_;  // signed distance at the corners of cells
    std::vector<CellBox<D>> changed_;
    std::vector<CellBox<D>> held_;                // per free body, the cells that it touched at the last placement, inside the grid or not
    std::vector<std::vector<std::size_t>> near_;  // per box of changed_
    std::vector<Extended> extended_;
    int known_ = 0;                          // ghost planes
    real time_ = 0;                          // of the last placement [s]
    std::optional<real> rate_;               // max_rate() over the planes of all ranks, with distributed storage
    bool placed_ = false, extends_ = false;  // extends_: extended_ is up to date
};

/// Force of the pressure on all solids [N; per metre of depth in 2D]: Σ p S, S the area of solid surface in each fluid cell, whose
/// components are differences of the open fractions of opposite faces.
template <int D>
Vec<D> pressure_force(const MacState<D>& s);

}  // namespace weir::mac
