#include "sim/room.hpp"

#include "geometry/sides.hpp"
#include "geometry/solids.hpp"
#include "parallel/grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

namespace weir::sim {

namespace {

/// Relative tolerance: the error of sampled volumes and particle lattices.
constexpr real distinguishable = 0.02;
constexpr int moments = 64;

/// Sample points of the whole domain, and the volume fraction of each that lies inside a surface.
template <int D>
struct Samples {
    Index<D> count{};
    Vec<D> origin{}, step{};
    explicit Samples(const scene::Scene& scene) : origin(scene.vec<D>("grid.origin")) {
        const Index<D> cells = scene.index<D>("grid.cells");
        const Vec<D> size = scene.vec<D>("grid.size");
        for (int a = 0; a < D; ++a) count[a] = std::min(cells[a], D == 2 ? 128 : 40), step[a] = size[a] / count[a];
    }
    /// Integral of f over the sample points.
    template <class F>
    real volume(F&& f) const {
        real one = 1;
        for (int a = 0; a < D; ++a) one *= step[a];
        return one * sum_over(replicated(count), [&](const Index<D>& I) {
                   Vec<D> x;
                   for (int a = 0; a < D; ++a) x[a] = origin[a] + step[a] * (I[a] + 0.5);
                   return f(x);
               });
    }
    real inside(real distance) const { return std::clamp(0.5 - distance / *std::max_element(step.begin(), step.end()), 0.0, 1.0); }
};

template <int D>
bool closed(const scene::Scene& scene) {
    const geometry::Sides<D> sides(scene);
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1})
            if (const auto kind = sides.side(a, end).kind; kind == geometry::SideKind::outflow || kind == geometry::SideKind::inflow)
                return false;
    return !scene.has("sinks") || scene.root().tables("sinks").empty();
}

template <int D>
void require(const scene::Scene& scene) {
    geometry::Solids<D> solids(scene);
    std::size_t first = 0;
    while (first < solids.count() && !solids[first].motion.moves()) ++first;
    if (first == solids.count() || !closed<D>(scene)) return;
    const Samples<D> samples(scene);
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const real liquid = samples.volume([&](const Vec<D>& x) {
        real d = infinity;
        for (const auto& shape : shapes) d = std::min(d, shape->distance(x));
        return std::min(samples.inside(d), 1 - samples.inside(solids.distance(x)));
    });
    const std::string path = fmt::format("solids[{}].motion", solids.in_list(first));
    for (int k = 1; k <= moments; ++k) {
        const real t = scene.number("time.end") * k / moments;
        solids.set_time(t);
        const real room = samples.volume([&](const Vec<D>& x) { return 1 - samples.inside(solids.distance(x)); });
        if (room < (1 - distinguishable) * liquid)
            scene.refuse(
                path,
                fmt::format(
                    "at t = {:.3g} s the moving solids leave a volume of {:.4g} {}, and the closed domain contains {:.4g} of liquid", t,
                    room, D == 2 ? "m^2" : "m^3", liquid),
                "add a side of kind \"outflow\", reduce the liquid, or change the motion");
    }
}

}  // namespace

void require_room(const scene::Scene& scene) {
    constexpr std::array<std::string_view, 4> keep_volume{"mac_water", "tallcell", "pbf", "sph"};
    if (std::find(keep_volume.begin(), keep_volume.end(), scene.solver()) == keep_volume.end()) return;
    if (scene.effect("rest_density") || !scene.has("solids") || scene.root().tables("solids").empty()) return;
    if (scene.dim() == 2) return require<2>(scene);
    require<3>(scene);
}

}  // namespace weir::sim
