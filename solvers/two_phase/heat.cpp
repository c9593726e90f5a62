#include "two_phase/heat.hpp"

#include "core/error.hpp"
#include "mac/grid/initial.hpp"
#include "mac/grid/rows.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "scene/names.hpp"
#include "two_phase/solids.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

using geometry::SideKind;
using scene::Key;
using scene::Type;

template <int D>
std::vector<Key> Heat<D>::keys_of_a_fluid() {
    return {{.name = "heat_capacity",
             .type = Type::number,
             .doc = "Specific heat capacity. Required by effects.heat.",
             .unit = "J/(kg K)",
             .min = 0,
             .min_open = true},
            {.name = "conductivity",
             .type = Type::number,
             .doc = "Thermal conductivity. It acts only if effects.heat is named.",
             .unit = "W/(m K)",
             .fallback = 0.0,
             .min = 0},
            {.name = "expansion",
             .type = Type::number,
             .doc = "-(1/rho) drho/dT, of the Boussinesq buoyancy. It acts only if effects.heat is named.",
             .unit = "1/K",
             .fallback = 0.0}};
}

template <int D>
scene::Variant Heat<D>::schema() {
    return {
        "heat",
        "Heat of both fluids: carried with them, and conducted. Requires fluid.heat_capacity, gas.heat_capacity and initial.temperature.",
        {{.name = "ambient", .type = Type::number, .doc = "Temperature without buoyancy.", .unit = "K", .fallback = 0.0}},
        {},
        "fluid.heat_capacity = 4000.0\nfluid.conductivity = 0.6\ngas.heat_capacity = 1000.0\ngas.conductivity = 0.03\n"
        "initial.temperature = { name = \"linear\", value = 300.0, gradient = <1.0>, at = <0.0> }"};
}

namespace {

/// The temperature of a fluid is its content over its volume, so round-off matters where it fills less of a cell.
constexpr real sliver = 1e-6;

real part_of(real fraction, std::size_t phase) { return phase == 0 ? fraction : 1 - fraction; }

void require(const scene::Scene& scene, const std::string& key, const std::string& reason) {
    if (!scene.has(key)) scene.refuse("effects.heat", "effects.heat requires \"" + key + "\": " + reason);
}

/// The temperature of what enters through each inflow and, where it is given, open side.
template <int D>
EnteringFractions<D> entering_temperatures(const scene::Scene& scene, const geometry::Sides<D>& sides) {
    EnteringFractions<D> entering;
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto& side = sides.side(a, end);
            if (side.kind == SideKind::inflow) require(scene, scene::side_key(a, end) + ".temperature", "fluid enters there");
            if (side.kind == SideKind::inflow || side.kind == SideKind::outflow)
                entering[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)] = side.temperature;
        }
    return entering;
}

/// Walls with a temperature conduct; other sides insulate.
template <int D>
Boundary<D> conducting_sides(const geometry::Sides<D>& sides) {
    Boundary<D> boundary = field_boundary(sides, "temperature");
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const SideKind kind = sides.side(a, end).kind;
            auto& rule = boundary.end[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)];
            if (kind == SideKind::inflow || kind == SideKind::outflow) rule = {};
        }
    return boundary;
}

}  // namespace

template <int D>
Heat<D>::Heat(const scene::Scene& scene, const MacState<D>& state, const Densities& rho)
    : rho_(rho), ambient_(scene.effect("heat")->number("ambient")) {
    for (const char* fluid : {"fluid", "gas"}) require(scene, std::string(fluid) + ".heat_capacity", "heat has a capacity in both fluids");
    require(scene, "initial.temperature", "heat starts with it");
    capacity_ = {rho.liquid * scene.number("fluid.heat_capacity"), rho.gas * scene.number("gas.heat_capacity")};
    expansion_ = {rho.liquid * scene.number("fluid.expansion"), rho.gas * scene.number("gas.expansion")};
    const Boundary<D> sides = conducting_sides<D>(state.sides);
    own_.ghosts = FractionGhosts<D>(sides, entering_temperatures<D>(scene, state.sides));
    for (std::size_t phase = 0; phase < 2; ++phase) {
        own_.values[phase] = Grid<real, D>(state.extent());
        own_.padded[phase] = Padded<D>(state.extent());
        own_.flux[phase] = Grid<real, D>(Transport<D>::flux_extent(state), 0, 1);
    }
    const Densities conductivity{scene.number("fluid.conductivity"), scene.number("gas.conductivity")};
    if (conductivity.liquid > 0 || conductivity.gas > 0)
        conduction_ = std::make_unique<HeatConduction<D>>(state, capacity_, conductivity, sides);
}

template <int D>
void Heat<D>::start(const scene::Scene& scene, MacState<D>& state) {
    for (auto& of_fluid : own_.values) set_initial_field(of_fluid, state.u, scene, "temperature");
    if (scene.has("initial.liquid_temperature")) own_.values[0].fill(scene.number("initial.liquid_temperature"));
    mix(state);
}

template <int D>
CarriedByDust<D> Heat<D>::carried_by_dust() {
    for (std::size_t phase = 0; phase < 2; ++phase)
        for_each_row(Index<D>{}, own_.values[phase].extent(), [&](const Index<D>& first, int count) {
            std::copy_n(&own_.values[phase](first), count, own_.padded[phase].at(first));
        });
    return {own_.padded, own_.values};
}

template <int D>
void Heat<D>::finish_transport(MacState<D>& state) {
    entered_ += state.u.cell_volume() * (capacity_.liquid * own_.entered[0] + capacity_.gas * own_.entered[1]);
    mix(state);
}

/// Of the temperatures of fluids that fill more than a sliver of their cells.
template <int D>
std::array<real, 2> Heat<D>::range_of(const MacState<D>& state) const {
    const auto most = [&](std::size_t phase, real sign) {
        return max_over(state.extent(), [&](const Index<D>& I) {
            return is_open(state, I) && part_of(state.fields[0].values(I), phase) > sliver ? sign * own_.values[phase](I) : -infinity;
        });
    };
    return {-std::max(most(0, -1), most(1, -1)), std::max(most(0, 1), most(1, 1))};
}

/// The temperature of a cell is that of the contents of both fluids together.
template <int D>
void Heat<D>::mix(MacState<D>& state) const {
    const Grid<real, D>& fraction = state.fields[0].values;
    Grid<real, D>& T = temperature(state);
    for_each_row(Index<D>{}, T.extent(), [&](const Index<D>& first, int count) {
        const real *f = &fraction(first), *liquid = &own_.values[0](first), *gas = &own_.values[1](first);
        real* to = &T(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real part = f[i] * capacity_.liquid / capacity_.of(f[i]), mixed = gas[i] + part * (liquid[i] - gas[i]);
            to[i] = f[i] >= 1 ? liquid[i] : f[i] <= 0 ? gas[i] : mixed;
        }
    });
}

template <int D>
void Heat<D>::conduct(MacState<D>& state, const Padded<D>& f, const FaceFractions<D>& faces, real dt) {
    if (!conduction_) return;
    added_ += conduction_->apply(state, f, faces, dt, temperature(state));
    share(state.fields[0].values, temperature(state), dt);
}

/// What a cell gained is shared by both fluids. Their distances from its temperature shrink by conduction between them, and so far that no
/// fluid leaves the range between its own and the new temperature. Weighted with the capacities these distances are opposite, so the
/// content is that of the cell.
template <int D>
void Heat<D>::share(const Grid<real, D>& fraction, const Grid<real, D>& T, real dt) {
    auto &liquid = own_.values[0], &gas = own_.values[1];
    for_each_cell(T.extent(), [&](const Index<D>& I) {
        const real f = fraction(I), before = conduction_->before()(I), now = T(I);
        if (f <= 0 || f >= 1) {
            liquid(I) = f >= 1 ? now : liquid(I) + (now - before);
            gas(I) = f <= 0 ? now : gas(I) + (now - before);
            return;
        }
        real kept = conduction_->remaining_difference(f, dt);
        for (const auto* own : {&liquid, &gas})
            if (const real distance = (*own)(I)-before; distance != 0) kept = std::min(kept, std::max(0.0, 1 - (now - before) / distance));
        liquid(I) = now + kept * (liquid(I) - before);
        gas(I) = now + kept * (gas(I) - before);
    });
}

template <int D>
void Heat<D>::add_buoyancy(MacState<D>& state, const FaceFractions<D>& faces, const Vec<D>& gravity, real dt) const {
    if (expansion_.liquid == 0 && expansion_.gas == 0) return;
    const Grid<real, D>& T = temperature(state);
    for (int a = 0; a < D; ++a) {
        if (gravity[a] == 0) continue;
        const auto& fraction = faces[static_cast<std::size_t>(a)];
        const int n = T.extent()[a];
        for_each_free_face(state.u, state.sides, a, [&](const Index<D>& I) {
            Index<D> above = I, below = I - e<D>(a);
            if (I[a] == 0) below[a] = state.sides.periodic(a) ? n - 1 : 0;
            if (I[a] == n) above[a] = n - 1;
            const real warmer = 0.5 * (T(below) + T(above)) - ambient_, f = fraction(I);
            state.u[a](I) -= dt * gravity[a] * expansion_.of(f) * warmer / rho_.of(f);
        });
    }
    sync_periodic(state.u, state.sides);
}

template <int D>
void Heat<D>::check(const MacState<D>& state) const {
    if (!std::isfinite(max_magnitude(temperature(state)))) throw NumericalFailure("temperature", "the temperature is not finite");
}

/// The content is relative to 0 K.
template <int D>
void Heat<D>::add_integrals(const MacState<D>& state, bool open, std::vector<Integral>& list) const {
    const std::string unit = D == 2 ? "J/m" : "J";
    std::array<real, 2> volume{}, sum{};
    for (std::size_t phase = 0; phase < 2; ++phase) {
        const auto total = [&](auto&& of) {
            return sum_over(state.extent(),
                            [&](const Index<D>& I) { return is_open(state, I) ? part_of(state.fields[0].values(I), phase) * of(I) : 0; });
        };
        volume[phase] = total([](const Index<D>&) { return 1.0; });
        sum[phase] = total([&](const Index<D>& I) { return own_.values[phase](I); });
    }
    list.push_back({"heat", unit, state.u.cell_volume() * (capacity_.liquid * sum[0] + capacity_.gas * sum[1])});
    list.push_back({"heat_added", unit, added_});
    if (open) list.push_back({"poured_heat", unit, entered_});
    list.push_back({"liquid_temperature", "K", volume[0] > sliver ? sum[0] / volume[0] : not_applicable});
    list.push_back({"gas_temperature", "K", volume[1] > sliver ? sum[1] / volume[1] : not_applicable});
    const std::array<real, 2> range = range_of(state);
    list.push_back({"coldest", "K", range[0]});
    list.push_back({"hottest", "K", range[1]});
}

template <int D>
void Heat<D>::save(Checkpoint& to) const {
    put_planes(to, "two_phase.liquid_temperature", own_.values[0]);
    put_planes(to, "two_phase.gas_temperature", own_.values[1]);
    to.put_value("two_phase.heat", std::array<real, 2>{added_, entered_});
}

template <int D>
void Heat<D>::restore(const Checkpoint& from) {
    get_planes(from, "two_phase.liquid_temperature", own_.values[0]);
    get_planes(from, "two_phase.gas_temperature", own_.values[1]);
    const auto sums = from.template get_value<std::array<real, 2>>("two_phase.heat");
    added_ = sums[0], entered_ = sums[1];
}

template <int D>
std::size_t Heat<D>::bytes() const {
    return own_.bytes() + (conduction_ ? conduction_->bytes() + sizeof(*conduction_) : 0);
}

template class Heat<2>;
template class Heat<3>;

}  // namespace weir::two_phase
