// Objects on columns of water, both ways. The water below an object is as thick as the gap that it leaves, and what a column's "surface"
// means there is the height to which the pressure under the object would lift it: the object gives back rho g times how far that stands
// above its underside (Archimedes), and where it covers the part f of a column,
//     water = (1 - f) (s - bed) + f (underside - bed).
// That is one linear system for s of the covered columns and the heights of the undersides at the end of a step, symmetric and positive
// when the heights are eliminated; added mass, damping by the waves that are made, and the wave that a dragged object pushes come out of it
// (for long waves: Lannes 2017, "On the dynamics of floating structures"). Water and displaced volume are kept to round-off.
#pragma once
#include "core/checkpoint.hpp"
#include "geometry/motion.hpp"
#include "heightfield/sweep.hpp"
#include "scene/scene.hpp"

#include <array>
#include <memory>
#include <vector>

namespace weir::heightfield {

/// One column that a body covers.
struct Cover {
    std::size_t column = 0;
    real part = 0;       // of its area, in [0, 1]
    real underside = 0;  // of the body above it, less the body's own height [m]
};

/// A body as the water sees it. Bodies with more freedom than heave fit in here: they move themselves in `move` and get the same force
/// back.
class Body {
public:
    virtual ~Body() = default;
    /// To time t along the ways that the water has no say in; tells what it covers then.
    virtual void move(real t, std::vector<Cover>& covers) = 0;
    /// How many columns it passes a second at time t.
    virtual real pace(real t) const = 0;
    /// What resists being lifted [kg]; infinity for a body whose height is prescribed.
    virtual real mass() const = 0;
    /// Its own height [m] and the speed of that [m/s]: what the water decides of.
    virtual real height() const = 0;
    virtual real speed() const = 0;
    virtual void set(real height, real speed) = 0;
    virtual real top() const = 0;  // above the height: water over it is more than a height field can tell [m]
    /// Of the box around it [m], where it was moved to last.
    virtual Vec<3> middle() const = 0;
    virtual Vec<3> size() const = 0;
    virtual void save(Checkpoint& to, const std::string& name) const = 0;
    virtual void restore(const Checkpoint& from, const std::string& name) = 0;
};

/// Boxes of the scene's list "floats".
std::vector<std::unique_ptr<Body>> make_floats(const scene::Scene& scene, const Plane& plane);

/// What the water did to a body in the last step.
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
    /// Whether a body is over a column, or was in the last step: its surface is the height that its pressure stands for.
    bool covers(std::size_t column) const { return !place_of_.empty() && place_of_[column] >= 0; }
    const Pushed& pushed(std::size_t b) const { return pushed_[b]; }
    /// Places the bodies at t = 0 in water whose surface is given: what they displace is taken away from below them.
    void enter(const Field& surface, const Field& rate, Stiffness& k);
    /// Before the sweep of a step that ends at `t`: moves the bodies, makes the gaps below them the depths there, keeps what the sweep
    /// spoils.
    void before(real t, const Field& surface, const Field& rate, Stiffness& k);
    /// After it: the covered columns and the heights anew.
    void after(real dt, Field& surface, Field& rate);
    /// Depth that bodies displace in each column.
    void displaced(const Field& surface, Field& to) const;
    /// Adds the set "floats": where each body is, and how large.
    void show(FieldSet& fields) const;
    /// Columns that the fastest passes a second at time t.
    real pace(real t) const;
    /// The highest column of water above the top of a body [m]; 0 where none is.
    real over_top(const Field& surface) const;
    /// Volume of water less that of free columns with these surfaces [m^3].
    real missing(const Field& surface) const;
    int iterations() const { return iterations_; }
    std::size_t bytes() const;
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from, real t, const Field& surface, const Field& rate, Stiffness& k);

private:
    /// A column below bodies, or that was below them in the last step.
    struct Covered {
        std::size_t column = 0;
        bool clings = false;                           // touched by a body whose height is prescribed
        real water = 0;                                // thickness at the beginning of the step [m]
        real surface = 0, rate = 0;                    // then
        std::array<std::size_t, 4> beside{};           // columns along x and z; itself at the ends of the plane
        std::array<real, 4> surface_beside{}, k{};     // then; of the faces to them
        std::array<std::ptrdiff_t, 4> place_beside{};  // in covered_, or -1
    };
    /// What one body covers of one column.
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
    std::vector<std::ptrdiff_t> place_of_;                             // of each column in covered_, or -1
    std::vector<real> x_, r_, p_, ap_, diagonal_, free_, gap_, part_;  // one a covered column
    std::vector<real> stiff_, given_;                                  // one a body
    int iterations_ = 0;
    mutable std::array<std::vector<real>, 6> shown_;  // middle and size of each body
};

}  // namespace weir::heightfield
