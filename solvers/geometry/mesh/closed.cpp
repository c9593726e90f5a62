// Checks that triangles bound a region: every edge belongs to two of them in opposite directions, and those around every point form a
// single ring.
#include "core/error.hpp"
#include "geometry/mesh/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace weir::geometry {

namespace {

std::string place(const Vec<3>& x) {
    char text[96];
    std::snprintf(text, sizeof text, "[%.4g, %.4g, %.4g]", x[0], x[1], x[2]);
    return text;
}

struct Edge {
    int from, to;
    bool operator==(const Edge&) const = default;
};
struct EdgeHash {
    std::size_t operator()(const Edge& e) const {
        return static_cast<std::size_t>(0x9e3779b97f4a7c15ULL *
                                        ((static_cast<std::uint64_t>(e.from) << 32) | static_cast<std::uint32_t>(e.to)));
    }
};

/// Returns whether the triangles at a point, linked across its edges, are a single ring.
bool is_one_ring(const std::vector<std::array<int, 3>>& corners, const std::vector<int>& around, int point) {
    std::vector<std::pair<int, int>> steps;  // each triangle leads from one neighbour of the point to the next
    for (const int t : around) {
        const auto& c = corners[static_cast<std::size_t>(t)];
        const std::size_t k = c[0] == point ? 0 : c[1] == point ? 1 : 2;
        steps.emplace_back(c[(k + 1) % 3], c[(k + 2) % 3]);
    }
    std::sort(steps.begin(), steps.end());
    int at = steps.front().first;
    std::size_t count = 0;
    do {
        at = std::lower_bound(steps.begin(), steps.end(), std::pair{at, -1})->second;
        ++count;
    } while (at != steps.front().first && count <= steps.size());
    return count == steps.size();
}

}  // namespace

void weld(Triangles& mesh) {
    std::vector<int> order(mesh.points.size()), to(mesh.points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto& x = mesh.points;
    const auto at = [&](int i) -> const std::array<real, 3>& { return x[static_cast<std::size_t>(i)]; };
    std::sort(order.begin(), order.end(), [&](int i, int j) { return at(i) != at(j) ? at(i) < at(j) : i < j; });
    for (std::size_t k = 0; k < order.size(); ++k)  // the first of equal ones represents all
        to[static_cast<std::size_t>(order[k])] =
            k > 0 && at(order[k]) == at(order[k - 1]) ? to[static_cast<std::size_t>(order[k - 1])] : order[k];
    std::vector<int> number(x.size(), -1);
    Triangles out;
    for (const auto& t : mesh.corners) {
        std::array<int, 3> c;
        for (std::size_t k = 0; k < 3; ++k) c[k] = to[static_cast<std::size_t>(t[k])];
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        for (int& i : c) {
            int& n = number[static_cast<std::size_t>(i)];
            if (n < 0) {
                n = static_cast<int>(out.points.size());
                out.points.push_back(x[static_cast<std::size_t>(i)]);
                if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[static_cast<std::size_t>(i)]);
            }
            i = n;
        }
        out.corners.push_back(c);
    }
    mesh = std::move(out);
}

real six_volumes(const Triangles& mesh, real* products) {
    real sum = 0, all = 0;
    for (const auto& t : mesh.corners) {
        const Vec<3>&o = mesh.points[0], a = mesh.points[static_cast<std::size_t>(t[0])] - o,
              b = mesh.points[static_cast<std::size_t>(t[1])] - o, c = mesh.points[static_cast<std::size_t>(t[2])] - o;
        sum += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
        for (int i = 0; i < 3; ++i)
            all += std::abs(a[i]) * (std::abs(b[(i + 1) % 3] * c[(i + 2) % 3]) + std::abs(b[(i + 2) % 3] * c[(i + 1) % 3]));
    }
    if (products) *products = all;
    return sum;
}

void require_closed(Triangles& mesh, const std::string& name) {
    if (mesh.corners.empty()) throw BadInput(name + ": no triangle with an area is in it");
    const auto edge_place = [&](const Edge& e) {
        return place(0.5 * (mesh.points[static_cast<std::size_t>(e.from)] + mesh.points[static_cast<std::size_t>(e.to)]));
    };
    std::unordered_map<Edge, int, EdgeHash> uses;
    uses.reserve(3 * mesh.corners.size());
    for (const auto& t : mesh.corners)
        for (std::size_t k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    std::size_t open = 0;
    Edge first{};
    for (const auto& t : mesh.corners)  // in the order of the file, so that the same edge is reported each time
        for (std::size_t k = 0; k < 3; ++k) {
            const Edge e{t[k], t[(k + 1) % 3]}, back{e.to, e.from};
            const int along = uses[e];
            const auto found = uses.find(back);
            const int against = found == uses.end() ? 0 : found->second;
            if (along + against > 2)
                throw BadInput(name + ": not manifold: " + std::to_string(along + against) + " triangles meet at the edge at " +
                               edge_place(e));
            if (along == 2) throw BadInput(name + ": two triangles at the edge at " + edge_place(e) + " face opposite ways");
            if (against == 0 && open++ == 0) first = e;
        }
    if (open > 0)
        throw BadInput(name + ": not closed: " + std::to_string(open) + (open == 1 ? " edge belongs" : " edges belong") +
                       " to one triangle only, the first at " + edge_place(first));
    std::vector<std::vector<int>> around(mesh.points.size());
    for (std::size_t t = 0; t < mesh.corners.size(); ++t)
        for (const int c : mesh.corners[t]) around[static_cast<std::size_t>(c)].push_back(static_cast<int>(t));
    for (std::size_t i = 0; i < around.size(); ++i)
        if (!is_one_ring(mesh.corners, around[i], static_cast<int>(i)))
            throw BadInput(name + ": not manifold: two surfaces meet in the one point " + place(mesh.points[i]));
    // rounding of a sum of n products is at most n eps/2 of each, and typically sqrt(n) of them: for a million triangles, 1e3 eps of all
    real products = 0;
    const real volume = six_volumes(mesh, &products);
    if (!(std::abs(volume) > 1e3 * std::numeric_limits<real>::epsilon() * products))
        throw BadInput(name + ": the surface is flat: it bounds no volume");
    if (volume < 0)
        for (auto& t : mesh.corners) std::swap(t[1], t[2]);
}

}  // namespace weir::geometry
