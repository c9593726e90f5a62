// Water and its vapour in balance in a closed vessel.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

using namespace weir;
using namespace weir::validation;

namespace {

/// SR1-86 [Pa].
real saturation_pressure(real T) {
    const real th = 1 - T / 647.096;
    const real sum = -7.85951783 * th + 1.84408259 * std::pow(th, 1.5) - 11.7866497 * std::pow(th, 3) + 22.6807411 * std::pow(th, 3.5) -
                     15.9618719 * std::pow(th, 4) + 1.80122502 * std::pow(th, 7.5);
    return 22.064e6 * std::exp(647.096 / T * sum);
}

/// All lines of water: R14-08 below the triple point, SR1-86 above.
void draw_lines(Reference& ref) {
    const real pt = 611.657;
    Curve saturation{.label = "saturation", .dashed = true}, sublimation{.label = "sublimation", .dashed = true},
        melting{.label = "melting", .dashed = true};
    const auto add = [](Curve& line, real T, real p) { line.x.push_back(T), line.y.push_back(p); };
    for (int i = 0; i <= 75; ++i) {
        const real T = 273.16 + (647.096 - 273.16) * i / 75;
        add(saturation, T, saturation_pressure(T));
    }
    for (int i = 0; i <= 30; ++i) {
        const real T = 230 + (273.16 - 230) * i / 30, x = T / 273.16;
        const real sum =
            -21.2144006 * std::pow(x, 0.00333333333) + 27.3203819 * std::pow(x, 1.20666667) - 6.10598130 * std::pow(x, 1.70333333);
        add(sublimation, T, pt * std::exp(sum / x));
    }
    for (int i = 0; i <= 30; ++i) {
        const real T = 273.16 - (273.16 - 270) * std::pow(i / 30.0, 4), x = T / 273.16;
        add(melting, T,
            pt * (1 + 1.19539337e6 * (1 - std::pow(x, 3)) + 8.08183159e4 * (1 - std::pow(x, 25.75)) +
                  3.33826860e3 * (1 - std::pow(x, 103.75))));
    }
    ref.curves["saturation"] = saturation, ref.curves["sublimation"] = sublimation, ref.curves["melting"] = melting;
}

/// Until when the surroundings have this temperature: the last keyframe at it, or the end where that is the last of all.
real ends_at(const scene::Scene& scene, real T) {
    real ends = 0;
    const auto& frames = scene.root().tables("heat.ambient.keyframes");
    for (const auto& frame : frames)
        if (frame.number("temperature") == T) ends = frame.number("t");
    return !frames.empty() && frames.back().number("temperature") == T ? scene.number("time.end") : ends;
}

}  // namespace

/// Rows of the run's mass, and until when the surroundings have each temperature.
REFERENCE(closed_vessel) {
    Reference ref{.source = "SR1-86 and IF97"};
    const real mass = scene.number("vessel.mass"), volume = scene.number("vessel.volume");
    if (volume != 1) throw BadInput("the table of closed vessels is for 1 m^3");
    const Table all = read_table(data / "closed_vessel.csv");
    auto &pressure = ref.curves["pressure"], &vapour = ref.curves["vapour"], &energy = ref.curves["energy"], &dry = ref.curves["dry"],
         &until = ref.curves["until"];
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
        if (all.number(i, "m_kg") != mass) continue;
        const real T = all.number(i, "T_K");
        const auto add = [&](Curve& curve, real y) { curve.x.push_back(T), curve.y.push_back(y); };
        add(pressure, all.number(i, "p_Pa")), add(vapour, all.number(i, "m_vapour_kg"));
        add(energy, all.text(i, "u_J_per_kg") == "nan" ? std::nan("") : all.number(i, "u_J_per_kg"));
        add(dry, all.text(i, "state") == "two-phase" ? 0 : 1);
        add(until, ends_at(scene, T));
    }
    draw_lines(ref);
    return ref;
}

/// Water in balance with its vapour at each temperature at which the surroundings rest.
REFERENCE(saturated_gas) {
    (void)data;
    Reference ref{.source = "SR1-86"};
    const real never = std::nan("");
    for (const auto& frame : scene.root().tables("heat.ambient.keyframes")) {
        const real T = frame.number("temperature");
        auto& pressure = ref.curves["pressure"];
        if (std::find(pressure.x.begin(), pressure.x.end(), T) != pressure.x.end()) continue;
        for (const auto& [name, y] : {std::pair<const char*, real>{"pressure", saturation_pressure(T)},
                                      {"vapour", never},
                                      {"energy", never},
                                      {"dry", 0},
                                      {"until", ends_at(scene, T)}})
            ref.curves[name].x.push_back(T), ref.curves[name].y.push_back(y);
    }
    draw_lines(ref);
    return ref;
}
