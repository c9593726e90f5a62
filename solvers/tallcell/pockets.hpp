// Pockets: liquid enclosed by walls without connection to air. Its pressure is determined up to a constant, and the volume swept by a
// moving wall violates the compatibility condition. As on the uniform grid (poisson/poisson.hpp) the right-hand side is made compatible:
// the excess is distributed evenly over the pocket's rows, and the pressure has mean 0. In parallel each rank joins the knots of its lines;
// sets are joined across subdomain boundaries by the knots of adjacent lines. Sums are taken line by line: bitwise independent of the
// number of ranks.
#pragma once
#include "tallcell/column_matrix.hpp"

#include <vector>

namespace weir::tallcell {

class Pockets {
public:
    /// Finds sets of knots that the matrix couples to one another but not to air.
    void find(const ColumnMatrix& A, const Knots& knots);
    void clear() { count_ = 0; }
    bool any() const { return count_ > 0; }
    /// Subtracts λ m in each pocket so that Σ b = 0; m: the number of rows that a knot represents.
    void make_compatible(std::vector<real>& b) const;
    /// Subtracts from q its mean over the rows of each pocket.
    void remove_means(std::vector<real>& q) const;
    std::size_t bytes() const;

private:
    using Ints = std::vector<int>;
    /// A knot beside a subdomain boundary, and the first knot of its set on one rank: global indices, line by line.
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
    Ints begin_, end_;               // the knots of lines, where known on this rank
    Ints number_;                    // their global indices
    Ints parent_, pocket_;           // per knot: parent in its set; index of its pocket, -1 where connected to air
    Ints here_, lower_;              // knots at or below the shared rows of a line, column by column, and of the line on its lower side
    Ints firsts_;                    // first knots of lines, and of pockets
    std::vector<char> open_;         // per root: whether any of its knots touches air
    std::vector<real> mass_, size_;  // rows per knot and per pocket
    mutable std::vector<real> mean_;
    mutable std::vector<ExactSum> sums_;  // of the pockets
};

}  // namespace weir::tallcell
