// Solids so thin that the stencils of the level set reach through them. Cells beside such a wall see φ as the liquid on their own side of
// it does: of the cells around them, those that are reached through open faces keep their φ, and from these it is continued into the solid
// and beyond, layer by layer. Values never come through a wall, and no result depends on the order of cells.
#pragma once
#include "core/grid.hpp"
#include "staggered/solid_faces.hpp"
#include "surface/frame.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace weir::surface {

/// φ in the cells around one, `reach` to either side.
template <int D>
struct Around {
    static constexpr int most = 3;
    static constexpr std::size_t power(std::size_t base) { return D == 2 ? base * base : base * base * base; }

    int reach = 1;
    std::array<real, power(2 * most + 1)> phi;
    std::array<std::uint8_t, power(2 * most + 1)> reached;  // 1: through open faces

    int width() const { return 2 * reach + 1; }
    std::size_t count() const { return power(static_cast<std::size_t>(width())); }
    int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? width() : width() * width(); }
    std::size_t at(const Index<D>& by) const {
        int place = 0;
        for (int d = 0; d < D; ++d) place += (by[d] + reach) * stride(d);
        return static_cast<std::size_t>(place);
    }
    real operator()(const Index<D>& by) const { return phi[at(by)]; }
    /// Beside the middle, along an axis.
    real beside(int axis, int by) const {
        Index<D> J{};
        J[axis] = by;
        return (*this)(J);
    }
    /// Catmull–Rom along each axis in turn at d [cells] from the middle, at most reach − 1.
    real cubic(const Vec<D>& d) const;
    /// Linear along each axis, at most a cell from the middle.
    real linear(const Vec<D>& d) const;
};

/// Weights of four equidistant samples at part f of the way between the middle two (Catmull & Rom 1974); exact at samples.
std::array<real, 4> catmull_rom(real f);

template <int D>
class ThinWalls {
public:
    /// Closed cells in a row, with open ones at both ends, that stencils of both sides see: two cells on either side, and one that both
    /// continue into.
    static constexpr int thickest = 5;
    /// `skin`: the closed cells near open ones, those beside them first; `faces`: closed faces, of which those between open cells count.
    /// Where each rank holds its own planes alone, `deep` of them are known beyond its cuts.
    void find(const Frame<D>& frame, const Grid<std::uint8_t, D>& closed, const std::vector<Index<D>>& skin,
              const std::array<std::vector<Index<D>>, D>* faces, int deep);
    /// Whether a stencil around cell I may reach through a wall.
    bool is_near(const Index<D>& I) const { return any_ && (marks_(I) & near_wall) != 0; }
    /// Whether closed cell I is of a wall that both its sides continue into.
    bool is_between(const Index<D>& I) const { return any_ && (marks_(I) & between) != 0; }
    bool any() const { return any_; }
    /// The mean φ of the open cells at both ends of the wall that closed cell I is of, along the axis where that is largest; −∞ where it is
    /// of none.
    real on_both_sides(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I) const;
    /// Whether liquid passes from open cell I to the one beside it, J. `closed`: as it was found from.
    bool passes(const Grid<std::uint8_t, D>& closed, const Index<D>& I, int axis, int by, Index<D>& J) const;
    /// φ around an open cell.
    void look(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I, int reach, Around<D>& to) const;
    std::size_t bytes() const { return marks_.bytes(); }

private:
    static constexpr std::uint8_t near_wall = 128, between = 64;  // and bit d: the lower face along d is closed, between open cells
    static constexpr int reach_ = 2;                              // of a stencil
    void mark_run(const Grid<std::uint8_t, D>& closed, const Index<D>& first, int axis, int by);
    void mark_around(const Index<D>& lo, const Index<D>& hi);
    void flood_inside(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const;
    void flood(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const;
    void continue_into(Around<D>& to) const;

    Frame<D> frame_;
    Grid<std::uint8_t, D> marks_;
    bool any_ = false;
};

}  // namespace weir::surface
