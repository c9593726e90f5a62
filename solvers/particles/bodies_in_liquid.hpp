// Rigid bodies among particles. To a particle a body is what any solid is, a part of its kernel (solid_terms.hpp), so what the body does to
// the particle is known, and the particle does the opposite to the body, at its own place: momentum is kept to round-off.
//
// A body may be lighter than the water that it moves, or weigh nothing. What it feels in a step depends on how it moves in that step: where
// it closes on a particle by u along the gradient w of the kernel's part inside it, the particle gets k w (w.u) less or more, with a k that
// the method knows: of SPH the pressure that follows in one step, of PBF the multiplier that follows in one iteration. The velocities of
// the bodies solve
//
//     (M + K) dV = P,    K = sum over particles of m k w w^T,  as a rigid velocity sees w,    P = -sum of m times what particles are given
//
// and each particle is given k w (w.dV) back. K is the added mass of that water which learns of the body's motion in the step, so nothing
// has to be guessed, no force is delayed, and the sum of all momenta is what it was.
#pragma once
#include "core/hand.hpp"
#include "particles/fluid.hpp"
#include "rigid/bodies.hpp"

#include <memory>
#include <vector>

namespace weir::particles {

/// A particle and the body next to it.
template <int D>
struct Meeting {
    int particle = -1;         // its number, whatever the caller counts
    std::ptrdiff_t body = -1;  // -1: none
    Vec<D> at{};               // where the particle is [m]
    Vec<D> pull{};            // gradient of the kernel's part inside the body, what walls hide of it taken off; or a unit normal [1/m or 1]
    real part = 0, open = 1;  // the kernel's part inside the body, and how much of it walls do not hide
    Vec<D> given{};           // velocity that the body gives the particle [m/s]
    real stiff = 0;           // and how much of the body's change along `pull` [m^2 or 1], across it
    real rub = 0;
};

template <int D>
class BodiesInLiquid {
public:
    /// None where the domain has no bodies.
    static std::unique_ptr<BodiesInLiquid> make(const Fluid<D>& fluid);
    explicit BodiesInLiquid(const Fluid<D>& fluid);

    const rigid::Bodies<D>& bodies() const { return *bodies_; }
    const Vec<D>& gravity() const { return gravity_; }
    /// Of the fastest point of a body [m/s].
    real speed() const { return bodies_->max_rate(1); }
    /// Who meets whom: filled by a method before each exchange.
    std::vector<Meeting<D>>& meetings() { return meetings_; }
    const std::vector<Meeting<D>>& meetings() const { return meetings_; }

    /// A time over the length of the last step; 0 before the first.
    real over_last(real dt) const { return last_dt_ > 0 ? dt / last_dt_ : 0; }
    /// The hand may take hold of them; refuses keyframes of bodies that there are not.
    void follow(std::shared_ptr<Hand> hand, const scene::Scene& scene);
    /// A step from `time` on: remembers where bodies are, what they may touch in it, and which of them the hand holds.
    void begin(const Domain<D>& domain, real time, real dt);
    /// That, and they fall by their weight, and go where their velocities take them in dt.
    void fall(Domain<D>& domain, real time, real dt);
    /// New velocities of bodies from all meetings, from their weight where `heavy`, and from what they touch. Meetings then say what
    /// particles have been given in all.
    void exchange(Domain<D>& domain, real dt, bool heavy);
    /// What of it came back by the body's own change.
    Vec<D> back(const Meeting<D>& m) const { return m.stiff * closing(m) * m.pull + m.rub * across(m); }
    /// pull . change of the body's velocity there.
    real closing(const Meeting<D>& m) const { return dot(m.pull, change_at(m)); }
    /// From where the step began along the velocities, for its length.
    void move(Domain<D>& domain, real dt);
    /// A meeting with a body that would have had the particle inside, which has been put out of it.
    void push_out(const Domain<D>& domain, int particle, const Vec<D>& free, real dt);
    /// slow: of what particles gave in this step, velocities keep that over the longer of this step and the last (solvers/pbf).
    void end(Domain<D>& domain, real dt, real slow);

    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from, Domain<D>& domain);
    std::size_t bytes() const;

private:
    static constexpr std::size_t n = rigid::freedoms<D>;
    using Twist = rigid::Twist<D>;
    using Matrix = std::array<Twist, n>;
    Vec<D> change_at(const Meeting<D>& m) const;
    Vec<D> across(const Meeting<D>& m) const;
    /// A push along `along` at x, as a rigid velocity of body b sees it.
    Twist seen(std::size_t b, const Vec<D>& x, const Vec<D>& along) const;
    void sum_up();
    void solve_for_velocities(real dt, bool heavy);
    void count_forces();
    void be_held(real time, real dt);
    void tell_hand(bool heavy);

    std::shared_ptr<rigid::Bodies<D>> bodies_;
    Vec<D> gravity_{};
    real mass_ = 0, spacing_ = 0, rho0_ = 0;  // of a particle [kg], between particles [m], and of the liquid [kg/m^3]
    std::vector<Meeting<D>> meetings_;
    std::vector<rigid::Body<D>> start_;            // bodies where the step began, none lighter than can be carried
    std::vector<char> dry_, wet_;                  // no fluid and nothing else touched it in the step before; fluid does now
    rigid::Contacts<D> contacts_;                  // of the step: each exchange goes on with the impulses of those before
    std::vector<Twist> impulse_, force_, gained_;  // of one exchange; of the step, from the fluid; velocity, from the fluid
    std::vector<Matrix> matrix_;
    real last_dt_ = 0;
    std::shared_ptr<Hand> hand_;  // none: nobody takes hold
    /// Of the body that it holds in this step: the impulse is weight (target - V).
    struct {
        int body = -1;
        real weight = 0;
        Vec<D> target{};
    } hold_;
    rigid::Mobility own_, inverse_, mobility_;
    std::vector<char> free_;
    std::vector<real> velocity_, before_, change_;
};

}  // namespace weir::particles
