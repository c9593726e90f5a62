// The particles of a surface, with their images beyond the sides of the domain. In parallel each rank has those that it reads; the
// partition is known to all ranks.
#pragma once
#include "core/solver.hpp"
#include "particles/threads/cell_sort.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace weir::surfaces {

/// The particles at one time, followed by their images beyond walls and periodic sides.
struct Cloud {
    std::array<std::vector<real>, 3> x;  // [m]
    std::vector<int> source;             // particle of each image
    int own = 0;                         // number of particles, without images
    real spacing = 0;                    // at rest [m]

    int count() const { return static_cast<int>(x[0].size()); }
    particles::Coordinates coordinates() const { return {x[0].data(), x[1].data(), x[2].data()}; }
    int particle(int i) const { return i < own ? i : source[static_cast<std::size_t>(i - own)]; }
};

/// The domain of a liquid; in 2D it has no sides along z.
struct Domain {
    Vec<3> lo{}, hi{};  // [m]
    std::array<bool, 3> periodic{};
    bool flat = false;

    /// f(x of an image along an axis) for the images of a particle closer to a side than `band`.
    template <class F>
    void for_images(std::size_t axis, real x, real band, const F& f) const {
        const real size = hi[axis] - lo[axis];
        if (x - lo[axis] < band && x >= lo[axis]) f(periodic[axis] ? x + size : 2 * lo[axis] - x);
        if (hi[axis] - x < band && x <= hi[axis]) f(periodic[axis] ? x - size : 2 * hi[axis] - x);
    }
};

/// One span per component; in 2D two.
using Components = std::vector<std::span<const real>>;

/// Fills a cloud of known spacing: particles, with images of those within a band of a side. The liquid continues behind a wall, or repeats,
/// so that its surface meets the side as if there were more liquid. A 2D liquid is a slice of an infinite one: copies of its particles, one
/// spacing in front and behind, as far as they contribute.
void gather(const Components& position, const Domain& domain, real band, Cloud& cloud);

/// Global properties of all particles.
struct CloudExtent {
    particles::Box box;               // of particles and images
    std::array<real, 3> least, most;  // of particles
    std::int64_t count = 0;           // with images
    bool finite = true;
};
CloudExtent extent_of(const Cloud& cloud);
/// Combines those of all ranks.
CloudExtent extent_of_all(const CloudExtent& own);

/// This rank's components of particles: its part where they are distributed, otherwise an equal share.
Components part_of(const FieldSet& fields, const FieldView& field);

/// The particles that this rank reads, received from their owners, in the order of one process; velocities where there are any.
struct ReceivedParticles {
    std::array<std::vector<real>, 3> x, v;
};
/// readers(x along the axis): the ranks that read particles at x; also applied to images, for particles in a band.
ReceivedParticles receive_particles(const Components& position, const Components& velocity, const Domain& domain, std::size_t axis,
                                    real band, const std::function<std::span<const int>(real)>& readers);

}  // namespace weir::surfaces
