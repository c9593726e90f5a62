#include "reconstruction/finish.hpp"

#include "core/parallel.hpp"
#include "reconstruction/triangle.hpp"

#include <algorithm>
#include <cmath>

namespace weir::reconstruction {

namespace {

/// Taubin 1995: 1/lambda + 1/mu = 0.1 is the pass band; shapes smoother than that keep their size.
constexpr real forward = 0.5, back = -1 / (1 / forward - 0.1);

/// Points around each point: in a closed mesh the end of each directed side; of lines both ends.
struct Neighbours {
    std::vector<int> start, list;
    explicit Neighbours(const SurfaceMesh& mesh) : start(mesh.points.size() + 1, 0), list(3 * mesh.corners.size() + 2 * mesh.lines.size()) {
        for (const auto& t : mesh.corners)
            for (const int c : t) ++start[static_cast<std::size_t>(c) + 1];
        for (const auto& line : mesh.lines)
            for (const int c : line) ++start[static_cast<std::size_t>(c) + 1];
        for (std::size_t i = 0; i + 1 < start.size(); ++i) start[i + 1] += start[i];
        std::vector<int> next(start.begin(), start.end() - 1);
        for (const auto& t : mesh.corners)
            for (std::size_t c = 0; c < 3; ++c) list[static_cast<std::size_t>(next[static_cast<std::size_t>(t[c])]++)] = t[(c + 1) % 3];
        for (const auto& line : mesh.lines)
            for (std::size_t c = 0; c < 2; ++c) list[static_cast<std::size_t>(next[static_cast<std::size_t>(line[c])]++)] = line[1 - c];
    }
};

}  // namespace

void smooth(SurfaceMesh& mesh, const std::vector<real>& weight, int passes) {
    if (passes == 0 || mesh.points.empty()) return;
    const Neighbours around(mesh);
    std::vector<Vec<3>> moved(mesh.points.size());
    const auto step = [&](real share) {
        parallel_for(0, static_cast<int>(mesh.points.size()), [&](int p) {
            const auto at = static_cast<std::size_t>(p);
            Vec<3> sum{};
            for (int i = around.start[at]; i < around.start[at + 1]; ++i)
                sum += mesh.points[static_cast<std::size_t>(around.list[static_cast<std::size_t>(i)])];
            const int count = around.start[at + 1] - around.start[at];
            moved[at] = mesh.points[at] + (share * weight[at]) * (sum / real(count) - mesh.points[at]);
        });
        mesh.points.swap(moved);
    };
    for (int pass = 0; pass < passes; ++pass) step(forward), step(back);
}

void add_normals(SurfaceMesh& mesh) {
    mesh.normals.assign(mesh.points.size(), Vec<3>{});
    for (const auto& t : mesh.corners) {
        const Vec<3> n = area_vector(mesh, t);
        for (const int c : t) mesh.normals[static_cast<std::size_t>(c)] += n;
    }
    for (const auto& line : mesh.lines) {
        const Vec<3> along = end(mesh, line, 1) - end(mesh, line, 0);
        for (const int c : line) mesh.normals[static_cast<std::size_t>(c)] += Vec<3>{{along[1], -along[0], 0}};
    }
    parallel_for(0, static_cast<int>(mesh.points.size()), [&](int p) {
        Vec<3>& n = mesh.normals[static_cast<std::size_t>(p)];
        const real length = norm(n);
        n = length > 0 ? n / length : Vec<3>{{0, 1, 0}};
    });
}

void add_thickness(SurfaceMesh& mesh, const Samples& samples) {
    mesh.thickness.resize(mesh.points.size());
    const real step = 0.5 * std::min({samples.spacing[0], samples.spacing[1], samples.spacing[2]});
    const int most = 2 * (samples.n[0] + samples.n[1] + samples.n[2]);  // a line inside a box is no longer than its sides together
    parallel_for(0, static_cast<int>(mesh.points.size()), [&](int p) {
        const auto at = static_cast<std::size_t>(p);
        real before = 0;
        int i = 1;
        for (; i <= most; ++i) {
            const real here = samples.at(mesh.points[at] - (i * step) * mesh.normals[at]);
            if (here <= 0) {
                mesh.thickness[at] = step * (before > 0 ? i - 1 + before / (before - here) : i - 1);
                return;
            }
            before = here;
        }
        mesh.thickness[at] = step * most;
    });
}

}  // namespace weir::reconstruction
