// Enthalpy and temperature of a substance at one pressure: linear in each state (one heat capacity per state), with a jump by the latent
// heat between adjacent states. As in the enthalpy method (Voller & Prakash 1987), enthalpy is the variable and temperature follows.
#pragma once
#include "core/types.hpp"

#include <array>

namespace weir::thermo {

enum class State { solid, liquid, vapour, supercritical };

/// "solid", "liquid", "vapour", "supercritical"
const char* name_of(State state);

/// The state of an enthalpy: temperature, and the mass fraction in the next warmer state.
struct Warmth {
    real T = 0;      // [K]
    int state = 0;   // index of the curve's state
    real share = 0;  // of the next one, in [0, 1); nonzero only at the temperature of the phase change
};

class HeatCurve {
public:
    /// The coldest state, without lower limit. It has enthalpy h at T.
    HeatCurve(State state, real heat_capacity, real T, real h);
    /// Appends the state that begins at temperature T [K], above the last one, after absorbing `latent_heat` [J/kg].
    void then(State state, real heat_capacity, real T, real latent_heat);

    int states() const { return count_; }
    State state(int i) const { return at(i).state; }
    real heat_capacity(int i) const { return at(i).c; }                                            // [J/(kg K)]
    real begins_at(int i) const { return at(i).T_low; }                                            // [K]; −∞ for the first
    real latent_heat(int i) const { return i + 1 < count_ ? at(i + 1).h_low - at(i).h_high : 0; }  // to the next state [J/kg]
    real lowest(int i) const { return at(i).h_low; }    // enthalpy where it begins, −∞ for the first
    real highest(int i) const { return at(i).h_high; }  // and where it ends, ∞ for the last [J/kg]

    /// Specific enthalpy [J/kg]; at the temperature of a phase change, that of the warmer state.
    real enthalpy(real T) const;
    real enthalpy(const Warmth& warmth) const;
    Warmth warmth(real enthalpy) const;
    real temperature(real enthalpy) const { return warmth(enthalpy).T; }
    /// Mass fraction in this state.
    real share(State state, const Warmth& warmth) const;

private:
    struct Line {
        State state;
        real c, T, h;                                                  // it passes through (T, h)
        real T_low = -infinity, h_low = -infinity, h_high = infinity;  // range of the state
    };
    const Line& at(int i) const { return line_[static_cast<std::size_t>(i)]; }
    std::array<Line, 3> line_;
    int count_ = 1;
};

}  // namespace weir::thermo
