// Quasi-Newton estimate of the added mass of bodies, without extra solves. It is initialized from the wet surface and updated by the
// pressure solves. A change s of the velocities to which the pressure responds with the impulse −y implies y = m s. Each such pair improves
// the estimate by the BFGS formula (Nocedal & Wright 2006, ch. 6), as in quasi-Newton coupling of fluids and structures (Degroote, Bathe &
// Vierendeels 2009). The result is stored with the body, in units of the initial estimate, so it rotates and submerges with the wet
// surface.
#pragma once
#include "rigid/contacts.hpp"

#include <vector>

namespace weir::rigid {

/// A matrix of one body, row by row.
template <int D>
using Block = std::array<Twist<D>, freedoms<D>>;

/// The inverse of the free rows and columns of a positive definite matrix, symmetric to the last bit; zero in the others.
template <int D>
Block<D> inverse_of(Block<D> m, const char* free);

template <int D>
class AddedMass {
public:
    void resize(std::size_t bodies) { known_.resize(bodies); }
    /// Sets a body's initial estimate, from its wet surface; all zero where it is dry.
    void see(std::size_t body, const Block<D>& guess);
    /// The present estimate.
    const Block<D>& of(std::size_t body) const { return known_[body].mass; }
    /// The block-diagonal inverse of mass plus added mass, for the free velocities.
    void begin(const std::vector<Block<D>>& masses, const std::vector<char>& free, Mobility& mobility) const;
    /// Updates the estimate by a change of the velocities and the impulse against it, and `mobility` likewise.
    void learn(const std::vector<real>& change, const std::vector<real>& impulse, const std::vector<Block<D>>& masses,
               const std::vector<char>& free, Mobility& mobility);
    /// Stores an exact result: the diagonal block of each body is kept.
    void learn(const Mobility& exact);

    void save(Checkpoint& to, const std::string& name) const;
    void restore(const Checkpoint& from, const std::string& name);
    std::size_t bytes() const { return known_.capacity() * sizeof(Known) + (seen_.capacity() + answer_.capacity()) * sizeof(real); }

private:
    static constexpr std::size_t n = freedoms<D>;
    struct Known {
        Block<D> mass{}, share{};  // share: the mass scaled on both sides by the diagonal of the initial estimate
        Twist<D> scale{};          // square roots of that diagonal; all zero: dry
        bool wet = false;
    };
    static void keep(Known& known);
    void improve(Known& known, const real* change, const real* impulse);

    std::vector<Known> known_;
    std::vector<real> seen_, answer_;
};

}  // namespace weir::rigid
