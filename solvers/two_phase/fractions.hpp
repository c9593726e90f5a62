// Liquid fractions of cells and of the control volumes of faces. One fraction of a face's control volume is used by momentum, pressure,
// tension and viscosity: that of the two half cells beside the face, below the planes of the cells.
#pragma once
#include "geometry/shape.hpp"
#include "mac/grid/ghosts.hpp"
#include "mac/grid/state.hpp"
#include "two_phase/planes.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace weir::two_phase {

using namespace mac;  // the words of the grid are the solver's own

/// The densities of both phases [kg/m³].
struct Densities {
    real liquid = 1, gas = 1;
    real of(real fraction) const { return gas + (liquid - gas) * fraction; }
    real lightest() const { return std::min(liquid, gas); }
};

/// Fractions on faces: one grid per axis, of the extent of that velocity component.
template <int D>
using FaceFractions = std::array<Grid<real, D>, D>;

template <int D>
Strides<D> strides_of(const Padded<D>& q) {
    Strides<D> stride;
    for (int d = 0; d < D; ++d) stride[static_cast<std::size_t>(d)] = q.stride(d);
    return stride;
}

/// Cells of a block of three along each axis, and the offset of the k-th of them from the middle one.
template <int D>
constexpr int block_cells = D == 2 ? 9 : 27;
template <int D>
Index<D> block_offset(int k) {
    Index<D> by;
    for (int d = 0; d < D; ++d, k /= 3) by[d] = k % 3 - 1;
    return by;
}

/// The fraction of the fluid that enters at each end of each axis; no value: nothing enters there by itself.
template <int D>
using EnteringFractions = std::array<std::array<std::optional<real>, 2>, D>;

/// Fractions beyond the sides: periodic; that of the fluid that enters at an inflow; otherwise mirrored (a contact angle of 90 degrees).
template <int D>
class FractionGhosts {
public:
    FractionGhosts() = default;
    /// `component`: the axis of the faces, of which the first and last lie on sides; −1: cells.
    FractionGhosts(const geometry::Sides<D>& sides, int component, const EnteringFractions<D>& entering);
    /// Of another quantity of cells: with these conditions, and these values where fluid enters.
    FractionGhosts(const Boundary<D>& boundary, const EnteringFractions<D>& entering) : boundary_(boundary), entering_(entering) {}
    void fill_all(Padded<D>& to, const Grid<real, D>& from) const;
    /// From the values of the inner box.
    void fill_outer(Padded<D>& q) const;

private:
    void mirror_about_sides(Padded<D>& q) const;
    void set_entering(Padded<D>& q) const;
    Boundary<D> boundary_;
    int mirrored_axis_ = -1;  // whose outermost nodes lie on sides
    EnteringFractions<D> entering_{};
};

/// The cell's index within the domain: periodic images and mirror images of cells beyond the sides.
template <int D>
class Around {
public:
    Around(const geometry::Sides<D>& sides, const Index<D>& cells) : cells_(cells) {
        for (int d = 0; d < D; ++d) periodic_[static_cast<std::size_t>(d)] = sides.periodic(d);
    }
    Index<D> operator()(Index<D> I) const;
    /// Returns whether the slowest axis is periodic.
    bool repeats() const { return periodic_[D - 1]; }
    /// False where I lies beyond a side that is not periodic; otherwise I becomes the index within the domain.
    bool wrap(Index<D>& I) const;

private:
    Index<D> cells_;
    std::array<bool, D> periodic_{};
};

/// The fraction of the control volume of every face: ½ upper half of the cell below + ½ lower half of the cell above. `cells` needs two
/// layers of ghosts; `scratch`: of the extents of `faces`.
template <int D>
void find_face_fractions(const Padded<D>& cells, FaceFractions<D>& faces, FaceFractions<D>& scratch);

/// Fractions within this distance of 0 or 1 are handed to the neighbour that is closest to one half, so that columns of cells end.
inline constexpr real dust = 1e-9;
/// What each fluid carries per volume: dust takes it along. `before`: a copy of `values`; entry 0 is of the liquid, entry 1 of the gas.
template <int D>
struct CarriedByDust {
    std::array<Padded<D>, 2>& before;
    std::array<Grid<real, D>, 2>& values;
};
/// Moves dust; the sum is unchanged. Each cell gathers what its neighbours give, in the order of their indices. `f`: the fractions before,
/// in the grid and with two layers of ghosts. Solid cells give and take nothing.
template <int D>
void hand_on_dust(const Padded<D>& before, const Around<D>& around, const Grid<poisson::Cell, D>& cells, Grid<real, D>& f,
                  const CarriedByDust<D>* carried = nullptr);

/// The fraction of every cell inside a shape: in cells near its surface by sub-cells, each cut by a plane at the shape's distance.
template <int D>
void start_fractions(const geometry::Shape<D>& liquid, const MacVelocity<D>& grid, Grid<real, D>& f);

}  // namespace weir::two_phase
