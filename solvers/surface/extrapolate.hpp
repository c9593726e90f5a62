// Velocity beyond the liquid, outwards from the faces whose velocity is known: ∇(∇u·∇φ)·∇φ = 0 in the first two layers (Aslam 2004),
// ∇u·∇φ = 0 beyond (Adalsteinsson & Sethian 1999), with upwind differences as in the fast sweeping of Zhao 2005. Faces are visited layer by
// layer from the known ones, each from finished layers only: one visit a face, and no result depends on threads, on the direction of a
// sweep, or on a mirror. Over ranks each finds the layers as far beyond its cuts as they reach, and the values on its own
// planes of faces.
#pragma once
#include "surface/level_set.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace weir::surface {

template <int D>
using FaceMarks = std::array<Grid<std::uint8_t, D>, D>;
template <int D>
using FaceLists = std::array<std::vector<Index<D>>, D>;

template <int D>
class Extrapolation {
public:
    Extrapolation() = default;
    /// `steepest`: what linear continuation may claim of acceleration along the flow [m/s²], see slope().
    Extrapolation(const Frame<D>& frame, real steepest)
        : frame_(frame),
          steepest_(steepest),
          h_min_(frame.h_min()),
          band_rows_(product(frame.cells) / static_cast<std::size_t>(frame.cells[0])),
          joins_(static_cast<std::size_t>(frame.cells[0]) + 1) {}
    /// Fills u on unknown faces (mark 0) up to `layers` faces away from known ones (mark 1); marks them 1 + layer. It starts at the faces
    /// of cells near the surface and at `in_solids`; anywhere else no one asks.
    void operator()(MacVelocity<D>& u, FaceMarks<D>& mark, const LevelSet<D>& surface, const FaceLists<D>& in_solids, int layers);
    std::size_t bytes() const {
        return (front_.capacity() + next_.capacity()) * sizeof(Index<D>) + value_.capacity() * sizeof(real) +
               own_.capacity() * sizeof(int) + band_rows_.capacity() * sizeof(Extent) + joins_.capacity();
    }

private:
    void bring_marks(FaceMarks<D>& marks, int layers);
    bool is_near(int plane) const { return near_.empty() || near_[static_cast<std::size_t>(plane)] != 0; }
    void find_band_rows(const LevelSet<D>& surface, int layers);
    void start_front(Grid<std::uint8_t, D>& mark, int a, const LevelSet<D>& surface, int layers);
    template <class F>
    void for_each_own(F&& f);
    void join_front(Grid<std::uint8_t, D>& mark, int a, const Index<D>& face);
    void grow_front(Grid<std::uint8_t, D>& mark, int a);
    real value(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, const Grid<real, D>& phi, const Index<D>& I, int a,
               int layer) const;
    real slope(const Grid<real, D>& u, const Grid<std::uint8_t, D>& mark, Index<D> J, int a, int axis, int by, int layer) const;
    real smooth_change(real here, real behind, real further, int axis) const;
    bool step(Index<D>& I, int a, int axis, int by) const;

    Frame<D> frame_;
    real steepest_ = 0, h_min_ = 0;
    std::vector<Index<D>> front_, next_;
    std::vector<real> value_;
    std::vector<int> own_;                      // over ranks: places in the front of this rank's own faces
    std::array<std::vector<char>, 2> near_of_;  // and in which planes of faces along other axes and along the last it looks for layers
    std::vector<char> near_;                    // those of the faces at work
    std::vector<Extent> band_rows_;             // of every row of cells: its part in the layers from which the first front starts
    std::vector<std::uint8_t> joins_;           // of one row of faces
};

/// Sets every face without a mark to 0. Farther from the liquid nothing says what moves: what stood there is of earlier steps, and gravity
/// would accelerate it for ever.
template <int D>
void still_air(MacVelocity<D>& u, const FaceMarks<D>& known);

}  // namespace weir::surface
