#include "surfaces/contour_flat.hpp"

#include <algorithm>
#include <cstddef>

namespace weir::surfaces {

namespace {

/// The points on the edges between two samples, created on first use.
class Crossings {
public:
    Crossings(const Samples& samples, PlaneRange rows, SurfaceMesh& mesh)
        : samples_(samples), rows_(rows), mesh_(mesh), along_{points(), points()} {}

    /// The point on the edge from sample (i, j) to the next along axis a.
    int point(int i, int j, std::size_t a) {
        int& number = along_[a][samples_.linear(i, j - rows_.begin, 0)];
        if (number >= 0) return number;
        number = static_cast<int>(mesh_.points.size());
        const real here = real(samples_(i, j, 0)), next = real(samples_(i + (a == 0), j + (a == 1), 0));
        Vec<3> x = samples_.position(i, j, 0);
        x[static_cast<int>(a)] += samples_.spacing[a] * here / (here - next);
        mesh_.points.push_back(x);
        return number;
    }

private:
    std::vector<int> points() const { return std::vector<int>(samples_.linear(0, rows_.end - rows_.begin, 0), -1); }

    const Samples& samples_;
    PlaneRange rows_;
    SurfaceMesh& mesh_;
    std::array<std::vector<int>, 2> along_;
};

}  // namespace

Piece contour_flat(const Samples& samples, SurfaceMesh& mesh) {
    mesh.points.clear(), mesh.lines.clear();
    const PlaneRange layers = samples.layers;
    if (layers.begin >= layers.end) return {};
    const PlaneRange rows{std::max(0, layers.begin - 2), std::min(samples.n[1], layers.end + 2)};
    Crossings crossings(samples, rows, mesh);
    const auto cell = [&](int i, int j) {
        // corners and edges counterclockwise from the lower left
        const std::array<float, 4> f{samples(i, j, 0), samples(i + 1, j, 0), samples(i + 1, j + 1, 0), samples(i, j + 1, 0)};
        const auto side = [&](std::size_t s) {
            return s == 0   ? crossings.point(i, j, 0)
                   : s == 1 ? crossings.point(i + 1, j, 1)
                   : s == 2 ? crossings.point(i, j + 1, 0)
                            : crossings.point(i, j, 1);
        };
        const auto leaves = [&](std::size_t s) { return f[s] > 0 && f[(s + 1) % 4] <= 0; };
        const auto enters = [&](std::size_t s) { return f[s] <= 0 && f[(s + 1) % 4] > 0; };
        // two opposite corners of liquid are connected where the mean of the corners is liquid; otherwise they are cut off separately
        const bool joined = f[0] + f[1] + f[2] + f[3] > 0;
        for (std::size_t s = 0; s < 4; ++s) {
            if (!leaves(s)) continue;
            std::size_t to = s;
            do to = (to + (joined ? 1 : 3)) % 4;
            while (!enters(to));
            mesh.lines.push_back({side(s), side(to)});
        }
    };
    std::vector<std::size_t> points, lines;  // number before each row of cells
    for (int j = rows.begin; j + 1 < rows.end; ++j) {
        points.push_back(mesh.points.size()), lines.push_back(mesh.lines.size());
        for (int i = 0; i + 1 < samples.n[0]; ++i) cell(i, j);
    }
    points.push_back(mesh.points.size()), lines.push_back(mesh.lines.size());
    const auto before = [&](const std::vector<std::size_t>& list, int row) {
        return list[static_cast<std::size_t>(std::clamp(row, rows.begin, rows.end - 1) - rows.begin)];
    };
    return piece_of(
        layers, [&](int row) { return before(points, row); }, before(lines, layers.begin), before(lines, layers.end));
}

}  // namespace weir::surfaces
