// Monolithic coupling of rigid bodies and pressure (Batty, Bertails & Bridson 2007). For the fluid a body is a moving solid: its closed
// face areas displace fluid. With D_k the divergence due to a unit of velocity k,
//
//     A p = −h² ρ/dt (∇·u* + Σ D_k V_k),      M (V − V*) = dt F,      F_k = ΔV Σ p D_k     [ΔV: volume of a cell]
//
// Eliminating p leaves (M + m) V with the discrete added mass m_kl = ρ ΔV D_k·A⁻¹ h² D_l: well posed for bodies lighter than the water,
// even massless ones. Eliminating V leaves (A + U C Uᵀ) p with one column per degree of freedom. The multigrid of A solves it in one or two
// more iterations, unless the added mass is many times the body's own; such bodies are part of the matrix. Lighter bodies and contacts are
// coupled by partitioned iterations: pressure for given velocities, then velocities for given pressure. A quasi-Newton estimate of m
// (rigid/added_mass.hpp) sets the update; contacts use the same metric. The tolerance of each pressure solve follows the change of the
// velocities, so all iterations together cost little more than one solve. In a cut cell the pressure is known at the cell's centre only; F
// extrapolates it to the wall by the hydrostatic gradient, so a flat bottom also floats between cell layers.
#pragma once
#include "core/brush.hpp"
#include "mac/bodies/no_slip_walls.hpp"
#include "mac/bodies/solid_faces.hpp"
#include "mac/grid/state.hpp"
#include "poisson/poisson.hpp"
#include "rigid/added_mass.hpp"
#include "rigid/bodies.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace weir::mac {

/// Rejects explicit friction where a scene's fluid has no-slip bodies: their friction is implicit.
void refuse_explicit_friction(const scene::Table& viscosity, const scene::Scene& scene);

template <int D>
class BodiesInFlow {
public:
    explicit BodiesInFlow(const scene::Scene& scene);
    /// nullptr where the scene has no bodies.
    static std::unique_ptr<BodiesInFlow> make(const scene::Scene& scene);
    /// The scene's solids, followed by the bodies of `in`, which may be nullptr.
    static geometry::Solids<D> solids(const scene::Scene& scene, BodiesInFlow* in);

    const rigid::Bodies<D>& bodies() const { return bodies_; }
    /// Enables interactive forcing of the bodies; rejects keyframes with a body index out of range.
    void follow(std::shared_ptr<BrushForcing> forcing, const scene::Scene& scene);
    /// Fluid whose density varies: that of the cell with this linear index [kg/m³]. Without it, it is s.rho.
    void set_density(std::function<real(std::size_t)> of_cell) { density_of_cell_ = std::move(of_cell); }
    /// Initializes the wet parts of the bodies at t = 0.
    void start(const MacState<D>& s, const SolidPlacement<D>& solids);
    /// Makes the bodies with no slip couple to viscosity; `holds_closed`: see NoSlipWalls.
    void couple_friction(MacState<D>& s, bool holds_closed);
    /// Before advance_free(): fills the cells and faces that bodies are leaving with the velocity of the neighbouring fluid, after free
    /// fall for a time dt.
    void leave(MacState<D>& s, real dt) const;
    /// Extrapolates the pressure into cells without fluid, from their neighbours by the hydrostatic gradient.
    void continue_pressure(MacState<D>& s) const;
    /// Finds the no-slip wall links, and estimates the bodies' motion for the friction of a step dt.
    void set_no_slip_walls(const MacState<D>& s, const SolidPlacement<D>& solids, real dt);
    /// Moves the bodies for a time dt along their velocities.
    void advance_free(SolidPlacement<D>& solids, real dt);
    /// Solves for the pressure s.p and the velocities of the bodies: A p = b plus the contribution of their velocities; on entry b contains
    /// that of the previous velocities. solver nullptr: there is no fluid.
    const poisson::Report& solve(MacState<D>& s, SolidPlacement<D>& solids, real dt, poisson::Solver<D>* solver, real tolerance,
                                 Grid<real, D>* b);

    /// Time until a dry body at its present velocity meets the liquid, which moves by `speed` at most, or is a tenth of a cell deep in it;
    /// dt at most. Until the first pressure solve that includes the body, the liquid that it covers is lost or displaced. `phi`: signed
    /// distance to the liquid's surface, at least `cap` where it is not known.
    real time_to_land(const MacState<D>& s, const Grid<real, D>& phi, real cap, real speed, real dt) const;

    /// What bodies and solids drive through films (sealed_films.cpp) [m^D/s].
    real flux_in_films() const;
    const Vec<D>& gravity() const { return gravity_; }
    /// Pressure solves of the last step, for tests and studies.
    int coupling_iterations() const { return coupling_iterations_; }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from, SolidPlacement<D>& solids);
    std::size_t bytes() const;

private:
    static constexpr std::size_t n = rigid::freedoms<D>;
    /// A face with the velocity of a body.
    struct Face {
        int axis;
        std::size_t face;
        rigid::Twist<D> moves;  // its velocity per unit of each of the body's velocities
    };
    /// A cell that a body cuts.
    struct Cut {
        std::size_t cell;
        rigid::Twist<D> out;             // ΔV D_k: volume flux out of the cell per unit of each velocity [m^D/s per m/s or rad/s]
        rigid::Twist<D> out_of_films{};  // the part of `out` that films between the body and others drive in (sealed_films.cpp)
        real out_by_solids = 0;          // what solids drive out of films [m^D/s]
        real below = 0;                  // g · (wall − cell centre); deep: g · (wall − centre of mass) [m²/s²]
        real deep = 0;
    };
    real density(const MacState<D>& s, std::size_t cell) const { return density_of_cell_ ? density_of_cell_(cell) : s.rho; }
    real gap(const MacState<D>& s, const Grid<real, D>& phi, real cap, const rigid::Body<D>& body) const;
    void find_cuts(const MacState<D>& s, const SolidPlacement<D>& solids);
    void find_faces(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t body);
    Cut& cut(std::size_t cell, std::size_t body);
    /// A closed cell between a body and a wall or another solid, and the flux out of it as in Cut.
    struct Sealed {
        std::size_t cell;
        rigid::Twist<D> out;
    };
    bool is_sealed(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t own, const Index<D>& I) const;
    void open_films(const MacState<D>& s, const geometry::Solids<D>& solids, std::size_t body);
    real driven_by_solids(const MacState<D>& s, const geometry::Solids<D>& solids, const Index<D>& I) const;
    void add_films(const MacState<D>& s, real dt, Grid<real, D>& b) const;
    void set_velocities(MacState<D>& s) const;
    void scatter(std::size_t body, const rigid::Twist<D>& velocity, real scale, Grid<real, D>& to) const;
    rigid::Twist<D> push(std::size_t body, const Grid<real, D>& p) const;
    rigid::Twist<D> force(const MacState<D>& s, std::size_t body) const;
    real liquid_fraction(const MacState<D>& s, std::size_t body) const;
    real density_around(const MacState<D>& s, std::size_t body) const;
    bool falls(std::size_t body) const;
    rigid::Twist<D> weight(const MacState<D>& s, std::size_t body) const;
    rigid::Block<D> mass_of(std::size_t body) const;
    rigid::Block<D> mass_of_wet_surface(const MacState<D>& s, std::size_t body) const;
    void begin(const MacState<D>& s, bool wet, real dt);
    void apply_grab(const MacState<D>& s, real dt);
    void record_brush_impulse();
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
    void coupling_iteration(MacState<D>& s, poisson::Solver<D>& solver, real tolerance, real dt, Grid<real, D>& b);
    /// f(list) for each list with one entry per degree of freedom.
    static void for_each_list(auto& self, auto&& f) {
        for (auto* list : {&self.velocity_, &self.next_, &self.before_, &self.gained_, &self.heavy_, &self.met_, &self.last_, &self.change_,
                           &self.missing_, &self.base_, &self.others_})
            f(*list);
    }

    rigid::Bodies<D> bodies_;
    std::unique_ptr<NoSlipWalls<D>> no_slip_walls_;  // nullptr: no body has no slip
    rigid::Contacts<D> contacts_;
    Vec<D> gravity_{};
    std::function<real(std::size_t)> density_of_cell_;  // empty: s.rho
    real rho_ = 1, cell_ = 0, h2_ = 0;
    Vec<D> h_{};
    std::vector<std::vector<Face>> faces_;  // per body, the faces that it closes, wholly or partly
    std::vector<std::vector<Cut>> cuts_;
    std::vector<std::size_t> near_;  // solids near the present body
    std::vector<Sealed> sealed_;     // cells at the present body; only where the density varies
    Grid<real, D> rhs_, phi_;        // for measuring the added mass; phi_ otherwise zero, to hold list indices
    rigid::AddedMass<D> added_;
    rigid::Mobility mobility_;
    std::vector<rigid::Block<D>> masses_;
    std::vector<char> free_;
    std::vector<real> velocity_, next_;     // of all bodies, of this iteration and of the next
    std::vector<real> before_, gained_;     // at the start of the step; acceleration of the last step
    std::vector<real> heavy_, met_, last_;  // weights; pressure impulses of this iteration and of the last
    std::vector<real> change_, missing_;
    std::vector<real> base_;                // the velocities that b contains
    std::vector<real> others_;              // impulses of contacts and joints
    std::vector<char> joined_;              // per body: whether it is part of the pressure matrix
    std::vector<rigid::Block<D>> inverse_;  // inverse masses of those
    poisson::LowRank matrix_;
    real b_squared_ = 0, whole_ = 0;               // ‖b‖² now; ‖b‖ with the extrapolated velocities
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr: no interactive forcing
    /// The body that is grabbed in this step: the impulse is weight (target − V).
    struct Hold {
        int body = -1;
        real weight = 0;
        Vec<D> target{};
    } grab_;
    poisson::Report report_;
    int coupling_iterations_ = 0;
};

}  // namespace weir::mac
