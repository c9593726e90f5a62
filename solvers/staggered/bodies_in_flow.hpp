// Rigid bodies and the pressure as one system (Batty, Bertails & Bridson 2007). The fluid sees a body as a solid that moves: what its faces
// close, they push. With D_k the divergence that a unit of velocity k makes,
//
//     A p = −h² ρ/dt (∇·u* + Σ D_k V_k),      M (V − V*) = dt F,      F_k = ΔV Σ p D_k     [ΔV: volume of a cell]
//
// Eliminating p leaves (M + m) V with the grid's own added mass m_kl = ρ ΔV D_k·A⁻¹ h² D_l: well posed for bodies that are lighter than the
// water, or weigh nothing. Eliminating V leaves (A + U C Uᵀ) p with as few columns as the bodies have freedoms: the multigrid of A solves
// it in an iteration or two more, as long as the added mass is not many times the body's own, and such bodies are part of the matrix. What
// is lighter, and contacts, are met by turns, the pressure with the velocities that are known and the velocities with the pressure, where
// an estimate of m that learns from every turn (rigid/added_mass.hpp) says how far to go; contacts are met in the same metric. The pressure
// of a turn is solved as far as the velocities are known, so that all turns together cost little more than one solve. Of a wall that cuts a
// cell the grid knows the pressure in the cell's middle alone: F takes it at the wall, by the gradient that water at rest has, so that a
// flat bottom floats between the cells too.
#pragma once
#include "core/hand.hpp"
#include "poisson/poisson.hpp"
#include "rigid/added_mass.hpp"
#include "rigid/bodies.hpp"
#include "staggered/solid_faces.hpp"
#include "staggered/state.hpp"
#include "staggered/wall_grip.hpp"

#include <memory>
#include <vector>

namespace weir::staggered {

/// Where a scene's fluid sticks to bodies its friction is of the end of the step.
void refuse_friction_of_before(const scene::Table& viscosity, const scene::Scene& scene);

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
    /// A fluid with viscosity sticks to those that say so; `holds_closed`: see WallGrip.
    void stick(MacState<D>& s, bool holds_closed);
    /// Before they fly: what stands in the cells and faces that they leave goes on as the fluid beside, having fallen for a time dt.
    void leave(MacState<D>& s, real dt) const;
    /// Its part of the pressure: in cells without fluid that of the neighbours, by the gradient of water at rest.
    void continue_pressure(MacState<D>& s) const;
    /// Where it does, and what of the bodies' motion the friction of a step dt meets.
    void grip(const MacState<D>& s, const SolidPlacement<D>& solids, real dt);
    /// A time dt along their velocities.
    void fly(SolidPlacement<D>& solids, real dt);
    /// The pressure s.p and the velocities of the bodies: A p = b with what their velocities add to b, which is that of before on entry.
    /// No solver: there is no fluid.
    const poisson::Report& solve(MacState<D>& s, SolidPlacement<D>& solids, real dt, poisson::Solver<D>* solver, real tolerance,
                                 Grid<real, D>* b);

    /// How long until a dry body that moves as now meets the liquid, which moves by `speed` at most, or is a tenth of a cell in it; dt at
    /// most. A body goes on with its velocity until the pressure has seen it, so that what it closes of the liquid until then is lost or
    /// lifted. `phi`: distance from the liquid's surface, at least `cap` where it is not known.
    real time_to_land(const MacState<D>& s, const Grid<real, D>& phi, real cap, real speed, real dt) const;

    const Vec<D>& gravity() const { return gravity_; }
    /// Pressure solves of the last step, for tests and studies.
    int turns() const { return turns_; }
    void save(Checkpoint& to) const;
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
    real gap(const MacState<D>& s, const Grid<real, D>& phi, real cap, const rigid::Body<D>& body) const;
    void find_cuts(const MacState<D>& s, const SolidPlacement<D>& solids);
    void find_faces(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t body);
    Cut& cut(std::size_t cell, std::size_t body);
    void set_velocities(MacState<D>& s) const;
    void scatter(std::size_t body, const rigid::Twist<D>& velocity, real scale, Grid<real, D>& to) const;
    rigid::Twist<D> push(std::size_t body, const Grid<real, D>& p) const;
    rigid::Twist<D> force(const MacState<D>& s, std::size_t body) const;
    real wet_part(const MacState<D>& s, std::size_t body) const;
    rigid::Twist<D> weight(std::size_t body) const;
    rigid::Block<D> mass_of(std::size_t body) const;
    rigid::Block<D> mass_of_wet_surface(const MacState<D>& s, std::size_t body) const;
    void begin(const MacState<D>& s, bool wet, real dt);
    void be_held(const MacState<D>& s, real dt);
    void tell_hand();
    void measure_added_mass(const MacState<D>& s, poisson::Solver<D>& solver);
    void pushed(const MacState<D>& s, std::vector<real>& impulse, real dt) const;
    void learn();
    void move_under_forces();
    void find_contacts(const geometry::Solids<D>& solids, real dt);
    void touch(const geometry::Solids<D>& solids, real dt, bool anew);
    bool join_matrix(const MacState<D>& s);
    void leave_matrix();
    bool fluid_decides(const geometry::Solids<D>& solids, real dt);
    void expect_others(const MacState<D>& s, real dt);
    rigid::Twist<D> impulse_without_pressure(const MacState<D>& s, std::size_t body, real dt) const;
    void follow_pressure(const MacState<D>& s, real dt);
    real square_of(const MacState<D>& s, const Grid<real, D>& b) const;
    real adopt(const MacState<D>& s, real dt, Grid<real, D>* b);
    void take_velocities(MacState<D>& s, SolidPlacement<D>& placement, real dt);
    void turn(MacState<D>& s, poisson::Solver<D>& solver, real tolerance, real dt, Grid<real, D>& b);
    /// f(list) of each list with a number a free velocity.
    static void for_each_list(auto& self, auto&& f) {
        for (auto* list : {&self.velocity_, &self.next_, &self.before_, &self.gained_, &self.heavy_, &self.met_, &self.last_, &self.change_,
                           &self.missing_, &self.base_, &self.others_})
            f(*list);
    }

    rigid::Bodies<D> bodies_;
    std::unique_ptr<WallGrip<D>> grip_;  // none: nothing sticks
    rigid::Contacts<D> contacts_;
    Vec<D> gravity_{};
    real rho_ = 1, cell_ = 0, h2_ = 0;
    Vec<D> h_{};
    std::vector<std::vector<Face>> faces_;  // of each body, those that it closes, wholly or in part
    std::vector<std::vector<Cut>> cuts_;
    std::vector<std::size_t> near_;  // solids near the body that is looked at
    Grid<real, D> rhs_, phi_;        // of the added mass where it must be measured; phi_ else zero, for a list's places
    rigid::AddedMass<D> added_;
    rigid::Mobility mobility_;
    std::vector<rigid::Block<D>> masses_;
    std::vector<char> free_;
    std::vector<real> velocity_, next_;     // of all bodies, this turn's and the next one's
    std::vector<real> before_, gained_;     // when the step began; what the last step changed them by, over dt
    std::vector<real> heavy_, met_, last_;  // weights; the pressure's impulses of this turn and of the last one
    std::vector<real> change_, missing_;
    std::vector<real> base_;                // what b has of the velocities
    std::vector<real> others_;              // impulses of contacts and joints
    std::vector<char> joined_;              // of each body: is it part of the pressure's matrix?
    std::vector<rigid::Block<D>> inverse_;  // of the mass, of those
    poisson::LowRank matrix_;
    real b_squared_ = 0, whole_ = 0;  // ‖b‖² now; ‖b‖ with the velocities that were expected
    std::shared_ptr<Hand> hand_;      // none: nobody takes hold
    /// Of the body that it holds in this step: the impulse is weight (target − V).
    struct Hold {
        int body = -1;
        real weight = 0;
        Vec<D> target{};
    } hold_;
    poisson::Report report_;
    int turns_ = 0;
};

}  // namespace weir::staggered
