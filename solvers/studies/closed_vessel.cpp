#include "studies/closed_vessel.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "thermo/closed_gas.hpp"
#include "thermo/heat_keys.hpp"
#include "thermo/scene_substance.hpp"

#include <algorithm>
#include <utility>

namespace weir::studies {

using namespace thermo;
using scene::Key;
using scene::Type;

namespace {

constexpr real gas_constant = 461.526;           // [J/(kg K)]
constexpr real coldest = 273.16, hottest = 646;  // range of the saturation formulas, below the critical point [K]

/// Internal energies [J/kg].
real liquid_energy(const Saturation& s) { return s.liquid_enthalpy - s.p / s.liquid_density; }
real vapour_energy(const Saturation& s) { return s.vapour_enthalpy - s.p / s.vapour_density; }

/// The temperature at which saturated vapour has this density, by Newton's method for its logarithm; at least the coldest.
real saturated_at(real density) {
    if (density <= water_at_saturation(coldest).vapour_density) return coldest;
    real T = 400;
    for (int i = 0; i < 50; ++i) {
        const real here = std::log(water_at_saturation(T).vapour_density), beside = std::log(water_at_saturation(T + 0.01).vapour_density);
        const real next = std::clamp(T + 0.01 * (std::log(density) - here) / (beside - here), coldest, hottest);
        if (std::abs(next - std::exchange(T, next)) < 1e-12 * next) break;
    }
    return T;
}

Key positive(const char* name, const char* doc, const char* unit) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true, .min = 0, .min_open = true};
}

}  // namespace

std::vector<Key> ClosedVessel::keys() {
    Key substance = thermo::substance_key();
    substance.doc += " Of this solver: \"water\".";
    return {
        substance,
        {.name = "heat", .type = Type::table, .doc = "The surroundings.", .keys = {thermo::pressure_key(), thermo::ambient_key()}},
        {.name = "vessel",
         .type = Type::table,
         .doc = "A rigid vessel that contains only water and its vapour.",
         .required = true,
         .keys = {positive("volume", "Volume of the vessel.", "m^3"),
                  positive("mass", "Mass of the water, liquid and vapour.", "kg"),
                  positive("temperature", "Temperature at the start.", "K"),
                  {.name = "vapour", .type = Type::number, .doc = "Mass of vapour at the start.", .unit = "kg", .fallback = 0.0, .min = 0},
                  positive("transfer", "Evaporation rate per pascal below the saturation pressure.", "kg/(s Pa)"),
                  {.name = "exchange",
                   .type = Type::number,
                   .doc = "Heat transfer coefficient to heat.ambient.",
                   .unit = "W/K",
                   .fallback = 0.0,
                   .min = 0}}}};
}

ClosedVessel::ClosedVessel(const scene::Scene& scene)
    : water_(thermo::substance_of(scene)),
      ambient_(scene),
      volume_(scene.number("vessel.volume")),
      mass_(scene.number("vessel.mass")),
      transfer_(scene.number("vessel.transfer")),
      exchange_(scene.number("vessel.exchange")),
      vapour_(scene.number("vessel.vapour")),
      T_(scene.number("vessel.temperature")) {
    if (scene.root().text("substance.name") != "water")
        scene.refuse("substance", "energies of liquid and vapour in equilibrium are available for water only", "\"water\"");
    if (T_ < coldest || T_ > hottest)
        scene.refuse("vessel.temperature", "vessel.temperature is " + scene::number_text(T_) + " K",
                     "liquid and vapour are in equilibrium from 273.16 to 646 K");
    if (vapour_ > mass_)
        scene.refuse("vessel.vapour", "vessel.vapour is " + scene::number_text(vapour_) + " kg, more than the total mass",
                     "at most vessel.mass");
    if (exchange_ > 0 && !ambient_.has_temperature())
        scene.refuse("vessel.exchange", "the vessel exchanges heat with surroundings that are not defined",
                     "add heat.ambient with a temperature or keyframes");
    if (!(gas_volume(T_) > 0))
        scene.refuse("vessel.mass", "the liquid fills the vessel: no volume is left for vapour",
                     "less than " + scene::number_text(std::floor(volume_ * water_at_saturation(T_).liquid_density)) + " kg");
    const Index<2> cells = scene.index<2>("grid.cells");
    const Vec<2> origin = scene.vec<2>("grid.origin"), size = scene.vec<2>("grid.size");
    grid_ = {.dim = 2,
             .cells = {cells[0], cells[1], 1},
             .origin = {origin[0], origin[1], 0},
             .spacing = {size[0] / cells[0], size[1] / cells[1], 0}};
    temperature_.resize(product(cells)), liquid_.resize(product(cells));
    U_ = energy(T_);
    p_ = pressure_of_gas();
    show();
}

real ClosedVessel::gas_volume(real T) const { return volume_ - liquid_mass() / water_at_saturation(T).liquid_density; }

/// Energy of saturated liquid plus that of vapour, which has a constant heat capacity from the saturation temperature of its density; in
/// equilibrium it is saturated.
real ClosedVessel::energy(real T) const {
    const Saturation s = water_at_saturation(T);
    const real liquid = liquid_mass() * liquid_energy(s);
    if (vapour_ == 0) return liquid;
    const real from = saturated_at(vapour_ / (volume_ - liquid_mass() / s.liquid_density));
    const real c = water_->conduction(State::vapour).heat_capacity - gas_constant;
    return liquid + vapour_ * (vapour_energy(water_at_saturation(from)) + c * (T - from));
}

/// T from U and the masses, by the secant method.
void ClosedVessel::find_temperature() {
    constexpr real beside = 0.01;
    for (int i = 0; i < 50; ++i) {
        const real here = energy(T_), T = std::clamp(T_ + beside * (U_ - here) / (energy(T_ + beside) - here), coldest, hottest - beside);
        const real change = std::abs(T - std::exchange(T_, T));
        if (change < 1e-13 * T_) break;
    }
    if (!(T_ > coldest && T_ < hottest - beside))
        throw NumericalFailure("temperature", "the vessel is colder than the triple point or as warm as the critical one");
    if (!(gas_volume(T_) > 0)) throw NumericalFailure("pressure", "the liquid has filled the vessel");
}

real ClosedVessel::pressure_of_gas() const { return thermo::pressure_of_vapour(*water_, vapour_ / gas_volume(T_), T_); }

/// Rate at which the gas approaches the saturation pressure at constant temperature [1/s].
real ClosedVessel::fastest() const {
    const Saturation s = water_at_saturation(T_);
    return transfer_ * s.p / (s.vapour_density * gas_volume(T_));
}

/// Liquid and vapour exchange mass at the rate at the start of the step, which decays with the pressure difference; T follows.
StepReport ClosedVessel::step(real dt) {
    const real rate = fastest(), lasts = -std::expm1(-rate * dt) / rate;
    const real wanted = transfer_ * (water_at_saturation(T_).p - p_) * lasts;
    const real given = exchange_ > 0 ? dt * exchange_ * (ambient_.temperature(time_ + 0.5 * dt) - T_) : 0;
    vapour_ = std::clamp(vapour_ + wanted, real(0), mass_);
    added_ += given, U_ += given;
    find_temperature();
    p_ = pressure_of_gas();
    time_ += dt;
    show();
    return {.dt = dt};
}

/// A third of the time constants of evaporation and of exchange through the wall; the heat of evaporation couples both.
real ClosedVessel::advised_dt() const {
    const Saturation s = water_at_saturation(T_);
    const real capacity = 2000 * mass_;  // [J/K], below that of any liquid and close to that of vapour
    const real feedback = 1 + s.vapour_density * gas_volume(T_) / s.p * s.dpdT * (vapour_energy(s) - liquid_energy(s)) / capacity;
    const real dt = std::min(1 / (3 * fastest() * feedback), exchange_ > 0 ? capacity / (3 * exchange_) : infinity);
    return std::min(dt, ambient_.to_next_frame(time_));
}

/// The vessel's cells from below, filled with liquid up to its volume.
void ClosedVessel::show() {
    std::fill(temperature_.begin(), temperature_.end(), T_);
    const real level = (1 - gas_volume(T_) / volume_) * grid_.cells[1];
    for (int j = 0; j < grid_.cells[1]; ++j)
        std::fill_n(liquid_.begin() + static_cast<std::ptrdiff_t>(j) * grid_.cells[0], grid_.cells[0], std::clamp(level - j, 0.0, 1.0));
}

FieldSet ClosedVessel::fields() const {
    FieldSet set;
    set.grid = grid_;
    set.fields.push_back({"temperature", "K", Where::cell, "", {temperature_}});
    set.fields.push_back({"liquid", "", Where::cell, "", {liquid_}});
    return set;
}

/// The energy is computed from the temperature instead of U_: their difference is an error of the state.
std::vector<Integral> ClosedVessel::integrals() const {
    return {{"pressure", "Pa", p_},
            {"temperature", "K", T_},
            {"vapour_mass", "kg", vapour_},
            {"liquid_mass", "kg", liquid_mass()},
            {"internal_energy", "J", energy(T_)},
            {"heat_added", "J", added_}};
}

void ClosedVessel::save(Checkpoint& to) const { to.put_value("vessel", std::array<real, 4>{vapour_, U_, added_, time_}); }

void ClosedVessel::restore(const Checkpoint& from) {
    const auto reals = from.get_value<std::array<real, 4>>("vessel");
    vapour_ = reals[0], U_ = reals[1], added_ = reals[2], time_ = reals[3];
    find_temperature();
    p_ = pressure_of_gas();
    show();
}

}  // namespace weir::studies
