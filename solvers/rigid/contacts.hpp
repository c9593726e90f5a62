// Contacts of bodies with walls, solids and each other, and the contact impulses. Contact spheres of one body are tested against the signed
// distance of the other. The constraints on velocities are unilateral, with Coulomb friction and Newton's restitution (Moreau 1988), and
// are solved together with joints (rows.hpp). The metric is given by the caller: in water the added mass also resists, and an impulse on
// one body moves others through the water.
#pragma once
#include "geometry/sides.hpp"
#include "geometry/solids.hpp"
#include "rigid/joints.hpp"

#include <vector>

namespace weir::rigid {

/// Obstacles of bodies, besides each other.
template <int D>
struct Surroundings {
    Vec<D> min{}, max{};             // of the domain [m]
    std::array<bool, 2 * D> wall{};  // lower and upper end of each axis
    const geometry::Solids<D>* solids = nullptr;
    std::size_t prescribed = 0;         // index of the first of them; the following ones are bodies
    real reach = 0;                     // larger gaps are ignored [m]
    const Joints<D>* joints = nullptr;  // bodies connected by these do not collide
};

template <int D>
class Contacts {
public:
    /// Finds the pairs of points and surfaces within reach, at the bodies' present positions.
    void find(const std::vector<Body<D>>& bodies, const Surroundings<D>& around);
    /// Returns whether there are neither contacts nor joints.
    bool empty() const { return list_.empty() && !joints_; }
    std::size_t count() const { return list_.size(); }
    /// Marks the bodies of all pairs found, and those of joints, as touched.
    void mark(std::vector<Body<D>>& bodies) const;
    /// Changes the velocities so that within a time dt no gap becomes negative, with the restitution and friction of both sides, and all
    /// joints hold. Marks the bodies with contact. A repeated call for the same contacts starts from the previous impulses.
    void resolve(std::vector<Body<D>>& bodies, const Mobility& mobility, std::vector<real>& velocities, real dt, real gravity);
    /// Adds the impulses of contacts and joints to those on the bodies.
    void add_impulses(std::vector<real>& impulses) const { rows_.add_impulses(impulses); }
    /// Declares that the velocities of the next call include the impulses found so far.
    void carry_on() { carried_ = true, rows_.carry_on(); }

private:
    struct Contact {
        std::size_t body;
        std::ptrdiff_t other;  // −1: an obstacle with prescribed motion, or at rest
        Vec<D> at, normal;     // the normal points to `body`
        Vec<D> moves{};        // velocity of the other side where it is prescribed
        real gap = 0, friction = 0, restitution = 0;
        bool bounces = false;
        real rebound = 0;  // target velocity of the bounce [m/s]
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
    Rows<D> rows_;  // D per contact: normal, then tangential; then those of joints
};

}  // namespace weir::rigid
