// What a rank sends of a level set and of the velocity that is continued beyond the liquid: the exchanges of LevelSet::redistance() and of
// Extrapolation, for the formulas of solvers that have them (core/traffic.hpp).
#pragma once
#include "core/traffic.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace weir::surface {

/// An array over cells or faces n, of `each` bytes an entry.
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
    int visits;  // of one of them
    PlaneSize cells;
    std::array<PlaneSize, D> faces{};

    SurfaceTally(const Index<D>& n_, const Vec<D>& h, real cfl, bool ring_)
        : n(n_), ring(ring_), layers(static_cast<int>(std::ceil(cfl)) + 4), cells(plane_of(n, sizeof(real))) {
        real least = h[0], most = h[0];
        for (int d = 1; d < D; ++d) least = std::min(least, h[d]), most = std::max(most, h[d]);
        visits = most <= least * (1 + 1e-9) ? 2 : 1 + static_cast<int>(std::ceil(most / least));
        for (int a = 0; a < D; ++a) faces[static_cast<std::size_t>(a)] = plane_of(n + e<D>(a), sizeof(real));
    }

    /// Who is inside is known as far as the band is found beyond the cuts; values of a layer are found in several visits, each time from
    /// those beside them.
    void distance(Tally& tally) const {
        const int found = 2 * layers;
        tally.refresh({plane_of(n, sizeof(std::uint8_t))}, found + 1);
        tally.refresh({cells}, 1, 1 + visits * (layers - 1));
        tally.refresh({cells}, layers);
    }
    /// Liquid parts of cells before each sweep, before, between and after what is handed on; φ, and how far both stand apart.
    void liquid_parts(Tally& tally) const {
        constexpr int passes = 2;
        tally.refresh({cells}, 2, D + 1 + passes);
        tally.refresh({cells}, 3);
        tally.refresh({cells}, 1, 2);
    }
    /// Which faces are known as far as a slope looks behind the last layer; a layer is found from three planes at the cuts, or four around
    /// the axis, later ones from one.
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

}  // namespace weir::surface
