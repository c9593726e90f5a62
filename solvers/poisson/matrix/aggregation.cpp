#include "poisson/matrix/aggregation.hpp"

#include <algorithm>
#include <numeric>

namespace weir::poisson {

namespace {

/// Largest two-grid condition number allowed for a pair (Napov & Notay 2012 use 8; an isotropic pair has 4 in 2D, 6 in 3D).
constexpr real worst_quality = 10;

/// Number of pairing passes, and the target size of the next level: a fourth of the unknowns, plus a margin for single ones.
constexpr int passes = 3;
constexpr real wanted_coarsening = 0.3;

/// Coupling of an unknown to p = 0: its diagonal minus its weights, exactly zero inside a closed component.
real to_zero(const Matrix& A, std::size_t i) {
    real weights = 0;
    for (int k = A.start[i]; k < A.start[i + 1]; ++k) weights += A.weight[static_cast<std::size_t>(k)];
    return A.diagonal[i] - weights;
}

/// Quality of the pair {i, j} (Napov & Notay 2012, eq. 4.4, symmetric case): harmonic mean of the diagonals over their coupling.
real quality(real diagonal_i, real diagonal_j, real weight, real zero_i, real zero_j) {
    const real held = zero_i > 0 && zero_j > 0 ? 1 / (1 / zero_i + 1 / zero_j) : 0;
    return 2 / (1 / diagonal_i + 1 / diagonal_j) / (weight + held);
}

/// The unknowns of each group, group by group.
struct Members {
    std::vector<int> first, unknown;
    explicit Members(const Aggregation& groups) : first(static_cast<std::size_t>(groups.count) + 1, 0), unknown(groups.of.size()) {
        for (const int g : groups.of) ++first[static_cast<std::size_t>(g) + 1];
        for (std::size_t g = 1; g < first.size(); ++g) first[g] += first[g - 1];
        std::vector<int> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < groups.of.size(); ++i)
            unknown[static_cast<std::size_t>(next[static_cast<std::size_t>(groups.of[i])]++)] = static_cast<int>(i);
    }
    int size(int group) const { return first[static_cast<std::size_t>(group) + 1] - first[static_cast<std::size_t>(group)]; }
};

constexpr int largest_group = 8;

/// A candidate group G: its diagonals D, and the matrix A_G of the faces inside it and of those to p = 0.
struct Candidate {
    int size = 0;
    std::array<int, largest_group> unknown;
    std::array<real, largest_group> diagonal;
    std::array<std::array<real, largest_group>, largest_group> S;

    void add(const Matrix& A, const Members& members, int group) {
        for (int k = members.first[static_cast<std::size_t>(group)]; k < members.first[static_cast<std::size_t>(group) + 1]; ++k) {
            const auto at = static_cast<std::size_t>(size++);
            unknown[at] = members.unknown[static_cast<std::size_t>(k)];
            diagonal[at] = A.diagonal[static_cast<std::size_t>(unknown[at])];
        }
    }

    /// Returns whether the two-grid quality max_v 2 vᵀ(D − D 1 1ᵀ D / 1ᵀD1) v / vᵀ A_G v is at most `worst_quality` (Napov & Notay 2012,
    /// theorem 3.2: worst_quality A_G minus that matrix has a Cholesky factor). The smoother must reduce the variation inside a group.
    bool is_good(const Matrix& A, const Vector& zero) {
        const auto n = static_cast<std::size_t>(size);
        real total = 0;
        for (std::size_t i = 0; i < n; ++i) total += diagonal[i];
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j) S[i][j] = 2 * diagonal[i] * diagonal[j] / total;
            const auto row = static_cast<std::size_t>(unknown[i]);
            S[i][i] += worst_quality * zero[row] - 2 * diagonal[i];
            for (int k = A.start[row]; k < A.start[row + 1]; ++k)
                for (std::size_t j = 0; j < n; ++j)
                    if (unknown[j] == A.column[static_cast<std::size_t>(k)] && j != i) {
                        S[i][j] -= worst_quality * A.weight[static_cast<std::size_t>(k)];
                        S[i][i] += worst_quality * A.weight[static_cast<std::size_t>(k)];
                    }
        }
        for (std::size_t k = 0; k + 1 < n; ++k) {  // the last pivot is zero up to the coupling to p = 0: constants are exact
            if (!(S[k][k] > 0)) return false;
            for (std::size_t i = k + 1; i < n; ++i)
                for (std::size_t j = k + 1; j <= i; ++j) S[i][j] -= S[i][k] * S[j][k] / S[k][k];
        }
        return true;
    }
};

/// Pairs groups of A's unknowns; C is A coarsened by them. Partners are tried in the order of their quality in C.
Aggregation join_pairs(const Matrix& A, const Vector& zero, const Aggregation& groups, const Matrix& C) {
    const auto n = static_cast<std::size_t>(C.size());
    const Members members(groups);
    Vector zero_of_group(n);
    for (std::size_t i = 0; i < n; ++i) zero_of_group[i] = to_zero(C, i);
    Aggregation joined;
    joined.of.assign(n, -1);
    std::vector<std::pair<real, int>> partners;
    for (std::size_t i = 0; i < n; ++i) {
        if (joined.of[i] >= 0) continue;
        joined.of[i] = joined.count++;
        partners.clear();
        for (int k = C.start[i]; k < C.start[i + 1]; ++k) {
            const auto j = static_cast<std::size_t>(C.column[static_cast<std::size_t>(k)]);
            if (j == i || joined.of[j] >= 0) continue;
            if (members.size(static_cast<int>(i)) + members.size(static_cast<int>(j)) > largest_group) continue;
            const real q = quality(C.diagonal[i], C.diagonal[j], C.weight[static_cast<std::size_t>(k)], zero_of_group[i], zero_of_group[j]);
            if (q < worst_quality) partners.emplace_back(q, static_cast<int>(j));
        }
        std::sort(partners.begin(), partners.end());
        for (const auto& [q, j] : partners) {
            Candidate both;
            both.add(A, members, static_cast<int>(i));
            both.add(A, members, j);
            if (both.size > 2 && !both.is_good(A, zero)) continue;  // for two unknowns q is the quality
            joined.of[static_cast<std::size_t>(j)] = joined.of[i];
            break;
        }
    }
    return joined;
}

}  // namespace

void sort_last_row(Matrix& C) {
    for (std::size_t k = static_cast<std::size_t>(C.start.back()) + 1; k < C.column.size(); ++k)
        for (std::size_t m = k; m > static_cast<std::size_t>(C.start.back()) && C.column[m] < C.column[m - 1]; --m) {
            std::swap(C.column[m], C.column[m - 1]);
            std::swap(C.weight[m], C.weight[m - 1]);
        }
}

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
    std::vector<int> seen(m, -1);  // entry of column c in the present row
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
        sort_last_row(C);
        real diagonal = 0;
        for (std::size_t k = static_cast<std::size_t>(begin); k < C.column.size(); ++k) diagonal += C.weight[k];
        C.diagonal.push_back(diagonal + zero);
        C.start.push_back(static_cast<int>(C.column.size()));
    }
    return C;
}

Aggregation aggregate(const Matrix& A) {
    const auto n = static_cast<std::size_t>(A.size());
    Vector zero(n);
    for (std::size_t i = 0; i < n; ++i) zero[i] = to_zero(A, i);
    Aggregation groups;
    groups.of.resize(n);
    std::iota(groups.of.begin(), groups.of.end(), 0);
    groups.count = A.size();
    Matrix coarse;
    for (int pass = 0; pass < passes && groups.count > wanted_coarsening * A.size(); ++pass) {
        if (pass > 0) coarse = coarsen(A, groups);
        const Aggregation joined = join_pairs(A, zero, groups, pass == 0 ? A : coarse);
        for (int& group : groups.of) group = joined.of[static_cast<std::size_t>(group)];
        groups.count = joined.count;
    }
    return groups;
}

}  // namespace weir::poisson
