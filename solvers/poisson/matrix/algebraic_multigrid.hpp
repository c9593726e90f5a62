// Aggregation multigrid with the K-cycle (Notay & Vassilevski 2008; Notay 2010). It is slower than the geometric cycle on open water, but
// robust for walls, slits and face weights of any size, because it coarsens only along strong couplings of the matrix.
#pragma once
#include "poisson/matrix/aggregation.hpp"
#include "poisson/matrix/sparse_cholesky.hpp"

namespace weir::poisson {

class AlgebraicMultigrid {
public:
    /// The K-cycle uses inner products, so M depends on r: conjugate gradients must be flexible.
    static constexpr bool is_linear = false;

    void prepare(const Matrix& A, const Components& components);
    /// z = M r: one cycle. r must be compatible in closed components.
    void apply(const Vector& r, Vector& z);
    std::size_t bytes() const;

private:
    struct Level {
        Matrix own;  // empty on the finest level, whose matrix is the caller's
        const Matrix* A = nullptr;
        Aggregation groups;       // to the next level
        Vector r, x, c, v, d, w;  // right-hand side and solution of this level; directions of the K-cycle and their products
        const Matrix& matrix() const { return A != nullptr ? *A : own; }
    };
    void cycle(std::size_t l, const Vector& r, Vector& z);
    void accelerate(std::size_t l);
    std::vector<Level> levels_;
    std::unique_ptr<SparseCholesky> coarsest_;
    Components coarsest_components_;
};

}  // namespace weir::poisson
