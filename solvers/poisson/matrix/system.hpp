// The pressure equation on numbered fluid cells: a symmetric M-matrix by rows, and the closed components that make it singular. All methods
// except the geometric multigrid and the DCT use this list, so that only fluid cells cost time.
#pragma once
#include "poisson/poisson.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::poisson {

using Vector = std::vector<real>;

/// Block length of loops over long lists; sums add the blocks in order, so they do not depend on the number of threads.
inline constexpr std::size_t block_size = 4096;

/// f(begin, end) for each block of [0, n), threaded.
template <class F>
void for_each_block(std::size_t n, F&& f) {
    parallel_for(0, static_cast<int>((n + block_size - 1) / block_size), [&](int k) {
        const std::size_t begin = static_cast<std::size_t>(k) * block_size;
        f(begin, std::min(n, begin + block_size));
    });
}

/// The sum of f(begin, end) over the blocks of [0, n).
template <class F>
real sum_of_blocks(std::size_t n, F&& f) {
    return exact_sum(static_cast<int>((n + block_size - 1) / block_size), [&](int k) {
        const std::size_t begin = static_cast<std::size_t>(k) * block_size;
        return f(begin, std::min(n, begin + block_size));
    });
}

/// (A x)_i = diagonal_i x_i − Σ_k weight_k x_{column_k},  k in [start_i, start_{i+1}), columns ascending, weights positive.
struct Matrix {
    std::vector<int> start{0}, column;
    Vector weight, diagonal;
    int size() const { return static_cast<int>(diagonal.size()); }
    std::size_t bytes() const;
};

/// r = b − A x.
void residual(const Matrix& A, const Vector& x, const Vector& b, Vector& r);
/// y = A x.
void multiply(const Matrix& A, const Vector& x, Vector& y);

real dot(const Vector& a, const Vector& b);

/// Closed components: connected sets of unknowns without a face to p = 0.
struct Components {
    std::vector<int> of;  // index of each unknown's closed component, −1 where air fixes the pressure; empty if no component is closed
    int closed = 0;
    /// Subtracts from x its mean over each closed component.
    void remove_means(Vector& x) const;
    std::size_t bytes() const;

private:
    mutable Vector sum_, count_;
};

/// Union-find over the faces of positive weight. A component is open if some row's diagonal exceeds its weights, that is, if a face leads
/// to p = 0. Memory is reused between calls.
class ComponentFinder {
public:
    void find(const Matrix& A, Components& components);
    std::size_t bytes() const;

private:
    int root(int i);
    std::vector<int> parent_, number_;
    std::vector<char> open_;
};

template <int D>
struct System {
    Matrix A;
    std::vector<int> cell;             // linear index of each unknown's cell
    std::vector<std::uint8_t> colour;  // neighbours have different colours: 0 and 1, more only across odd periodic axes
    Components components;

    /// `zero`: further couplings to p = 0 (zero_coupling.hpp); nullptr: none.
    void build(const Operator<D>& op, const Grid<real, D>* zero = nullptr);
    std::size_t bytes() const;
};

}  // namespace weir::poisson
