// What the conjugate gradients keep of columns on top of the matrix, A + Σ U C Uᵀ: the numbers Uᵀ v of their vectors, and where in these
// the cells of U lie.
#pragma once
#include "poisson/level.hpp"
#include "poisson/low_rank.hpp"

namespace weir::poisson {

template <int D>
class AddedColumns {
public:
    bool empty() const { return more_ == nullptr; }
    /// Columns of a problem with this layout, and its right-hand side.
    void begin(const LowRank& more, const Layout<D>& at, Grid<real, D>& b);
    /// The right-hand side is as it was, and there are no columns.
    void end();
    /// x is zero; x is p.
    void see_zero();
    void see(const Grid<real, D>& p);
    void see(const Coloured<double>& x);
    /// The right-hand side less what the columns make of x.
    void set_rhs();

    /// u·U C Uᵀ u of a vector that is about to become part of the direction.
    real energy(const Coloured<float>& u);
    /// The direction is u and β times what it was.
    void turn(real beta);
    /// x goes by α along the direction.
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
    std::vector<real> given_;     // b there
    std::vector<Row> x_, u_, p_;  // Uᵀ of each, block by block
};

}  // namespace weir::poisson
