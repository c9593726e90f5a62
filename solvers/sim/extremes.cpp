#include "sim/extremes.hpp"

#include "geometry/solids.hpp"
#include "parallel/communicator.hpp"
#include "rigid/bodies.hpp"
#include "sim/owners.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace weir::sim {

namespace {

/// A value of one field component and its place.
struct Extreme {
    real value = 0;  // |u|, or the value itself
    std::array<real, 3> at{};
    std::array<int, 3> cell{-1, -1, -1};  // of a grid
    int number = -1;                      // of a particle or body
};

/// Entry i of a component on the grid.
Extreme on_grid(const GridView& grid, const FieldView& view, std::size_t component, std::size_t i, real value) {
    Extreme e{.value = value};
    for (std::size_t a = 0; a < static_cast<std::size_t>(grid.dim); ++a) {
        const bool face = view.where == Where::face && component == a;
        const auto extent = static_cast<std::size_t>(grid.cells[a] + (face ? 1 : 0));
        e.cell[a] = static_cast<int>(i % extent), i /= extent;
        e.at[a] = grid.origin[a] + grid.spacing[a] * (e.cell[a] + (face ? 0.0 : 0.5));
    }
    return e;
}

/// NaN compares as largest.
bool beyond(real value, real than) { return value > than || (std::isnan(value) && !std::isnan(than)); }

Extreme largest_in_grid(const FieldSet& fields, const FieldView& view) {
    Extreme most;
    for (std::size_t c = 0; c < view.data.size(); ++c) {
        const auto [first, last] = own_entries(fields, view, c);
        for (std::size_t i = first; i < last; ++i)
            if (const real value = std::abs(view.data[c][i]); beyond(value, most.value)) most = on_grid(fields.grid, view, c, i, value);
    }
    return most;
}

Extreme largest_of_points(const FieldSet& fields, const FieldView& view) {
    Extreme most;
    const FieldView* position = fields.find(view.set, "position");
    if (!position || view.data.empty()) return most;
    for (std::size_t i = 0; i < view.data[0].size(); ++i) {
        real square = 0;
        for (const auto& component : view.data) square += component[i] * component[i];
        if (!beyond(std::sqrt(square), most.value)) continue;
        most = {.value = std::sqrt(square), .number = static_cast<int>(i)};
        for (std::size_t a = 0; a < position->data.size() && a < 3; ++a) most.at[a] = position->data[a][i];
    }
    return most;
}

/// Global maximum over the ranks.
Extreme largest(const FieldSet& fields, const FieldView& view) {
    Extreme most = view.where == Where::particle ? largest_of_points(fields, view) : largest_in_grid(fields, view);
    if (communicator().several())
        for (const Extreme& other : of_ranks(most))
            if (beyond(other.value, most.value)) most = other;
    return most;
}

std::string place(const Extreme& e, int dim) {
    std::string at, cell;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dim); ++a) {
        at += fmt::format("{}{:.4g}", a ? ", " : "", e.at[a]);
        cell += fmt::format("{}{}", a ? ", " : "", e.cell[a]);
    }
    return fmt::format("at [{}] m{}", at, e.number < 0 ? " (cell " + cell + ")" : "");
}

std::string of_field(const FieldSet& fields, const FieldView& view, int dim) {
    const Extreme e = largest(fields, view);
    if (e.value == 0) return {};
    if (view.name == "velocity") {
        const std::string what = view.set == rigid::body_set_name ? fmt::format("bodies[{}]", e.number)
                                 : view.set.empty()               ? "the fastest flow"
                                                                  : "the fastest of the " + view.set;
        return fmt::format("{} moves at {:.3g} m/s {}", what, e.value, place(e, dim));
    }
    return fmt::format("the largest {} is {:.3g} {} {}", view.name, e.value, view.unit, place(e, dim));
}

template <int D>
std::string of_solids(const scene::Scene& scene, real time) {
    std::string all;
    geometry::Solids<D> solids(scene);
    solids.set_time(time);
    for (std::size_t s = 0; s < solids.count() && solids.in_list(s) == s; ++s) {
        const geometry::Pose<D>& pose = solids.pose(s);
        const real spin = std::sqrt(pose.spin[0] * pose.spin[0] + pose.spin[1] * pose.spin[1] + pose.spin[2] * pose.spin[2]);
        const real speed = norm(pose.velocity);
        if (speed > 0) all += fmt::format("; solids[{}] moves at {:.3g} m/s", s, speed);
        if (spin > 0) all += fmt::format("; solids[{}] turns at {:.3g} rad/s", s, spin);
    }
    return all;
}

}  // namespace

std::string extremes(const scene::Scene& scene, const FieldSet& fields, real time) {
    std::string all;
    for (const FieldView& view : fields.fields) {
        if (view.name != "velocity" && view.name != "pressure" && view.name != column_depth_name) continue;
        if (const std::string one = of_field(fields, view, scene.dim()); !one.empty()) all += (all.empty() ? "" : "; ") + one;
    }
    all += scene.dim() == 2 ? of_solids<2>(scene, time) : of_solids<3>(scene, time);
    return all.empty() ? "nothing moves" : all;
}

}  // namespace weir::sim
