#include "thermo/heat_curve.hpp"

#include <algorithm>
#include <stdexcept>

namespace weir::thermo {

const char* name_of(State state) {
    constexpr std::array names{"solid", "liquid", "vapour", "supercritical"};
    return names[static_cast<std::size_t>(state)];
}

HeatCurve::HeatCurve(State state, real heat_capacity, real T, real h) { line_[0] = {state, heat_capacity, T, h}; }

void HeatCurve::then(State state, real heat_capacity, real T, real latent_heat) {
    if (count_ == 3) throw std::logic_error("a heat curve has three states at most");
    Line& last = line_[static_cast<std::size_t>(count_ - 1)];
    last.h_high = last.h + last.c * (T - last.T);
    const real h = last.h_high + latent_heat;
    line_[static_cast<std::size_t>(count_++)] = {state, heat_capacity, T, h, T, h};
}

real HeatCurve::enthalpy(real T) const {
    int i = count_ - 1;
    while (i > 0 && T < at(i).T_low) --i;
    return at(i).h + at(i).c * (T - at(i).T);
}

real HeatCurve::enthalpy(const Warmth& w) const {
    if (w.share > 0) return at(w.state).h_high + w.share * latent_heat(w.state);
    return std::min(at(w.state).h + at(w.state).c * (w.T - at(w.state).T), at(w.state).h_high);
}

Warmth HeatCurve::warmth(real enthalpy) const {
    int i = count_ - 1;
    while (i > 0 && enthalpy < at(i).h_low) --i;
    const Line& line = at(i);
    if (enthalpy > line.h_high) return {at(i + 1).T_low, i, (enthalpy - line.h_high) / latent_heat(i)};
    const real T = line.T + (enthalpy - line.h) / line.c;
    return {i + 1 < count_ ? std::min(T, at(i + 1).T_low) : T, i, 0};
}

real HeatCurve::share(State state, const Warmth& w) const {
    if (at(w.state).state == state) return 1 - w.share;
    return w.share > 0 && at(w.state + 1).state == state ? w.share : 0;
}

}  // namespace weir::thermo
