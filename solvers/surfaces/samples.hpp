// A scalar on a lattice: depth inside the liquid. Its zero level set is the surface.
#pragma once
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "parallel/plane_store.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>

namespace weir::surfaces {

/// The layers that a rank owns, for this partition of the lattice's planes: layer k lies between plane k and the next.
inline PlaneRange layers_of(const Partition& cut, int rank) {
    return {std::min(cut.begin(rank), cut.planes() - 1), std::min(cut.end(rank, cut.planes()), cut.planes() - 1)};
}

/// Planes of the slowest axis may be distributed: each rank owns a slab and stores two ghost planes on each side.
struct Samples {
    std::array<int, 3> n{0, 0, 0};  // along each axis, x fastest
    Vec<3> first{};                 // position of the first one [m]
    std::array<real, 3> spacing{1, 1, 1};
    real unit = 1;            // [m]
    PlaneStore<float> depth;  // inside the liquid, in units; negative outside, clamped to [-1, 1]
    PlaneRange own{0, 0}, held{0, 0}, layers{0, 0};
    std::shared_ptr<const Slab> slab{};  // of the planes of depth; nullptr: all

    /// Allocates all of them; in parallel, with this partition, those that this rank stores.
    void make_room(const Partition& cut = {});
    /// In parallel: fills the ghost planes from their owners.
    void exchange(const Partition& cut);
    /// In 3D z, for a plane of samples y.
    int slowest() const { return n[2] > 1 ? 2 : 1; }
    std::size_t plane() const { return static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(slowest() == 2 ? n[1] : 1); }
    std::size_t linear(int i, int j, int k) const {
        return static_cast<std::size_t>(i) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(j) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(k));
    }
    float& operator()(int i, int j, int k) { return depth.data()[linear(i, j, k)]; }
    float operator()(int i, int j, int k) const { return depth.data()[linear(i, j, k)]; }
    Vec<3> position(int i, int j, int k) const {
        return {{first[0] + spacing[0] * i, first[1] + spacing[1] * j, first[2] + spacing[2] * k}};
    }
    /// The two samples around a point along an axis (the outermost beyond the lattice): the lower one and the interpolation weight.
    struct Between {
        std::size_t low;
        real part;
    };
    Between between(std::size_t axis, real x) const;
    /// The layer that contains a point.
    int layer_of(const Vec<3>& x) const;
    /// Returns whether the samples around a point are stored here: in or next to this rank's layers.
    bool is_near(const Vec<3>& x) const;
    /// Trilinear; constant beyond the outermost samples.
    real at(const Vec<3>& x) const;
};

/// f(i, j, k) for the samples of these planes, on threads.
template <class F>
void for_samples(const Samples& samples, PlaneRange planes, const F& f) {
    const bool flat = samples.slowest() == 1;
    parallel_for(planes.begin, planes.end, [&](int plane) {
        for (int j = flat ? plane : 0; j < (flat ? plane + 1 : samples.n[1]); ++j)
            for (int i = 0; i < samples.n[0]; ++i) f(i, j, flat ? 0 : plane);
    });
}

}  // namespace weir::surfaces
