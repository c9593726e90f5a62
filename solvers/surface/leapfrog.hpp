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
    /// `whole`: forces act for the step that they are in, and the next one takes the velocity as they left it: light bodies do not bear a
    /// force that acts for longer or shorter than the flow does.
    explicit Leapfrog(const MacVelocity<D>& u, bool whole = false);

    /// A step has been made, or restored.
    bool started() const { return any_; }
    /// The rate of change as a scene begins: u is what keep() saw, dt later.
    void begin(const MacVelocity<D>& u, real dt) { find_rate(u, dt), any_ = true; }
    /// u(t), as it is between steps, becomes u(t + dt/2).
    void advance(MacVelocity<D>& u, real dt) const { add(u, whole_ ? ahead_ : 0.5 * dt); }
    /// How long forces act in this step. `on_grid`: what is carried is u(t + dt/2), else it is what the last step has left on markers.
    real kick(real dt, bool on_grid);
    /// Markers carry u(t): it has been given to them between steps.
    void take_present() { ahead_ = 0; }
    /// The velocity before forces act, and on which faces the liquid has brought one.
    void keep(const MacVelocity<D>& u, const FaceMarks<D>& known);
    /// u, which forces and pressure have brought to the middle of a next step of dt, becomes what it is at the end of this one.
    void retreat(MacVelocity<D>& u, real kick);

    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);
    std::size_t bytes() const { return rate_.bytes(); }

private:
    void add(MacVelocity<D>& u, real time) const;
    void find_rate(const MacVelocity<D>& u, real dt);

    MacVelocity<D> rate_;  // of change, of the velocity [m/s²]; during a step the velocity before forces [m/s], none where it is infinite
    real ahead_ = 0;       // of time(): the velocity that is carried [s]
    bool any_ = false, whole_ = false;  // any_: a step has been made
};

}  // namespace weir::surface
