// The liquid part F of every cell, which only declared sources and sinks change in sum: moved by geometric fluxes in direction-split sweeps
// (Weymouth & Yue 2010), with planes whose normals are those of the level set. The level set stays the geometry that everything else looks
// at; after it has moved it is corrected, locally, to enclose what F holds (coupled level set and volume of fluid: Sussman & Puckett 2000;
// mass-conserving level set: van der Pijl et al. 2005). What F says of liquid or air too thin for the level set moves on to the surface.
#pragma once
#include "core/checkpoint.hpp"
#include "staggered/state.hpp"
#include "surface/level_set.hpp"

#include <vector>

namespace weir::surface {

template <int D>
class LiquidVolume {
public:
    LiquidVolume() = default;
    explicit LiquidVolume(const Frame<D>& frame);

    /// F of a level set. Cells that solids cut hold what is outside them.
    void start(const LevelSet<D>& surface, const MacState<D>& state);
    /// Where they stand now.
    void see_solids(const LevelSet<D>& surface, const MacState<D>& state);
    /// Moves F by dt in state.u, through the open parts of faces; φ is of before the step, `reversed` the order of the sweeps. Answers
    /// what has left through open sides [m^D].
    real advect(const MacState<D>& state, const Grid<real, D>& phi, real dt, bool reversed);
    /// Adds to a cell of this rank's own planes [cells].
    void add(const Index<D>& I, real cells) {
        if (is_own_plane(I[D - 1])) part_(I) += cells;
    }
    /// What a level set has gained that has been moved outwards by `shift`, for a source or sink that moves the surface.
    void follow(const LevelSet<D>& surface, const MacState<D>& state, real shift);
    /// Hands on what no cell can hold (F > 1, F < 0), towards where there is room; and what stands deep in the liquid or just outside it
    /// to the surface. Nothing is lost.
    void settle(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    /// Moves the surface so that in each neighbourhood it encloses what F holds, by a part of the way that goes with the step's Courant
    /// number: shorter steps do not correct it more often. φ is a distance only nearly.
    void correct(LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt, real courant);
    /// Of a step of dt while the fastest flow crosses `rate` cells a second: with the speed that gravity g adds in a cell, and the gravity
    /// wave of two cells (ω dt ≤ 1).
    real courant(real dt, real rate, real g) const;

    const Grid<real, D>& part() const { return part_; }
    real volume() const;  // [m^D]
    /// Gathers the planes of all ranks, where each rank stores all planes and keeps its own.
    void make_whole() { gather(part_); }
    void save(Checkpoint& to) const;
    static bool is_saved(const Checkpoint& from) { return from.has("surface.liquid_part"); }
    void restore(const Checkpoint& from);
    std::size_t bytes() const;

private:
    struct Sweep {
        int axis;
        real scale;  // dt/h
        const real *u, *open;
        const Grid<real, D>* phi;
        real* flux;
    };
    template <class F>
    void for_each_own_line(int below, int above, bool ring, F&& f) const;
    void find_reach(bool within = false);
    void sweep(const MacState<D>& state, const Grid<real, D>& phi, real dt, int axis, real& departed);
    void find_fluxes(const Sweep& s, std::size_t face, std::size_t lower, std::size_t upper, int count);
    void find_side_flux(const Sweep& s, const MacState<D>& state, const Index<D>& I, std::size_t face);
    void add_fluxes(const Sweep& s, const Grid<real, D>& flux);
    real through_side(const Grid<real, D>& flux, int axis, int side) const;
    Vec<D> normal(const Grid<real, D>& phi, const Index<D>& I) const;
    real liquid_through(const Grid<real, D>& phi, const Index<D>& donor, int axis, real courant) const;
    real rest_of(std::size_t cell, real phi, const Grid<std::uint8_t, D>& exempt) const;
    /// What a cell can hold: its part outside solids.
    real capacity(std::size_t cell) const;
    bool may_have_rests(std::size_t first, int count, const Grid<real, D>& phi, const MacState<D>& state) const;
    void find_rests(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    void hand_on(const Grid<real, D>& phi, const MacState<D>& state);
    template <class F>
    void for_each_near_line(F&& f) const;
    void compare(const LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    std::array<real, 2> around(const Index<D>& I) const;
    void find_drops(const Grid<real, D>& phi, const MacState<D>& state);
    void join_drop(Grid<real, D>& phi, const Index<D>& I);

    Frame<D> frame_;
    real reach_ = 0;                // of the level set's band [m]
    Grid<real, D> part_, open_;     // open_: parts outside solids; none without solids
    Grid<real, D> dilation_;        // Σ c dC of the sweeps so far
    Grid<std::uint8_t, D> full_;    // c: F > ½ as the step began
    Grid<real, D> missing_, near_;  // F − φ's fraction, and how much surface a cell has
    std::array<Grid<real, D>, D> flux_;
    std::vector<Extent> lines_, reach_of_;  // of every line of cells: where F is not 0, and where it may come to be
    struct Rest {
        std::size_t cell;
        real part;
        bool outwards;
    };
    std::vector<Rest> rests_;
    std::vector<std::size_t> drops_;
};

}  // namespace weir::surface
