// A bed with a depth that varies along x, and its effect on a wave of given frequency from deep water (Fournier & Reeves 1986, with the
// exact dispersion relation instead of their fit):
//
//     omega^2 = (g k + sigma k^3/rho) tanh(k h(x)),   k_z = const (Snell),   phase = integral of sqrt(k^2 - k_z^2) dx
//
// They leave the height unchanged; here it follows from conservation of energy along rays: a^2 c_g cos(heading) = const (Green's law),
// limited by the breaking height, 0.78 h (McCowan 1894).
#pragma once
#include "waves/dispersion.hpp"

#include <vector>

namespace weir::waves {

/// Depth at points along x, linear between them, constant beyond them.
struct Bed {
    std::vector<real> x, depth;
    bool empty() const { return x.empty(); }
    real at(real where) const;
    real slope(real where) const;  // d depth / dx
};

/// One wave over the bed.
class Shoaled {
public:
    struct Place {
        real phase = 0;  // the integral from the bed's first point [rad]
        real kx = 0, k = 0;
        real growth = 1;  // of the amplitude
        real depth = infinity;
    };
    /// kx, kz: in deep water.
    Shoaled(const Bed& bed, const Restoring& by, real kx, real kz, real omega);
    Place at(real x) const;
    std::size_t bytes() const { return (phase_.capacity() + kx_.capacity() + growth_.capacity()) * sizeof(real); }

private:
    real from_, step_, kz_;
    std::vector<real> phase_, kx_, growth_;  // at nodes
    Bed bed_;
};

}  // namespace weir::waves
