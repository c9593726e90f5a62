// Low-rank part of the matrix, A + Σ U C Uᵀ, in conjugate gradients: the numbers Uᵀ v of their vectors, and the positions of the cells of U
// in these vectors.
#pragma once
#include "poisson/geometric/level.hpp"
#include "poisson/matrix/low_rank.hpp"

namespace weir::poisson {

template <int D>
class AddedColumns {
public:
    bool empty() const { return more_ == nullptr; }
    /// Sets the columns of a problem with this layout, and its right-hand side.
    void begin(const LowRank& more, const Layout<D>& at, Grid<real, D>& b);
    /// Restores the right-hand side and removes the columns.
    void end();
    /// Sets x to zero; sets x to p.
    void see_zero();
    void see(const Grid<real, D>& p);
    void see(const Coloured<double>& x);
    /// Subtracts the product of the columns with x from the right-hand side.
    void set_rhs();

    /// u·U C Uᵀ u of a vector that is about to be added to the direction.
    real energy(const Coloured<float>& u);
    /// direction = u + β direction.
    void update_direction(real beta);
    /// x += α direction.
    void move(real alpha);
    /// r −= α U C Uᵀ p.
    void subtract_product(real alpha, const Coloured<float>& r) const;

    std::size_t bytes() const;

private:
    using Row = LowRank::Row;
    struct Place {
        std::size_t colour;
        std::ptrdiff_t entry;
    };
    template <class T>
    void product(const Coloured<T>& v, std::vector<Row>& sums) const;

    const LowRank* more_ = nullptr;
    Grid<real, D>* b_ = nullptr;
    std::vector<Place> places_;   // of the entries
    std::vector<real> given_;     // values of b there
    std::vector<Row> x_, u_, p_;  // Uᵀ of each vector, block by block
};

}  // namespace weir::poisson
