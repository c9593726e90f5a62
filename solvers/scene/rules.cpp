#include "scene/rules.hpp"

#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace weir::scene {
namespace {

Domain domain_of(const Table& root) {
    if (!root.has("grid.size") || !root.has("grid.origin")) return {};
    Domain domain{root.numbers("grid.origin"), root.numbers("grid.origin")};
    const auto& size = root.numbers("grid.size");
    if (size.size() != domain.min.size()) return {};  // their lengths are checked against dim, which may be unknown
    for (std::size_t d = 0; d < size.size(); ++d) domain.max[d] += size[d];
    return domain;
}

/// Cells are indexed by int. The memory limit is checked elsewhere, because it depends on the solver (sim::require_memory).
void check_cells(const Table& root, const Report& report) {
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    if (!root.has("grid.cells")) return;
    double cells = 1;
    for (const double n : root.numbers("grid.cells")) cells *= n;
    if (cells > most)
        report(root.place("grid.cells"), fmt::format("grid.cells makes {:.3g} cells; at most {:.0f} can be numbered", cells, most));
}

/// A cell must be wider than the rounding of its own coordinates, with a margin of three digits.
void check_resolution(const Table& root, const Domain& domain, const Report& report) {
    if (!domain.known() || !root.has("grid.cells") || root.numbers("grid.cells").size() != domain.min.size()) return;
    for (std::size_t d = 0; d < domain.min.size(); ++d) {
        const double width = root.numbers("grid.size")[d] / root.numbers("grid.cells")[d];
        const std::string axis = axis_name(static_cast<int>(d));
        const double farthest = std::max(std::abs(domain.min[d]), std::abs(domain.max[d]));
        if (!std::isfinite(farthest) || width < 1e3 * std::numeric_limits<double>::epsilon() * farthest)
            return report(root.place("grid.size"),
                          fmt::format("cells of {:.3g} m along {} cannot be distinguished at {} = {:.3g} m in double precision", width,
                                      axis, axis, farthest));
    }
}

void check_time(const Table& root, const Report& report) {
    if (root.has("time.dt") && root.has("time.max_dt") && root.number("time.dt") > root.number("time.max_dt"))
        report(root.place("time.dt"), fmt::format("time.dt is {} s, above time.max_dt = {} s", number_text(root.number("time.dt")),
                                                  number_text(root.number("time.max_dt"))));
}

/// Liquid and emitters must reach into the domain.
void check_reach(const Table& shape, const std::string& path, const Domain& domain, const Report& report) {
    if (domain.known() && misses(shape, domain))
        report(shape.place("shape"), fmt::format("{} lies outside the domain, so it adds no fluid", path),
               fmt::format("the domain reaches from {} to {}", point_text(domain.min), point_text(domain.max)));
}

void check_bodies(const Table& root, const Domain& domain, int dim, const Report& report) {
    const auto each = [&](const char* list, const auto& check) {
        const auto& tables = root.tables(list);
        for (std::size_t i = 0; i < tables.size(); ++i) {
            const auto path = fmt::format("{}[{}]", list, i);
            check_shape(tables[i], path, dim, report);
            check(tables[i], path);
        }
    };
    each("liquid", [&](const Table& t, const std::string& path) { check_reach(t, path, domain, report); });
    each("solids", [&](const Table& t, const std::string& path) {
        if (t.has("motion")) check_motion(t.table("motion"), path + ".motion", report);
    });
    each("bodies", [](const Table&, const std::string&) {});
    each("emitters", [&](const Table& t, const std::string& path) {
        check_reach(t, path, domain, report);
        if (t.has("start") && t.has("end") && t.number("end") <= t.number("start"))
            report(t.place("end"), fmt::format("{}.end is {} s, not after its start at {} s", path, number_text(t.number("end")),
                                               number_text(t.number("start"))));
    });
}

}  // namespace

std::string point_text(const std::vector<double>& point) {
    std::string out = "[";
    for (const double x : point) out += (out.size() > 1 ? ", " : "") + number_text(x);
    return out + "] m";
}

void check_rules(Table& root, int dim, const std::string& file, std::vector<Problem>& problems) {
    const Report report(file, problems);
    const Domain domain = domain_of(root);
    check_cells(root, report);
    check_resolution(root, domain, report);
    check_time(root, report);
    check_sides(root, dim, report);
    check_bodies(root, domain, dim, report);
    check_probes(root, domain, dim, report);
}

}  // namespace weir::scene
