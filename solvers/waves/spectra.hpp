// Spectra of wind seas, as densities of the variance of the surface elevation.
//
//     Pierson & Moskowitz 1964   S(w) = 8.1e-3 g^2 w^-5 exp(-0.74 (g / (w U))^4)          U at 19.5 m above the sea, a sea fully risen
//     JONSWAP (Hasselmann 1973)  S(w) = a g^2 w^-5 exp(-1.25 (wp/w)^4) G^exp(-(w - wp)^2 / (2 s^2 wp^2))
//                                a = 0.076 (U^2/(F g))^0.22, wp = 22 (g^2/(U F))^(1/3), s = 0.07 below the peak and 0.09 above, U at 10 m
//     Phillips 1958, as Tessendorf 2001 rounds it off    E(k) = (A/2) k^-3 exp(-1/(k L)^2), L = U^2/g; its variance is A L^2 / 4
//
// Spreading over directions: N(s) cos^2s((theta - wind)/2) (Longuet-Higgins, Cartwright & Smith 1963).
#pragma once
#include "waves/dispersion.hpp"

#include <string>

namespace weir::waves {

struct Spectrum {
    enum class Kind { pierson_moskowitz, jonswap, phillips };
    Kind kind = Kind::pierson_moskowitz;
    Restoring by;
    real depth = infinity;
    real alpha = 0;   // level of the tail
    real peak = 0;    // peak frequency [1/s]; for Phillips that of k = sqrt(2/3)/L
    real gamma = 1;   // JONSWAP's G
    real length = 0;  // Phillips's L [m]

    /// Variance per unit of frequency [m^2 s].
    real of_frequency(real omega) const;
    /// Variance per unit of wavenumber, over all directions [m^3].
    real of_wavenumber(real k) const;
    /// Variance of the sea [m^2]: the significant height is 4 times its root.
    real variance() const;
    real peak_wavenumber() const;
};

Spectrum pierson_moskowitz(const Restoring& by, real depth, real wind);
Spectrum jonswap(const Restoring& by, real depth, real wind, real fetch, real gamma);
Spectrum phillips(const Restoring& by, real depth, real wind, real alpha);

/// Directional spreading about the wind's direction; its integral over a circle is 1 [1/rad].
class Spreading {
public:
    explicit Spreading(real s);
    real operator()(real angle) const { return scale_ * std::pow(std::abs(std::cos(0.5 * angle)), 2 * s_); }

private:
    real s_, scale_;
};

}  // namespace weir::waves
