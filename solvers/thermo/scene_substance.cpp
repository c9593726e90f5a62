#include "thermo/scene_substance.hpp"

#include "core/error.hpp"

namespace weir::thermo {

namespace {

using scene::Key;
using scene::Type;

Key positive(const char* name, const char* doc, const char* unit) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true, .min = 0, .min_open = true};
}

Key conductivity() {
    return {.name = "conductivity", .type = Type::number, .doc = "Thermal conductivity.", .unit = "W/(m K)", .fallback = 0.0, .min = 0};
}

Key heat_capacity() { return positive("heat_capacity", "Specific heat capacity at constant pressure.", "J/(kg K)"); }

Key point(const char* name, const char* doc) {
    return {.name = name, .type = Type::numbers, .doc = doc, .unit = "K, Pa", .required = true, .min = 0, .min_open = true, .length = 2};
}

Key state(const char* name, std::vector<Key> keys) {
    std::string doc;
    for (const Key& key : keys)
        doc += (doc.empty() ? "Of the " + std::string(name) + ": " : ", ") + key.name + (key.unit.empty() ? "" : " [" + key.unit + "]");
    return {.name = name, .type = Type::table, .doc = doc + ".", .required = true, .keys = std::move(keys)};
}

Key density() { return positive("density", "Density.", "kg/m^3"); }

Key gas_constant_key() { return positive("gas_constant", "R of p = rho R T: 8.314 J/(mol K) over the molar mass.", "J/(kg K)"); }

Conduction conduction(const scene::Table& table) { return {table.number("heat_capacity"), table.number("conductivity")}; }

Point point_of(const scene::Table& table, const char* key) {
    const auto& pair = table.numbers(key);
    return {pair[0], pair[1]};
}

Constants constants_of(const scene::Table& table) {
    Constants k;
    k.triple = point_of(table, "triple"), k.critical = point_of(table, "critical");
    k.fusion = table.number("fusion"), k.vaporisation = table.number("vaporisation");
    k.solid_density = table.number("solid.density"), k.liquid_density = table.number("liquid.density");
    k.solid = conduction(table.table("solid")), k.liquid = conduction(table.table("liquid")), k.vapour = conduction(table.table("vapour"));
    k.expansion = table.number("liquid.expansion");
    return k;
}

}  // namespace

Key substance_key() {
    Key key{.name = "substance",
            .type = Type::table,
            .doc = "Substance of the scene: its phases, phase boundaries, latent heats and constants.",
            .required = true,
            .selector = "name",
            .example = "substance = \"water\""};
    const Key expansion{.name = "expansion", .type = Type::number, .doc = "-(1/rho) drho/dT.", .unit = "1/K", .fallback = 0.0};
    const Key fusion{.name = "fusion", .type = Type::number, .doc = "Latent heat of melting.", .unit = "J/kg", .required = true, .min = 0};
    key.variants = {
        {"water", "Water by the formulas of IAPWS; `weir describe substance water` prints it.", {}},
        {"own",
         "A substance defined by constants; its phase boundaries follow from the Clausius-Clapeyron equation through both points.",
         {point("triple", "Triple point: temperature and pressure."), point("critical", "Critical point: temperature and pressure."),
          fusion, positive("vaporisation", "Latent heat of boiling.", "J/kg"), state("solid", {density(), heat_capacity(), conductivity()}),
          state("liquid", {density(), heat_capacity(), conductivity(), expansion}), state("vapour", {heat_capacity(), conductivity()})}},
        {"ideal_gas", "Ideal gas, p = rho R T, without other phases.", {gas_constant_key(), heat_capacity(), conductivity()}},
        {"van_der_waals",
         "Van der Waals fluid, which boils according to Maxwell's equal-area rule and does not freeze.",
         {gas_constant_key(), point("critical", "The critical temperature and pressure."),
          state("liquid", {heat_capacity(), conductivity()}), state("vapour", {heat_capacity(), conductivity()})}}};
    return key;
}

SubstancePtr substance_of(const scene::Scene& scene) {
    const scene::Table& table = scene.root().table("substance");
    const std::string& name = table.text("name");
    if (name == "water") return water();
    if (name == "ideal_gas") return ideal_gas(table.number("gas_constant"), conduction(table));
    if (name == "van_der_waals")
        return van_der_waals(table.number("gas_constant"), point_of(table, "critical"), conduction(table.table("liquid")),
                             conduction(table.table("vapour")));
    const auto constants = constants_of(table);
    std::vector<scene::Problem> problems;
    for (const auto& fault : faults(constants)) {
        const std::string path = "substance." + fault.constant;
        problems.push_back(scene.problem(path, path + " " + fault.message));
    }
    if (!problems.empty()) scene.refuse(std::move(problems));
    return of_constants(constants);
}

}  // namespace weir::thermo
