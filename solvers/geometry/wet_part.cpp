#include "geometry/wet_part.hpp"

#include "geometry/shape.hpp"

#include <algorithm>
#include <cmath>

namespace weir::geometry {

template <int D>
real wet_part_of_plane(const scene::Scene& scene, int plane) {
    constexpr int most_along = D == 2 ? 65536 : 256;  // cells looked at along an axis
    const auto shapes = [&](const char* list) {
        return make_shapes<D>(scene.has(list) ? scene.root().tables(list) : std::vector<scene::Table>{});
    };
    const auto liquid = shapes("liquid"), solids = shapes("solids");
    const Vec<D> origin = scene.vec<D>("grid.origin"), size = scene.vec<D>("grid.size");
    const Index<D> n = scene.index<D>("grid.cells");
    const auto inside = [](const auto& list, const Vec<D>& x) {
        return std::any_of(list.begin(), list.end(), [&](const auto& shape) { return shape->contains(x); });
    };
    Index<D> looks = Index<D>::constant(1);
    for (int a = 0; a + 1 < D; ++a) looks[a] = std::min(n[a], most_along);
    int wet = 0, all = 0;
    for (int j = 0; j < (D == 2 ? 1 : looks[1]); ++j)
        for (int i = 0; i < looks[0]; ++i, ++all) {
            Index<D> I{};
            I[0] = static_cast<int>(static_cast<std::int64_t>(i) * n[0] / looks[0]);
            if constexpr (D == 3) I[1] = static_cast<int>(static_cast<std::int64_t>(j) * n[1] / looks[1]);
            I[D - 1] = plane;
            Vec<D> x;
            for (int a = 0; a < D; ++a) x[a] = origin[a] + size[a] * (I[a] + 0.5) / n[a];
            wet += inside(liquid, x) && !inside(solids, x) ? 1 : 0;
        }
    return static_cast<real>(wet) / all;
}

template real wet_part_of_plane<2>(const scene::Scene&, int);
template real wet_part_of_plane<3>(const scene::Scene&, int);

}  // namespace weir::geometry
