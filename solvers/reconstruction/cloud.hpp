// Particles that a surface is made of, with their images beyond the sides of the domain. Over ranks each has those that it reads: where
// they stand, all know alike.
#pragma once
#include "core/solver.hpp"
#include "particles/cell_sort.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace weir::reconstruction {

/// The particles of one instant, and behind them their images beyond walls and sides that repeat.
struct Cloud {
    std::array<std::vector<real>, 3> x;  // [m]
    std::vector<int> source;             // of each image: the particle that it is one of
    int own = 0;                         // particles that are no images
    real spacing = 0;                    // at rest [m]

    int count() const { return static_cast<int>(x[0].size()); }
    particles::Coordinates coordinates() const { return {x[0].data(), x[1].data(), x[2].data()}; }
    int particle(int i) const { return i < own ? i : source[static_cast<std::size_t>(i - own)]; }
};

/// The domain of a liquid; of a flat one it has no sides along z.
struct Domain {
    Vec<3> lo{}, hi{};  // [m]
    std::array<bool, 3> periodic{};
    bool flat = false;

    /// f(x of an image along an axis) for those of a particle that is closer to a side than `band`.
    template <class F>
    void for_images(std::size_t axis, real x, real band, const F& f) const {
        const real size = hi[axis] - lo[axis];
        if (x - lo[axis] < band && x >= lo[axis]) f(periodic[axis] ? x + size : 2 * lo[axis] - x);
        if (hi[axis] - x < band && x <= hi[axis]) f(periodic[axis] ? x - size : 2 * hi[axis] - x);
    }
};

/// A component each; in 2D two.
using Components = std::vector<std::span<const real>>;

/// To a cloud whose spacing is known: particles, with images of those within a band of a side: the liquid goes on beyond a wall, or
/// repeats, so that its surface meets the side as it would meet more liquid. A flat liquid is a slice of one that goes on for ever: its
/// particles again, a spacing in front and behind, as far as they count.
void gather(const Components& position, const Domain& domain, real band, Cloud& cloud);

/// What all ranks know of all particles.
struct Extent {
    particles::Box box;               // of particles and images
    std::array<real, 3> least, most;  // of particles
    std::int64_t count = 0;           // with images
    bool finite = true;
};
Extent extent_of(const Cloud& cloud);
/// From that of each rank.
Extent extent_of_all(const Extent& own);

/// Of particles of which each rank shows its part, this rank's; of those that all have, as many as any other rank takes.
Components part_of(const FieldSet& fields, const FieldView& field);

/// Of particles that each give their own, those that this rank reads, in the order of one process; velocities where there are any.
struct Brought {
    std::array<std::vector<real>, 3> x, v;
};
/// readers(x along the axis): the ranks that read what stands there; also where images along that axis do, of those in a band.
Brought bring_particles(const Components& position, const Components& velocity, const Domain& domain, std::size_t axis, real band,
                        const std::function<std::span<const int>(real)>& readers);

}  // namespace weir::reconstruction
