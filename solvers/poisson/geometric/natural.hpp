// The problem in the order of the caller's grids, for the geometric multigrid: cells with a margin, cleaned face weights in double
// precision, and runs of connected fluid cells. The true residual is computed here, independent of the cycle's packed arrays.
#pragma once
#include "poisson/poisson.hpp"

#include <cstdint>
#include <vector>

namespace weir::poisson {

/// Fluid cells [begin, end) of a row, connected by open faces, all of one component.
struct Run {
    int begin, end;
    int component;  // index of the closed component, −1 if the pressure is fixed
};

template <int D>
class Natural {
public:
    /// `own`: the planes that this rank solves for; without a partition every rank solves for all planes, and A must be whole.
    /// `zero`: further couplings to p = 0 (zero_coupling.hpp), read until the next build; nullptr: none.
    void build(const Operator<D>& A, const OwnPlanes& own, const Grid<real, D>* zero = nullptr);

    /// An operator with the same matrix; in parallel, whole on all ranks.
    Operator<D> as_operator() const;

    const Index<D>& extent() const { return n_; }
    const OwnPlanes& own() const { return own_; }
    bool weighted() const { return weighted_; }
    bool has_zero() const { return zero_ != nullptr; }
    /// The further couplings of a row's cells to p = 0; nullptr: none.
    const real* zero(int row) const { return zero_ ? zero_->data() + static_cast<std::ptrdiff_t>(row) * n_[0] : nullptr; }
    const Vec<D>& axis_weight() const { return axis_weight_; }
    const std::array<bool, D>& periodic() const { return periodic_; }
    int planes() const { return n_[D - 1]; }
    int rows_in_plane() const { return D == 2 ? 1 : n_[1]; }
    int row(int q, int j) const { return D == 2 ? q : q * n_[1] + j; }
    /// Cells of a row; [−1] and [n_x] are those beyond its ends.
    const std::uint8_t* cells(int row) const { return cells_.data() + 1 + static_cast<std::ptrdiff_t>(row + 1) * (n_[0] + 2); }
    /// The neighbouring row along axis a > 0; beyond a side −1, the row of outside cells.
    int neighbour(int q, int j, int a, int side) const;
    /// Cleaned weights: zero at solids and between cells that are not fluid; axis weight included. Row q, j of the faces along a.
    const real* faces(int a, int q, int j) const { return faces_[static_cast<std::size_t>(a)].data() + face_offset(a, q, j); }

    int closed() const { return closed_; }
    std::int64_t fluid_cells() const { return fluid_cells_; }
    std::size_t bytes() const;

    /// Means of the values over closed components: exact sums of those of their runs.
    void find_means(const Grid<real, D>& values) const;
    void clear_means() const { std::fill(mean_.begin(), mean_.end(), 0.0); }
    /// The same in two parts, for callers that already loop over the values: sums over the runs of every row, then means.
    void sum_row(int row, const real* values) const;
    void means_from_sums() const;
    /// Subtracts from p the mean of its closed component.
    void subtract_means(Grid<real, D>& p) const;
    /// ‖b − means‖₂ over fluid.
    real norm(const Grid<real, D>& b) const;
    /// Sets p to zero outside fluid; returns whether it is zero everywhere.
    bool clean(Grid<real, D>& p) const;
    void clear_outside(int row, real* values) const;
    real mean(const Run& run) const { return run.component < 0 ? 0 : mean_[static_cast<std::size_t>(run.component)]; }
    const Run* runs_begin(int row) const { return runs_.data() + run_start_[static_cast<std::size_t>(row)]; }
    const Run* runs_end(int row) const { return runs_.data() + run_start_[static_cast<std::size_t>(row) + 1]; }

    /// Returns whether no cell of the row is fluid.
    bool is_dry(int row) const { return runs_begin(row) == runs_end(row); }
    /// Returns whether all cells of the row and of its neighbouring rows are fluid.
    bool is_amid_fluid(int q, int j) const {
        bool amid = is_full(row(q, j));
        for (int a = 1; a < D; ++a)
            for (int side = 0; side < 2; ++side) amid = amid && is_full(neighbour(q, j, a, side));
        return amid;
    }
    /// r[i] = b[i] − mean for the fluid cells of a row, 0 elsewhere: the residual of p = 0.
    void rhs_row(int row, const real* b, real* r) const;
    /// r[i] = b[i] − mean − (A p)[i] for the cells of a row, 0 elsewhere. p must be zero outside fluid.
    void residual_row(int q, int j, const real* p, const real* b, real* r) const;

private:
    std::ptrdiff_t face_offset(int a, int q, int j) const {
        const std::ptrdiff_t nx = n_[0] + (a == 0 ? 1 : 0), ny = D == 2 ? 1 : n_[1] + (a == 1 ? 1 : 0);
        return nx * (D == 2 ? q : j + ny * q);
    }
    void copy_cells(const Operator<D>& A);
    void count_faces();
    void clean_faces(const Operator<D>& A);
    void find_runs();
    void gather_runs();
    void gather_open();
    /// In parallel, receives the values of the other ranks' runs.
    template <class T>
    void gather_by_runs(T* values) {
        first_runs_.clear();
        for (const int plane : own_.partition().at) {
            const std::size_t row = static_cast<std::size_t>(plane) * static_cast<std::size_t>(rows_in_plane());
            first_runs_.push_back(static_cast<std::size_t>(run_start_[row]));
        }
        communicator().gather_parts(values, sizeof(T), first_runs_);
    }
    void find_closed();
    void mark_open();
    /// f(row), threaded over all rows; in parallel, over those of this rank's planes.
    template <class F>
    void for_each_row_of_own(F&& f) const {
        const int rows = rows_in_plane(), begin = own_.lower(0), end = own_.upper(planes());
        parallel_for(begin * rows, end * rows, f);
    }
    bool is_wet(int row) const { return row >= 0 && wet_[static_cast<std::size_t>(row)] != dry; }
    bool is_full(int row) const { return row >= 0 && wet_[static_cast<std::size_t>(row)] == full; }
    static constexpr std::uint8_t dry = 0, some = 1, full = 2;

    Index<D> n_{};
    bool weighted_ = false;
    Vec<D> axis_weight_{};
    std::array<bool, D> periodic_{};
    PlaneStore<std::uint8_t> cells_, count_;  // count_: open faces of each cell, where all weights are equal
    std::vector<std::uint8_t> wet_;           // amount of fluid in each row
    std::array<PlaneStore<real>, D> faces_;
    const Grid<real, D>* zero_ = nullptr;
    OwnPlanes own_{};
    PlaneRange planes_{0, 0};  // own_ within the grid
    std::vector<int> run_start_;
    std::vector<Run> runs_;
    int closed_ = 0;
    std::int64_t fluid_cells_ = 0;
    std::vector<real> size_;                // cells of each closed component
    mutable std::vector<real> mean_, sum_;  // of components, of this rank's runs
    mutable std::vector<ExactSum> component_sum_;
    std::vector<std::size_t> first_runs_;  // per rank
    std::vector<int> root_, number_;       // scratch of find_closed: root of each run, component of each root
    std::vector<char> open_;
};

}  // namespace weir::poisson
