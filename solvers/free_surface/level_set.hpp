// The free surface as the zero of a signed distance φ (negative in the liquid) in a narrow band of cells.
//   motion          Dφ/Dt = 0: semi-Lagrangian, RK2 trace, tensor cubic interpolation (Strain 1999)
//   distance        |∇φ| = 1: first-order upwind differences (Rouy & Tourin 1992; Zhao 2005), layer by layer outwards from the cells
//                   beside the surface, whose values are kept: the zero level set does not move
//   markers         an escaped marker shows that the level set lost liquid: φ = min(φ, |x − x_p| − r) (Foster & Fedkiw 2001; Enright
//                   et al. 2002)
// In parallel each rank computes the values of its own planes of cells; it finds the band there and in the ghost planes that determine its
// own part. The level set is thus the smooth part of the markers' shape: second order where the grid resolves it, and exactly at rest for
// liquid at rest.
#pragma once
#include "core/checkpoint.hpp"
#include "free_surface/level_set_ranks.hpp"
#include "free_surface/marker_motion.hpp"
#include "free_surface/markers.hpp"
#include "free_surface/plane_cut.hpp"
#include "free_surface/thin_walls.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace weir::free_surface {

template <int D>
class LevelSet {
public:
    Grid<real, D> phi;  // [m] at cell centres; ± cap() outside the band

    LevelSet() = default;
    /// `reach`: largest motion of the surface in one step [cells].
    LevelSet(const Frame<D>& frame, int reach);

    /// Sets the cells that are closed to the liquid. Their φ is extrapolated from open cells, so the contact angle at a solid is 90
    /// degrees. `faces`: closed faces, some of which may lie between open cells.
    void set_closed(const Grid<std::uint8_t, D>& closed, const std::array<std::vector<Index<D>>, D>* faces = nullptr);
    /// Sets the open fractions of cells from the solids' distances at their corners; call it after solids were placed.
    void set_open_parts(const SolidPlacement<D>& solids);
    real open_part(const Index<D>& I) const { return open_part_.empty() ? 1 : open_part_(I); }
    /// φ at x, from the same side of thin walls.
    real at(const Vec<D>& x) const;
    /// φ around cell I as seen from its side of a thin wall; false, with no result, where no wall is near: then phi is valid.
    bool look(const Index<D>& I, int reach, Around<D>& to) const;
    /// Returns whether liquid can pass from cell I to its neighbour, if there is one.
    bool passes(const Index<D>& I, int axis, int by) const;
    /// Moves the surface by dt in the field u, which must be known throughout the band. `reach`: in parallel, the number of ghost planes
    /// that a rank reads.
    void advect(const MacVelocity<D>& u, real dt, int reach = 0);
    /// In parallel, gathers φ from all ranks.
    void gather_whole() { gather(phi); }
    /// Particle level-set correction: unites the liquid with spheres around escaped markers. Returns how many of this rank's own markers
    /// had escaped. Markers must be sorted. `part`, if given: the liquid fraction of each cell; a marker in a cell without liquid is
    /// ignored.
    std::size_t correct_with_particles(const Markers<D>& markers, const Grid<real, D>* part = nullptr);
    /// Number of this rank's own escaped markers still outside the surface: drops too small for the grid.
    std::size_t count_airborne(const Markers<D>& markers) const;
    /// Reinitializes φ to a signed distance and finds the band.
    void redistance();
    /// φ −= shift within the band: moves the surface outwards by `shift` [m].
    void dilate(real shift);
    /// Volume correction: moves the surface outwards by the missing volume [m^D] over its area, at most a fiftieth of a cell, which is less
    /// than its motion. Returns the distance [m].
    real regain(real missing);
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);

    real cap() const { return (layers_ + 1) * frame_.h_max(); }
    int layers() const { return layers_; }
    /// Cells of the band, layer by layer from the surface; layer 1 is beside it. In parallel, those near this rank's planes, in the order
    /// of one process.
    const std::vector<Index<D>>& band() const { return band_; }
    /// Closed cells beside open ones, three layers deep.
    const std::vector<Index<D>>& skin() const { return skin_; }
    /// 1.. in the band, 0 outside it.
    const Grid<std::uint8_t, D>& layer() const { return layer_; }
    std::size_t layer_begin(int layer) const { return layer_start_[static_cast<std::size_t>(layer - 1)]; }
    std::size_t layer_end(int layer) const { return layer_start_[static_cast<std::size_t>(layer)]; }

    /// Liquid fraction of a cell, in [0, 1], with φ lowered by `shift`. φ is a plane in each half cell along every axis: exact for planes,
    /// and sheets or drops thinner than a cell keep their volume.
    real fraction(const Index<D>& I, real shift = 0) const;
    /// Centroid of the liquid in a cell relative to its centre [cells], times the fraction, with the same planes.
    Vec<D> moment(const Index<D>& I) const;
    real volume() const;  // [m^D] of liquid in the open parts of cells
    real area() const;    // [m^(D−1)] of the surface, from the derivative of the volume with respect to φ
    std::size_t bytes() const;

private:
    template <class F>
    void for_each_open_beside_closed(const std::vector<char>& planes, F&& f) const;
    void find_skin(const std::vector<char>& planes);
    void continue_layer(std::size_t first, std::size_t last);
    void share_skin(bool distributed);
    void uncover(const Grid<std::uint8_t, D>& closed);
    void continue_into_solids();
    /// Width of the cell normal to the surface near it [m].
    real width_at(const Index<D>& I) const;
    /// In cells that are not cubes: a marker has escaped when its distance outside exceeds a part of the cell's width in that direction.
    bool escaped_across(const Vec<D>& x) const;
    void join_sphere(const Vec<D>& x, real radius);
    template <class F>
    void for_each_escaped(F&& f) const;
    /// Differences of φ to the lower and the upper neighbour. Beyond a wall, and where a neighbour's distance is unknown, the difference of
    /// the other side is used.
    std::array<Vec<D>, 2> slopes(const Index<D>& I) const;
    std::array<Vec<D>, 2> slopes_on_this_side(const Index<D>& I) const;
    bool crosses_on_this_side(const Index<D>& I) const;
    bool sees_walls(const Index<D>& I) const { return walls_.is_near(I) && closed_(I) == 0; }
    bool joins(const Index<D>& I, int axis, int by) const;
    void find_inside();
    /// Ghost planes in which a rank finds the band: the distance between a cell of the last layer and a cell near its root, when both
    /// belong to one rank.
    int wide() const { return 2 * layers_; }
    void find_near();
    bool is_near(int plane) const { return near_.empty() || near_[static_cast<std::size_t>(plane)] != 0; }
    void find_surface();
    void collect_surface();
    void join_layers();
    void mark_changes_of_sign(const Index<D>& first, std::size_t at);
    void find_own();
    /// f(index in the band) for the entries [first, last) in this rank's own planes.
    template <class F>
    void for_each_own(std::size_t first, std::size_t last, F&& f) const;
    template <class F>
    real sum_over_band(int layers, F&& f) const;
    bool crosses_in_liquid(const Index<D>& I) const;
    void rescale_surface();
    void grow_band();
    void fill_layer(int layer);
    real upwind_distance(const Index<D>& I, int layer) const;
    real departed(const MacVelocity<D>& u, const Index<D>& I, real dt) const;
    real cubic(const Vec<D>& x) const;
    real cubic_on_this_side(const Index<D>& I, Vec<D> d) const;
    real cubic_near(const Index<D>& I, const Vec<D>& d) const;

    Frame<D> frame_;
    int layers_ = 4, reach_ = 1;
    real diagonal_ = 0;                              // of a cell [m]
    Grid<std::uint8_t, D> layer_, inside_, closed_;  // layer_: 1.. in the band, 0 outside; inside_: φ < 0, as of find_inside()
    std::vector<Index<D>> band_, skin_;
    std::vector<std::size_t> layer_start_;
    std::vector<real> value_;
    std::vector<std::uint8_t> escaped_;
    std::vector<int> own_;    // in parallel: indices in the band of this rank's own cells
    std::vector<char> near_;  // in parallel: the planes in which the band is found
    SkinOfRanks<D> skin_of_ranks_;
    std::vector<std::size_t> skin_end_;  // of each of its layers
    ThinWalls<D> walls_;
    Grid<real, D> open_part_;  // empty without solids
};

template <int D>
template <class F>
void LevelSet<D>::for_each_own(std::size_t first, std::size_t last, F&& f) const {
    if (!frame_.own().distributed()) return parallel_for(static_cast<int>(first), static_cast<int>(last), f);
    const auto place = [&](std::size_t at) { return std::lower_bound(own_.begin(), own_.end(), static_cast<int>(at)) - own_.begin(); };
    parallel_for(static_cast<int>(place(first)), static_cast<int>(place(last)), [&](int i) { f(own_[static_cast<std::size_t>(i)]); });
}

/// The part of a cell outside solids: below the plane fitted to the distances at its corners.
template <int D>
real open_part_of_cell(const SolidPlacement<D>& solids, const Index<D>& I);
/// Integral over the unit cube about 0 of x where value + g·x < 0.
template <int D>
Vec<D> moment_below_plane(real value, const Vec<D>& g);
/// Mean of fraction_below_plane() over the half cells along every axis, with φ a plane in each: slope[0] and slope[1] are the differences
/// of φ to the lower and the upper neighbour.
template <int D>
real fraction_of_halves(real phi, const std::array<Vec<D>, 2>& slope);

}  // namespace weir::free_surface
