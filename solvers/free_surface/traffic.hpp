// Estimate of what a rank sends for a level set and the extrapolated velocity: the exchanges of LevelSet::redistance() and of
// Extrapolation, for the estimates of solvers (parallel/traffic.hpp).
#pragma once
#include "core/types.hpp"
#include "parallel/traffic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace weir::free_surface {

/// An array over cells or faces n, with `each` bytes per entry.
template <int D>
PlaneSize plane_of(const Index<D>& n, std::size_t each) {
    for (int d = 0; d + 1 < D; ++d) each *= static_cast<std::size_t>(n[d]);
    return {each, n[D - 1]};
}

template <int D>
struct SurfaceTally {
    Index<D> n;
    bool ring;
    int layers;  // of the band
    int visits;  // per layer
    PlaneSize cells;
    std::array<PlaneSize, D> faces{};

    SurfaceTally(const Index<D>& n_, const Vec<D>& h, real cfl, bool ring_)
        : n(n_), ring(ring_), layers(static_cast<int>(std::ceil(cfl)) + 4), cells(plane_of(n, sizeof(real))) {
        real least = h[0], most = h[0];
        for (int d = 1; d < D; ++d) least = std::min(least, h[d]), most = std::max(most, h[d]);
        visits = most <= least * (1 + 1e-9) ? 2 : 1 + static_cast<int>(std::ceil(most / least));
        for (int a = 0; a < D; ++a) faces[static_cast<std::size_t>(a)] = plane_of(n + e<D>(a), sizeof(real));
    }

    /// The flags of inside cells as far as the band is found in ghost planes; the values of a layer in several visits, each from their
    /// neighbours.
    void distance(Tally& tally) const {
        const int found = 2 * layers;
        tally.refresh({plane_of(n, sizeof(std::uint8_t))}, found + 1);
        tally.refresh({cells}, 1, 1 + visits * (layers - 1));
        tally.refresh({cells}, layers);
    }
    /// Liquid fractions before each sweep and before, between and after redistributions; φ, and the difference of both.
    void liquid_parts(Tally& tally) const {
        constexpr int passes = 2;
        tally.refresh({cells}, 2, D + 1 + passes);
        tally.refresh({cells}, 3);
        tally.refresh({cells}, 1, 2);
    }
    /// The marks of known faces as far as a slope reads behind the last layer. The first layers need three ghost planes, or four around a
    /// periodic axis; later ones need one.
    void continue_velocity(Tally& tally, int to) const {
        const int behind = ring ? 4 : 3;
        std::array<PlaneSize, D> marks;
        for (int a = 0; a < D; ++a) marks[static_cast<std::size_t>(a)] = plane_of(n + e<D>(a), sizeof(std::uint8_t));
        tally.refresh(marks, to + 4);
        tally.refresh(faces, behind);
        for (const PlaneSize& component : faces) {
            if (to > 1) tally.refresh({component}, behind);
            if (to > 2) tally.refresh({component}, 1, to - 2);
        }
    }
};

}  // namespace weir::free_surface
