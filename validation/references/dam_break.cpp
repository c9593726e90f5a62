// Experiments with a collapsing column of water, n^2 = height / base = 2. Z = x_front / a against T = t sqrt(2 g / a), H = height / (2 a)
// against tau = t sqrt(g / a), a = base width. (Two scalings: the front's time has the factor sqrt 2, the height's has not.)
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

/// Added to the simulated T: the gate takes time to open, a simulated column is free at once. The value used by others with the table of
/// Martin & Moyce (Lethe's dam-break example), not fitted to us.
constexpr real gate_delay = 0.175;

/// Base width [m] and gravity of the scene's column, and its scales of time.
void add_scales(Reference& ref, const scene::Scene& scene) {
    const scene::Table& column = scene.root().tables("liquid").at(0);
    const real a = column.vec<2>("max")[0] - column.vec<2>("min")[0];
    const real g = -needed_effect(scene, "gravity").numbers("g").at(1);
    ref.numbers["base"] = a;
    ref.numbers["height"] = column.vec<2>("max")[1] - column.vec<2>("min")[1];
    ref.numbers["front_time"] = std::sqrt(a / (2 * g));
    ref.numbers["height_time"] = std::sqrt(a / g);
}

}  // namespace

REFERENCE(dam_break_martin_moyce) {
    Reference ref{.source = "Martin & Moyce 1952, tables 2 and 6, n^2 = 2, a = 2.25 in"};
    add_scales(ref, scene);
    ref.curves["front"] = read_table(data / "martin_moyce1952_n2eq2_front.csv").curve("T", "Z", "Martin & Moyce 1952");
    ref.curves["height"] = read_table(data / "martin_moyce1952_n2eq2_height.csv").curve("tau", "H", "Martin & Moyce 1952");
    ref.numbers["time_shift"] = gate_delay;
    return ref;
}

REFERENCE(dam_break_front) {
    Reference ref = dam_break_martin_moyce_reference(scene, data);
    ref.curves["front.other"] =
        read_table(data / "koshizuka_oka1996.csv").where("series", "exp").curve("T", "Z", "Koshizuka & Oka 1996, experiment");
    return ref;
}

REFERENCE(dam_break_koshizuka_oka) {
    Reference ref{.source = "Koshizuka & Oka 1996 (experiment, digitised)"};
    add_scales(ref, scene);
    const Table all = read_table(data / "koshizuka_oka1996.csv");
    ref.curves["front"] = all.where("series", "exp").curve("T", "Z", "Koshizuka & Oka 1996, experiment");
    ref.curves["front.mps"] = all.where("series", "mps").curve("T", "Z", "Koshizuka & Oka 1996, MPS");
    ref.numbers["time_shift"] = gate_delay;
    return ref;
}

REFERENCE(dam_break_kleefsman) {
    Reference ref{.source = "Kleefsman et al. 2005 (SPHERIC test 2), experiment"};
    const Table all = read_table(data / "kleefsman2005_pressure.csv");
    for (const char* gauge : {"P1", "P2", "P3", "P4"}) ref.curves[gauge] = all.curve("t", gauge, "Kleefsman et al. 2005, experiment");
    return ref;
}
