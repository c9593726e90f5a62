// Steady flow behind a grid of bars (Kovasznay 1948), exact, with L = U = 1 and Re = 1/nu:
//   u = 1 - exp(lambda x) cos 2 pi y,  v = lambda/(2 pi) exp(lambda x) sin 2 pi y,  p/rho = -exp(2 lambda x)/2 + const,
//   lambda = Re/2 - sqrt(Re^2/4 + 4 pi^2).
#pragma once
#include "core/types.hpp"

namespace weir::validation {

struct Kovasznay {
    real Re = 40;
    real lambda() const { return Re / 2 - std::sqrt(Re * Re / 4 + 4 * pi * pi); }
    Vec<2> velocity(const Vec<2>& x) const {
        const real l = lambda(), growth = std::exp(l * x[0]);
        return {1 - growth * std::cos(2 * pi * x[1]), l / (2 * pi) * growth * std::sin(2 * pi * x[1])};
    }
    /// Per unit of density.
    real pressure(const Vec<2>& x) const { return -std::exp(2 * lambda() * x[0]) / 2; }
};

}  // namespace weir::validation
