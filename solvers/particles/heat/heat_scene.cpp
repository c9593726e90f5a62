// Heat settings of a scene with particles: the substance, heat from sides and heaters, initial temperatures.
#include "core/error.hpp"
#include "geometry/shape.hpp"
#include "particles/heat/heat.hpp"
#include "scene/formula.hpp"
#include "scene/names.hpp"
#include "thermo/ambient.hpp"
#include "thermo/heat_keys.hpp"
#include "thermo/scene_substance.hpp"

#include <algorithm>
#include <functional>

namespace weir::particles {

namespace {

using scene::Key;
using scene::Type;
using thermo::State;

std::string side_path(int axis, int end) { return std::string("sides.") + "xyz"[axis] + (end == 0 ? "_min" : "_max"); }

bool has_liquid(const thermo::HeatCurve& curve) {
    for (int i = 0; i < curve.states(); ++i)
        if (curve.state(i) == State::liquid) return true;
    return false;
}

/// Checks that the particles' density, common to all states, is a density of the liquid or its solid.
void check_density(const scene::Scene& scene, const thermo::Substance& substance, const HeatStates& states) {
    const real p = scene.number("heat.pressure"), rho = scene.number("fluid.density");
    const bool melts = substance.has(thermo::Boundary::melting);
    const real liquid =
        melts ? substance.warmer_density(thermo::Boundary::melting, states.T) : substance.density(State::liquid, {states.T, p});
    const real solid = melts ? substance.colder_density(thermo::Boundary::melting, states.T) : liquid;
    if (rho >= 0.9 * std::min(liquid, solid) && rho <= 1.1 * std::max(liquid, solid)) return;
    const auto text = [](real value) { return scene::number_text(std::round(value * 10) / 10); };
    scene.refuse("fluid.density",
                 "fluid.density is " + scene::number_text(rho) + " kg/m^3, which does not match the density of " + substance.name(),
                 "solid " + text(solid) + ", liquid " + text(liquid) + " kg/m^3: this solver uses one density for solid and liquid");
}

/// At the lowest pressure of the scene: under higher pressure the boiling enthalpy is larger (Vapour).
thermo::HeatCurve liquid_curve(const scene::Scene& scene, const thermo::Substance& substance) {
    const thermo::Ambient ambient(scene);
    const std::string path = ambient.pressure_changes() ? "heat.ambient.keyframes" : "heat.pressure";
    const auto curve = thermo::curve_at(ambient.lowest_pressure(), path, scene, substance);
    if (!has_liquid(curve))
        scene.refuse(substance.has(thermo::Boundary::saturation) ? path : "substance",
                     "at " + scene::number_text(ambient.lowest_pressure()) + " Pa " + substance.name() + " is never a liquid",
                     "particles represent a liquid");
    return curve;
}

/// initial.temperature as a function of position.
template <int D>
std::function<real(const Vec<D>&)> temperature_function(const scene::Scene& scene) {
    const auto& table = scene.root().table("initial.temperature");
    const std::string& name = table.text("name");
    if (name == "constant") return [T = table.number("value")](const Vec<D>&) { return T; };
    if (name == "linear")
        return [T = table.number("value"), slope = table.vec<D>("gradient"), at = table.vec<D>("at")](const Vec<D>& x) {
            return T + dot(slope, x - at);
        };
    if (name == "formula") return scene::formula_of_place<D>(scene, "initial.temperature.value");
    const auto centre = table.vec<D>("centre");
    if (name == "gaussian")
        return [centre, base = table.number("base"), height = table.number("amplitude"), w = table.number("width")](const Vec<D>& x) {
            return base + height * std::exp(-dot(x - centre, x - centre) / (2 * w * w));
        };
    return [centre, r = table.number("radius"), in = table.number("value"), out = table.number("outside")](const Vec<D>& x) {
        return norm(x - centre) < r ? in : out;
    };
}

Key frozen_key() {
    return {.name = "frozen",
            .type = Type::text,
            .doc =
                "Treatment of particles that are more than half frozen. held: each keeps its position and the volume of liquid. free: "
                "neighbouring particles form one rigid piece, which floats or sinks with the volume of the solid; particles frozen to a "
                "wall below the melting point stay there.",
            .fallback = std::string("held"),
            .choices = {"held", "free"}};
}

}  // namespace

bool heat_is_named(const scene::Scene& scene) { return scene.has("substance"); }

std::vector<Key> heat_keys() {
    Key sides{.name = "sides", .type = Type::table};
    for (const char* axis : {"x", "y", "z"})
        for (const char* end : {"_min", "_max"})
            sides.keys.push_back({.name = std::string(axis) + end, .type = Type::table, .variants = {thermo::wall_with_exchange()}});
    return {thermo::substance_key_of_heat("Naming it lets particles carry heat, melt and freeze; `fluid.density` is that of the liquid, "
                                          "and of the solid unless `heat.frozen` is \"free\"."),
            {.name = "heat",
             .type = Type::table,
             .doc = "Heat transfer of a substance. Requires `substance`.",
             .keys = {thermo::pressure_key(), thermo::ambient_key_of_particles(), frozen_key(), vapour_key()}},
            thermo::heaters_key("Heat sources, distributed uniformly over the particles inside; without particles inside they add nothing. "
                                "Requires `substance`."),
            sides};
}

Key initial_temperature_key() {
    const auto number = [](const char* name, const char* doc, const char* unit) {
        return Key{.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true};
    };
    Key key{.name = "temperature", .type = Type::table, .doc = "Temperature at t = 0. Requires `substance`.", .selector = "name"};
    key.variants = {{"ball",
                     "One value in a ball, another outside.",
                     {{.name = "centre", .type = Type::numbers, .doc = "Centre.", .unit = "m", .required = true, .length = -1},
                      number("radius", "Radius.", "m"),
                      number("value", "Inside.", "K"),
                      number("outside", "Outside.", "K")}},
                    scene::formula_variant("K")};
    return key;
}

real emitted_enthalpy(const scene::Scene& scene, std::size_t i) {
    const std::string path = "emitters[" + std::to_string(i) + "]";
    const auto& table = scene.root().tables("emitters")[i];
    if (!table.has("temperature")) scene.refuse(path, "an emitter of particles with heat requires a temperature");
    const real T = table.number("temperature");
    thermo::check_temperature(scene, path + ".temperature", T);
    const auto curve = liquid_curve(scene, *thermo::substance_of(scene));
    const real h = curve.enthalpy(T);
    if (h > heat_states(curve, {}).liquid_end)
        scene.refuse(path + ".temperature", "at " + scene::number_text(T) + " K the liquid boils", "an emitter adds liquid");
    return h;
}

template <int D>
Heat<D>::Heat(const scene::Scene& scene, const Domain<D>& domain)
    : curve_(liquid_curve(scene, *thermo::substance_of(scene))),
      lo_(domain.lo),
      hi_(domain.hi),
      spacing_(domain.spacing),
      rho0_(scene.number("fluid.density")),
      ambient_(scene) {
    const auto substance = thermo::substance_of(scene);
    std::array<real, 3> k{};
    for (int i = 0; i < curve_.states(); ++i)
        if (curve_.state(i) != State::supercritical)
            k[static_cast<std::size_t>(curve_.state(i))] = substance->conduction(curve_.state(i)).conductivity;
    states_ = heat_states(curve_, k);
    check_density(scene, *substance, states_);
    set_ice(scene, domain, *substance);
    if (vapour_is_named(scene)) {
        vapour_ = std::make_unique<Vapour<D>>(scene, domain, substance, states_);
        const real highest = vapour_->highest_shift();
        states_.T_vapour = heat_temperature(states_.liquid_end + highest, highest, &states_);
    }
    const auto& frames = scene.root().tables("heat.ambient.keyframes");
    if (!vapour_ && std::any_of(frames.begin(), frames.end(), [](const auto& frame) { return frame.has("pressure"); }))
        scene.refuse("heat.ambient.keyframes", "the pressure of the surroundings sets the boiling point, and this liquid does not boil",
                     "heat.vapour");
    Scheme scheme;
    scheme.read(scene);
    set_pairs(scheme);
    read_sides(scene, domain);
    read_heaters(scene, domain);
}

/// Moving ice has a larger spacing but must conduct as the solid: its pair sums are corrected by the volume ratio.
template <int D>
void Heat<D>::set_ice(const scene::Scene& scene, const Domain<D>& domain, const thermo::Substance& substance) {
    free_ = scene.text("heat.frozen") == "free";
    if (!free_) return;
    if (!substance.has(thermo::Boundary::melting))
        scene.refuse("heat.frozen", std::string(substance.name()) + " never freezes",
                     "substance.fusion and a triple point make one that does");
    if (vapour_is_named(scene))
        scene.refuse("heat.frozen", "moving ice cannot be combined with vapour", "heat.frozen = \"held\", or no heat.vapour");
    if (!scene.root().tables("bodies").empty())
        scene.refuse("heat.frozen", "free ice cannot be combined with moving bodies", "heat.frozen = \"held\"");
    for (int a = 0; a < D; ++a)
        if (domain.sides.periodic(a))
            scene.refuse("heat.frozen",
                         "free ice cannot cross periodic sides, and this scene is periodic along " + std::string(1, "xyz"[a]),
                         "heat.frozen = \"held\"");
    const real liquid = substance.warmer_density(thermo::Boundary::melting, states_.T),
               solid = substance.colder_density(thermo::Boundary::melting, states_.T);
    if (std::abs(rho0_ - liquid) > std::abs(rho0_ - solid))
        scene.refuse(
            "fluid.density",
            "fluid.density is " + scene::number_text(rho0_) + " kg/m^3, nearer the solid's than the liquid's, and heat.frozen is \"free\"",
            "liquid " + scene::number_text(std::round(liquid * 10) / 10) + " kg/m^3: free ice has its own density");
    states_.swells = liquid / solid - 1;
    states_.k_c[0] *= (liquid / solid) * (liquid / solid);
}

template <int D>
std::function<bool(const Vec<D>&)> frozen_at_start(const scene::Scene& scene) {
    if (!scene.has("initial.temperature.name")) return [](const Vec<D>&) { return false; };
    return [value = temperature_function<D>(scene), curve = liquid_curve(scene, *thermo::substance_of(scene)),
            states = heat_states(liquid_curve(scene, *thermo::substance_of(scene)), {0, 0, 0})](const Vec<D>& x) {
        const real T = value(x);
        return T > 0 && heat_melted(curve.enthalpy(T), &states) < 0.5;
    };
}

/// At the surface, where boiling starts.
template <int D>
bool Heat<D>::boils_at_start(real T) const {
    const real more = vapour_ ? vapour_->params().shift[0] : 0;
    return T > heat_temperature(states_.liquid_end + more, more, &states_);
}

/// The liquid's end at the lowest pressure of all times.
template <int D>
real Heat<D>::start_enthalpy(real T) const {
    if (boils_at_start(T)) throw BadInput("at " + scene::number_text(T) + " K the liquid boils");
    const real least = heat_temperature(states_.liquid_end, 0, &states_);
    return T > least ? states_.liquid_end + (T - least) / states_.per_c[1] : curve_.enthalpy(T);
}

/// Beyond it the particles' own function of temperature continues.
template <int D>
real Heat<D>::theta_of_wall(real T) const {
    return vapour_ ? heat_theta_at(T, &states_) : heat_theta(curve_.enthalpy(T), 0, &states_);
}

template <int D>
void Heat<D>::read_sides(const scene::Scene& scene, const Domain<D>& domain) {
    const auto fill = [&](auto& w) {
        for (int a = 0; a < 3; ++a) w.lo[a] = -1e15F, w.hi[a] = 1e15F, w.lo_theta[a] = w.hi_theta[a] = 0, w.lo_held[a] = w.hi_held[a] = 0;
    };
    fill(single_walls_), fill(plain_walls_);
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const std::string path = side_path(a, end);
            const auto T = scene.has(path + ".temperature") ? std::optional<real>(scene.number(path + ".temperature")) : std::nullopt;
            if (!domain.walled(a, end)) {
                if (T)
                    scene.refuse(path + ".temperature", "fluid cannot enter through a side of particles",
                                 "use emitters for inflow, or a temperature of a wall");
                continue;
            }
            const auto place = [&](auto& w) {
                using Number = std::remove_reference_t<decltype(w.closest)>;
                (end ? w.hi : w.lo)[a] = static_cast<Number>((end ? domain.hi : domain.lo)[a] - domain.centre()[a]);
                (end ? w.hi_held : w.lo_held)[a] = T.has_value();
                if (T) (end ? w.hi_theta : w.lo_theta)[a] = static_cast<Number>(theta_of_wall(*T));
            };
            if (T) {
                thermo::check_temperature(scene, path + ".temperature", *T);
                if (!vapour_ && boils_at_start(*T))
                    scene.refuse(path + ".temperature", "at " + scene::number_text(*T) + " K the liquid boils",
                                 "add heat.vapour to let it boil");
                held_ = true;
                freezing_[static_cast<std::size_t>(2 * a + end)] = *T < states_.T;
            }
            place(single_walls_), place(plain_walls_);
            for (const char* key : {".heat_flux", ".exchange"})
                if (T && scene.has(path + key)) scene.refuse(path + key, "the wall has a temperature, which determines the heat flux");
            if (scene.has(path + ".heat_flux")) fluxes_.push_back({a, end, scene.number(path + ".heat_flux")});
            if (scene.has(path + ".exchange")) read_exchange(scene, a, end, path);
        }
    limit_exchange();
}

template <int D>
void Heat<D>::read_exchange(const scene::Scene& scene, int axis, int end, const std::string& path) {
    if (!ambient_.has_temperature())
        scene.refuse(path + ".exchange", "the wall exchanges heat with surroundings that are not defined",
                     "add heat.ambient with a temperature or keyframes");
    exchanges_.push_back({axis, end, scene.number(path + ".exchange")});
}

/// Within a substep no particle, even in a corner, becomes warmer than the surroundings.
template <int D>
void Heat<D>::limit_exchange() {
    real fastest = 0;  // [1/s]
    for (const Exchange& wall : exchanges_) {
        real most = 0;
        for (int state = 0; state < 3; ++state)
            most = std::max(most, states_.per_c[state] / (1 / wall.coefficient + 0.25 * spacing_ / states_.k[state]));
        fastest += most / (spacing_ * rho0_);
    }
    if (fastest > 0) stable_dt_ = std::min(stable_dt_, 1 / fastest);
}

template <int D>
void Heat<D>::read_heaters(const scene::Scene& scene, const Domain<D>& domain) {
    const auto& tables = scene.root().tables("heaters");
    for (std::size_t i = 0; i < tables.size(); ++i) {
        thermo::check_heater(scene, i);
        const std::string path = "heaters[" + std::to_string(i) + "]";
        Heater heater{geometry::make_shape<D>(tables[i]), tables[i].number("start"), tables[i].number_or("end", infinity),
                      tables[i].number("power")};
        bool covers = false, free = false;
        const Index<D> cells = scene.index<D>("grid.cells");
        Index<D> at{};
        for (std::size_t c = 0; c < product(cells); ++c) {
            const Vec<D> x = domain.lo + domain.spacing * (to_vec(at) + Vec<D>::constant(0.5));
            for (int a = 0; a < D && ++at[a] == cells[a]; ++a) at[a] = 0;
            if (!heater.shape->contains(x)) continue;
            covers = true;
            free = free || domain.solids.empty() || domain.solids.distance(x) > 0;
        }
        if (!free)
            scene.refuse(path, covers ? "the heater lies inside solids: it heats no fluid" : "the heater covers the centre of no cell");
        heaters_.push_back(std::move(heater));
    }
}

template <int D>
void Heat<D>::start(const scene::Scene& scene, Fluid<D>& fluid) const {
    if (!scene.has("initial.temperature.name"))
        scene.refuse("substance", "a substance requires an initial temperature", "initial.temperature");
    const auto value = temperature_function<D>(scene);
    fluid.warm = true;
    fluid.enthalpy.clear();
    real coldest = infinity, hottest = 0;
    for (int i = 0; i < fluid.count(); ++i) {
        const real T = value(fluid.position(i));
        if (!(T >= coldest)) coldest = T;
        hottest = std::max(hottest, T);
        fluid.enthalpy.push_back(boils_at_start(T) ? states_.vapour_begin : start_enthalpy(T));  // rejected below
        if (free_) fluid.density[static_cast<std::size_t>(i)] = rho0_ * rest(fluid.enthalpy.back());
    }
    if (!(coldest > 0))
        scene.refuse("initial.temperature", "the lowest temperature is " + scene::number_text(coldest) + " K at the start",
                     "it must be greater than 0 K");
    if (boils_at_start(hottest))
        scene.refuse("initial.temperature", "at " + scene::number_text(hottest) + " K the liquid boils", "particles start as a liquid");
}

#define WEIR_INSTANTIATE(D)                                                                          \
    template Heat<D>::Heat(const scene::Scene&, const Domain<D>&);                                   \
    template void Heat<D>::set_ice(const scene::Scene&, const Domain<D>&, const thermo::Substance&); \
    template std::function<bool(const Vec<D>&)> frozen_at_start(const scene::Scene&);                \
    template bool Heat<D>::boils_at_start(real) const;                                               \
    template real Heat<D>::start_enthalpy(real) const;                                               \
    template real Heat<D>::theta_of_wall(real) const;                                                \
    template void Heat<D>::read_sides(const scene::Scene&, const Domain<D>&);                        \
    template void Heat<D>::read_exchange(const scene::Scene&, int, int, const std::string&);         \
    template void Heat<D>::limit_exchange();                                                         \
    template void Heat<D>::read_heaters(const scene::Scene&, const Domain<D>&);                      \
    template void Heat<D>::start(const scene::Scene&, Fluid<D>&) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::particles
