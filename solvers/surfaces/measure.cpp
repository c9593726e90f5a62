#include "surfaces/measure.hpp"

#include "surfaces/triangle.hpp"

#include <algorithm>

namespace weir::surfaces {

real volume(const SurfaceMesh& mesh) {
    if (mesh.points.empty()) return 0;
    const Vec<3> from = mesh.points.front();  // a point near the surface: less rounding error than with the origin
    real six = 0;
    for (const auto& t : mesh.corners) six += dot(corner(mesh, t, 0) - from, cross(corner(mesh, t, 1) - from, corner(mesh, t, 2) - from));
    if (!mesh.lines.empty()) {
        real two = 0;
        for (const auto& line : mesh.lines) two += cross(end(mesh, line, 0) - from, end(mesh, line, 1) - from)[2];
        return two / 2;
    }
    return six / 6;
}

real area(const SurfaceMesh& mesh) {
    real sum = 0;
    for (const auto& line : mesh.lines) sum += norm(end(mesh, line, 1) - end(mesh, line, 0));
    for (const auto& t : mesh.corners) sum += 0.5 * norm(area_vector(mesh, t));
    return sum;
}

real smallest_triangle(const SurfaceMesh& mesh) {
    real least = infinity;
    for (const auto& t : mesh.corners) least = std::min(least, 0.5 * norm(area_vector(mesh, t)));
    return least;
}

namespace {

Topology topology_of_lines(const SurfaceMesh& mesh) {
    std::vector<std::array<int, 2>> met(mesh.points.size(), {0, 0});  // lines that begin and end at each point
    for (const auto& line : mesh.lines)
        for (std::size_t c = 0; c < 2; ++c) ++met[static_cast<std::size_t>(line[c])][c];
    Topology found;
    found.edges = static_cast<std::int64_t>(mesh.lines.size());
    for (const auto& [begin, last] : met) {
        found.unused_points += begin + last == 0;
        found.open_edges += begin + last > 0 && (begin != 1 || last != 1);
    }
    found.euler = static_cast<std::int64_t>(mesh.points.size()) - found.unused_points - found.edges;
    return found;
}

}  // namespace

Topology topology(const SurfaceMesh& mesh) {
    if (!mesh.lines.empty()) return topology_of_lines(mesh);
    // every directed edge once; a closed, oriented surface has each of them and its reverse exactly once
    std::vector<std::pair<int, int>> sides;
    sides.reserve(3 * mesh.corners.size());
    std::vector<char> used(mesh.points.size(), 0);
    for (const auto& t : mesh.corners)
        for (std::size_t c = 0; c < 3; ++c) {
            sides.emplace_back(t[c], t[(c + 1) % 3]);
            used[static_cast<std::size_t>(t[c])] = 1;
        }
    std::sort(sides.begin(), sides.end());
    Topology found;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const std::pair<int, int> back{sides[i].second, sides[i].first};
        const auto [first, last] = std::equal_range(sides.begin(), sides.end(), back);
        const bool again = i > 0 && sides[i] == sides[i - 1];
        if (again) continue;
        const bool twice = i + 1 < sides.size() && sides[i + 1] == sides[i];
        const bool met = first != last;
        if (sides[i].first < sides[i].second || !met) ++found.edges;
        if ((twice || last - first != 1) && (sides[i].first < sides[i].second || !met)) ++found.open_edges;
    }
    found.unused_points = std::count(used.begin(), used.end(), 0);
    found.euler =
        static_cast<std::int64_t>(mesh.points.size()) - found.unused_points - found.edges + static_cast<std::int64_t>(mesh.corners.size());
    return found;
}

}  // namespace weir::surfaces
