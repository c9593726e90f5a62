// Pressure on tall cells: that of the uniform grid, restricted to functions that are linear inside elements (p = P q). The matrix is Pᵀ A_f
// P, symmetric positive definite. The projection is orthogonal: idempotent, never increases energy, exact for the hydrostatic pressure. The
// surface enters by ghost fluid (Gibou et al. 2002) and solids by open fractions (Batty et al. 2007), as on the uniform grid. After a
// projection the vertical velocity inside elements is rebuilt from the bottom up, so that every cell is divergence-free. In parallel each
// rank owns lines of columns, their faces towards the line after them, and has the knots of one ghost line on each side.
#pragma once
#include "free_surface/level_set.hpp"
#include "mac/grid/state.hpp"
#include "tallcell/multigrid.hpp"
#include "tallcell/pockets.hpp"
#include "tallcell/samples.hpp"

#include <vector>

namespace weir::tallcell {

using namespace free_surface;  // the words of the grid and of its free surface are the solver's own

/// Cells with a thinner layer of liquid, relative to h, have no unknown: this bounds 1/θ by 1 + 1/thinnest, as on the uniform grid.
inline constexpr real thinnest = 0.02;

/// Changes of the samples of runs by advection: per axis, in the order of the runs; for the vertical axis per knot.
template <int D>
using RunChanges = std::array<std::vector<Pair>, D>;

struct FaceOfColumns;

struct Shape {
    Division division = Division::stacked;
    int depth = 8;  // minimum number of regular rows below the surface
};

template <int D>
class TallPressure {
public:
    TallPressure(const Frame<D>& frame, int up, const poisson::Options& options);

    /// Finds the liquid cells (state.cells, where not `closed`) and the knots: rows outside the level set's band may be tall.
    void set_surface(const LevelSet<D>& surface, const Grid<std::uint8_t, D>& closed, const Shape& shape, MacState<D>& state);
    /// The same with knots of any kind in `place(layout, cells, knots)`; φ [m] at cell centres. For tests and studies.
    template <class Place>
    void set_surface(const Grid<real, D>& phi, const Grid<std::uint8_t, D>& closed, MacState<D>& state, Place&& place) {
        find_liquid(phi, closed, state);
        place(layout_, state.cells, knots_);
        finish_surface(phi, state);
    }

    /// Restricts the lattice velocity to the unknowns: moments over rows. Orthogonal, so it adds no energy. Where the lattice's velocity is
    /// divergence-free the unknowns' is too, for any knots.
    void restrict_velocity(const MacState<D>& state);
    void change_runs(const RunChanges<D>& by);
    /// Below this row all faces of the lattice are in runs.
    int floor_of_singles() const { return floor_; }
    /// The number of runs along an axis; for the vertical one, of knots.
    std::size_t run_count(int a) const { return a == layout_.up ? at(knots_.count()) : runs_[layout_.axes[0] == a ? 0 : 1].size(); }
    /// Unknowns of the pressure.
    std::int64_t unknowns() const;
    /// Solves for the pressure and makes the unknowns divergence-free, except for the volume that moving walls sweep into pockets;
    /// `pockets`: whether there may be any.
    const poisson::Report& project(const Grid<real, D>& phi, MacState<D>& state, real dt, bool pockets = false);
    /// Interpolates back to the lattice: linear over rows, the vertical velocity rebuilt, the pressure interpolated.
    void spread(MacState<D>& state, real dt);
    /// max |u|/h over the rows of runs, as of the last spread() [1/s]; it includes all rows below that of fastest_run_below().
    real fastest_run() const { return fastest_run_; }
    int fastest_run_below() const { return fastest_run_below_; }
    /// Largest |∇·u| over cells that are knots [1/s]; inside elements spread() makes it zero.
    real max_divergence(const MacState<D>& state) const;
    /// −Cᵀw: minus the divergence of the unknowns, tested with each knot's hat function.
    void weak_divergence(const MacState<D>& state, std::vector<real>& b) const;
    /// Σ mass w² over all unknowns: twice the kinetic energy, in units of ρ times a cell.
    real energy(const Grid<real, D>& phi, const MacState<D>& state) const;

    const Layout<D>& layout() const { return layout_; }
    const Knots& knots() const { return knots_; }
    const ColumnMatrix& matrix() const { return A_; }
    const std::vector<real>& potential() const { return q_; }
    ColumnMultigrid& solver() { return solver_; }
    /// y = A x, by knots.
    void multiply(const std::vector<real>& x, std::vector<real>& y) { solver_.multiply(A_, knots_, x, y); }
    /// The height of the element that contains each cell of this rank's columns [m]; 0 outside the liquid.
    void write_heights(Grid<real, D>& to) const;
    /// Iterates over the runs of faces along axis a on the lower side of a column (its own vertical faces where a is up), bottom up.
    class RunsUp {
    public:
        /// Moves to the first run at or above this row; returns whether it contains it. Rows must not decrease.
        bool reaches(int row) {
            while (k_ < end_ && run().row + run().count <= row) advance();
            return k_ < end_ && run().row <= row;
        }
        /// Its index among all runs of its axis.
        std::size_t index() const { return at(k_); }
        /// Returns whether any run is left.
        bool ahead() const { return k_ < end_; }
        Run run() const { return knots_ ? Run{knots_->row[at(k_)] + 1, knots_->length[at(k_)], k_, k_} : (*runs_)[at(k_)]; }
        /// False at a wall, whose faces have a prescribed velocity.
        bool any_faces() const { return faces_; }

    private:
        friend class TallPressure;
        void advance() {
            ++k_;
            while (knots_ && k_ < end_ && knots_->length[at(k_)] < 2) ++k_;
        }
        const Knots* knots_ = nullptr;
        const std::vector<Run>* runs_ = nullptr;
        int k_ = 0, end_ = 0;
        bool faces_ = true;
    };
    RunsUp runs_up(int a, int column) const;
    std::size_t samples() const;
    std::size_t bytes() const;

private:
    static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
    void find_liquid(const Grid<real, D>& phi, const Grid<std::uint8_t, D>& closed, MacState<D>& state) const;
    void finish_surface(const Grid<real, D>& phi, const MacState<D>& state);
    void find_runs(const MacState<D>& state);
    void agree_on_rows();
    int covered_from_below(int column) const;
    void assemble(const Grid<real, D>& phi, const MacState<D>& state);
    void find_shared_rows();
    void place_column(int column);
    void add_vertical(const Grid<real, D>& phi, const MacState<D>& state, int column);
    void add_horizontal(const Grid<real, D>& phi, const MacState<D>& state, int z, int f);
    void add_inner_rows(const Grid<real, D>& phi, const MacState<D>& state, const FaceOfColumns& face, int k);
    real cut(const Grid<real, D>& phi, std::size_t liquid, std::size_t air) const {
        return std::min(1 - phi[air] / phi[liquid], largest_cut_);  // 1/θ between a liquid cell and an air cell
    }
    static constexpr int faces() { return 2 * (D - 1); }
    void project_faces(const Grid<real, D>& phi, MacState<D>& state, int h, const ColumnRange& columns);
    void project_vertical(const Grid<real, D>& phi, MacState<D>& state);
    /// Linear indices of a column's cells, or of its faces on the lower side along an axis.
    struct Line {
        std::size_t first, stride;
        std::size_t operator()(int row) const { return first + static_cast<std::size_t>(row) * stride; }
    };
    /// Adjacent columns of a line; `count` of them are contiguous in memory.
    struct Block {
        int column, count;
    };
    static constexpr int block_columns = 16;
    /// max f(block) over columns; the columns of a block are adjacent along x, unless x is vertical.
    template <class F>
    real largest_of_blocks(const ColumnRange& columns, F&& f) const;
    template <class F>
    real largest_of_blocks(F&& f) const {
        return largest_of_blocks(layout_.own(), f);
    }
    template <class Together, class One>
    void for_each_run(int h, const Block& block, Together&& together, One&& one) const;
    template <class Together, class One>
    void for_each_element(const Block& block, Together&& together, One&& one) const;
    /// The faces around a block's columns: first indices, and the factor of a velocity into the column, over h [1/m].
    struct Sides {
        struct Side {
            Line line;
            const real* values;
            real into;
        };
        std::array<Side, 4> side;
        bool side_by_side;  // otherwise not contiguous, or cut by solids: columns are processed one by one
    };
    Sides sides_of(const MacState<D>& state, const Block& block) const;
    template <class F>
    void inflow_above_elements(const MacState<D>& state, const Block& block, const Sides& sides, F&& f) const;
    void weak_divergence(const MacState<D>& state, int column, int end, std::vector<real>& b) const;
    real largest_divergence(const MacState<D>& state, int column, int end) const;
    void restrict_runs(const MacState<D>& state, int h, const Block& block);
    void change_runs(const RunChanges<D>& by, int h, const ColumnRange& columns);
    real spread_runs(MacState<D>& state, int h, const Block& block) const;
    real rebuild(MacState<D>& state, const Block& block) const;
    void spread_pressure(MacState<D>& state, const Block& block, real scale) const;
    real pressure_at(const Row& row) const {
        if (!row.wet) return 0;
        return row.share > 0 ? (1 - row.share) * q_[at(row.knot)] + row.share * q_[at(row.knot) + 1] : q_[at(row.knot)];
    }
    /// Pressure at a row of the element above a knot.
    real pressure_at(int knot, real row) const {
        const real share = (row - knots_.row[at(knot)]) / knots_.length[at(knot)];
        return (1 - share) * q_[at(knot)] + share * q_[at(knot) + 1];
    }
    template <class T>
    Line line(const Grid<T, D>& q, int column) const {
        return {q.linear(layout_.foot(column)), static_cast<std::size_t>(q.stride(layout_.up))};
    }
    /// visit_faces of horizontal axis h, on the lower side of `column`; single(face, ...) additionally gets the face's linear index.
    template <class Single, class Tall>
    void visit(const MacState<D>& state, int h, int column, Single&& single, Tall&& run) const {
        visit(state, h, column, layout_.rows, single, run);
    }
    /// The same below row `end`, which must lie inside no run.
    template <class Single, class Tall>
    void visit(const MacState<D>& state, int h, int column, int end, Single&& single, Tall&& run) const;
    /// The open fraction of a face; flux() also includes the solid's part of the flux.
    static real open(const MacState<D>& state, int axis, std::size_t face) {
        return state.solid.any() ? state.solid.open[at(axis)][face] : 1;
    }
    static real flux(const MacState<D>& state, int axis, std::size_t face) {
        if (!state.solid.any()) return state.u[axis][face];
        const real w = state.solid.open[at(axis)][face];
        return w * state.u[axis][face] + (1 - w) * state.solid.velocity[at(axis)][face];
    }

    Frame<D> frame_;
    Layout<D> layout_;
    poisson::Options options_;
    Knots knots_;
    std::vector<int> row_index_;      // index of a lattice row among the shared rows, −1 for others
    std::vector<int> rows_of_ranks_;  // flags of lattice rows, from each rank
    ColumnMatrix A_;
    ColumnMultigrid solver_;
    Pockets pockets_;
    std::array<PlaneStore<int>, 2> run_start_;  // per horizontal axis and column on the upper side
    std::array<std::vector<Run>, 2> runs_;
    std::array<std::vector<Pair>, 2> w_;  // the samples of runs [m/s]
    int elements_end_ = 0;                // from this row on there is no element longer than one cell
    int floor_ = 0, fastest_run_below_ = 0;
    real fastest_run_ = 0;
    std::vector<real> mean_;   // of the vertical velocity in the element above each knot [m/s]
    std::vector<real> b_, q_;  // q = dt p/ρ [m²/s]
    real largest_cut_ = 0;
    poisson::Report nothing_to_do_;
};

template <int D>
template <class F>
real TallPressure<D>::largest_of_blocks(const ColumnRange& columns, F&& f) const {
    const int n = layout_.n[0], size = layout_.axes[0] == 0 ? block_columns : 1, a_line = (n + size - 1) / size;
    return parallel_max(a_line * ((columns.end - columns.begin) / n), [&](int i) {
        const int x = i % a_line * size;
        return f(Block{columns.begin + i / a_line * n + x, std::min(size, n - x)});
    });
}

template <int D>
template <class Single, class Tall>
void TallPressure<D>::visit(const MacState<D>& state, int h, int column, int end, Single&& single, Tall&& run) const {
    const int lower = layout_.lower(column, h), axis = layout_.axes[at(h)];
    if (lower < 0 || lower == column) return;
    const Line face = line(state.u[axis], column);
    const real* open = state.solid.any() ? state.solid.open[at(axis)].data() : nullptr;
    visit_faces(
        knots_, lower, column, end, [&](int row) { return !open || open[face(row)] == 1; },
        [&](int row, const Row& l, const Row& r) { single(face(row), row, l, r); }, run);
}

}  // namespace weir::tallcell
