// Rules about the sides of the domain, and the two notations of a periodic axis.
#include "scene/names.hpp"
#include "scene/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace weir::scene {
namespace {

std::string kind_of(const Table& root, int axis, int end) { return root.text_or(side_key(axis, end) + ".kind", ""); }

/// `grid.periodic` names the axis: its sides may repeat that, but have no other kind.
void make_periodic(Table& root, int axis, const Report& report) {
    for (int end = 0; end < 2; ++end) {
        Table* side = root.find_table(side_key(axis, end));
        const auto kind = kind_of(root, axis, end);
        if (!side || kind == "periodic") continue;
        if (const Place place = root.place(side_key(axis, end) + ".kind"); place.column > 0) {
            report(place, fmt::format("{} is {}, but grid.periodic names {}", side_key(axis, end), quote(kind), quote(axis_name(axis))));
        } else {
            Table periodic;
            periodic.set("kind", std::string("periodic"));
            *side = periodic;
        }
    }
}

void check_periodic(Table& root, int dim, const Report& report) {
    Table* grid = root.find_table("grid");
    const auto listed = grid && grid->has("periodic") ? grid->texts("periodic") : std::vector<std::string>{};
    if (dim == 2 && std::find(listed.begin(), listed.end(), "z") != listed.end())
        report(root.place("grid.periodic"), "grid.periodic names \"z\"; this scene has dim = 2");
    std::vector<std::string> periodic;
    for (int axis = 0; axis < dim; ++axis) {
        const bool by_list = std::find(listed.begin(), listed.end(), axis_name(axis)) != listed.end();
        const std::array<std::string, 2> kinds{kind_of(root, axis, 0), kind_of(root, axis, 1)};
        const int first = kinds[0] == "periodic" ? 0 : 1;
        if (by_list) {
            make_periodic(root, axis, report);
        } else if ((kinds[0] == "periodic") != (kinds[1] == "periodic") && !kinds[0].empty() && !kinds[1].empty()) {
            report(root.place(side_key(axis, first) + ".kind"),
                   fmt::format("{} is periodic, but {} is {}", side_key(axis, first), side_key(axis, 1 - first),
                               quote(kinds[static_cast<std::size_t>(1 - first)])),
                   "make both ends of an axis periodic, or neither");
        }
        if (by_list || (kinds[0] == "periodic" && kinds[1] == "periodic")) periodic.push_back(axis_name(axis));
    }
    if (grid && (grid->has("periodic") || !periodic.empty())) grid->set("periodic", periodic, grid->place("periodic"));
}

/// Rejects a wall that moves normal to its plane: it would change the domain's volume.
void check_moving_wall(const Table& side, int axis, const std::string& name, const Report& report) {
    if (side.text_or("kind", "") != "moving_wall" || !side.has("velocity")) return;
    const auto& velocity = side.numbers("velocity");
    if (static_cast<std::size_t>(axis) < velocity.size() && velocity[static_cast<std::size_t>(axis)] != 0)
        report(side.place("velocity"), fmt::format("{}.velocity has {} m/s along {}; a wall of the domain moves only along itself", name,
                                                   number_text(velocity[static_cast<std::size_t>(axis)]), axis_name(axis)));
}

}  // namespace

void check_sides(Table& root, int dim, const Report& report) {
    check_periodic(root, dim, report);
    for (int axis = 0; axis < dim; ++axis)
        for (int end = 0; end < 2; ++end) {
            Table* side = root.find_table(side_key(axis, end));
            if (!side) continue;
            if (kind_of(root, axis, end) == "open") side->set("kind", std::string("outflow"), side->place("kind"));
            check_moving_wall(*side, axis, side_key(axis, end), report);
        }
}

}  // namespace weir::scene
