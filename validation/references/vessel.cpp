// Water and its vapour in balance in a closed vessel.
#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <cmath>

using namespace weir;
using namespace weir::validation;

/// Rows of the run's mass; and until when the surroundings have each temperature: the last keyframe at it, or the end where that is the
/// last of all.
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
        real ends = 0;
        const auto& frames = scene.root().tables("heat.ambient.keyframes");
        for (const auto& frame : frames)
            if (frame.number("temperature") == T) ends = frame.number("t");
        if (!frames.empty() && frames.back().number("temperature") == T) ends = scene.number("time.end");
        add(until, ends);
    }
    auto& line = ref.curves["saturation"];
    line.label = "saturation";
    for (real T = 275; T <= 510; T += 5) {  // SR1-86
        const real th = 1 - T / 647.096;
        const real sum = -7.85951783 * th + 1.84408259 * std::pow(th, 1.5) - 11.7866497 * std::pow(th, 3) + 22.6807411 * std::pow(th, 3.5) -
                         15.9618719 * std::pow(th, 4) + 1.80122502 * std::pow(th, 7.5);
        line.x.push_back(T), line.y.push_back(22.064e6 * std::exp(647.096 / T * sum));
    }
    return ref;
}
