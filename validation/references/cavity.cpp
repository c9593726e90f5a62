// Tables of the lid-driven cavity, 2D and cube, in one convention: unit box, lid y = 1 moving in +x with speed 1; u along the vertical
// and v along the horizontal centreline.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <algorithm>
#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

std::string reynolds(const scene::Scene& scene) {
    return std::to_string(std::lround(scene.root().vec<3>("sides.y_max.velocity")[0] / scene.number("fluid.viscosity")));
}

/// Ghia's rows without the misprints.
Curve ghia(const std::filesystem::path& data, const std::string& kind, const std::string& Re) {
    return read_table(data / "cavity2d_ghia1982.csv")
        .where("Re", Re)
        .where("kind", kind)
        .where("ok", "1")
        .curve("coord", "value", "Ghia 1982");
}

}  // namespace

REFERENCE(cavity) {
    const std::string Re = reynolds(scene);
    const Table own = read_table(data / "cavity2d_own.csv").where("Re", Re);
    if (own.rows.empty()) throw BadInput("no cavity data for Re = " + Re + "; known: 100, 400, 1000");
    Reference ref{.source = "own Newton solve with Richardson extrapolation; Re 1000: Botella & Peyret 1998; shown too: Ghia et al. 1982"};
    for (const std::string kind : {"u", "v"}) {
        ref.curves["centreline." + kind] = own.where("kind", kind).curve("coord", "value", "Richardson");
        ref.curves["centreline." + kind + ".ghia"] = ghia(data, kind, Re);
        if (Re == "1000")
            ref.curves["centreline." + kind] =
                read_table(data / "cavity2d_botella_peyret1998.csv").where("kind", kind).curve("coord", "value", "Botella & Peyret 1998");
    }
    return ref;
}

// The paper's cavity is centred at the origin with its lid at x = -1/2 moving in +y: X = y + 1/2, Y = 1/2 - x, u = v_paper, v = -u_paper.
REFERENCE(cavity_3d) {
    const Table cube = read_table(data / "cavity3d_albensoeder_kuhlmann2005.csv");
    Reference ref{.source = "Albensoeder & Kuhlmann 2005, tables 5 and 6"};
    Curve u = cube.where("kind", "v").curve("coord", "value", "Albensoeder & Kuhlmann 2005");
    for (auto& x : u.x) x = 0.5 - x;
    Curve v = cube.where("kind", "u").curve("coord", "value", "Albensoeder & Kuhlmann 2005");
    for (auto& y : v.x) y += 0.5;
    for (auto& value : v.y) value = -value;
    ref.curves = {{"centreline.u", u}, {"centreline.v", v}};
    return ref;
}

// Air between a hot and a cold wall. Ra = g beta dT L^3 / (nu alpha) picks the row; speeds in the table are in units of alpha / L.
namespace {

/// Of the effect, of the liquid of two phases, or of the liquid where the scene names a substance [m^2/s].
real diffusivity_of(const scene::Scene& scene) {
    if (scene.effect("heat"))
        return scene.number("fluid.conductivity") / (scene.number("fluid.density") * scene.number("fluid.heat_capacity"));
    if (const auto* diffusion = scene.effect("diffusion")) return diffusion->number("temperature");
    return scene.number("substance.liquid.conductivity") / (scene.number("fluid.density") * scene.number("substance.liquid.heat_capacity"));
}

/// Gravity times expansion [m/(s^2 K)].
real lift_of(const scene::Scene& scene) {
    if (scene.effect("buoyancy")) return scene.number("effects.buoyancy.beta");
    if (scene.effect("heat")) return -scene.effect("gravity")->numbers("g")[1] * scene.number("fluid.expansion");
    return scene.number("heat.lift") * scene.number("substance.liquid.expansion");
}

}  // namespace

REFERENCE(heated_cavity) {
    const real lift = lift_of(scene);
    const real hot = scene.number("sides.x_min.temperature"), cold = scene.number("sides.x_max.temperature");
    const real L = scene.vec<2>("grid.size")[0], alpha = diffusivity_of(scene);
    const real Ra = lift * (hot - cold) * L * L * L / (scene.number("fluid.viscosity") * alpha);
    const Table all = read_table(data / "heated_cavity_devahldavis1983.csv");
    Reference ref{.source = "de Vahl Davis 1983, and an own Newton solve with Richardson extrapolation"};
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
        if (std::abs(all.number(i, "Ra") / Ra - 1) > 0.01) continue;  // a Rayleigh number within 1% names the row
        const bool own = all.text(i, "source") == "own";
        for (const std::string name : {"Nu_mean", "Nu_0", "u_max", "v_max"})
            ref.numbers[own ? name : name + ".devahldavis"] = all.number(i, name);
    }
    if (!ref.numbers.count("Nu_mean")) throw BadInput("no heated-cavity data for Ra = " + std::to_string(Ra));
    ref.numbers["speed_unit"] = alpha / L;
    return ref;
}
