#include "geometry/liquid_fraction.hpp"

#include "geometry/shape.hpp"

#include <algorithm>
#include <cmath>

namespace weir::geometry {

namespace liquid_fraction {

/// Liquid and solids of a scene, sampled at cell centres.
template <int D>
class Look {
public:
    Look(const scene::Scene& scene, int most_along)
        : origin_(scene.vec<D>("grid.origin")),
          size_(scene.vec<D>("grid.size")),
          n_(scene.index<D>("grid.cells")),
          liquid_(shapes(scene, "liquid")),
          solids_(shapes(scene, "solids")) {
        for (int a = 0; a + 1 < D; ++a) looks_[a] = std::min(n_[a], most_along);
    }

    int planes() const { return n_[D - 1]; }
    /// Number of cells of a plane per sample.
    real each() const {
        real each = 1;
        for (int a = 0; a + 1 < D; ++a) each *= static_cast<real>(n_[a]) / looks_[a];
        return each;
    }
    /// f(point) for at most `most` cells along each axis of a plane, evenly spread.
    template <class F>
    void for_each_of_plane(int plane, F&& f) const {
        for (int j = 0; j < (D == 2 ? 1 : looks_[1]); ++j)
            for (int i = 0; i < looks_[0]; ++i) {
                Index<D> I{};
                I[0] = static_cast<int>(static_cast<std::int64_t>(i) * n_[0] / looks_[0]);
                if constexpr (D == 3) I[1] = static_cast<int>(static_cast<std::int64_t>(j) * n_[1] / looks_[1]);
                I[D - 1] = plane;
                Vec<D> x;
                for (int a = 0; a < D; ++a) x[a] = origin_[a] + size_[a] * (I[a] + 0.5) / n_[a];
                f(x);
            }
    }
    bool in_liquid(const Vec<D>& x) const {
        return std::any_of(liquid_.begin(), liquid_.end(), [&](const auto& shape) { return shape->contains(x); });
    }
    bool in_solids(const Vec<D>& x) const {
        return std::any_of(solids_.begin(), solids_.end(), [&](const auto& shape) { return shape->contains(x); });
    }
    /// Returns whether the liquid's boundary lies within this distance of x, along an axis and inside the domain. At walls it has no
    /// surface.
    bool near_surface(const Vec<D>& x, real beside) const {
        const bool wet = in_liquid(x);
        for (int a = 0; a < D; ++a)
            for (const real by : {-beside, beside}) {
                Vec<D> y = x;
                y[a] += by;
                if (y[a] > origin_[a] && y[a] < origin_[a] + size_[a] && in_liquid(y) != wet) return true;
            }
        return false;
    }

private:
    static std::vector<ShapePtr<D>> shapes(const scene::Scene& scene, const char* list) {
        return make_shapes<D>(scene.has(list) ? scene.root().tables(list) : std::vector<scene::Table>{});
    }
    Vec<D> origin_, size_;
    Index<D> n_, looks_ = Index<D>::constant(1);
    std::vector<ShapePtr<D>> liquid_, solids_;
};

}  // namespace liquid_fraction

template <int D>
real liquid_fraction_of_plane(const scene::Scene& scene, int plane) {
    const liquid_fraction::Look<D> look(scene, D == 2 ? 65536 : 256);
    int wet = 0, all = 0;
    look.for_each_of_plane(plane, [&](const Vec<D>& x) { wet += look.in_liquid(x) && !look.in_solids(x) ? 1 : 0, ++all; });
    return static_cast<real>(wet) / all;
}

template <int D>
std::vector<PlaneOfLiquid> liquid_in_planes(const scene::Scene& scene, real beside) {
    const liquid_fraction::Look<D> look(scene, D == 2 ? 4096 : 64);
    std::vector<PlaneOfLiquid> planes(static_cast<std::size_t>(look.planes()));
    for (int plane = 0; plane < look.planes(); ++plane) {
        PlaneOfLiquid& of_plane = planes[static_cast<std::size_t>(plane)];
        look.for_each_of_plane(plane, [&](const Vec<D>& x) {
            if (look.in_solids(x)) return;
            if (look.in_liquid(x)) of_plane.wet += look.each();
            if (look.near_surface(x, beside)) of_plane.near += look.each();
        });
    }
    return planes;
}

#define WEIR_INSTANTIATE(D)                                              \
    template real liquid_fraction_of_plane<D>(const scene::Scene&, int); \
    template std::vector<PlaneOfLiquid> liquid_in_planes<D>(const scene::Scene&, real);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::geometry
