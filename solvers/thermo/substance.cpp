#include "thermo/substance.hpp"

#include "core/error.hpp"
#include "thermo/invert.hpp"

#include <cstdio>
#include <string>

namespace weir::thermo {

namespace {

std::string digits(real value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

/// "0.1 Pa is below the sublimation line of water, which begins at ..."
[[noreturn]] void refuse(const std::string& what, const std::string& why) { throw BadInput(what + ": " + why); }

}  // namespace

const char* name_of(Boundary boundary) {
    return boundary == Boundary::sublimation ? "sublimation" : boundary == Boundary::melting ? "melting" : "saturation";
}

real Substance::temperature(Boundary boundary, real p) const {
    const auto [lo, hi] = ends(boundary);
    const real p_lo = pressure(boundary, lo), p_hi = pressure(boundary, hi);
    if (p == p_lo) return lo;
    if (p == p_hi) return hi;
    if (!(p > std::min(p_lo, p_hi) && p < std::max(p_lo, p_hi)))
        refuse("the " + std::string(name_of(boundary)) + " line of " + name() + " does not reach " + digits(p) + " Pa",
               "it runs from " + digits(std::min(p_lo, p_hi)) + " to " + digits(std::max(p_lo, p_hi)) + " Pa");
    // ln p is nearly linear in 1/T for boundaries with vapour, p itself nearly linear in T otherwise
    if (boundary == Boundary::melting)
        return root_between(lo, hi, [&](real T) { return std::pair{pressure(boundary, T) - p, slope(boundary, T)}; });
    const real inverse = root_between(1 / hi, 1 / lo, [&](real x) {
        const real T = 1 / x, at = pressure(boundary, T);
        return std::pair{std::log(at / p), -slope(boundary, T) * T * T / at};
    });
    return 1 / inverse;
}

real Substance::colder_density(Boundary boundary, real T) const {
    return density(boundary == Boundary::saturation ? State::liquid : State::solid, {T, pressure(boundary, T)});
}

real Substance::warmer_density(Boundary boundary, real T) const {
    return density(boundary == Boundary::melting ? State::liquid : State::vapour, {T, pressure(boundary, T)});
}

real Substance::latent_heat(Boundary boundary, real T) const {
    return T * slope(boundary, T) * (1 / warmer_density(boundary, T) - 1 / colder_density(boundary, T));
}

void Substance::check_range(const Point& at) const {
    if (!(at.T > 0)) refuse("a temperature of " + digits(at.T) + " K", "it must be greater than 0 K");
    if (!(at.p > 0)) refuse("a pressure of " + digits(at.p) + " Pa", "it must be greater than 0 Pa");
    if (at.T < lowest().T)
        refuse("a temperature of " + digits(at.T) + " K",
               std::string("the formulas of ") + name() + " begin at " + digits(lowest().T) + " K");
    if (at.p > highest().p)
        refuse("a pressure of " + digits(at.p) + " Pa",
               std::string("the formulas of ") + name() + " end at " + digits(highest().p) + " Pa");
}

State Substance::state(const Point& at) const {
    check_range(at);
    const auto within = [&](Boundary b) { return has(b) && at.T >= ends(b).first && at.T <= ends(b).second; };
    const bool above_melting = within(Boundary::melting) && at.p >= pressure(Boundary::melting, at.T);
    const auto critical_point = critical();
    if (has(Boundary::melting) && triple()) {
        // a solid lighter than its melt liquefies under pressure, others solidify; for a vertical boundary the temperature decides
        // temperature decides.
        const real tilt = slope(Boundary::melting, triple()->T);
        const bool shrinks = tilt < 0, upright = std::isinf(tilt);
        if (at.T < triple()->T) {
            if (at.p <= pressure(Boundary::sublimation, at.T)) return State::vapour;
            return shrinks && above_melting ? State::liquid : State::solid;
        }
        if (!shrinks && !upright && above_melting && at.p > pressure(Boundary::melting, at.T)) return State::solid;
    }
    if (critical_point && at.T >= critical_point->T) return at.p >= critical_point->p ? State::supercritical : State::vapour;
    if (!has(Boundary::saturation)) return State::vapour;
    return at.p > pressure(Boundary::saturation, at.T) ? State::liquid : State::vapour;
}

HeatCurve Substance::heat_curve(real p) const {
    check_range({std::max(lowest().T, real(1)), p});
    const auto c = [&](State s) { return conduction(s).heat_capacity; };
    const auto three = triple();
    if (!has(Boundary::saturation)) return {State::vapour, c(State::vapour), 0, 0};
    const auto boil = [&](HeatCurve& curve) {
        const Point top = *critical();
        if (p >= top.p) return curve.then(State::supercritical, c(State::vapour), top.T, 0);
        const real T = temperature(Boundary::saturation, p);
        curve.then(State::vapour, c(State::vapour), T, latent_heat(Boundary::saturation, T));
    };
    if (!three) {
        HeatCurve curve(State::liquid, c(State::liquid), p < critical()->p ? temperature(Boundary::saturation, p) : critical()->T, 0);
        boil(curve);
        return curve;
    }
    // the solid at the triple point has the liquid's enthalpy minus the heat of fusion
    HeatCurve curve(State::solid, c(State::solid), three->T, -latent_heat(Boundary::melting, three->T));
    if (p <= three->p) {
        const real T = temperature(Boundary::sublimation, p);
        curve.then(State::vapour, c(State::vapour), T, latent_heat(Boundary::sublimation, T));
        return curve;
    }
    const real T = temperature(Boundary::melting, p);
    curve.then(State::liquid, c(State::liquid), T, latent_heat(Boundary::melting, T));
    boil(curve);
    return curve;
}

}  // namespace weir::thermo
