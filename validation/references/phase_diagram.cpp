// What is known of a substance in the plane of temperature and pressure: tables of the lines, of states between them, and the points where
// lines end.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

using namespace weir;
using namespace weir::validation;

namespace {

/// States by the numbers that the solver's field has.
real number_of(const std::string& state) {
    real number = 0;
    for (const char* name : {"solid", "liquid", "vapour", "supercritical"}) {
        if (state == name) return number;
        ++number;
    }
    throw BadInput("states.csv: no state is called \"" + state + "\"");
}

Curve known_states(const Table& table) {
    Curve curve{.label = "states"};
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        curve.x.push_back(table.number(i, "T_K")), curve.y.push_back(number_of(table.text(i, "state")));
        curve.names.push_back(table.text(i, "p_Pa"));
    }
    return curve;
}

}  // namespace

REFERENCE(phase_diagram) {
    Reference ref{.source = "IAPWS SR1-86(1992), R14-08(2011)"};
    const Table saturation = read_table(data / "water_saturation.csv"), ice = read_table(data / "water_sublimation_melting.csv");
    ref.curves["saturation_pressure"] = saturation.curve("T_K", "p_Pa", "IAPWS SR1-86, saturation");
    ref.curves["liquid_density"] = saturation.curve("T_K", "rho_liq", "liquid");
    ref.curves["vapour_density"] = saturation.curve("T_K", "rho_vap", "vapour");
    ref.curves["heat_of_vaporisation"] = saturation.curve("T_K", "L_v_J_per_kg", "latent heat");
    ref.curves["sublimation_pressure"] = ice.curve("T_K", "p_sublimation_Pa", "IAPWS R14-08, sublimation");
    ref.curves["melting_pressure"] = ice.curve("T_K", "p_melting_Ih_Pa", "IAPWS R14-08, melting");
    ref.curves["boiling_temperature"] = read_table(data / "boiling_points.csv").curve("p_Pa", "T_sat_K", "boiling points");
    ref.curves["states"] = known_states(read_table(data / "states.csv"));
    ref.numbers = {
        {"triple.T", 273.16}, {"triple.p", 611.657}, {"critical.T", 647.096}, {"critical.p", 22.064e6}, {"critical.density", 322}};
    return ref;
}

REFERENCE(van_der_waals) {
    Reference ref{.source = "Maxwell's rule of equal areas"};
    const Table table = read_table(data / "van_der_waals_coexistence.csv");
    ref.curves["saturation_pressure"] = table.curve("Tr", "pr", "equal areas, by quadrature");
    ref.curves["liquid_density"] = table.curve("Tr", "rho_liq_r", "liquid");
    ref.curves["vapour_density"] = table.curve("Tr", "rho_vap_r", "vapour");
    return ref;
}
