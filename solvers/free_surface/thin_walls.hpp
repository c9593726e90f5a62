// Solids thinner than the stencils of the level set. Cells beside such a wall use φ of the liquid on their own side: cells connected
// through open faces keep their φ, and it is extrapolated from them into the solid and beyond, layer by layer. Values never pass through a
// wall, and results do not depend on the order of cells.
#pragma once
#include "free_surface/frame.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "parallel/grid.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace weir::free_surface {

/// φ in the cells around one, `reach` to either side.
template <int D>
struct Around {
    static constexpr int most = 3;
    static constexpr std::size_t power(std::size_t base) { return D == 2 ? base * base : base * base * base; }

    int reach = 1;
    std::array<real, power(2 * most + 1)> phi;
    std::array<std::uint8_t, power(2 * most + 1)> reached;  // 1: connected through open faces

    int width() const { return 2 * reach + 1; }
    std::size_t count() const { return power(static_cast<std::size_t>(width())); }
    int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? width() : width() * width(); }
    std::size_t at(const Index<D>& by) const {
        int place = 0;
        for (int d = 0; d < D; ++d) place += (by[d] + reach) * stride(d);
        return static_cast<std::size_t>(place);
    }
    real operator()(const Index<D>& by) const { return phi[at(by)]; }
    /// The value beside the middle, along an axis.
    real beside(int axis, int by) const {
        Index<D> J{};
        J[axis] = by;
        return (*this)(J);
    }
    /// Catmull–Rom along each axis in turn at d [cells] from the middle, at most reach − 1.
    real cubic(const Vec<D>& d) const;
    /// Linear along each axis, at most one cell from the middle.
    real linear(const Vec<D>& d) const;
};

/// Weights of four equidistant samples at fraction f between the middle two (Catmull & Rom 1974); exact at samples.
std::array<real, 4> catmull_rom(real f);

template <int D>
class ThinWalls {
public:
    /// Longest row of closed cells between open ones that stencils of both sides reach: two cells on either side, and one that is
    /// extrapolated from both.
    static constexpr int thickest = 5;
    /// `skin`: the closed cells near open ones, starting with those beside them; `faces`: closed faces, of which those between open cells
    /// are used. With distributed storage, `ghost_planes` planes of them are known.
    void find(const Frame<D>& frame, const Grid<std::uint8_t, D>& closed, const std::vector<Index<D>>& skin,
              const std::array<std::vector<Index<D>>, D>* faces, int ghost_planes);
    /// Returns whether a stencil around cell I may reach through a wall.
    bool is_near(const Index<D>& I) const { return any_ && (marks_(I) & near_wall) != 0; }
    /// Returns whether closed cell I belongs to a wall that is extrapolated into from both sides.
    bool is_between(const Index<D>& I) const { return any_ && (marks_(I) & between) != 0; }
    bool any() const { return any_; }
    /// The mean φ of the open cells at both ends of the wall through closed cell I, along the axis where it is largest; −∞ where I is in no
    /// wall.
    real on_both_sides(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I) const;
    /// Returns whether liquid can pass from open cell I to its neighbour J. `closed`: as passed to find().
    bool passes(const Grid<std::uint8_t, D>& closed, const Index<D>& I, int axis, int by, Index<D>& J) const;
    /// φ around an open cell.
    void look(const Grid<std::uint8_t, D>& closed, const Grid<real, D>& phi, const Index<D>& I, int reach, Around<D>& to) const;
    std::size_t bytes() const { return marks_.bytes(); }

private:
    static constexpr std::uint8_t near_wall = 128, between = 64;  // bit d: the lower face along d is closed, between open cells
    static constexpr int reach_ = 2;                              // radius of a stencil
    void mark_run(const Grid<std::uint8_t, D>& closed, const Index<D>& first, int axis, int by);
    void mark_around(const Index<D>& lo, const Index<D>& hi);
    void flood_inside(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const;
    void flood(const Grid<std::uint8_t, D>& closed, const Index<D>& I, Around<D>& to) const;
    void continue_into(Around<D>& to) const;

    Frame<D> frame_;
    Grid<std::uint8_t, D> marks_;
    bool any_ = false;
};

}  // namespace weir::free_surface
