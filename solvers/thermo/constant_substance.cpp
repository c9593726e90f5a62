// A substance with constant heat capacities, densities and conductivities; the equations of its phase boundaries are in substance.hpp.
#include "core/error.hpp"
#include "thermo/substance.hpp"

#include <cstdio>

namespace weir::thermo {

namespace {

class ConstantSubstance final : public Substance {
public:
    explicit ConstantSubstance(const Constants& constants)
        : k_(constants),
          shrinking_(1 / constants.liquid_density - 1 / constants.solid_density),
          R_(k_.vaporisation * (1 / k_.triple.T - 1 / k_.critical.T) / std::log(k_.critical.p / k_.triple.p)) {}
    const char* name() const override { return "this substance"; }
    std::optional<Point> triple() const override { return k_.triple; }
    std::optional<Point> critical() const override { return k_.critical; }
    bool has(Boundary) const override { return true; }
    std::pair<real, real> ends(Boundary boundary) const override {
        if (boundary == Boundary::saturation) return {k_.triple.T, k_.critical.T};
        if (boundary == Boundary::sublimation) return {0, k_.triple.T};
        if (upright()) return {k_.triple.T, k_.triple.T};
        return shrinking_ < 0 ? std::pair{real(0), k_.triple.T} : std::pair{k_.triple.T, infinity};
    }
    real pressure(Boundary boundary, real T) const override {
        if (boundary != Boundary::melting) return k_.triple.p * std::exp(heat(boundary) / R_ * (1 / k_.triple.T - 1 / T));
        return upright() ? k_.triple.p : k_.triple.p + k_.fusion / shrinking_ * std::log(T / k_.triple.T);
    }
    real slope(Boundary boundary, real T) const override {
        if (boundary != Boundary::melting) return pressure(boundary, T) * heat(boundary) / (R_ * T * T);
        return upright() ? infinity : k_.fusion / (shrinking_ * T);
    }
    real temperature(Boundary boundary, real p) const override {
        if (boundary == Boundary::melting)
            return upright() ? k_.triple.T : k_.triple.T * std::exp((p - k_.triple.p) * shrinking_ / k_.fusion);
        return 1 / (1 / k_.triple.T - R_ / heat(boundary) * std::log(p / k_.triple.p));
    }
    real density(State state, const Point& at) const override {
        if (state == State::solid) return k_.solid_density;
        return state == State::liquid ? k_.liquid_density : at.p / (R_ * at.T);
    }
    real latent_heat(Boundary boundary, real) const override { return heat(boundary); }
    Conduction conduction(State state) const override {
        return state == State::solid ? k_.solid : state == State::liquid ? k_.liquid : k_.vapour;
    }
    real expansion(real) const override { return k_.expansion; }

private:
    bool upright() const { return shrinking_ == 0 || k_.fusion == 0; }
    real heat(Boundary boundary) const {
        if (boundary == Boundary::melting) return k_.fusion;
        return boundary == Boundary::saturation ? k_.vaporisation : k_.fusion + k_.vaporisation;
    }
    Constants k_;
    real shrinking_;  // v_liquid − v_solid [m^3/kg]
    real R_;          // [J/(kg K)]
};

std::string text(real value, const char* unit) {
    char out[48];
    std::snprintf(out, sizeof out, "%.6g %s", value, unit);
    return out;
}

}  // namespace

std::vector<Fault> faults(const Constants& k) {
    std::vector<Fault> list;
    const auto positive = [&](const char* name, real value, const char* unit) {
        if (!(value > 0)) list.push_back({name, "is " + text(value, unit) + ", not above 0"});
    };
    positive("triple", k.triple.T, "K");
    positive("triple", k.triple.p, "Pa");
    positive("critical", k.critical.T, "K");
    positive("critical", k.critical.p, "Pa");
    if (list.empty() && !(k.critical.T > k.triple.T))
        list.push_back({"triple", "is at " + text(k.triple.T, "K") + ", not below the critical point at " + text(k.critical.T, "K")});
    if (list.empty() && !(k.critical.p > k.triple.p))
        list.push_back({"triple", "is at " + text(k.triple.p, "Pa") + ", not below the critical point at " + text(k.critical.p, "Pa")});
    if (k.fusion < 0) list.push_back({"fusion", "is " + text(k.fusion, "J/kg") + ", below 0"});
    positive("vaporisation", k.vaporisation, "J/kg");
    positive("solid.density", k.solid_density, "kg/m^3");
    positive("liquid.density", k.liquid_density, "kg/m^3");
    positive("solid.heat_capacity", k.solid.heat_capacity, "J/(kg K)");
    positive("liquid.heat_capacity", k.liquid.heat_capacity, "J/(kg K)");
    positive("vapour.heat_capacity", k.vapour.heat_capacity, "J/(kg K)");
    if (!list.empty()) return list;
    const ConstantSubstance all(k);
    const real melts = all.temperature(Boundary::melting, k.critical.p);
    if (!(melts < k.critical.T))
        list.push_back({"fusion", "lets the solid melt at " + text(melts, "K") + " under the critical pressure, above the critical " +
                                      text(k.critical.T, "K")});
    return list;
}

SubstancePtr of_constants(const Constants& constants) {
    if (const auto wrong = faults(constants); !wrong.empty()) throw BadInput(wrong.front().constant + " " + wrong.front().message);
    return std::make_shared<ConstantSubstance>(constants);
}

}  // namespace weir::thermo
