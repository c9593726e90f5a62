// Two-way coupling of objects and columns of water. The water below an object is as thick as the gap below it. The "surface" of a covered
// column is the height equivalent to the pressure there. The object gets the force rho g times the difference of that height and its
// underside (Archimedes). Where it covers the fraction f of a column,
// This gives one linear system for s of the covered columns and the heights of the undersides at the end of a step; it is symmetric
// positive definite after elimination of the heights. Added mass, radiation damping and the bow wave of a dragged object result from it
// (for long waves: Lannes 2017, "On the dynamics of floating structures"). Water volume and displaced volume are conserved to round-off.
#pragma once
#include "core/checkpoint.hpp"
#include "geometry/motion.hpp"
#include "heightfield/sweep.hpp"
#include "scene/scene.hpp"

#include <array>
#include <memory>
#include <vector>

namespace weir::heightfield {

/// A column covered by a body.
struct Cover {
    std::size_t column = 0;
    real part = 0;       // of its area, in [0, 1]
    real underside = 0;  // of the body above it, relative to the body's height [m]
};

/// The interface of a body for the water. Bodies with more degrees of freedom than heave can implement it: they move themselves in `move`
/// and receive the same force.
class Body {
public:
    virtual ~Body() = default;
    /// Moves the degrees of freedom that do not depend on the water to time t; then returns the covered columns.
    virtual void move(real t, std::vector<Cover>& covers) = 0;
    /// Columns crossed per second at time t.
    virtual real pace(real t) const = 0;
    /// Inertia against heave [kg]; infinite for a body of prescribed height.
    virtual real mass() const = 0;
    /// Its height [m] and vertical speed [m/s]: the unknowns of the coupling.
    virtual real height() const = 0;
    virtual real speed() const = 0;
    virtual void set(real height, real speed) = 0;
    virtual real top() const = 0;  // relative to the height: a height field cannot represent water above it [m]
    /// Centre of its bounding box [m], after the last move.
    virtual Vec<3> middle() const = 0;
    virtual Vec<3> size() const = 0;
    virtual void save(Checkpoint& to, const std::string& name) const = 0;
    virtual void restore(const Checkpoint& from, const std::string& name) = 0;
};

/// Boxes of the scene's list "floats".
std::vector<std::unique_ptr<Body>> make_floats(const scene::Scene& scene, const Plane& plane);

/// The effect of the water on a body in the last step.
struct Pushed {
    real displaced = 0;  // [m^3]
    real up = 0;         // force [N]
    real along_x = 0, along_z = 0;
};

class Floats {
public:
    Floats(std::vector<std::unique_ptr<Body>> bodies, const Plane& plane, const Field& bed, const Field& still_depth, real g, real rho,
           bool periodic_x, bool periodic_z);
    bool empty() const { return bodies_.empty(); }
    std::size_t count() const { return bodies_.size(); }
    const Body& body(std::size_t b) const { return *bodies_[b]; }
    /// Returns whether a body covers a column, or did in the last step: its surface is then the height equivalent to the pressure.
    bool covers(std::size_t column) const { return !place_of_.empty() && place_of_[column] >= 0; }
    const Pushed& pushed(std::size_t b) const { return pushed_[b]; }
    /// Places the bodies at t = 0 in water with a given surface: the displaced water is removed from below them.
    void enter(const Field& surface, const Field& rate, Stiffness& k);
    /// Before the sweep of a step that ends at `t`: moves the bodies, sets the depths below them to the gaps, and stores values that the
    /// sweep overwrites.
    void before(real t, const Field& surface, const Field& rate, Stiffness& k);
    /// After the sweep: recomputes the covered columns and the heights.
    void after(real dt, Field& surface, Field& rate);
    /// Depth displaced by bodies in each column.
    void displaced(const Field& surface, Field& to) const;
    /// Adds the set "floats": position and size of each body.
    void show(FieldSet& fields) const;
    /// Columns that the fastest body crosses per second at time t.
    real pace(real t) const;
    /// The highest column of water above the top of a body [m]; 0 where there is none.
    real over_top(const Field& surface) const;
    /// Water volume minus that of free columns with these surfaces [m^3].
    real missing(const Field& surface) const;
    int iterations() const { return iterations_; }
    std::size_t bytes() const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from, real t, const Field& surface, const Field& rate, Stiffness& k);

private:
    /// A column below bodies now or in the last step.
    struct Covered {
        std::size_t column = 0;
        bool clings = false;                           // in contact with a body of prescribed height
        real water = 0;                                // thickness at the start of the step [m]
        real surface = 0, rate = 0;                    // at the start of the step
        std::array<std::size_t, 4> beside{};           // neighbours along x and z; itself at the ends of the plane
        std::array<real, 4> surface_beside{}, k{};     // at the start of the step; of the faces to them
        std::array<std::ptrdiff_t, 4> place_beside{};  // index in covered_, or -1
    };
    /// The coverage of one column by one body.
    struct Contact {
        std::size_t place, body;
        real part, underside;
        bool touches;
    };
    void locate(real t, const Field& surface, const Field& rate);
    void add(std::size_t column, real water, const Field& surface, const Field& rate);
    void see_whole(std::size_t body) const;
    void see_depths();
    void set_stiffness(Stiffness& k);
    void see_neighbours(const Field& surface, const Stiffness& k);
    void set_up(real dt);
    struct System;
    void solve(real dt);
    void multiply(const std::vector<real>& x, std::vector<real>& y, real dt) const;
    real height_of(std::size_t body) const;
    bool change_contacts();
    void take(real dt, Field& surface, Field& rate);
    void tell();
    void forget_free_columns();

    std::vector<std::unique_ptr<Body>> bodies_;
    Plane plane_;
    const Field &bed_, &depth_;
    real g_, rho_;
    bool periodic_x_, periodic_z_;
    std::vector<Pushed> pushed_;
    std::vector<Covered> covered_;
    std::vector<Contact> contacts_;
    std::vector<Cover> covers_;
    std::vector<std::ptrdiff_t> place_of_;                             // index of each column in covered_, or -1
    std::vector<real> x_, r_, p_, ap_, diagonal_, free_, gap_, part_;  // one entry per covered column
    std::vector<real> stiff_, given_;                                  // one entry per body
    int iterations_ = 0;
    mutable std::array<std::vector<real>, 6> shown_;  // centre and size of each body
};

}  // namespace weir::heightfield
