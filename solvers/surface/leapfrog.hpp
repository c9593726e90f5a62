// The middle of a step. Surface and markers are where time() says at the end of a step and move with the velocity of its middle; forces and
// pressure act where they then stand, from the middle of one step to the middle of the next (leapfrog; Störmer 1907; Hairer, Lubich &
// Wanner 2003):
//   x(t + dt) = x(t) + dt u(t + dt/2),     u(t + dt/2 + dt'/2) = u(t + dt/2) + (dt/2 + dt'/2) a(x(t + dt))
// The next step dt' is not known when forces act: it is taken to be as long as this one, and the next force acts for what is then missing.
// So the energy of a wave neither grows nor falls, whatever the steps follow; forces that act for dt alone feed it where steps shorten as
// it gets faster, by ω² δdt/4 of its energy a second where steps swing by δdt.
#pragma once
#include "core/checkpoint.hpp"
#include "surface/extrapolate.hpp"

namespace weir::surface {

template <int D>
class Leapfrog {
public:
    Leapfrog() = default;
    explicit Leapfrog(const MacVelocity<D>& u);

    /// A step has been made, or restored.
    bool started() const { return any_; }
    /// The rate of change as a scene begins: u is what keep() saw, dt later.
    void begin(const MacVelocity<D>& u, real dt) { finish(u, dt), any_ = true; }
    /// u, of the middle of a step as long as the last one, becomes that of the middle of a step of dt.
    void advance(MacVelocity<D>& u, real dt) const;
    /// How long forces act in this step. `on_grid`: what is carried is what moves the liquid, else it is what the last step has left on
    /// markers.
    real kick(real dt, bool on_grid);
    /// The same where bodies or emitters are part of the step, and the velocity stays as forces left it: it is theirs, and light bodies do
    /// not bear a force that acts for longer or shorter than the flow does. What is carried then stays as far ahead as it was.
    real whole_kick(real dt);
    /// The velocity before forces act.
    void keep(const MacVelocity<D>& u);
    /// The same, and on which faces the liquid has brought one.
    void keep(const MacVelocity<D>& u, const FaceMarks<D>& known);
    /// The velocity after forces have acted for `kick`.
    void finish(const MacVelocity<D>& u, real kick);
    /// u at time(), where surface and markers are, of this rank's own planes and one beyond.
    const MacVelocity<D>& at_end(const MacVelocity<D>& u, const Frame<D>& frame) const;

    /// In parallel (MPI), gathers the rate of change of all ranks.
    void make_whole() {
        for (auto& rate : rate_.face) gather(rate);
    }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return rate_.bytes() + at_end_.bytes(); }

private:
    MacVelocity<D> rate_;  // of change, of the velocity [m/s²]; during a step the velocity before forces [m/s], none where it is infinite
    mutable MacVelocity<D> at_end_;
    real ahead_ = 0;    // of time(): the velocity that is carried [s]
    bool any_ = false;  // a step has been made
};

}  // namespace weir::surface
