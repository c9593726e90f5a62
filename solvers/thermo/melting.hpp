// Solid and liquid of a substance at the pressure of a scene, for loops over cells or particles: temperature as a function of specific
// enthalpy with the plateau of the phase change (Voller & Prakash 1987).
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"
#include "thermo/substance.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace weir::thermo {

struct Melting {
    real T = 0;                      // of melting [K]
    real h_solid = 0, h_liquid = 0;  // the ends of the plateau [J/kg]
    real c_solid = 0, c_liquid = 0;  // [J/(kg K)]
    real k_solid = 0, k_liquid = 0;  // [W/(m K)]
    real boils_above = infinity;     // [J/kg]

    real temperature(real h) const {
        return T + ((std::min(h, h_solid) - h_solid) / c_solid + (std::max(h, h_liquid) - h_liquid) / c_liquid);
    }
    real liquid(real h) const { return h >= h_liquid ? 1 : h <= h_solid ? 0 : (h - h_solid) / (h_liquid - h_solid); }
    /// At the melting temperature, that of the liquid.
    real enthalpy(real at) const { return at < T ? h_solid + c_solid * (at - T) : h_liquid + c_liquid * (at - T); }
    /// dH/dT; 0 on the plateau, where the temperature is constant.
    real capacity(real h) const { return h < h_solid ? c_solid : h > h_liquid ? c_liquid : 0; }
    real conductivity(real share) const { return k_solid + share * (k_liquid - k_solid); }
};

/// For a scene's substance at its `heat.pressure`. Rejects substances without a liquid that freezes, and a `fluid.density` that is neither
/// phase's: `solver` uses one density for both, and is named in the message.
Melting melting_of(const scene::Scene& scene, const std::string& solver);

/// At another pressure. Throws BadInput where there is no melting at it.
Melting melting_at(const Substance& substance, real pressure);

/// Relative density difference of a liquid to its melting point: the integral of the coefficient of thermal expansion over temperature, the
/// factor of gravity in the Boussinesq approximation. Zero in a solid.
class Lightness {
public:
    explicit Lightness(const scene::Scene& scene);
    real operator()(real T) const {
        const real at = std::clamp((T - melts_) * per_step_, real(0), real(steps));
        const auto i = std::min(static_cast<std::size_t>(at), steps - 1);
        return value_[i] + (at - static_cast<real>(i)) * (value_[i + 1] - value_[i]);
    }

private:
    static constexpr std::size_t steps = 512;  // for water a sixth of a kelvin up to boiling
    real melts_, per_step_;
    std::array<real, steps + 1> value_{};
};

}  // namespace weir::thermo
