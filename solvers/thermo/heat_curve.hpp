// Enthalpy and temperature of a substance at one pressure: straight lines (one heat capacity a state) with a step of latent heat between
// each state and the next warmer one. As in the enthalpy method (Voller & Prakash 1987), enthalpy is what is kept; temperature follows.
#pragma once
#include "core/types.hpp"

#include <array>

namespace weir::thermo {

enum class State { solid, liquid, vapour, supercritical };

/// "solid", "liquid", "vapour", "supercritical"
const char* name_of(State state);

/// What an enthalpy means: a temperature, and how much of the mass has gone over into the next warmer state.
struct Warmth {
    real T = 0;      // [K]
    int state = 0;   // which of the curve's states
    real share = 0;  // of the next one, in [0, 1); not 0 only at the temperature where both may be
};

class HeatCurve {
public:
    /// The coldest state, without lower end. Enthalpy h at T belongs to it.
    HeatCurve(State state, real heat_capacity, real T, real h);
    /// The state that begins at temperature T [K], above the last one, when each kilogramme has taken up `latent_heat` [J/kg].
    void then(State state, real heat_capacity, real T, real latent_heat);

    int states() const { return count_; }
    State state(int i) const { return at(i).state; }
    real heat_capacity(int i) const { return at(i).c; }                                            // [J/(kg K)]
    real begins_at(int i) const { return at(i).T_low; }                                            // [K]; −∞ of the first
    real latent_heat(int i) const { return i + 1 < count_ ? at(i + 1).h_low - at(i).h_high : 0; }  // to the next state [J/kg]
    real lowest(int i) const { return at(i).h_low; }    // enthalpy where it begins, −∞ of the first
    real highest(int i) const { return at(i).h_high; }  // and where it ends, ∞ of the last [J/kg]

    /// Specific enthalpy [J/kg]; at a temperature where two states may be, that of the warmer one.
    real enthalpy(real T) const;
    real enthalpy(const Warmth& warmth) const;
    Warmth warmth(real enthalpy) const;
    real temperature(real enthalpy) const { return warmth(enthalpy).T; }
    /// How much of the mass is in this state.
    real share(State state, const Warmth& warmth) const;

private:
    struct Line {
        State state;
        real c, T, h;                                                  // it passes through (T, h)
        real T_low = -infinity, h_low = -infinity, h_high = infinity;  // and belongs to the state from here to there
    };
    const Line& at(int i) const { return line_[static_cast<std::size_t>(i)]; }
    std::array<Line, 3> line_;
    int count_ = 1;
};

}  // namespace weir::thermo
