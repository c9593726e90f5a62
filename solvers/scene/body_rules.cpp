// Rules about shapes, their motions, and probes.
#include "scene/names.hpp"
#include "scene/rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

namespace weir::scene {
namespace {

bool is_zero(const std::vector<double>& v) {
    return std::all_of(v.begin(), v.end(), [](double x) { return x == 0; });
}

void check_box(const Table& box, const std::string& path, const Report& report) {
    if (!box.has("min") || !box.has("max") || box.numbers("min").size() != box.numbers("max").size()) return;
    for (std::size_t d = 0; d < box.numbers("min").size(); ++d) {
        const double low = box.numbers("min")[d], high = box.numbers("max")[d];
        if (low >= high)
            report(box.place("max"), fmt::format("{}.max is not above its min along {}: {} m against {} m", path,
                                                 axis_name(static_cast<int>(d)), number_text(high), number_text(low)));
    }
}

void check_direction(const Table& table, const char* key, const std::string& path, const Report& report) {
    if (table.has(key) && is_zero(table.numbers(key)))
        report(table.place(key), fmt::format("{}.{} is the zero vector; it must have a direction", path, key));
}

bool has_all(const Table& t, std::initializer_list<const char*> keys) {
    return std::all_of(keys.begin(), keys.end(), [&](const char* key) { return t.has(key); });
}

/// Returns whether the bounding box of a segment with a radius (or a point: from = to) does not intersect the domain.
bool segment_misses(const std::vector<double>& from, const std::vector<double>& to, double radius, const Domain& domain) {
    for (std::size_t d = 0; d < std::min({from.size(), to.size(), domain.min.size()}); ++d)
        if (std::max(from[d], to[d]) + radius <= domain.min[d] || std::min(from[d], to[d]) - radius >= domain.max[d]) return true;
    return false;
}

/// Returns whether no corner of the domain lies behind the plane.
bool half_space_misses(const Table& plane, const Domain& domain) {
    const auto &point = plane.numbers("point"), &normal = plane.numbers("normal");
    double deepest = 0;
    for (std::size_t d = 0; d < std::min({point.size(), normal.size(), domain.min.size()}); ++d)
        deepest += std::min(normal[d] * (domain.min[d] - point[d]), normal[d] * (domain.max[d] - point[d]));
    return deepest >= 0;
}

bool is_file_name(const std::string& name) {
    return !name.empty() && name.size() <= 100 && name[0] != '.' && name[0] != '-' &&
           std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-' || c == '.'; });
}

void check_inside(const Table& probe, const char* key, const std::string& path, const Domain& domain, const Report& report) {
    if (!probe.has(key) || !domain.known()) return;
    const auto& at = probe.numbers(key);
    for (std::size_t d = 0; d < std::min(at.size(), domain.min.size()); ++d)
        if (at[d] < domain.min[d] || at[d] > domain.max[d])
            return report(probe.place(key), fmt::format("{}.{} lies outside the domain", path, key),
                          fmt::format("the domain reaches from {} to {}", point_text(domain.min), point_text(domain.max)));
}

}  // namespace

void check_shape(const Table& shape, const std::string& path, int dim, const Report& report) {
    const auto kind = shape.text_or("shape", "");
    if (kind == "mesh" && dim == 2) report(shape.place("shape"), fmt::format("{} is a mesh, a shape of 3D; this scene has dim = 2", path));
    if (kind == "mesh") check_direction(shape, "axis", path, report);
    if (kind == "box") check_box(shape, path, report);
    if (kind == "plane") check_direction(shape, "normal", path, report);
    if (kind == "cylinder" && has_all(shape, {"from", "to"}) && shape.numbers("from") == shape.numbers("to"))
        report(shape.place("to"), fmt::format("{}.to is the same point as its from; a cylinder needs a length", path));
    for (const char* list : {"of", "minus"})
        if (kind == "union" || kind == "difference") {
            const auto& parts = shape.tables(list);
            for (std::size_t i = 0; i < parts.size(); ++i) check_shape(parts[i], fmt::format("{}.{}[{}]", path, list, i), dim, report);
        }
    if (kind == "difference" && shape.has("from")) check_shape(shape.table("from"), path + ".from", dim, report);
}

bool misses(const Table& shape, const Domain& domain) {
    const auto kind = shape.text_or("shape", "");
    if (kind == "box" && has_all(shape, {"min", "max"})) return segment_misses(shape.numbers("min"), shape.numbers("max"), 0, domain);
    if (kind == "sphere" && has_all(shape, {"centre", "radius"}))
        return segment_misses(shape.numbers("centre"), shape.numbers("centre"), shape.number("radius"), domain);
    if ((kind == "capsule" || kind == "cylinder") && has_all(shape, {"from", "to", "radius"}))
        return segment_misses(shape.numbers("from"), shape.numbers("to"), shape.number("radius"), domain);
    if (kind == "plane" && has_all(shape, {"point", "normal"}))
        return !is_zero(shape.numbers("normal")) && half_space_misses(shape, domain);
    if (kind == "difference" && shape.has("from")) return misses(shape.table("from"), domain);
    const auto& parts = shape.tables("of");
    return kind == "union" && !parts.empty() && std::all_of(parts.begin(), parts.end(), [&](const Table& t) { return misses(t, domain); });
}

void check_motion(const Table& motion, const std::string& path, const Report& report) {
    check_direction(motion, "axis", path, report);
    const auto& frames = motion.tables("frames");
    for (std::size_t i = 1; i < frames.size(); ++i)
        if (has_all(frames[i], {"t"}) && has_all(frames[i - 1], {"t"}) && frames[i].number("t") <= frames[i - 1].number("t"))
            report(frames[i].place("t"), fmt::format("{}.frames[{}].t is {} s; it must be after {} s of the previous keyframe", path, i,
                                                     number_text(frames[i].number("t")), number_text(frames[i - 1].number("t"))));
}

void check_probes(const Table& root, const Domain& domain, int dim, const Report& report) {
    std::map<std::string, Place> names;
    const auto& probes = root.tables("probes");
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Table& probe = probes[i];
        const auto path = fmt::format("probes[{}]", i);
        if (probe.has("name") && !is_file_name(probe.text("name")))
            report(probe.place("name"), fmt::format("{}.name is {}, which is not a valid file name", path, quote(probe.text("name"))),
                   "letters, digits, '_', '-' and '.', not as the first character");
        else if (probe.has("name"))
            if (const auto [first, inserted] = names.emplace(probe.text("name"), probe.place("name")); !inserted)
                report(probe.place("name"), fmt::format("two probes have the name {}; each writes its own file", quote(probe.text("name"))),
                       first->second.line > 0 ? fmt::format("first given in line {}", first->second.line) : "");
        for (const char* key : {"at", "from", "to"}) check_inside(probe, key, path, domain, report);
        if (has_all(probe, {"from", "to"}) && probe.numbers("from") == probe.numbers("to"))
            report(probe.place("to"), fmt::format("{}.to is the same point as its from; a line needs a length", path));
        if (dim == 2 && probe.text_or("axis", "") == "z")
            report(probe.place("axis"), fmt::format("{}.axis is \"z\"; this scene has dim = 2", path));
    }
}

}  // namespace weir::scene
