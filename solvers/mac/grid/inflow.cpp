#include "mac/grid/inflow.hpp"

#include <cmath>
#include <stdexcept>

namespace weir::mac {

using geometry::SideKind;

const std::vector<std::string>& inflow_profiles() {
    static const std::vector<std::string> names{"uniform", "parabolic", "kovasznay"};
    return names;
}

template <int D>
Vec<D> kovasznay(const Vec<D>& x, real nu) {
    const real re = 1 / nu, lambda = re / 2 - std::sqrt(re * re / 4 + 4 * pi * pi);
    Vec<D> u{};
    u[0] = 1 - std::exp(lambda * x[0]) * std::cos(2 * pi * x[1]);
    u[1] = lambda / (2 * pi) * std::exp(lambda * x[0]) * std::sin(2 * pi * x[1]);
    return u;
}

template <int D>
Vec<D> inflow_velocity(const geometry::Sides<D>& sides, int axis, int end, const MacVelocity<D>& grid, const Vec<D>& x, real nu) {
    const auto& side = sides.side(axis, end);
    if (side.profile == "uniform") return side.velocity;
    if (side.profile == "kovasznay") return kovasznay(x, nu);
    if (side.profile != "parabolic") throw std::logic_error("inflow profile \"" + side.profile + "\" is in the schema but has no meaning");
    real shape = 1;
    for (int b = 0; b < D; ++b) {
        if (b == axis || sides.periodic(b)) continue;
        const real s = (x[b] - grid.origin[b]) / (grid.h[b] * grid.cells[b]);
        shape *= 6 * s * (1 - s);
    }
    return shape * side.velocity;
}

template <int D>
void set_side_faces(MacVelocity<D>& u, const geometry::Sides<D>& sides, real nu) {
    for (int a = 0; a < D; ++a) {
        for (int end = 0; end < 2; ++end) {
            const auto& side = sides.side(a, end);
            if (side.kind == SideKind::periodic || side.kind == SideKind::outflow) continue;
            Index<D> lo{};
            Extent<D> hi = u[a].extent();
            (end == 0 ? hi[a] : lo[a]) = end == 0 ? 1 : u.cells[a];
            for_each_in(lo, hi, [&](const Index<D>& I) {
                u[a](I) = side.kind == SideKind::inflow ? inflow_velocity(sides, a, end, u, u.face_centre(a, I), nu)[a] : 0;
            });
        }
    }
}

template Vec<2> kovasznay(const Vec<2>&, real);
template Vec<3> kovasznay(const Vec<3>&, real);
template Vec<2> inflow_velocity(const geometry::Sides<2>&, int, int, const MacVelocity<2>&, const Vec<2>&, real);
template Vec<3> inflow_velocity(const geometry::Sides<3>&, int, int, const MacVelocity<3>&, const Vec<3>&, real);
template void set_side_faces(MacVelocity<2>&, const geometry::Sides<2>&, real);
template void set_side_faces(MacVelocity<3>&, const geometry::Sides<3>&, real);

}  // namespace weir::mac
