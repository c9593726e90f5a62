// Coupling of rigid bodies and particles. For a particle a body is like any solid, a covered part of its kernel (solid_terms.hpp). The
// force of the body on the particle is known, and the particle exerts the opposite force at its position: momentum is conserved to
// round-off.
//
// A body may be lighter than the displaced liquid, or massless, so the coupling is implicit. Where it approaches a particle with speed u
// along the gradient w of the covered part of the kernel, the particle's velocity change is reduced by k w (w.u). The method provides k:
// for SPH from the pressure after one step, for PBF from the multiplier after one iteration. The changes of the bodies' velocities solve
//
//     (M + K) dV = P,    K = sum over particles of m k w w^T  in rigid velocities,    P = -sum of m times the particles' velocity changes
//
// and each particle gets k w (w.dV) in return. K is the added mass of the liquid that responds within the step. No added mass is estimated,
// no force is delayed, and total momentum is conserved.
#pragma once
#include "core/brush.hpp"
#include "particles/state/fluid.hpp"
#include "rigid/bodies.hpp"

#include <memory>
#include <vector>

namespace weir::particles {

/// A coupling pair: a particle and the closest body.
template <int D>
struct Meeting {
    int particle = -1;         // index of the particle, in the caller's numbering
    std::ptrdiff_t body = -1;  // -1: none
    Vec<D> at{};               // where the particle is [m]
    Vec<D> pull{};             // gradient of the kernel's part inside the body, reduced by walls; or a unit normal [1/m or 1]
    real part = 0, open = 1;   // the kernel's part inside the body, and its fraction not hidden by walls
    Vec<D> given{};            // velocity change of the particle due to the body [m/s]
    real stiff = 0;            // response to the body's velocity change along `pull` [m^2 or 1], and across it
    real friction = 0;
};

template <int D>
class BodiesInLiquid {
public:
    /// nullptr where the domain has no bodies.
    static std::unique_ptr<BodiesInLiquid> make(const Fluid<D>& fluid);
    explicit BodiesInLiquid(const Fluid<D>& fluid);

    const rigid::Bodies<D>& bodies() const { return *bodies_; }
    const Vec<D>& gravity() const { return gravity_; }
    /// Maximum speed of a point of a body [m/s].
    real speed() const { return bodies_->max_rate(1); }
    /// The coupling pairs: filled by a method before each exchange.
    std::vector<Meeting<D>>& meetings() { return meetings_; }
    const std::vector<Meeting<D>>& meetings() const { return meetings_; }

    /// Ratio of a time to the last step; 0 before the first.
    real over_last(real dt) const { return last_dt_ > 0 ? dt / last_dt_ : 0; }
    /// Enables interactive forcing of the bodies; rejects keyframes with a body index out of range.
    void follow(std::shared_ptr<BrushForcing> forcing, const scene::Scene& scene);
    /// Begins a step at `time`: stores the bodies' state, finds possible contacts, and the body grabbed by interactive forcing.
    void begin(const Domain<D>& domain, real time, real dt);
    /// The same; then applies gravity and moves the bodies for a time dt.
    void fall(Domain<D>& domain, real time, real dt);
    /// Computes the bodies' velocities from all pairs, contacts, and, if `heavy`, gravity. Afterwards the pairs contain the total velocity
    /// change of their particles.
    void exchange(Domain<D>& domain, real dt, bool heavy);
    /// The part of that due to the body's own velocity change.
    Vec<D> back(const Meeting<D>& m) const { return m.stiff * closing(m) * m.pull + m.friction * across(m); }
    /// pull . change of the body's velocity at the particle.
    real closing(const Meeting<D>& m) const { return dot(m.pull, change_at(m)); }
    /// Moves the bodies from their positions at the start of the step with their velocities.
    void move(Domain<D>& domain, real dt);
    /// Adds a pair for a particle that was moved out of a body.
    void push_out(const Domain<D>& domain, int particle, const Vec<D>& free, real dt);
    /// slow: the time of PBF's velocity update, the longer of this step and the last, is applied to the particles' impulses (solvers/pbf).
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
    /// A force along `along` at x, in the rigid velocities of body b.
    Twist seen(std::size_t b, const Vec<D>& x, const Vec<D>& along) const;
    void sum_up();
    void solve_for_velocities(real dt, bool heavy);
    void count_forces();
    void apply_grab(real time, real dt);
    void record_brush_impulse(bool heavy);

    std::shared_ptr<rigid::Bodies<D>> bodies_;
    Vec<D> gravity_{};
    real mass_ = 0, spacing_ = 0, rho0_ = 0;  // of a particle [kg], spacing [m], density of the liquid [kg/m^3]
    std::vector<Meeting<D>> meetings_;
    std::vector<rigid::Body<D>> start_;            // bodies at the start of the step, with the minimum density
    std::vector<char> dry_, wet_;                  // no contact with fluid or anything else in the last step; contact with fluid now
    rigid::Contacts<D> contacts_;                  // of the step: each exchange starts from the impulses of the previous ones
    std::vector<Twist> impulse_, force_, gained_;  // of one exchange; of the step, from the fluid; velocity change by the fluid
    std::vector<Matrix> matrix_;
    real last_dt_ = 0;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr: no interactive forcing
    /// The body that is grabbed in this step: the impulse is weight (target - V).
    struct {
        int body = -1;
        real weight = 0;
        Vec<D> target{};
    } grab_;
    rigid::Mobility own_, inverse_, mobility_;
    std::vector<char> free_;
    std::vector<real> velocity_, before_, change_;
};

}  // namespace weir::particles
