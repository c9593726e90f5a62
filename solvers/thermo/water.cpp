// Water. With θ = T/T_c, τ = 1 − θ, x = T/T_t:
//   saturation    ln(p/p_c) = (1/θ) Σ aᵢ τ^eᵢ,  ρ_l/ρ_c = 1 + Σ bᵢ τ^eᵢ,  ln(ρ_v/ρ_c) = Σ cᵢ τ^eᵢ      IAPWS SR1-86(1992),
//   enthalpies    h = α(θ) + (T/ρ) dp/dT                                                                Wagner & Pruss 1993
//   sublimation   ln(p/p_t) = (1/x) Σ aᵢ x^eᵢ                                                           IAPWS R14-08(2011)
//   melting       p/p_t = 1 + Σ aᵢ (1 − x^eᵢ)   of ice Ih, 251.165 K to T_t
#include "core/error.hpp"
#include "thermo/substance.hpp"

#include <algorithm>
#include <array>

namespace weir::thermo {

namespace {

constexpr Point triple_point{273.16, 611.657}, critical_point{647.096, 22.064e6};
constexpr real critical_density = 322, gas_constant = 461.526;
constexpr real melting_end = 251.165;      // triple point of ice Ih, ice III and water [K]
constexpr real sublimation_begin = 50;     // [K]
constexpr real ice_density = 916.7094922;  // IAPWS R10-06(2009) at the triple point
// at constant temperature, of ice (R10-06) and of water at 0 °C (IAPWS-95) [1/Pa]; without them the heat of fusion along the melting curve
// would have an error of 6% at 15 MPa, since its Δv is a small difference
constexpr real ice_compressibility = 1.1779e-10, water_compressibility = 5.0885e-10;

/// a x^e
struct Term {
    real a, e;
};
template <std::size_t N>
real sum(const std::array<Term, N>& terms, real x) {
    real total = 0;
    for (const Term& t : terms) total += t.a * std::pow(x, t.e);
    return total;
}
/// Its derivative: Σ a e x^(e − 1).
template <std::size_t N>
real derivative(const std::array<Term, N>& terms, real x) {
    real total = 0;
    for (const Term& t : terms) total += t.a * t.e * std::pow(x, t.e - 1);
    return total;
}

constexpr std::array<Term, 6> saturation{
    {{-7.85951783, 1}, {1.84408259, 1.5}, {-11.7866497, 3}, {22.6807411, 3.5}, {-15.9618719, 4}, {1.80122502, 7.5}}};
constexpr std::array<Term, 6> liquid_density{{{1.99274064, 1.0 / 3},
                                              {1.09965342, 2.0 / 3},
                                              {-0.510839303, 5.0 / 3},
                                              {-1.75493479, 16.0 / 3},
                                              {-45.5170352, 43.0 / 3},
                                              {-6.74694450e5, 110.0 / 3}}};
constexpr std::array<Term, 6> vapour_density{{{-2.03150240, 2.0 / 6},
                                              {-2.68302940, 4.0 / 6},
                                              {-5.38626492, 8.0 / 6},
                                              {-17.2991605, 18.0 / 6},
                                              {-44.7586581, 37.0 / 6},
                                              {-63.9201063, 71.0 / 6}}};
constexpr std::array<Term, 5> alpha{
    {{-5.65134998e-8, -19}, {2690.66631, 1}, {127.287297, 4.5}, {-135.003439, 5}, {0.981825814, 54.5}}};  // in θ, [kJ/kg]
constexpr real alpha_at_zero = -1135.905627715;
constexpr std::array<Term, 3> sublimation{{{-21.2144006, 0.00333333333}, {27.3203819, 1.20666667}, {-6.10598130, 1.70333333}}};
constexpr std::array<Term, 3> melting{{{1.19539337e6, 3}, {8.08183159e4, 25.75}, {3.33826860e3, 103.75}}};

real tau(real T) { return 1 - T / critical_point.T; }

real saturation_pressure(real T) { return critical_point.p * std::exp(critical_point.T / T * sum(saturation, tau(T))); }
real saturation_slope(real T) {
    const real p = saturation_pressure(T);
    return -p / T * (std::log(p / critical_point.p) + derivative(saturation, tau(T)));
}
real saturated_liquid(real T) { return critical_density * (1 + sum(liquid_density, tau(T))); }
real saturated_vapour(real T) { return critical_density * std::exp(sum(vapour_density, tau(T))); }

class Water final : public Substance {
public:
    const char* name() const override { return "water"; }
    std::optional<Point> triple() const override { return triple_point; }
    std::optional<Point> critical() const override { return critical_point; }
    Point lowest() const override { return {sublimation_begin, 0}; }
    Point highest() const override { return {infinity, pressure(Boundary::melting, melting_end)}; }

    bool has(Boundary) const override { return true; }
    std::pair<real, real> ends(Boundary boundary) const override {
        if (boundary == Boundary::saturation) return {triple_point.T, critical_point.T};
        return {boundary == Boundary::melting ? melting_end : sublimation_begin, triple_point.T};
    }
    real pressure(Boundary boundary, real T) const override {
        if (boundary == Boundary::saturation) return saturation_pressure(T);
        const real x = T / triple_point.T;
        if (boundary == Boundary::sublimation) return triple_point.p * std::exp(sum(sublimation, x) / x);
        return triple_point.p * (1 + sum(melting, 1) - sum(melting, x));
    }
    real slope(Boundary boundary, real T) const override {
        if (boundary == Boundary::saturation) return saturation_slope(T);
        const real x = T / triple_point.T;
        if (boundary == Boundary::melting) return -triple_point.p / triple_point.T * derivative(melting, x);
        return pressure(boundary, T) / triple_point.T * (derivative(sublimation, x) - sum(sublimation, x) / x) / x;
    }

    /// The saturation formula exceeds the triple point's pressure by 1e-7 there: pressures in between are assigned to that point.
    real temperature(Boundary boundary, real p) const override {
        const bool between = boundary == Boundary::saturation && p >= triple_point.p && p <= saturation_pressure(triple_point.T);
        return between ? triple_point.T : Substance::temperature(boundary, p);
    }

    real density(State state, const Point& at) const override {
        if (state == State::solid) return ice_density;
        if (state == State::liquid) return saturated_liquid(std::max(at.T, triple_point.T));
        if (state == State::supercritical) throw BadInput("the density of supercritical water is not known here");
        return at.p / (compressibility_factor(at) * gas_constant * at.T);
    }
    real colder_density(Boundary boundary, real T) const override {
        if (boundary != Boundary::melting) return Substance::colder_density(boundary, T);
        return ice_density * std::exp(ice_compressibility * (pressure(boundary, T) - triple_point.p));
    }
    real warmer_density(Boundary boundary, real T) const override {
        if (boundary == Boundary::saturation) return saturated_vapour(T);
        if (boundary == Boundary::sublimation) return Substance::warmer_density(boundary, T);
        return saturated_liquid(triple_point.T) * std::exp(water_compressibility * (pressure(boundary, T) - triple_point.p));
    }

    /// Ice: heat capacity of R10-06 at 273.15 K and 101325 Pa; conductivity of Slack 1980 at 273 K. Water: mean heat capacity from the
    /// triple to the normal boiling point, consistent with the enthalpies below; conductivity of Ramires et al. 1995 at 298.15 K. Steam: at
    /// 373 K and 101325 Pa, IAPWS-95; conductivity there at zero density, IAPWS R15-11.
    Conduction conduction(State state) const override {
        if (state == State::solid) return {2096.7, 2.14};
        if (state == State::liquid) return {4192.03, 0.6065};
        return {2077, 0.02415};
    }
    real expansion(real T) const override {
        const real t = std::clamp(T, triple_point.T, critical_point.T);
        return critical_density / critical_point.T * derivative(liquid_density, tau(t)) / saturated_liquid(t);
    }

private:
    /// Z = p/(ρ R T) of the vapour: the measured value on the saturation curve, tending to 1 away from it. At constant pressure 1 − Z falls
    /// as T⁻², as the van der Waals attraction does; below the triple point, where only vapour of low pressure exists, it falls as p.
    static real compressibility_factor(const Point& at) {
        const real at_triple = triple_point.p / (saturated_vapour(triple_point.T) * gas_constant * triple_point.T);
        if (at.p <= triple_point.p) return 1 - (1 - at_triple) * at.p / triple_point.p;
        if (at.p >= critical_point.p) throw BadInput("the density of water above its critical pressure is not known here");
        const real T = water()->temperature(Boundary::saturation, at.p), Z = at.p / (saturated_vapour(T) * gas_constant * T);
        return 1 - (1 - Z) * (T / at.T) * (T / at.T);
    }
};

}  // namespace

SubstancePtr water() {
    static const SubstancePtr it = std::make_shared<Water>();
    return it;
}

Saturation water_at_saturation(real T) {
    Saturation s{};
    s.p = saturation_pressure(T), s.dpdT = saturation_slope(T);
    s.liquid_density = saturated_liquid(T), s.vapour_density = saturated_vapour(T);
    const real both = 1000 * (alpha_at_zero + sum(alpha, T / critical_point.T));
    s.liquid_enthalpy = both + T / s.liquid_density * s.dpdT;
    s.vapour_enthalpy = both + T / s.vapour_density * s.dpdT;
    return s;
}

}  // namespace weir::thermo
