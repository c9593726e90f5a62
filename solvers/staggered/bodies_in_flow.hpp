// Rigid bodies and the pressure as one system (Batty, Bertails & Bridson 2007). The fluid sees a body as a solid that moves: what its faces
// close, they push. With D_k the divergence that a unit of velocity k makes,
//
//     A p = −h² ρ/dt (∇·u* + Σ D_k V_k),      M (V − V*) = dt F,      F_k = ΔV Σ p D_k     [ΔV: volume of a cell]
//
// Each A φ_k = h² D_k gives a column of the grid's own added mass, m_kl = ρ ΔV D_k·φ_l, and V follows from (M + m) V: well posed for bodies
// that are lighter than the water, or weigh nothing. The same matrix is the metric of contacts, so that what touches stands still in the
// water too. Of a wall that cuts a cell the grid knows the pressure in the cell's middle alone: F takes it at the wall, by the gradient
// that water at rest has, so that a flat bottom floats between the cells too.
#pragma once
#include "core/hand.hpp"
#include "poisson/poisson.hpp"
#include "rigid/bodies.hpp"
#include "staggered/solid_faces.hpp"
#include "staggered/state.hpp"

#include <memory>
#include <vector>

namespace weir::staggered {

template <int D>
class BodiesInFlow {
public:
    explicit BodiesInFlow(const scene::Scene& scene);
    /// None where the scene names no bodies.
    static std::unique_ptr<BodiesInFlow> make(const scene::Scene& scene);
    /// The scene's solids, and behind them the bodies of `in`, which may be none.
    static geometry::Solids<D> solids(const scene::Scene& scene, BodiesInFlow* in);

    const rigid::Bodies<D>& bodies() const { return bodies_; }
    /// The hand may take hold of them; refuses keyframes of bodies that there are not.
    void follow(std::shared_ptr<Hand> hand, const scene::Scene& scene);
    /// What of them stands in fluid at t = 0.
    void start(const MacState<D>& s, const SolidPlacement<D>& solids);
    /// A time dt along their velocities.
    void fly(SolidPlacement<D>& solids, real dt);
    /// After the pressure was solved with the velocities of before: the velocities of now, and the pressure that belongs to them.
    /// `b` is the right-hand side that gave s.p; nullptr: there is no fluid.
    void react(MacState<D>& s, SolidPlacement<D>& solids, real dt, poisson::Solver<D>* solver, Grid<real, D>* b);

    const Vec<D>& gravity() const { return gravity_; }
    /// Added mass and mass of the last step, free of what was held, for tests and studies.
    const rigid::Mobility& added_mass() const { return added_; }
    void save(Checkpoint& to) const { bodies_.save(to); }
    void restore(const Checkpoint& from, SolidPlacement<D>& solids);
    std::size_t bytes() const;

private:
    static constexpr std::size_t n = rigid::freedoms<D>;
    /// A face whose velocity is a body's.
    struct Face {
        int axis;
        std::size_t face;
        rigid::Twist<D> moves;  // its velocity by each of the body's
    };
    /// A cell that a body cuts.
    struct Cut {
        std::size_t cell;
        rigid::Twist<D> out;  // ΔV D_k: what of the cell's fluid each velocity pushes out [m^D/s by m/s or rad/s]
        real below = 0;       // g · (wall − middle of the cell), and of the wall from the body's centre of mass [m²/s²]
        real deep = 0;
    };
    void find_cuts(const MacState<D>& s, const SolidPlacement<D>& solids);
    void find_faces(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t body);
    Cut& cut(std::size_t cell, std::size_t body);
    void set_velocities(MacState<D>& s) const;
    void scatter(std::size_t body, const rigid::Twist<D>& velocity, real scale, Grid<real, D>& to) const;
    rigid::Twist<D> push(std::size_t body, const Grid<real, D>& p) const;
    rigid::Twist<D> force(const MacState<D>& s, std::size_t body) const;
    real wet_part(const MacState<D>& s, std::size_t body) const;
    rigid::Twist<D> weight(std::size_t body) const;
    std::array<rigid::Twist<D>, n> mass_of(std::size_t body) const;
    void add_mass(const MacState<D>& s, poisson::Solver<D>* solver);
    /// Of the body that the hand holds: what its pull adds to the matrix of masses and to the impulses.
    void be_held(const MacState<D>& s, real dt, std::vector<real>& impulse);
    real held_mass(std::size_t body) const;
    Vec<D> held_target(const Brush<D>& brush, const MacState<D>& s, real dt) const;
    void tell_hand(const MacState<D>& s, real dt);
    void move_under_forces(const MacState<D>& s, real dt);
    void touch(const geometry::Solids<D>& solids, real dt);

    rigid::Bodies<D> bodies_;
    rigid::Contacts<D> contacts_;
    Vec<D> gravity_{};
    real rho_ = 1, cell_ = 0, h2_ = 0;
    Vec<D> h_{};
    std::vector<std::vector<Face>> faces_;  // of each body, those that it closes, wholly or in part
    std::vector<std::vector<Cut>> cuts_;
    Grid<real, D> rhs_, phi_;
    rigid::Mobility added_, total_, mobility_;
    std::shared_ptr<Hand> hand_;  // none: nobody takes hold
    std::vector<char> free_;
    std::vector<real> velocity_, before_;
};

}  // namespace weir::staggered
