// A substance as text for users: weir describe substance NAME.
#include "thermo/scene_substance.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::thermo {

namespace {

constexpr real usual_pressure = 101325;  // [Pa]

std::string points_text(const Substance& s) {
    std::string out;
    const auto add = [&](const char* name, const std::optional<Point>& at) {
        if (at) out += fmt::format("    {:15} {:.6g} K, {:.6g} Pa\n", name, at->T, at->p);
    };
    add("triple point", s.triple());
    add("critical point", s.critical());
    return out;
}

std::string curve_text(const HeatCurve& curve) {
    std::string out = fmt::format("At {:g} Pa:\n", usual_pressure);
    for (int i = 0; i < curve.states(); ++i) {
        if (i > 0)
            out += fmt::format("    at {:.6g} K {:.6g} J/kg make {} of {}\n", curve.begins_at(i), curve.latent_heat(i - 1),
                               name_of(curve.state(i)), name_of(curve.state(i - 1)));
    }
    return out;
}

std::string constants_text(const Substance& s, const HeatCurve& curve) {
    std::string out = fmt::format("Constants:  {:>18} {:>18}\n", "c [J/(kg K)]", "k [W/(m K)]");
    for (int i = 0; i < curve.states(); ++i) {
        const auto c = s.conduction(curve.state(i));
        out += fmt::format("    {:8}{:18.6g} {:18.6g}\n", name_of(curve.state(i)), c.heat_capacity, c.conductivity);
    }
    return out;
}

/// Eleven rows along a phase boundary.
std::string line_text(const Substance& s, Boundary boundary) {
    if (!s.has(boundary)) return "";
    const auto [lo, hi] = s.ends(boundary);
    std::string out = fmt::format("\nThe line of {}:\n{:>12} {:>14} {:>20} {:>20} {:>16}\n", name_of(boundary), "T [K]", "p [Pa]",
                                  "colder [kg/m^3]", "warmer [kg/m^3]", "latent [J/kg]");
    for (int i = 0; i <= 10; ++i) {
        const real T = lo + (hi - lo) * i / 10;
        out += fmt::format("{:12.3f} {:14.6g} {:20.6g} {:20.6g} {:16.6g}\n", T, s.pressure(boundary, T), s.colder_density(boundary, T),
                           s.warmer_density(boundary, T), s.latent_heat(boundary, T));
    }
    return out;
}

}  // namespace

std::string describe(const Substance& substance) {
    const HeatCurve curve = substance.heat_curve(usual_pressure);
    std::string out =
        fmt::format("substance \"{}\"\n", substance.name()) + points_text(substance) + curve_text(curve) + constants_text(substance, curve);
    for (const auto boundary : {Boundary::sublimation, Boundary::melting, Boundary::saturation}) out += line_text(substance, boundary);
    return out;
}

}  // namespace weir::thermo
