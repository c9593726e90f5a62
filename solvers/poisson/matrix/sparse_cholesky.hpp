// A minimal interface to SuiteSparse's CHOLMOD (Chen, Davis, Hager & Rajamanickam 2008): factor a matrix, solve with it.
#pragma once
#include "poisson/matrix/system.hpp"

#include <memory>

namespace weir::poisson {

class SparseCholesky {
public:
    SparseCholesky();
    ~SparseCholesky();
    SparseCholesky(const SparseCholesky&) = delete;
    SparseCholesky& operator=(const SparseCholesky&) = delete;

    /// Factors A, with a raised first diagonal entry in each closed component. The analysis is reused while the pattern is unchanged, the
    /// factor while the values are unchanged.
    void factor(const Matrix& A, const Components& components);
    /// x = A⁻¹ b; for a closed component any solution of a compatible b.
    void solve(const Vector& b, Vector& x);
    std::size_t bytes() const;
    int analyses() const { return analyses_; }
    int factorizations() const { return factorizations_; }

private:
    void upper_by_columns(const Matrix& A, const Components& components);

    struct Handles;
    std::unique_ptr<Handles> cholmod_;
    struct Columns {
        std::vector<long> start, row;
        Vector value;
        std::size_t bytes() const { return (start.capacity() + row.capacity()) * sizeof(long) + value.capacity() * sizeof(real); }
    };
    Columns now_, next_;      // of the present factor, and of the next matrix
    std::vector<char> held_;  // closed components with a raised diagonal
    int analyses_ = 0, factorizations_ = 0;
};

}  // namespace weir::poisson
