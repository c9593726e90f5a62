// Multigrid-preconditioned conjugate gradients for pressures on columns of knots (column_matrix.hpp). Knots couple to the next above and
// below in their column, and to knots of neighbouring columns. So every diagonal block of a column is tridiagonal and is solved exactly.
//   smoother        exact column solves in the order of a checkerboard, mirrored after the correction; half of the columns at once
//   coarser         2 (or 2 × 2) columns become one; it has each row that is a knot of every child covering it, so the spaces are nested
//   prolongation    constant across, the parent's linear functions at the child's knots
//   operator        Galerkin: Pᵀ A_v P + ½ Pᵀ A_h P; the half makes constants across as stiff as they should be (Braess 1995)
//   cycle           V(2,2): symmetric and positive, as conjugate gradients need it
// In parallel each rank has a range of lines of columns (ColumnPlaces::cut), and ghost lines are exchanged after each colour. Levels too
// small for messages are replicated. Sums are taken line by line: bitwise independent of the number of ranks.
#pragma once
#include "poisson/poisson.hpp"
#include "tallcell/column_matrix.hpp"

#include <vector>

namespace weir::tallcell {

/// Returns whether a level is distributed with this partition of its lines.
bool worth_sharing(const ColumnPlaces& places, const Partition& cut);
Partition halved(Partition cut);

class ColumnMultigrid {
public:
    static constexpr int usual_sweeps = 2;
    explicit ColumnMultigrid(const poisson::Options& options, int sweeps = usual_sweeps) : options_(options), sweeps_(sweeps) {}
    /// Builds all coarser levels from the finest.
    void setup(const ColumnMatrix& finest);
    /// A x = b by knots. x holds the initial guess, which is replaced by zero where that has the smaller residual. The report's residuals
    /// are as in poisson::Report.
    const poisson::Report& solve(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& b, std::vector<real>& x);
    int levels() const { return static_cast<int>(levels_.size()); }
    std::size_t bytes() const;

    /// y = A x by knots, for tests.
    void multiply(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& x, std::vector<real>& y);
    /// z = M⁻¹ r by knots, one V-cycle, for tests.
    void precondition(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& r, std::vector<real>& z);

private:
    struct Level {
        ColumnMatrix coarse;  // unused on the finest level, whose matrix is the caller's
        // data read by a cycle, in single precision: sufficient for a preconditioner, whose time is memory-bound
        std::array<LineStore<float>, 2> beside, beside_next;  // W
        LineStore<float> diagonal, next;                      // of T + Σ W on shared rows
        LineStore<float> inverse, ratio;                      // L D Lᵀ of Rᵀ (T + Σ W) R
        LineStore<float> x, b, r;
        ColumnPlaces places;  // layout of all these
    };
    static void coarsen(const ColumnMatrix& A, ColumnMatrix& to);
    static void add_children(const ColumnMatrix& A, ColumnMatrix& to, int Z);
    static void add_lower_faces(const ColumnMatrix& A, ColumnMatrix& to, int Z);
    static void narrow_beside(const ColumnMatrix& A, Level& level, int z);
    static void factorise(const ColumnMatrix& A, Level& level);
    void cycle(std::size_t l, const ColumnMatrix& A);
    void sweep(const ColumnMatrix& A, Level& level, bool upwards, bool from_zero, bool read);
    static void solve_columns(const ColumnMatrix& A, Level& level, int z, int parity, int begin, int end, bool alone);
    static void residual(const ColumnMatrix& A, Level& level);
    static void restrict_residual(const ColumnMatrix& A, const Level& level, const ColumnMatrix& coarse, Level& next);
    static void add_correction(const ColumnMatrix& A, Level& level, const ColumnMatrix& coarse, const Level& next);
    void place(const ColumnMatrix& A, const Knots& knots, const std::vector<real>& from, LineStore<real>& to) const;
    void fetch(const ColumnMatrix& A, const Knots& knots, const LineStore<real>& from, std::vector<real>& to) const;
    void precondition(const ColumnMatrix& A, real largest);
    struct Residual {
        real norm, largest, b_squares, b_largest;
    };
    Residual residual(const ColumnMatrix& A);
    struct System;

    poisson::Options options_;
    int sweeps_;
    std::vector<Level> levels_;
    ColumnPlaces places_;
    LineStore<real> x_, b_, r_, p_, Ap_;  // on shared rows
    real scale_ = 1;                      // scale of the last preconditioned residual
    poisson::Report report_;
};

}  // namespace weir::tallcell
