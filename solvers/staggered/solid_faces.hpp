// Solids on the staggered grid: open fractions and normal velocities of faces, and what stands inside solids so that interpolation near
// them reads sensible values.
#pragma once
#include "geometry/solids.hpp"
#include "staggered/state.hpp"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace weir::staggered {

/// Faces open by less than this count as closed: fractions near zero make the pressure matrix arbitrarily badly conditioned and move
/// the surface by at most this part of a cell (Ng, Min & Gibou 2009 leave the cure open; Batty et al. 2007 clamp likewise).
inline constexpr real least_open_fraction = 0.01;

/// Faces open by less than this take part in the flux, but what the pressure leaves on them says little about the liquid's velocity: it is
/// the rest of what larger faces do, over this fraction, and squeezes out at any speed. They get the continued velocity instead.
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
    /// Its faces along an axis, as the cells above them.
    CellBox faces(int a) const { return {lo, hi + e<D>(a)}; }
    /// Where they are.
    geometry::Region<D> region(const Vec<D>& origin, const Vec<D>& h) const {
        geometry::Region<D> r;
        for (int d = 0; d < D; ++d) r.min[d] = origin[d] + h[d] * lo[d], r.max[d] = origin[d] + h[d] * hi[d];
        return r;
    }
    /// So many cells more on all sides, and of all these those of a grid.
    CellBox grown(const Index<D>& by, const Index<D>& cells) const {
        CellBox b;
        for (int d = 0; d < D; ++d) b.lo[d] = std::clamp(lo[d] - by[d], 0, cells[d]), b.hi[d] = std::clamp(hi[d] + by[d], 0, cells[d]);
        return b;
    }
    /// f(I, count) for its rows along the first axis, one after another.
    template <class F>
    void rows(F&& f) const {
        if (lo[0] >= hi[0]) return;
        CellBox first = *this;
        first.hi[0] = lo[0] + 1;
        first.in_order([&](const Index<D>& I) { f(I, hi[0] - lo[0]); });
    }
    /// f(I) one after another, in the order of a grid, whatever the threads.
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

    /// Open fractions, face velocities and cell flags at time t; those that the solids have not been near since they were placed last stay
    /// as they are.
    void place(MacState<D>& s, real t);
    /// In parallel (MPI), from here on so many planes beyond the cuts are known too. `see` looks at the flags of cells while they tell of
    /// solids alone; then those that were held before are what they were: liquid, air, and what is held to be solid.
    void know(MacState<D>& s, int planes, const std::function<void()>& see = {});
    /// Where that was: boxes of cells that reach further from the solids than reach().
    const std::vector<CellBox<D>>& changed() const { return changed_; }
    /// Cells whose middle is this far from the solids hold no point that is a hundredth of a cell from them or nearer; by how fast
    /// distances may grow. Half the diagonal of a face is less: of a face that one solid cuts, another is not nearest that is this far
    /// away.
    static real reach(const Vec<D>& h, real steepest) { return 0.5 * steepest * norm(h) + 0.01 * *std::min_element(h.begin(), h.end()); }
    /// The solids that are nearer to a box of these than two diagonals of a cell; all that are nearer to it than that.
    std::span<const std::size_t> near(std::size_t box) const { return near_[box]; }
    /// Distance from the lower corner of a cell, or two of reach() if it is more; as it was when solids were near last.
    real corner_distance(const Index<D>& I) const { return corner_(I); }
    /// Both planes of corners of this plane of cells are stored here.
    bool holds_corners(int plane) const { return corner_.store().holds(plane) && corner_.store().holds(plane + 1); }
    /// u·n = u_solid·n on closed faces.
    void set_faces(MacState<D>& s) const;
    /// The solids move at other speeds than when they were placed.
    void see_velocities(const MacState<D>& s);
    /// Continues s.before one face into solids with free slip: tangentially as the flow beside, through the surface as the solid moves.
    void extend_velocity(MacState<D>& s);
    /// Continues a field's `before` one cell into solids: the mean of the neighbours that are not solid.
    void extend_field(const MacState<D>& s, Padded<D>& before) const;
    /// Largest |velocity| / h of a solid's face now [1/s]; where all that moves is free, nothing: who moves it knows how fast.
    real max_rate(const MacState<D>& s) const;
    std::size_t bytes() const { return corner_.bytes() + extended_.capacity() * sizeof(Extended); }

private:
    struct Extended {
        int axis;
        Index<D> face;
        Vec<D> normal, velocity;  // of the solid there
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
    std::vector<CellBox<D>> held_;  // of each solid that is free the cells that it touched when placed last, in the grid or not
    std::vector<std::vector<std::size_t>> near_;  // of each box of changed_
    std::vector<Extended> extended_;
    int known_ = 0;                          // planes beyond the cuts
    real time_ = 0;                          // when they were placed last [s]
    std::optional<real> rate_;               // max_rate() of all ranks' planes, where each holds its own
    bool placed_ = false, extends_ = false;  // extends_: extended_ is of the solids as they stand
};

/// Force of the pressure on all solids [N; per metre of depth in 2D]: Σ p S, S the area of solid surface in each fluid cell, whose
/// components are differences of the open fractions of opposite faces.
template <int D>
Vec<D> pressure_force(const MacState<D>& s);

}  // namespace weir::staggered
