#include "surfaces/finish.hpp"

#include "core/parallel.hpp"
#include "parallel/ownership.hpp"
#include "surfaces/triangle.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::surfaces {

namespace {

/// Taubin 1995: 1/lambda + 1/mu = 0.1 is the pass band; smoother shapes keep their size.
constexpr real forward = 0.5, back = -1 / (1 / forward - 0.1);

/// The neighbours of each point: in a closed mesh the ends of its directed edges; for lines both ends.
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

/// Halo exchange of the points of the layers adjacent to this rank's.
void exchange_points(std::vector<Vec<3>>& points, const Piece& piece, const Partition& cut) {
    const auto [begin, end] = layers_of(cut, communicator().rank());
    if (begin == end) return;
    std::vector<Message> messages;
    const auto meet = [&](int layer, std::size_t first, std::size_t last, std::size_t from, std::size_t to) {
        if (layer < 0 || layer + 1 >= cut.planes()) return;
        messages.push_back({owner_of(cut, layer), points.data() + first, (last - first) * sizeof(Vec<3>), points.data() + from,
                            (to - from) * sizeof(Vec<3>)});
    };
    meet(begin - 1, piece.begin, piece.first_end, piece.below, piece.begin);
    meet(end, piece.last_begin, piece.end, piece.end, piece.above);
    communicator().exchange(messages);
}

}  // namespace

void smooth(SurfaceMesh& mesh, const Piece& piece, const std::vector<real>& weight, int passes, const Partition& cut) {
    if (passes == 0) return;
    const Neighbours around(mesh);
    std::vector<Vec<3>> moved = mesh.points;
    const auto step = [&](real share) {
        parallel_for(0, static_cast<int>(piece.points()), [&](int p) {
            const auto own = static_cast<std::size_t>(p), at = piece.begin + own;
            Vec<3> sum{};
            for (int i = around.start[at]; i < around.start[at + 1]; ++i)
                sum += mesh.points[static_cast<std::size_t>(around.list[static_cast<std::size_t>(i)])];
            const int count = around.start[at + 1] - around.start[at];
            moved[at] = mesh.points[at] + (share * weight[own]) * (sum / real(count) - mesh.points[at]);
        });
        mesh.points.swap(moved);
        if (!cut.empty()) exchange_points(mesh.points, piece, cut);
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

namespace {

/// A ray into the liquid from a surface point, and its next sample position.
struct Ray {
    Vec<3> from, outwards;
    std::size_t point;
    int rank;
    int step;     // from 1
    real before;  // value of the samples at the previous step
};

/// Marching of rays, step by step.
struct March {
    const Samples& samples;
    real step = 0.5 * std::min({samples.spacing[0], samples.spacing[1], samples.spacing[2]});
    int most = 2 * (samples.n[0] + samples.n[1] + samples.n[2]);  // upper bound for a line inside the box: the sum of its sides

    Vec<3> place(const Ray& ray) const { return ray.from - (ray.step * step) * ray.outwards; }
    /// Length of the ray inside liquid; -1 where it leaves the layers stored here, with its position.
    real go(Ray& ray, bool knows_all) const {
        for (; ray.step <= most; ++ray.step) {
            const Vec<3> x = place(ray);
            if (!knows_all && !knows(samples.layer_of(x))) return -1;
            const real here = samples.at(x);
            if (here <= 0) return step * (ray.before > 0 ? ray.step - 1 + ray.before / (ray.before - here) : ray.step - 1);
            ray.before = here;
        }
        return step * most;
    }

private:
    bool knows(int layer) const { return layer >= samples.layers.begin && layer < samples.layers.end; }
};

/// The result of a ray.
struct Arrived {
    std::size_t point;
    real thickness;
};

/// Rays that leave this rank's layers migrate from owner to owner; the results are sent back.
void go_on_elsewhere(const std::vector<Ray>& left, const March& march, const Partition& cut, std::vector<real>& thickness) {
    const auto ranks = static_cast<std::size_t>(cut.ranks());
    ListsOfRanks<Ray> leaving(ranks);
    const auto leave = [&](const Ray& ray) {
        leaving[static_cast<std::size_t>(owner_of(cut, march.samples.layer_of(march.place(ray))))].push_back(ray);
    };
    for (const Ray& ray : left) leave(ray);
    ListsOfRanks<Arrived> arrived(ranks);
    while (communicator().largest(std::any_of(leaving.begin(), leaving.end(), [](const auto& list) { return !list.empty(); })) > 0) {
        const ListsOfRanks<Ray> come = exchange_lists(std::exchange(leaving, ListsOfRanks<Ray>(ranks)));
        for (const auto& list : come)
            for (Ray ray : list) {
                const real length = march.go(ray, false);
                length < 0 ? leave(ray) : arrived[static_cast<std::size_t>(ray.rank)].push_back({ray.point, length});
            }
    }
    for (const auto& list : exchange_lists(std::move(arrived)))
        for (const Arrived& one : list) thickness[one.point] = one.thickness;
}

}  // namespace

void add_thickness(SurfaceMesh& mesh, const Piece& piece, const Samples& samples, const Partition& cut) {
    mesh.thickness.assign(mesh.points.size(), 0);
    const March march{samples};
    std::vector<Ray> left;
    parallel_for(0, static_cast<int>(piece.points()), [&](int p) {
        const std::size_t at = piece.begin + static_cast<std::size_t>(p);
        Ray ray{mesh.points[at], mesh.normals[at], at, communicator().rank(), 1, 0};
        mesh.thickness[at] = march.go(ray, cut.empty());
        if (mesh.thickness[at] >= 0) return;
#pragma omp critical
        left.push_back(ray);
    });
    if (!cut.empty()) go_on_elsewhere(left, march, cut, mesh.thickness);
}

}  // namespace weir::surfaces
