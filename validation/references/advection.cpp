#include "validation/references/advection.hpp"

#include "validation/harness/reference.hpp"
#include "validation/references/table.hpp"

#include <algorithm>

namespace weir::validation {
namespace {

constexpr real disk_radius = 0.15, half_slot = 0.025, slot_top = 0.85;
constexpr Vec<2> centre{{{0.5, 0.75}}};

real disk(const Vec<2>& x) { return norm(x - centre) - disk_radius; }

/// Distance from x to the segment a - b.
real to_segment(const Vec<2>& x, const Vec<2>& a, const Vec<2>& b) {
    const Vec<2> d = b - a;
    return norm(x - a - std::clamp(dot(x - a, d) / dot(d, d), 0.0, 1.0) * d);
}

}  // namespace

real slotted_disk(const Vec<2>& x) {
    const real mouth = centre[1] - std::sqrt(disk_radius * disk_radius - half_slot * half_slot);  // where the slot's walls meet the circle
    const Vec<2> left{0.5 - half_slot, mouth}, right{0.5 + half_slot, mouth};
    const Vec<2> top_left{0.5 - half_slot, slot_top}, top_right{0.5 + half_slot, slot_top};
    const bool in_slot = std::abs(x[0] - 0.5) < half_slot && x[1] < slot_top;
    const bool inside = disk(x) < 0 && !in_slot;
    real d = std::min({to_segment(x, left, top_left), to_segment(x, top_left, top_right), to_segment(x, top_right, right)});
    // The circle is part of the boundary except below the slot, where its nearest point is an end of the arc (already an end of a wall).
    const Vec<2> r = x - centre;
    const real length = norm(r);
    const bool nearest_in_mouth = length == 0 || (r[1] < 0 && std::abs(r[0]) * disk_radius < half_slot * length);
    if (!nearest_in_mouth) d = std::min(d, std::abs(length - disk_radius));
    return inside ? -d : d;
}

real vortex_disk(const Vec<2>& x) { return disk(x); }

real gaussian_hill(const Vec<2>& x) { return std::exp(-dot(x - centre, x - centre) / (0.08 * 0.08)); }

Vec<2> rigid_rotation(const Vec<2>& x) { return 2 * pi * Vec<2>{0.5 - x[1], x[0] - 0.5}; }

Vec<2> single_vortex(const Vec<2>& x, real t, real T) {
    const real sx = std::sin(pi * x[0]), sy = std::sin(pi * x[1]), cx = std::cos(pi * x[0]), cy = std::cos(pi * x[1]);
    return 2 * std::cos(pi * t / T) * Vec<2>{-sx * sx * sy * cy, sy * sy * sx * cx};
}

Vec<2> unturned(const Vec<2>& x, real turns) {
    const real c = std::cos(2 * pi * turns), s = std::sin(2 * pi * turns);
    const Vec<2> r = x - Vec<2>{0.5, 0.5};
    return {0.5 + c * r[0] + s * r[1], 0.5 - s * r[0] + c * r[1]};
}

real vortex_disk_area() { return pi * disk_radius * disk_radius; }

real slotted_disk_area() {
    // The slot below y = slot_top inside the circle: a rectangle down to the centre's height and what hangs below it.
    const real below = half_slot * std::sqrt(disk_radius * disk_radius - half_slot * half_slot) +
                       disk_radius * disk_radius * std::asin(half_slot / disk_radius);
    return pi * disk_radius * disk_radius - (2 * half_slot * (slot_top - centre[1]) + below);
}

}  // namespace weir::validation

using namespace weir;
using namespace weir::validation;

namespace {

/// Rows of the baselines as numbers "<method>.<N>.first" (area change in percent, or maximum) and ".second" (symmetric difference, or RMS).
void add_baselines(Reference& ref, const std::filesystem::path& file, const std::string& test) {
    const Table all = read_table(file).where("case", test);
    for (std::size_t i = 0; i < all.rows.size(); ++i) {
        const std::string key = all.text(i, "method") + "." + all.text(i, "N");
        ref.numbers[key + ".first"] = all.number(i, "area_change_percent_or_max");
        ref.numbers[key + ".second"] = all.number(i, "sym_diff_area_or_rms");
    }
}

}  // namespace

REFERENCE(zalesak) {
    Reference ref{.source = "Zalesak 1979; errors of the same schemes by an independent implementation (cases/zalesak/data)"};
    ref.scalars["level_set"] = [](const Vec<3>& x, real t) { return slotted_disk(unturned({x[0], x[1]}, t)); };
    ref.numbers["area"] = slotted_disk_area();
    add_baselines(ref, data / "advection_baseline_errors.csv", "zalesak_1rev");
    return ref;
}

REFERENCE(single_vortex) {
    Reference ref{.source = "LeVeque 1996, Rider & Kothe 1998; errors of the same schemes by an independent implementation"};
    ref.scalars["level_set"] = [](const Vec<3>& x, real) { return vortex_disk({x[0], x[1]}); };  // at t = 0 and T
    ref.numbers["area"] = vortex_disk_area();
    add_baselines(ref, data / "advection_baseline_errors.csv", "single_vortex_T8");
    return ref;
}

REFERENCE(rotating_gaussian) {
    Reference ref{.source = "exact; errors of the same schemes by an independent implementation (cases/rotating_gaussian/data)"};
    ref.scalars["tracer"] = [](const Vec<3>& x, real t) { return gaussian_hill(unturned({x[0], x[1]}, t)); };
    add_baselines(ref, data / "advection_baseline_errors.csv", "rotating_gaussian_1rev_L2");
    return ref;
}
