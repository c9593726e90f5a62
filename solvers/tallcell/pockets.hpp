// Liquid that walls close in all around, no way from it to air: its pressure is known up to a constant, and what a wall that moves sweeps
// into it no pressure can make good. As on the uniform grid (poisson/poisson.hpp) the right-hand side is made compatible: what comes in is
// spread evenly over the pocket's rows, and its pressure has the mean 0. In parallel each rank joins the knots of its lines; which sets are
// one across the cuts all learn from the knots of the lines beside them. Sums are added line by line, so that no bit depends on the ranks.
#pragma once
#include "tallcell/column_matrix.hpp"

#include <vector>

namespace weir::tallcell {

class Pockets {
public:
    /// Sets of knots that the matrix couples to one another and to no air.
    void find(const ColumnMatrix& A, const Knots& knots);
    void clear() { count_ = 0; }
    bool any() const { return count_ > 0; }
    /// b − λ m in each pocket, Σ b = 0 after it; m: the rows that a knot stands for.
    void make_compatible(std::vector<real>& b) const;
    /// q less its mean over the rows of each pocket.
    void remove_means(std::vector<real>& q) const;
    std::size_t bytes() const;

private:
    using Ints = std::vector<int>;
    /// A knot beside a cut, and the first of its set as one rank sees it: numbers among all knots, line after line.
    struct Link {
        int first, knot, open;
    };
    static constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
    int root(int knot);
    void join(int a, int b);
    void join_line(const ColumnMatrix& A, const Knots& knots, int z);
    void number_knots(const ColumnMatrix& A, const Knots& knots);
    std::vector<Link> links_beside_cuts(const ColumnMatrix& A);
    void number_pockets(const ColumnMatrix& A);
    void weigh(const Knots& knots);
    template <class F>
    void sum_up(F&& of, std::vector<real>& sums) const;

    int count_ = 0;
    ColumnPlaces places_;
    LineRange own_;
    Ints begin_, end_;               // the knots of lines, as far as they are known here
    Ints number_;                    // of these among all
    Ints parent_, pocket_;           // by knot: of the same set; of its pocket the number, -1 where there is air
    Ints here_, lower_;              // knots at or below the shared rows of a line, column by column, and of the line on its lower side
    Ints firsts_;                    // of lines, and of pockets
    std::vector<char> open_;         // by root: whether any of its knots touches air
    std::vector<real> mass_, size_;  // rows by knot and by pocket
    mutable std::vector<real> mean_, by_line_;
};

}  // namespace weir::tallcell
