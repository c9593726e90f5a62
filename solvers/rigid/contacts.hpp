// Contacts of bodies with walls, solids and each other, and the impulses that end them. Points of one body against the signed distance of
// the other; unilateral constraints on velocities with Coulomb's friction and Newton's restitution (Moreau 1988), solved by projected
// Gauss-Seidel in a fixed order, each sweep a step of nonsmooth nonlinear conjugate gradients (Silcowitz-Hansen, Niebe & Erleben 2010), so
// that stacks of light and heavy bodies converge too. The metric is the caller's: in water a body resists with the added mass of what it
// moves too, and an impulse on one body moves others through the water.
#pragma once
#include "geometry/sides.hpp"
#include "geometry/solids.hpp"
#include "rigid/body.hpp"

#include <vector>

namespace weir::rigid {

/// A dense symmetric matrix, row by row: velocities of all bodies, `freedoms<D>` each, from impulses on them.
struct Mobility {
    std::size_t size = 0;
    std::vector<real> entries;
    void resize(std::size_t n) {
        size = n;
        entries.assign(n * n, 0.0);
    }
    real& operator()(std::size_t row, std::size_t column) { return entries[row * size + column]; }
    real operator()(std::size_t row, std::size_t column) const { return entries[row * size + column]; }
};

/// Of bodies in the air: the inverse of their masses; what is held does not move.
template <int D>
void dry_mobility(const std::vector<Body<D>>& bodies, Mobility& mobility);
/// The inverse of a symmetric matrix, of the rows and columns that are free; zero in the others.
void invert(const Mobility& matrix, const std::vector<char>& free, Mobility& inverse);

/// What bodies may touch besides each other.
template <int D>
struct Surroundings {
    Vec<D> min{}, max{};             // of the domain [m]
    std::array<bool, 2 * D> wall{};  // lower and upper end of each axis
    const geometry::Solids<D>* solids = nullptr;
    std::size_t prescribed = 0;  // the first of them; those behind are bodies
    real reach = 0;              // gaps larger than this are not looked at [m]
};

template <int D>
class Contacts {
public:
    /// Pairs of points and surfaces that are nearer than the reach, at the bodies' places.
    void find(const std::vector<Body<D>>& bodies, const Surroundings<D>& around);
    bool empty() const { return list_.empty(); }
    std::size_t count() const { return list_.size(); }
    /// Marks the bodies of all pairs that were found as touched.
    void mark(std::vector<Body<D>>& bodies) const;
    /// Changes the velocities so that over a time dt no gap closes further than to nothing, with the restitution and friction of both
    /// sides. Marks the bodies that are touched. Of the same contacts again, it begins with the impulses that were found.
    void resolve(std::vector<Body<D>>& bodies, const Mobility& mobility, std::vector<real>& velocities, real dt, real gravity);

private:
    struct Contact {
        std::size_t body;
        std::ptrdiff_t other;  // −1: nothing that moves by itself
        Vec<D> at, normal;     // the normal points to `body`
        Vec<D> moves{};        // velocity of the other side where that is prescribed
        real gap = 0, friction = 0, restitution = 0;
        real target = 0;  // least relative velocity along the normal
        bool bounces = false;
        std::array<real, D> impulse{};  // along the normal, then across it
    };
    /// One direction of one contact: which velocities it sees, and what an impulse along it does.
    struct Row {
        std::array<real, 2 * freedoms<D>> sees{};
        real response = 0;  // change of the relative velocity by a unit impulse
    };
    void against(std::size_t body, std::ptrdiff_t other, const Vec<D>& at, const Vec<D>& normal, const Vec<D>& moves, real gap,
                 const std::vector<Body<D>>& bodies);
    void touch_walls(const std::vector<Body<D>>& bodies, std::size_t b, const Surroundings<D>& around);
    void touch_solid(const std::vector<Body<D>>& bodies, std::size_t b, std::size_t solid, const Surroundings<D>& around);
    void reduce(std::size_t first, const std::vector<Body<D>>& bodies);
    void build_rows(const std::vector<Body<D>>& bodies, const Mobility& mobility);
    real sweep(std::vector<real>& velocities);
    static void limit(Contact& c, std::size_t k);
    void go_on(real beta, std::vector<real>& velocities);
    real relative(const Contact& c, const Row& row, const std::vector<real>& velocities) const;
    void push(std::size_t row, real impulse, std::vector<real>& velocities) const;

    std::vector<Contact> list_;
    std::vector<Row> rows_;                 // D a contact
    std::vector<real> responses_;           // of each row, the change of all velocities
    std::vector<real> direction_, gained_;  // of each row
    std::vector<real> free_;                // velocities without any impulse
    std::size_t size_ = 0;
};

}  // namespace weir::rigid
