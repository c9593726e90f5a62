// Bodies in water: what Archimedes, Lamb and Ursell say of them.
#include "validation/harness/fitting.hpp"
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <algorithm>
#include <cmath>

using namespace weir;
using namespace weir::validation;

namespace {

/// The root of an increasing function of a depth in [0, 1] of the body's height.
template <class F>
real depth_where(real value, F&& submerged) {
    real low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
        const real middle = 0.5 * (low + high);
        (submerged(middle) < value ? low : high) = middle;
    }
    return low;
}

const scene::Table& first_body(const scene::Scene& scene) { return scene.root().tables("bodies").at(0); }
real density_ratio(const scene::Scene& scene) { return first_body(scene).number("density") / scene.number("fluid.density"); }
real level(const scene::Scene& scene) { return scene.root().tables("liquid").at(0).numbers("max").at(1); }

}  // namespace

/// The height of the middle of an upright box, a disc, a ball or a cylinder that lies or stands, afloat.
REFERENCE(afloat) {
    const scene::Table& body = first_body(scene);
    const real s = density_ratio(scene);
    Reference ref{.source = "Archimedes"};
    if (body.text("shape") == "box") {
        const real height = body.numbers("max").at(1) - body.numbers("min").at(1);
        ref.numbers["height"] = level(scene) + (0.5 - s) * height;
        return ref;
    }
    bool round = scene.dim() == 2;  // it lies: a disc across
    if (body.text("shape") == "cylinder") {
        const real length = body.numbers("to").at(1) - body.numbers("from").at(1);
        for (int a = 0; a < scene.dim(); a += 2) round = round || body.numbers("to").at(a) != body.numbers("from").at(a);
        if (round && length != 0) throw BadInput("the draft of a cylinder that leans is not known here: it lies or stands");
        if (!round) {
            ref.numbers["height"] = level(scene) + (0.5 - s) * std::abs(length);
            return ref;
        }
    }
    const real diameter = 2 * body.number("radius");
    const real draft = depth_where(s, [&](real e) {
        const real q = std::acos(1 - 2 * e);
        return round ? (q - std::sin(q) * std::cos(q)) / pi : 3 * e * e - 2 * e * e * e;
    });
    ref.numbers["height"] = level(scene) + (0.5 - draft) * diameter;
    return ref;
}

/// The height of the middle of a disc or a ball that is as dense as the water: where it is put.
REFERENCE(stays) {
    Reference ref{.source = "Archimedes"};
    ref.numbers["height"] = first_body(scene).numbers("centre").at(1);
    return ref;
}

/// Added mass over displaced mass of a disc or a ball in the middle of a round vessel: exact, from the potentials r + b²/r and r + b³/(2
/// r²).
REFERENCE(round_vessel) {
    const real a = first_body(scene).number("radius");
    const real b = scene.root().tables("solids").at(0).tables("minus").at(0).number("radius");
    const real q = std::pow(b / a, scene.dim());
    Reference ref{.source = "Lamb 1932, arts. 68 and 93"};
    ref.numbers["coefficient"] = scene.dim() == 2 ? (q + 1) / (q - 1) : (q + 2) / (2 * (q - 1));
    return ref;
}

/// Heave of a half-immersed cylinder let go at a small height, in deep water without friction, over that height.
REFERENCE(heave_decay) {
    const Table table = read_table(data / "heave_decay_cylinder_2d_linear.csv");
    Reference ref{.source = "linear theory, from Ursell's multipoles (1949)"};
    Curve curve = table.curve("t_star", "x_over_x0", ref.source);
    const real a = first_body(scene).number("radius"), g = -needed_effect(scene, "gravity").numbers("g").at(1);
    for (real& t : curve.x) t *= std::sqrt(a / g);
    ref.curves["heave"] = curve;
    ref.numbers["start"] = first_body(scene).numbers("centre").at(1) - level(scene);
    return ref;
}

/// Heave of a ball let go a tenth of its diameter above where it floats: measured, over that height.
REFERENCE(heave_sphere) {
    const Table table = read_table(data / "kramer2021_sphere_heave_0p1D.csv");
    constexpr real te0 = 0.7561;  // the time by which the table divides [s]
    Reference ref{.source = "Kramer et al. 2021"};
    Curve curve = table.curve("t_over_Te0", "x3_over_H0", ref.source);
    for (real& t : curve.x) t *= te0;
    ref.curves["heave"] = curve;
    ref.numbers["start"] = first_body(scene).numbers("centre").at(1) - level(scene);
    return ref;
}

/// The greatest speed of a ball that sinks through one of four oils, told by its density.
REFERENCE(settling_sphere) {
    const Table table = read_table(data / "ten_cate2002_settling_sphere.csv");
    Reference ref{.source = "ten Cate et al. 2002"};
    for (std::size_t row = 0; row < table.rows.size(); ++row)
        if (table.number(row, "rho_f") == scene.number("fluid.density"))
            ref.numbers["fastest_fall"] = table.number(row, "u_inf") * table.number(row, "u_max_over_u_inf");
    if (ref.numbers.empty()) throw BadInput("no oil of the table has the density of this fluid");
    const real fastest = ref.number("fastest_fall");
    ref.curves["fall"] = {.label = "greatest speed measured", .x = {0, scene.number("time.end")}, .y = {fastest, fastest}, .dashed = true};
    return ref;
}

/// A disc sinks in a channel, by finite elements.
REFERENCE(settling_disc) {
    Reference ref{.source = "Glowinski et al. 2001"};
    Curve curve = read_table(data / "glowinski2001_disc_settling_velocity.csv").curve("t_s", "v_m_per_s", ref.source);
    for (real& v : curve.y) v = -v;
    ref.numbers["fastest_fall"] = *std::max_element(curve.y.begin(), curve.y.end());
    ref.curves["fall"] = curve;
    return ref;
}

/// A square beam stands upright where its metacentre lies above its middle; of half the water's density it rests on a corner.
REFERENCE(square_section) {
    const real s = density_ratio(scene), metacentric = s / 2 + 1 / (12 * s) - 0.5;
    Reference ref{.source = "Archimedes; metacentre by Bouguer"};
    ref.numbers["angle"] = metacentric > 0 ? 0 : pi / 4;
    return ref;
}
