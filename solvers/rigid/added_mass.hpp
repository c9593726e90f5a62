// The mass that a fluid adds to bodies, as far as it is known without solving for it: guessed from the wet surface, and then learnt from
// the fluid's own answers. A change s of the velocities that the pressure met by the impulse −y says y = m s; each such pair improves the
// guess by the formula of Broyden, Fletcher, Goldfarb & Shanno (Nocedal & Wright 2006, ch. 6), as quasi-Newton methods couple fluids and
// structures (Degroote, Bathe & Vierendeels 2009). What is learnt stays with the body, in units of the guess, so that it turns and dips
// with the wet surface.
#pragma once
#include "rigid/contacts.hpp"

#include <vector>

namespace weir::rigid {

/// A matrix of one body, row by row.
template <int D>
using Block = std::array<Twist<D>, freedoms<D>>;

/// The inverse of the rows and columns of a positive definite matrix that are free, symmetric to the last bit; zero in the others.
template <int D>
Block<D> inverse_of(Block<D> m, const char* free);

template <int D>
class AddedMass {
public:
    void resize(std::size_t bodies) { known_.resize(bodies); }
    /// A body as it stands: `guess` from its wet surface; all zero where it is dry.
    void see(std::size_t body, const Block<D>& guess);
    /// What is known of it.
    const Block<D>& of(std::size_t body) const { return known_[body].mass; }
    /// The inverse of mass and added mass, body by body, of what is free.
    void begin(const std::vector<Block<D>>& masses, const std::vector<char>& free, Mobility& mobility) const;
    /// A change of the velocities, and the impulse against it; `mobility` becomes one that knows of it.
    void learn(const std::vector<real>& change, const std::vector<real>& impulse, const std::vector<Block<D>>& masses,
               const std::vector<char>& free, Mobility& mobility);
    /// All of it is known: of each body its own part is kept.
    void learn(const Mobility& exact);

    void save(Checkpoint& to, const std::string& name) const;
    void restore(const Checkpoint& from, const std::string& name);
    std::size_t bytes() const { return known_.capacity() * sizeof(Known) + (seen_.capacity() + answer_.capacity()) * sizeof(real); }

private:
    static constexpr std::size_t n = freedoms<D>;
    struct Known {
        Block<D> mass{}, share{};  // share: the mass over the guess's diagonal, from both sides
        Twist<D> scale{};          // square roots of that diagonal; all zero: dry
        bool wet = false;
    };
    static void keep(Known& known);
    void improve(Known& known, const real* change, const real* impulse);

    std::vector<Known> known_;
    std::vector<real> seen_, answer_;
};

}  // namespace weir::rigid
