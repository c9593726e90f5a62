#include "thermo/heat_keys.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "thermo/ambient.hpp"
#include "thermo/scene_substance.hpp"

namespace weir::thermo {

using scene::Key;
using scene::Type;

Key substance_key_of_heat(const std::string& doc) {
    Key key = substance_key();
    key.required = false;
    key.doc += " " + doc;
    return key;
}

Key pressure_key() {
    return {.name = "pressure",
            .type = Type::number,
            .doc = "Ambient pressure, which determines melting and boiling points.",
            .unit = "Pa",
            .fallback = 101325.0,
            .min = 0,
            .min_open = true};
}

Key heaters_key(const std::string& doc) {
    return {.name = "heaters",
            .type = Type::tables,
            .doc = doc,
            .keys = {{.name = "power",
                      .type = Type::number,
                      .doc = "Heating power; in 2D per metre of depth. Negative: a cooler.",
                      .unit = "W",
                      .required = true},
                     {.name = "start", .type = Type::number, .doc = "Start time.", .unit = "s", .fallback = 0.0, .min = 0},
                     {.name = "end", .type = Type::number, .doc = "End time; unlimited if absent.", .unit = "s", .min = 0}},
            .selector = "shape",
            .variants_from = &scene::shapes};
}

std::vector<Key> keys_on_a_grid(const std::string& lets, std::vector<Key> own, const std::string& over) {
    std::vector<Key> keys = {pressure_key(), ambient_key()};
    keys.insert(keys.end(), own.begin(), own.end());
    keys.push_back({.name = "drag",
                    .type = Type::number,
                    .doc = "C of Carman and Kozeny's drag C (1 - f)^2/(f^3 + 0.001) in cells that are part solid.",
                    .unit = "kg/(m^3 s)",
                    .fallback = 1.6e6,
                    .min = 0,
                    .min_open = true});
    return {substance_key_of_heat("Naming it lets " + lets + ", with `fluid.density` for solid and liquid alike."),
            {.name = "heat", .type = Type::table, .doc = "Heat transfer of a substance. Requires `substance`.", .keys = keys},
            heaters_key("Heat sources, distributed uniformly over " + over + " Requires `substance`.")};
}

scene::Variant wall_with_exchange() {
    return {"wall",
            "",
            {{.name = "heat_flux", .type = Type::number, .doc = "Heat flux into the fluid. Requires `substance`.", .unit = "W/m^2"},
             {.name = "exchange",
              .type = Type::number,
              .doc = "Heat transfer coefficient between the surroundings, heat.ambient, and the inner face of the wall.",
              .unit = "W/(m^2 K)",
              .min = 0,
              .min_open = true}}};
}

HeatCurve curve_of(const scene::Scene& scene, const Substance& substance) {
    return curve_at(scene.number("heat.pressure"), "heat.pressure", scene, substance);
}

HeatCurve curve_at(real pressure, const std::string& path, const scene::Scene& scene, const Substance& substance) {
    try {
        return substance.heat_curve(pressure);
    } catch (const BadInput& error) {
        scene.refuse(path, error.what());
    }
}

void check_temperature(const scene::Scene& scene, const std::string& path, real T) {
    if (!(T > 0)) scene.refuse(path, "a temperature of " + scene::number_text(T) + " K", "it must be greater than 0 K");
}

void check_heater(const scene::Scene& scene, std::size_t i) {
    const auto& table = scene.root().tables("heaters")[i];
    const std::string path = "heaters[" + std::to_string(i) + "]";
    if (!(table.number_or("end", infinity) > table.number("start"))) scene.refuse(path + ".end", path + ".end must be after its start");
}

}  // namespace weir::thermo
