// Conjugate gradients with multigrid for pressures on columns of knots. Knots of one column couple to the next above and below, and to
// knots of the columns beside it; so every block of a column is tridiagonal and is solved exactly.
//   smoother        exact column solves, column by column in the order of a checkerboard; mirrored after the correction
//   coarser         2 (or 2 × 2) columns become one; it has the lowest and the highest knot and each row that is a knot of every child
//                   covering it, so the spaces are nested
//   prolongation    constant across, the parent's linear function evaluated at the child's knots
//   operator        Galerkin: Pᵀ A_v P + ½ Pᵀ A_h P; the half makes constants across as stiff as they should be (Braess 1995)
//   cycle           V(2,2): symmetric and positive, as conjugate gradients need it
#pragma once
#include "poisson/poisson.hpp"
#include "tallcell/columns.hpp"

#include <memory>
#include <vector>

namespace weir::tallcell {

/// One level: the matrix A = A_v + A_h by knots.
struct ColumnMatrix {
    std::array<int, 2> n{1, 1};      // columns along the horizontal axes
    std::array<bool, 2> periodic{};  // they
    int axes = 1;                    // how many
    Knots knots;
    // Of the block of a column: the diagonal, and the entry that couples a knot to the next above. v: vertical faces, h: horizontal ones.
    std::vector<real> vertical, vertical_next, horizontal, horizontal_next;
    // Entries of knot i with knots of the column beside it across side f: [begin[faces i + f], begin[faces i + f + 1]).
    std::vector<int> begin, beside;
    std::vector<real> entry;
    std::vector<int> lowest, highest;  // scratch of whoever counts entries

    int faces() const { return 2 * axes; }
    /// The column across side f = 2 (axis) + (0 lower, 1 upper); −1 where there is none, or it is the column itself.
    int neighbour(int column, int f) const;
    /// Room for what `knots` say; all entries zero, none beside.
    void resize();
    /// From how many knots each stands beside (in begin, one place further on) to places; `from`: the first of them.
    void place_entries(const std::vector<int>& from);
    /// Adds to the entry of knot i across side f with knot j.
    void add_beside(int i, int f, int j, real value) {
        const int first = begin[at(faces() * i + f)];
        entry[at(first + j - beside[at(first)])] += value;
    }
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    std::size_t bytes() const;
};

class ColumnMultigrid {
public:
    explicit ColumnMultigrid(const poisson::Options& options, int sweeps = 2) : options_(options), sweeps_(sweeps) {}
    /// Builds all coarser levels from the finest.
    void setup(const ColumnMatrix& finest);
    /// A x = b; x holds the first guess, dropped where zero is nearer. The report's residuals are as poisson::Report says.
    const poisson::Report& solve(const ColumnMatrix& A, const std::vector<real>& b, std::vector<real>& x);
    int levels() const { return static_cast<int>(levels_.size()); }
    std::size_t bytes() const;

    /// y = A x, for tests too.
    static void multiply(const ColumnMatrix& A, const std::vector<real>& x, std::vector<real>& y);
    /// z = M⁻¹ r, one V-cycle, for tests too.
    void precondition(const ColumnMatrix& A, const std::vector<real>& r, std::vector<real>& z);

private:
    struct Level {
        ColumnMatrix coarse;      // unused on the finest level, whose matrix is the caller's
        std::vector<int> parent;  // knot of the next coarser level at or below this one
        std::vector<real> share;  // of the parent's next knot
        // What a cycle reads, in single precision: a preconditioner need be no more exact, and memory is what its time goes to.
        std::vector<int> first;                                    // of a knot's entries
        std::vector<float> entry, diagonal, next, inverse, ratio;  // L D Lᵀ of the columns' blocks
        std::vector<float> x, b, r;
        std::vector<std::vector<int>> colours;  // columns of one colour are not neighbours
    };
    static void colour(const ColumnMatrix& A, Level& level);
    static void factorise(const ColumnMatrix& A, Level& level);
    static void coarsen(const ColumnMatrix& A, Level& level, ColumnMatrix& to);
    static void merge_knots(const ColumnMatrix& A, ColumnMatrix& to);
    static void map_knots(const ColumnMatrix& A, const ColumnMatrix& to, Level& level);
    static void count_entries(const ColumnMatrix& A, const Level& level, ColumnMatrix& to);
    static void add_entries(const ColumnMatrix& A, const Level& level, ColumnMatrix& to);
    void cycle(std::size_t l, const ColumnMatrix& A);
    static void sweep(const ColumnMatrix& A, Level& level, bool upwards, bool from_zero);
    static void residual(const ColumnMatrix& A, Level& level);
    static void solve_column(const ColumnMatrix& A, Level& level, int column, bool alone);

    poisson::Options options_;
    int sweeps_;
    std::vector<Level> levels_;
    std::vector<real> r_, p_, Ap_, z_;
    poisson::Report report_;
};

}  // namespace weir::tallcell
