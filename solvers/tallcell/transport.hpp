// Du/Dt = 0 on tall cells, by semi-Lagrangian advection (Stam 1999) or MacCormack's correction of it (Selle, Fedkiw, Kim, Liu & Rossignac
// 2008) on the lattice's velocity. Regular faces move as on the uniform grid. Rows inside tall cells change as the two Gauss points of
// their run do, linearly between: what rows the mesh restricts to its samples is that of the lattice plus the samples' own change.
#pragma once
#include "surface/marker_motion.hpp"
#include "tallcell/near_rows.hpp"
#include "tallcell/pressure.hpp"

namespace weir::tallcell {

template <int D>
class Transport {
public:
    Transport() = default;
    Transport(const Frame<D>& frame, const MacVelocity<D>& u, bool maccormack, int reach);
    /// u of all faces near the liquid, dt later. u must be known throughout the level set's band.
    void operator()(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, MacVelocity<D>& u);
    std::size_t bytes() const { return before_.bytes() + predicted_.bytes(); }

private:
    template <bool Correct>
    void pass(const TallPressure<D>& mesh, const Grid<real, D>& phi, const geometry::Sides<D>& sides, real dt, real near,
              MacVelocity<D>& to, MacVelocity<D>* runs_too) const;
    void keep_sides(MacVelocity<D>& to) const;
    void move_run(int a, Index<D> I, int up, const Run& run, real dt, Grid<real, D>& to, Grid<real, D>* also) const;
    bool move_run_of_eight(int a, Index<D> I, int up, const Run& run, real dt, Grid<real, D>& to, Grid<real, D>* also) const;
    template <bool Correct>
    bool move_eight(int a, const Index<D>& I, real dt, Eight& to) const;
    real at_point(const Grid<real, D>& u, int a, const Vec<D>& s) const;
    Stencil<D> stencil(const Vec<D>& s) const;
    Vec<D> moved(const Vec<D>& s, const Vec<D>& here, real dt) const;
    Vec<D> speed(const Vec<D>& s) const;
    real departed(int a, const Vec<D>& s, real dt) const;
    real corrected(int a, const Vec<D>& s, real here, real dt) const;

    Frame<D> frame_;
    bool maccormack_ = true, open_above_ = false;
    int up_ = 1;
    int reach_ = 1;  // cells that a point may travel in one step
    MacVelocity<D> before_, predicted_;
};

}  // namespace weir::tallcell
