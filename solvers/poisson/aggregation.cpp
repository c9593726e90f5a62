#include "poisson/aggregation.hpp"

namespace weir::poisson {

namespace {

/// The worst two-grid condition number that a pair may cause (Napov & Notay 2012 use 8; an isotropic pair has 4 in 2D, 6 in 3D).
constexpr real worst_quality = 10;

/// What joins an unknown to p = 0: its diagonal less its weights, exactly zero inside a closed component.
real to_zero(const Matrix& A, std::size_t i) {
    real weights = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k) weights += A.weight[static_cast<std::size_t>(k)];
    return A.diagonal[i] - weights;
}

/// Quality of the pair {i, j} (Napov & Notay 2012, eq. 4.4, symmetric case): harmonic mean of the diagonals over what holds them together.
real quality(real diagonal_i, real diagonal_j, real weight, real zero_i, real zero_j) {
    const real held = zero_i > 0 && zero_j > 0 ? 1 / (1 / zero_i + 1 / zero_j) : 0;
    return 2 / (1 / diagonal_i + 1 / diagonal_j) / (weight + held);
}

Aggregation aggregate_pairs(const Matrix& A) {
    const auto n = static_cast<std::size_t>(A.size());
    Aggregation groups;
    groups.of.assign(n, -2);
    Vector zero(n);
    for (std::size_t i = 0; i < n; ++i) zero[i] = to_zero(A, i);
    for (std::size_t i = 0; i < n; ++i) {
        if (groups.of[i] != -2) continue;
        int best = -1;
        real best_quality = worst_quality;
        for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
            const int j = A.column[static_cast<std::size_t>(k)];
            const auto other = static_cast<std::size_t>(j);
            if (other == i || groups.of[other] != -2) continue;
            const real q = quality(A.diagonal[i], A.diagonal[other], A.weight[static_cast<std::size_t>(k)], zero[i], zero[other]);
            if (q < best_quality) best = j, best_quality = q;
        }
        groups.of[i] = groups.count;
        if (best >= 0) groups.of[static_cast<std::size_t>(best)] = groups.count;
        ++groups.count;
    }
    return groups;
}

}  // namespace

Matrix coarsen(const Matrix& A, const Aggregation& groups) {
    const auto n = static_cast<std::size_t>(A.size()), m = static_cast<std::size_t>(groups.count);
    std::vector<int> first(m + 1, 0), member(n);
    for (std::size_t i = 0; i < n; ++i) ++first[static_cast<std::size_t>(groups.of[i]) + 1];
    for (std::size_t c = 0; c < m; ++c) first[c + 1] += first[c];
    std::vector<int> next(first.begin(), first.end() - 1);
    for (std::size_t i = 0; i < n; ++i)
        member[static_cast<std::size_t>(next[static_cast<std::size_t>(groups.of[i])]++)] = static_cast<int>(i);

    Matrix C;
    C.start.reserve(m + 1);
    C.diagonal.reserve(m);
    C.column.reserve(A.column.size() / 2);
    C.weight.reserve(A.column.size() / 2);
    std::vector<int> seen(m, -1);  // entry of column c in the row being built
    for (std::size_t c = 0; c < m; ++c) {
        const int begin = C.start.back();
        real zero = 0;
        for (int s = first[c]; s < first[c + 1]; ++s) {
            const auto i = static_cast<std::size_t>(member[static_cast<std::size_t>(s)]);
            zero += to_zero(A, i);
            for (int k = A.start[i]; k < A.start[i + 1]; ++k) {
                const auto entry = static_cast<std::size_t>(k);
                const auto d = static_cast<std::size_t>(groups.of[static_cast<std::size_t>(A.column[entry])]);
                if (d == c) continue;
                if (seen[d] < begin) {
                    seen[d] = static_cast<int>(C.column.size());
                    C.column.push_back(static_cast<int>(d));
                    C.weight.push_back(0);
                }
                C.weight[static_cast<std::size_t>(seen[d])] += A.weight[entry];
            }
        }
        real diagonal = 0;
        for (std::size_t k = static_cast<std::size_t>(begin); k < C.column.size(); ++k) diagonal += C.weight[k];
        C.diagonal.push_back(diagonal + zero);
        C.start.push_back(static_cast<int>(C.column.size()));
    }
    return C;
}

Aggregation aggregate_twice(const Matrix& A) {
    Aggregation pairs = aggregate_pairs(A);
    const Aggregation quads = aggregate_pairs(coarsen(A, pairs));
    for (int& group : pairs.of) group = quads.of[static_cast<std::size_t>(group)];
    pairs.count = quads.count;
    return pairs;
}

}  // namespace weir::poisson
