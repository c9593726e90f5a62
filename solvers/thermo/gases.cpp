// Two equations of state. The ideal gas has a single state. The van der Waals fluid has liquid and vapour, in equilibrium where the Gibbs
// energy of both is equal (Maxwell's equal areas). The equilibrium is exact in a parameter y, half the jump of entropy over R (Lekner, Am.
// J. Phys. 50 (1982) 161): with f = (y cosh y − sinh y) / (sinh y cosh y − y) and g = 1 + 2 f cosh y + f²
//     T/T_c = 27 f (f + cosh y) / (4 g²),   p/p_c = 27 f² (1 − f²) / g²,   v/b = 1 + e^(±y) / f   (− liquid, + vapour).
#include "core/error.hpp"
#include "thermo/invert.hpp"
#include "thermo/substance.hpp"

namespace weir::thermo {

namespace {

class IdealGas final : public Substance {
public:
    IdealGas(real gas_constant, const Conduction& vapour) : R_(gas_constant), vapour_(vapour) {}
    const char* name() const override { return "ideal_gas"; }
    bool has(Boundary) const override { return false; }
    std::pair<real, real> ends(Boundary) const override { return {0, 0}; }
    real pressure(Boundary, real) const override { return 0; }
    real slope(Boundary, real) const override { return 0; }
    real density(State, const Point& at) const override { return at.p / (R_ * at.T); }
    Conduction conduction(State) const override { return vapour_; }
    real expansion(real T) const override { return 1 / T; }

private:
    real R_;
    Conduction vapour_;
};

struct Lekner {
    real f, g, c;
    explicit Lekner(real y) : c(std::cosh(y)) {
        // below y = 0.05 both differences lose digits; their series: (1/3 + y²/30)/(2/3 + 2y²/15), accurate to y⁴/500
        const real s = std::sinh(y);
        f = y < 0.05 ? (1 + y * y / 10 + y * y * y * y / 280) / (2 + y * y * 2 / 5 + y * y * y * y * 4 / 105) : (y * c - s) / (s * c - y);
        g = 1 + 2 * f * c + f * f;
    }
    real T() const { return 27 * f * (f + c) / (4 * g * g); }
    real p() const { return 27 * f * f * (1 - f * f) / (g * g); }
};

class VanDerWaals final : public Substance {
public:
    VanDerWaals(real gas_constant, const Point& critical, const Conduction& liquid, const Conduction& vapour)
        : R_(gas_constant),
          top_(critical),
          a_(27 * R_ * R_ * top_.T * top_.T / (64 * top_.p)),
          b_(R_ * top_.T / (8 * top_.p)),
          liquid_(liquid),
          vapour_(vapour) {}
    const char* name() const override { return "van_der_waals"; }
    std::optional<Point> critical() const override { return top_; }
    Point lowest() const override { return {lowest_reduced * top_.T, 0}; }
    bool has(Boundary boundary) const override { return boundary == Boundary::saturation; }
    std::pair<real, real> ends(Boundary) const override { return {lowest_reduced * top_.T, top_.T}; }
    real pressure(Boundary, real T) const override { return T < top_.T ? top_.p * Lekner(parameter(T)).p() : top_.p; }
    real slope(Boundary, real T) const override {
        if (!(T < top_.T)) return 4 * top_.p / top_.T;
        const real y = parameter(T);
        return 2 * y * R_ / (volume(y, 1) - volume(y, -1));
    }
    real latent_heat(Boundary, real T) const override { return T < top_.T ? 2 * R_ * T * parameter(T) : 0; }
    real colder_density(Boundary, real T) const override { return T < top_.T ? 1 / volume(parameter(T), -1) : 1 / (3 * b_); }
    real warmer_density(Boundary, real T) const override { return T < top_.T ? 1 / volume(parameter(T), 1) : 1 / (3 * b_); }

    /// The root of p(ρ, T) = p on the branch of the state, bounded by the equilibrium densities. The liquid is compressible, by the
    /// equation of state.
    real density(State state, const Point& at) const override {
        real lo = 0, hi = 1 / b_;
        if (at.T < top_.T)
            (state == State::liquid ? lo : hi) = state == State::liquid ? colder_density({}, at.T) : warmer_density({}, at.T);
        hi = std::min(hi, (1 - 1e-12) / b_);
        const auto miss = [&](real rho) {
            const real free = 1 - b_ * rho;
            return std::pair{rho * R_ * at.T / free - a_ * rho * rho - at.p, R_ * at.T / (free * free) - 2 * a_ * rho};
        };
        if (miss(lo).first >= 0) return lo;
        return miss(hi).first <= 0 ? hi : root_between(lo, hi, miss);
    }
    Conduction conduction(State state) const override { return state == State::liquid ? liquid_ : vapour_; }
    real expansion(real T) const override {
        const real rho = T < top_.T ? colder_density({}, T) : 1 / (3 * b_), free = 1 - b_ * rho;
        return R_ / free / (R_ * T / (free * free) - 2 * a_ * rho);
    }

private:
    // ln p falls as 27 T_c/(8 T): at 0.2 T_c it is 1e-6 of the critical one, below the range in which this equation is used
    static constexpr real lowest_reduced = 0.2;
    real parameter(real T) const {
        return root_between(real(1e-9), real(40), [&](real y) {
            const real eps = 1e-6 * y;  // the slope is only used for the search
            const real at = Lekner(y).T();
            return std::pair{T / top_.T - at, -(Lekner(y + eps).T() - at) / eps};
        });
    }
    real volume(real y, int sign) const { return b_ * (1 + std::exp(sign * y) / Lekner(y).f); }

    real R_;
    Point top_;
    real a_, b_;
    Conduction liquid_, vapour_;
};

}  // namespace

SubstancePtr ideal_gas(real gas_constant, const Conduction& vapour) {
    if (!(gas_constant > 0)) throw BadInput("the gas constant is not above 0");
    return std::make_shared<IdealGas>(gas_constant, vapour);
}

SubstancePtr van_der_waals(real gas_constant, const Point& critical, const Conduction& liquid, const Conduction& vapour) {
    if (!(gas_constant > 0)) throw BadInput("the gas constant is not above 0");
    if (!(critical.T > 0 && critical.p > 0)) throw BadInput("the critical point is not above 0 K and 0 Pa");
    return std::make_shared<VanDerWaals>(gas_constant, critical, liquid, vapour);
}

}  // namespace weir::thermo
