#include "poisson/matrix/sparse_cholesky.hpp"

#include "core/error.hpp"
#include "core/scratch.hpp"

#include <suitesparse/cholmod.h>

#include <cstring>

namespace weir::poisson {

struct SparseCholesky::Handles {
    cholmod_common common;
    cholmod_factor* factor = nullptr;
    cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;  // kept between solves, so that they are allocated once

    Handles() {
        cholmod_l_start(&common);
        common.print = 0;
    }
    ~Handles() {
        cholmod_l_free_factor(&factor, &common);
        for (cholmod_dense** d : {&x, &y, &e}) cholmod_l_free_dense(d, &common);
        cholmod_l_finish(&common);
    }
};

SparseCholesky::SparseCholesky() : cholmod_(std::make_unique<Handles>()) {}
SparseCholesky::~SparseCholesky() = default;

namespace {

constexpr int small = 5000;  // below, dense blocks and BLAS threads cost more than they save

}  // namespace

/// The upper triangle of A by columns, which is its lower triangle by rows. In each closed component the first diagonal entry is doubled
/// (an isolated cell gets 1): a compatible right-hand side then makes that unknown zero, and the other equations are unchanged.
void SparseCholesky::upper_by_columns(const Matrix& A, const Components& components) {
    auto& [start, row, value] = next_;
    refill_scratch<char>(held_, static_cast<std::size_t>(components.closed), 0);
    start.assign(1, 0);
    row.clear();
    value.clear();
    for (std::size_t i = 0; i < A.diagonal.size(); ++i) {
        for (int k = A.start[i]; k < A.start[i + 1] && A.column[static_cast<std::size_t>(k)] < static_cast<int>(i); ++k) {
            const auto entry = static_cast<std::size_t>(k);
            const bool repeated = static_cast<long>(row.size()) > start.back() && row.back() == A.column[entry];  // two cells around
            if (repeated) {
                value.back() -= A.weight[entry];
            } else {
                row.push_back(A.column[entry]);
                value.push_back(-A.weight[entry]);
            }
        }
        real diagonal = A.diagonal[i];
        const int c = components.closed > 0 ? components.of[i] : -1;
        if (c >= 0 && !held_[static_cast<std::size_t>(c)])
            held_[static_cast<std::size_t>(c)] = 1, diagonal = diagonal > 0 ? 2 * diagonal : 1;
        row.push_back(static_cast<long>(i));
        value.push_back(diagonal);
        start.push_back(static_cast<long>(row.size()));
    }
}

void SparseCholesky::factor(const Matrix& A, const Components& components) {
    upper_by_columns(A, components);
    auto& [common, factor, x, y, e] = *cholmod_;
    const bool same_pattern = factor != nullptr && next_.start == now_.start && next_.row == now_.row;
    if (same_pattern && next_.value == now_.value) return;
    now_ = next_;  // not swapped: both keep their capacity
    if (A.size() == 0) return;
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = static_cast<std::size_t>(A.size());
    matrix.nzmax = now_.row.size();
    matrix.p = now_.start.data(), matrix.i = now_.row.data(), matrix.x = now_.value.data();
    matrix.stype = 1, matrix.itype = CHOLMOD_LONG, matrix.xtype = CHOLMOD_REAL, matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = matrix.packed = 1;
    common.supernodal = A.size() < small ? CHOLMOD_SIMPLICIAL : CHOLMOD_AUTO;
    if (!same_pattern) {
        cholmod_l_free_factor(&factor, &common);
        factor = cholmod_l_analyze(&matrix, &common);
        ++analyses_;
    }
    if (factor != nullptr) cholmod_l_factorize(&matrix, factor, &common);
    ++factorizations_;
    if (factor == nullptr || common.status < CHOLMOD_OK)
        throw NumericalFailure("pressure", "pressure solve: CHOLMOD ran out of memory or of its size limits");
    if (common.status == CHOLMOD_NOT_POSDEF)
        throw NumericalFailure("pressure", "pressure solve: CHOLMOD found the matrix not positive definite");
}

void SparseCholesky::solve(const Vector& b, Vector& x) {
    if (b.empty()) return;
    cholmod_dense rhs{};
    rhs.nrow = rhs.nzmax = rhs.d = b.size(), rhs.ncol = 1;
    rhs.x = const_cast<real*>(b.data());  // CHOLMOD does not write to a right-hand side
    rhs.xtype = CHOLMOD_REAL, rhs.dtype = CHOLMOD_DOUBLE;
    auto& h = *cholmod_;
    if (!cholmod_l_solve2(CHOLMOD_A, h.factor, &rhs, nullptr, &h.x, nullptr, &h.y, &h.e, &h.common))
        throw NumericalFailure("pressure", "pressure solve: CHOLMOD could not solve");
    std::memcpy(x.data(), h.x->x, b.size() * sizeof(real));
}

std::size_t SparseCholesky::bytes() const { return cholmod_->common.memory_inuse + now_.bytes() + next_.bytes() + held_.capacity(); }

}  // namespace weir::poisson
