// Extrapolation of the velocity beyond the liquid from the faces with known velocity: ∇(∇u·∇φ)·∇φ = 0 in the first two layers (Aslam 2004),
// ∇u·∇φ = 0 beyond (Adalsteinsson & Sethian 1999), with upwind differences as in the fast sweeping of Zhao 2005. Faces are visited layer by
// layer, each computed from finished layers only: one visit per face. Results do not depend on threads or sweep directions and are mirror
// symmetric. In parallel each rank finds the layers in the ghost planes that influence its own, and computes the values on its own planes
// of faces.
#pragma once
#include "free_surface/level_set.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace weir::free_surface {

template <int D>
using FaceMarks = std::array<Grid<std::uint8_t, D>, D>;
template <int D>
using FaceLists = std::array<std::vector<Index<D>>, D>;

template <int D>
class Extrapolation {
public:
    Extrapolation() = default;
    /// `steepest`: largest acceleration along the flow that linear extrapolation may imply [m/s²], see slope().
    Extrapolation(const Frame<D>& frame, real steepest)
        : frame_(frame),
          steepest_(steepest),
          h_min_(frame.h_min()),
          band_rows_(product(frame.cells) / static_cast<std::size_t>(frame.cells[0])),
          joins_(static_cast<std::size_t>(frame.cells[0]) + 1) {}
    /// Fills u on unknown faces (mark 0) up to `layers` faces away from known ones (mark 1) and marks them 1 + layer. It starts at the
    /// faces of cells near the surface and at `in_solids`; other faces are not used.
    void operator()(MacVelocity<D>& u, FaceMarks<D>& mark, const LevelSet<D>& surface, const FaceLists<D>& in_solids, int layers);
    std::size_t bytes() const {
        return (front_.capacity() + next_.capacity()) * sizeof(Index<D>) + value_.capacity() * sizeof(real) +
               own_.capacity() * sizeof(int) + band_rows_.capacity() * sizeof(Segment) + joins_.capacity();
    }

private:
    void refresh_marks(FaceMarks<D>& marks, int layers);
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
    std::vector<int> own_;                      // in parallel: indices in the front of the faces that this rank owns
    std::array<std::vector<char>, 2> near_of_;  // planes searched for layers, for faces along other axes and along the last
    std::vector<char> near_;                    // those of the present faces
    std::vector<Segment> band_rows_;            // per row of cells, the part within the layers from which the first front starts
    std::vector<std::uint8_t> joins_;           // of one row of faces
};

/// Sets every unmarked face to 0. Far from the liquid the old values are stale, and gravity would accelerate them forever.
template <int D>
void still_air(MacVelocity<D>& u, const FaceMarks<D>& known);

}  // namespace weir::free_surface
