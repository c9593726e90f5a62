// Du/Dt = 0 on tall cells, by semi-Lagrangian advection (Stam 1999) or its MacCormack correction (Selle, Fedkiw, Kim, Liu & Rossignac 2008)
// of the lattice velocity. Regular faces are advected as on the uniform grid. Inside tall cells the moments over each run are advected: its
// end rows, into which neighbouring runs are transported, and Gauss points between them represent all rows.
#pragma once
#include "free_surface/marker_motion.hpp"
#include "tallcell/near_rows.hpp"
#include "tallcell/pressure.hpp"

namespace weir::tallcell {

template <int D>
class Transport {
public:
    Transport() = default;
    Transport(const Frame<D>& frame, const MacVelocity<D>& u, bool maccormack, int reach);
    /// u of all faces near the liquid after dt, where nothing moves by more than `fastest` cells per second; except for runs of tall cells,
    /// whose changes are changes(). u must be known throughout the level set's band. In parallel for this rank's columns; u must then be
    /// known on `beside` ghost planes, the largest displacement plus two.
    void operator()(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real fastest,
                    MacVelocity<D>& u, int beside = 0);
    /// Per axis, in the order of the mesh's runs; for the vertical axis per knot.
    const RunChanges<D>& changes() const { return changes_; }
    std::size_t bytes() const;

private:
    void move_runs(const TallPressure<D>& mesh, real dt);
    Pair move_run(int a, Index<D> I, const Run& run, real dt) const;
    bool move_run_of_eight(int a, Index<D> I, const Run& run, real dt, std::array<Eight, 2>& change) const;
    bool change_of_eight(int a, Index<D> I, real row, real dt, Eight& change) const;
    void keep(const MacVelocity<D>& u, int beside);
    template <bool Correct>
    void pass(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real near,
              MacVelocity<D>& to) const;
    struct ColumnUp;
    struct BlockUp;
    BlockUp block_up(const TallPressure<D>& mesh, const Grid<real, D>& phi, int a, int c0, int count, const Grid<real, D>& to) const;
    void predict_run(const BlockUp& block, const ColumnUp& column, Grid<real, D>& to) const;
    template <bool Correct>
    void advect_row(const BlockUp& block, int row, real dt, Grid<real, D>& to) const;
    void keep_sides(MacVelocity<D>& to) const;
    /// Number of blocks of eight columns, counted from column 0.
    static int blocks_of(const ColumnRange& columns) { return (columns.end + row_lanes - 1) / row_lanes; }
    /// The centre of a face [cells].
    static Vec<D> face_place(int a, const Index<D>& I) {
        Vec<D> s;
        for (int d = 0; d < D; ++d) s[d] = I[d] + (d == a ? 0.0 : 0.5);
        return s;
    }
    bool inner(const Index<D>& I, int axis) const { return I[axis] >= 1 && I[axis] + 1 < frame_.cells[axis]; }
    /// Returns whether the eight columns from x = `first` on can be processed together, and by how much their start is shifted inwards. A
    /// column at an end of the row has no neighbour in memory; it is processed separately.
    bool fits_eight(int first) const { return first + row_lanes <= frame_.cells[0] && frame_.cells[0] >= row_lanes + 2; }
    int inward(int first) const { return first == 0 ? 1 : first + row_lanes == frame_.cells[0] ? -1 : 0; }
    template <bool Correct>
    bool move_eight(int a, const Index<D>& I, real dt, Eight& to) const;
    real at_point(const Grid<real, D>& u, int a, const Vec<D>& s) const;
    Stencil<D> stencil(const Vec<D>& s) const;
    Vec<D> moved(const Vec<D>& s, const Vec<D>& here, real dt) const;
    Vec<D> speed(const Vec<D>& s) const;
    real departed(int a, const Vec<D>& s, real dt) const;
    real corrected(int a, const Vec<D>& s, real here, real dt) const;

    Frame<D> frame_;
    bool maccormack_ = true, open_above_ = false;
    int up_ = 1;
    int reach_ = 1;                           // cells that a point may travel in one step
    int ends_ = 1;                            // rows at either end of a run that its outside may reach in one step
    int kept_from_ = 0;                       // below this row all faces are in runs, and so are all departure points
    MacVelocity<D> before_, predicted_;       // from that row upwards
    const MacVelocity<D>* source_ = nullptr;  // the advected velocity
    RunChanges<D> changes_;
};

}  // namespace weir::tallcell
