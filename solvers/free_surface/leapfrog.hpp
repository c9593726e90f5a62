// Leapfrog time integration. At the end of a step surface and markers are at time(); they move with the velocity at the middle of the step.
// Forces and pressure act at their positions, from the middle of one step to the middle of the next (Störmer 1907; Hairer, Lubich & Wanner
// 2003):
//   x(t + dt) = x(t) + dt u(t + dt/2),     u(t + dt/2 + dt'/2) = u(t + dt/2) + (dt/2 + dt'/2) a(x(t + dt))
// The next step dt' is not known when forces act: it is assumed equal to this one, and the next force corrects the difference. So the
// energy of a wave neither grows nor falls, for any sequence of steps. Forces that act for dt alone add energy where steps shorten as the
// wave gets faster: ω² δdt/4 of its energy per second where steps vary by δdt.
#pragma once
#include "core/checkpoint.hpp"
#include "free_surface/extrapolate.hpp"

namespace weir::free_surface {

template <int D>
class Leapfrog {
public:
    Leapfrog() = default;
    explicit Leapfrog(const MacVelocity<D>& u);

    /// Returns whether a step was made or restored.
    bool started() const { return any_; }
    /// The rate of change at the start of a scene: u is the velocity passed to keep(), dt later.
    void begin(const MacVelocity<D>& u, real dt) { finish(u, dt), any_ = true; }
    /// Moves u from the middle of a step as long as the last one to the middle of a step of dt.
    void advance(MacVelocity<D>& u, real dt) const;
    /// Duration of the forces in this step. `on_grid`: the carried velocity is the one that moves the liquid; otherwise it is the one that
    /// the last step stored on markers.
    real kick(real dt, bool on_grid);
    /// The same with bodies or emitters, which share the velocity after forces: light bodies require forces to act exactly for the flow's
    /// step. The carried velocity keeps its time offset.
    real whole_kick(real dt);
    /// Stores the velocity before forces act.
    void keep(const MacVelocity<D>& u);
    /// The same for the faces whose velocity is known.
    void keep(const MacVelocity<D>& u, const FaceMarks<D>& known);
    /// Computes the rate from the velocity after forces have acted for `kick`.
    void finish(const MacVelocity<D>& u, real kick);
    /// u at time(), the time of surface and markers, on this rank's own planes and one ghost plane.
    const MacVelocity<D>& at_end(const MacVelocity<D>& u, const Frame<D>& frame) const;

    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return rate_.bytes() + at_end_.bytes(); }

private:
    MacVelocity<D> rate_;  // rate of change [m/s²]; during a step the velocity before forces [m/s], unknown where infinite
    mutable MacVelocity<D> at_end_;
    real ahead_ = 0;    // time of the carried velocity minus time() [s]
    bool any_ = false;  // a step was made
};

}  // namespace weir::free_surface
