// Contacts of bodies with walls, solids and each other, and the impulses that end them. Points of one body against the signed distance of
// the other; unilateral constraints on velocities with Coulomb's friction and Newton's restitution (Moreau 1988), solved with those of
// joints (rows.hpp). The metric is the caller's: in water a body resists with the added mass of what it moves too, and an impulse on one
// body moves others through the water.
#pragma once
#include "geometry/sides.hpp"
#include "geometry/solids.hpp"
#include "rigid/joints.hpp"

#include <vector>

namespace weir::rigid {

/// What bodies may touch besides each other.
template <int D>
struct Surroundings {
    Vec<D> min{}, max{};             // of the domain [m]
    std::array<bool, 2 * D> wall{};  // lower and upper end of each axis
    const geometry::Solids<D>* solids = nullptr;
    std::size_t prescribed = 0;         // the first of them; those behind are bodies
    real reach = 0;                     // gaps larger than this are not looked at [m]
    const Joints<D>* joints = nullptr;  // bodies that these hold together do not touch each other
};

template <int D>
class Contacts {
public:
    /// Pairs of points and surfaces that are nearer than the reach, at the bodies' places.
    void find(const std::vector<Body<D>>& bodies, const Surroundings<D>& around);
    /// Neither contacts nor joints.
    bool empty() const { return list_.empty() && !joints_; }
    std::size_t count() const { return list_.size(); }
    /// Marks the bodies of all pairs that were found, and those of joints, as touched.
    void mark(std::vector<Body<D>>& bodies) const;
    /// Changes the velocities so that over a time dt no gap closes further than to nothing, with the restitution and friction of both
    /// sides, and no joint comes apart. Marks the bodies that are touched. Of the same contacts again, it begins with the impulses that
    /// were found.
    void resolve(std::vector<Body<D>>& bodies, const Mobility& mobility, std::vector<real>& velocities, real dt, real gravity);
    /// Adds what was found, of contacts and joints, to the impulses on the bodies.
    void add_impulses(std::vector<real>& impulses) const { rows_.add_impulses(impulses); }
    /// The velocities of the next call have the impulses found so far.
    void carry_on() { carried_ = true, rows_.carry_on(); }

private:
    struct Contact {
        std::size_t body;
        std::ptrdiff_t other;  // −1: nothing that moves by itself
        Vec<D> at, normal;     // the normal points to `body`
        Vec<D> moves{};        // velocity of the other side where that is prescribed
        real gap = 0, friction = 0, restitution = 0;
        bool bounces = false;
        real rebound = 0;  // as fast as that [m/s]
    };
    void against(std::size_t body, std::ptrdiff_t other, const Vec<D>& at, const Vec<D>& normal, const Vec<D>& moves, real gap,
                 const std::vector<Body<D>>& bodies);
    void touch_walls(const std::vector<Body<D>>& bodies, std::size_t b, const Surroundings<D>& around);
    void touch_solid(const std::vector<Body<D>>& bodies, std::size_t b, std::size_t solid, const Surroundings<D>& around);
    void reduce(std::size_t first, const std::vector<Body<D>>& bodies);
    void make_rows(const std::vector<Body<D>>& bodies, real dt);

    std::vector<Contact> list_;
    const Joints<D>* joints_ = nullptr;
    bool carried_ = false;
    std::vector<Row<D>> made_;
    Rows<D> rows_;  // D a contact: along the normal, then across it; then those of joints
};

}  // namespace weir::rigid
