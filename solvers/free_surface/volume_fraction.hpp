// The liquid volume fraction F of every cell; its sum changes only by declared sources and sinks. It is advected by geometric fluxes in
// direction-split sweeps (Weymouth & Yue 2010), with planes whose normals are those of the level set. The level set remains the geometry
// for everything else; after advection it is corrected locally to enclose F (coupled level set and volume of fluid: Sussman & Puckett 2000;
// mass-conserving level set: van der Pijl et al. 2005). Liquid or air in F too thin for the level set moves on to the surface.
#pragma once
#include "core/checkpoint.hpp"
#include "free_surface/level_set.hpp"
#include "mac/grid/state.hpp"

#include <vector>

namespace weir::free_surface {

template <int D>
class LiquidVolume {
public:
    LiquidVolume() = default;
    explicit LiquidVolume(const Frame<D>& frame);

    /// Initializes F from a level set. Cells cut by solids contain the liquid outside them.
    void start(const LevelSet<D>& surface, const MacState<D>& state);
    /// Updates the solids.
    void see_solids(const LevelSet<D>& surface, const MacState<D>& state);
    /// Advects F by dt in state.u, through the open fractions of faces. φ is that before the step; `reversed`: the order of the sweeps.
    /// Returns the volume that left through open sides [m^D].
    real advect(const MacState<D>& state, const Grid<real, D>& phi, real dt, bool reversed);
    /// Adds volume to a cell of this rank's own planes [cells].
    void add(const Index<D>& I, real cells) {
        if (frame_.own().contains(I[D - 1])) part_(I) += cells;
    }
    /// Adds the volume that a level set gained by a shift outwards, for a source or sink that moves the surface.
    void follow(const LevelSet<D>& surface, const MacState<D>& state, real shift);
    /// Redistributes volume outside [0, 1] to neighbours with room, and liquid or holes far from the surface to the surface. Conservative.
    void settle(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    /// Moves the surface so that in each neighbourhood it encloses the volume in F. The correction is proportional to the Courant number of
    /// the step: shorter steps do not correct more. φ is only approximately a distance.
    void correct(LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt, real courant);
    /// Courant number of a step dt for a flow that crosses `rate` cells per second. It includes the speed gained from gravity g over a
    /// cell, and the gravity wave of two cells (ω dt ≤ 1).
    real courant(real dt, real rate, real g) const;

    const Grid<real, D>& part() const { return part_; }
    real volume() const;  // [m^D]
    /// Gathers the planes of all ranks, where each rank stores all planes but computes only its own.
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
    /// Capacity of a cell: its open fraction outside solids.
    real capacity(std::size_t cell) const;
    bool may_have_rests(std::size_t first, int count, const Grid<real, D>& phi, const MacState<D>& state) const;
    void find_rests(const Grid<real, D>& phi, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    void distribute_excess(const Grid<real, D>& phi, const MacState<D>& state);
    template <class F>
    void for_each_near_line(F&& f) const;
    void compare(const LevelSet<D>& surface, const MacState<D>& state, const Grid<std::uint8_t, D>& exempt);
    std::array<real, 2> around(const Index<D>& I) const;
    void find_drops(const Grid<real, D>& phi, const MacState<D>& state);
    void join_drop(Grid<real, D>& phi, const Index<D>& I);

    Frame<D> frame_;
    real reach_ = 0;                // half width of the level set's band [m]
    Grid<real, D> part_, open_;     // open_: fractions outside solids; empty without solids
    Grid<real, D> dilation_;        // Σ c dC of the sweeps so far
    Grid<std::uint8_t, D> full_;    // c: F > ½ at the start of the step
    Grid<real, D> missing_, near_;  // F minus the fraction of φ; surface area per cell
    std::array<Grid<real, D>, D> flux_;
    std::vector<Segment> lines_, reach_of_;  // per line of cells: where F is not 0, and where it may become so
    struct Rest {
        std::size_t cell;
        real part;
        bool outwards;
    };
    std::vector<Rest> rests_;
    std::vector<std::size_t> drops_;
};

}  // namespace weir::free_surface
