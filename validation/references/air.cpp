// Enclosed air: a column of water on a cushion of gas, a glass upside down under water, and air that a bore traps.
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"
#include "validation/references/bore.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

/// The first liquid shape is a box, or a box less others.
const scene::Table& water_box(const scene::Scene& scene) {
    const scene::Table& liquid = scene.root().tables("liquid").at(0);
    return liquid.text("shape") == "difference" ? liquid.table("from") : liquid;
}

/// Gravity along an axis, in either direction.
struct Down {
    std::size_t axis = 1;
    real g = 0;         // [m/s²]
    bool falls = true;  // towards lower coordinates
    explicit Down(const scene::Scene& scene) {
        const auto all = needed_effect(scene, "gravity").numbers("g");
        for (std::size_t a = 0; a < all.size(); ++a)
            if (all[a] != 0) axis = a, g = std::abs(all[a]), falls = all[a] < 0;
    }
    /// Heights of the lower and upper end of a box.
    real bottom(const scene::Table& box) const { return falls ? box.numbers("min").at(axis) : -box.numbers("max").at(axis); }
    real top(const scene::Table& box) const { return falls ? box.numbers("max").at(axis) : -box.numbers("min").at(axis); }
};

}  // namespace

// ρ L x'' = p₀ ((H/x)^γ − 1) − ρ g L for the length x of the gas below the water, from rest at x = H, in a shaft open at the top.
REFERENCE(liquid_piston) {
    const Down down(scene);
    const real low = water_box(scene).numbers("min").at(down.axis), high = water_box(scene).numbers("max").at(down.axis);
    const real H = low - scene.root().numbers("grid.origin").at(down.axis), L = high - low, rho = scene.number("fluid.density");
    const real p0 = scene.number("enclosed_gas.pressure"), gamma = scene.number("enclosed_gas.exponent");
    const auto force = [&](real x) { return p0 * (std::pow(H / x, gamma) - 1) / (rho * L) - down.g; };
    constexpr int steps = 100000, every = 100;
    const real dt = scene.number("time.end") / steps;
    real x = H, v = 0, least = H, when = 0;
    Curve gas{.label = "exact", .x = {0}, .y = {H}};
    for (int i = 1; i <= steps; ++i) {  // Störmer-Verlet: errors below 1e-8
        const real middle = v + dt / 2 * force(x);
        x += dt * middle;
        v = middle + dt / 2 * force(x);
        if (x < least) least = x, when = i * dt;
        if (i % every == 0) gas.x.push_back(i * dt), gas.y.push_back(x);
    }
    Reference ref{.source = "a column of incompressible water on an adiabatic gas (ODE)"};
    ref.numbers = {{"length", H}, {"least", least}, {"time", when}, {"pressure", p0 * std::pow(H / least, gamma)}};
    ref.curves["gas"] = gas;
    return ref;
}

// p₀ (V₀/V)^γ = p₀ + ρ g d, with the depth d of the water surface in the glass below that of the tank, which falls as water enters the
// glass. The gas is the second box of the liquid's difference.
REFERENCE(glass) {
    const Down down(scene);
    const scene::Table& gas = scene.root().tables("liquid").at(0).tables("minus").at(0);
    if (gas.text("shape") != "box") return {.source = "incompressible gas (exact)"};
    const std::size_t across = down.axis == 1 ? 0 : 1;
    const real width = gas.numbers("max").at(across) - gas.numbers("min").at(across);
    const real bottom = down.bottom(gas), height = down.top(gas) - bottom;
    const real level = down.top(water_box(scene)), tank = scene.root().numbers("grid.size").at(across);
    const real rho = scene.number("fluid.density"), p0 = scene.root().number_or("enclosed_gas.pressure", 0);
    const real gamma = scene.root().number_or("enclosed_gas.exponent", 1);
    real low = 0, high = height;  // of the rise of water in the glass
    for (int i = 0; i < 100 && p0 > 0; ++i) {
        const real rise = (low + high) / 2, depth = level - rise * width / tank - bottom - rise;
        (p0 * (std::pow(height / (height - rise), gamma) - 1) < rho * down.g * depth ? low : high) = rise;
    }
    Reference ref{.source = p0 > 0 ? "Boyle-Mariotte and hydrostatics (exact)" : "incompressible gas (exact)"};
    ref.numbers = {{"start", width * height}, {"volume", width * (height - (p0 > 0 ? low : 0))}};
    return ref;
}

// A bore meets a block at its right with a hollow above the water: the first solid, a box less boxes, the last of which is the hollow. The
// air in it is closed by the bore, and its pressure is the head of the reflected bore above the water inside, between pool and lip.
REFERENCE(closed_hollow) {
    const Dam dam = dam_of(scene);
    const scene::Table& block = scene.root().tables("solids").at(0).table("from");
    const real g = gravity_down(scene), rho = scene.number("fluid.density"), floor = scene.root().numbers("grid.origin").at(1);
    const real lip = block.numbers("min").at(1) - floor;
    const Bore bore(dam, g);
    Reference ref{.source = "Stoker 1957: a bore and its reflection at a wall"};
    const real head = rho * g * (bore.reflected(g) - 0.5 * (dam.right + lip)), arrival = (block.numbers("min").at(0) - dam.x) / bore.speed;
    ref.numbers = {{"head", head}, {"arrival", arrival}};
    ref.curves["head"] = {
        .label = "head of the reflected bore", .x = {arrival, scene.number("time.end")}, .y = {head, head}, .dashed = true};
    return ref;
}
