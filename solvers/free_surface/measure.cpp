#include "free_surface/measure.hpp"

#include "free_surface/plane_cut.hpp"

namespace weir::free_surface {

/// Sum over faces of f times the liquid volume of the face (half of both cells').
template <int D>
template <class F>
real Measure<D>::sum_over_faces(int a, F&& f) const {
    return 0.5 * frame_.cell_volume() * sum_over(frame_.cells, [&](const Index<D>& I) {
               const real part = liquid_part(I);
               return part > 0 ? part * (f(I) + f(I + e<D>(a))) : 0;
           });
}

template <int D>
real Measure<D>::kinetic_energy(const MacVelocity<D>& u, real rho) const {
    real energy = 0;
    for (int a = 0; a < D; ++a) energy += 0.5 * rho * sum_over_faces(a, [&](const Index<D>& I) { return u[a](I) * u[a](I); });
    return energy;
}

template <int D>
Vec<D> Measure<D>::momentum(const MacVelocity<D>& u, real rho) const {
    Vec<D> sum;
    for (int a = 0; a < D; ++a) sum[a] = rho * sum_over_faces(a, [&](const Index<D>& I) { return u[a](I); });
    return sum;
}

/// The centroid of the liquid in a cell relative to its centre, per cell. For liquid below a surface by the level set; for a full cell cut
/// by a solid, the centroid of the open part: above a plane with the slope of the open fractions.
template <int D>
Vec<D> Measure<D>::middle(const Index<D>& I) const {
    const real fraction = surface_.fraction(I), open = surface_.open_part(I);
    if (fraction > 0 && fraction < 1) return surface_.moment(I) / fraction;
    if (fraction == 0 || open <= 0 || open == 1) return {};
    Vec<D> slope;
    for (int d = 0; d < D; ++d) slope[d] = surface_.open_part(frame_.near(I, d, -1)) - surface_.open_part(frame_.near(I, d, 1));
    return norm(slope) > 0 ? moment_below_plane(plane_with_fraction(open, slope), slope) / open : Vec<D>{};
}

template <int D>
real Measure<D>::potential_energy(const Vec<D>& gravity, real rho) const {
    return -rho * frame_.cell_volume() * sum_over(frame_.cells, [&](const Index<D>& I) {
        const real part = liquid_part(I);
        if (part <= 0) return 0.0;
        Vec<D> from_origin = frame_.centre(I) - frame_.origin;
        const Vec<D> from_centre = middle(I);
        for (int d = 0; d < D; ++d) from_origin[d] += frame_.h[d] * from_centre[d];
        return part * dot(gravity, from_origin);
    });
}

/// Coordinate along the axis where the surface leaves liquid cell I upwards; −infinity if its upper neighbour is liquid too.
template <int D>
real Measure<D>::crossing(const Index<D>& I, int axis) const {
    const real here = surface_.phi(I);
    if (here >= 0) return -infinity;
    Index<D> J = I;
    const real end = frame_.origin[axis] + frame_.h[axis] * frame_.cells[axis];
    if (!frame_.step(J, axis, 1) || J[axis] < I[axis]) return std::min(end, frame_.centre(I)[axis] - here);
    if (!surface_.passes(I, axis, 1)) return -infinity;  // under a thin solid
    const real there = surface_.phi(J);
    return there < 0 ? -infinity : frame_.centre(I)[axis] + frame_.h[axis] * here / (here - there);
}

template <int D>
real Measure<D>::furthest(int axis) const {
    return max_over(frame_.cells, [&](const Index<D>& I) { return crossing(I, axis); });
}

template <int D>
real Measure<D>::height_at_lower_end(int up) const {
    Extent<D> column = frame_.cells;
    column[up == 0 ? 1 : 0] = 1;
    return max_over(column, [&](const Index<D>& I) { return crossing(I, up); });
}

template <int D>
std::vector<Integral> Measure<D>::integrals(const MacVelocity<D>& u, real rho, const Vec<D>& gravity, int up, real target) const {
    const std::string volume_unit = D == 2 ? "m^2" : "m^3", per_depth = D == 2 ? "/m" : "";
    const Vec<D> p = momentum(u, rho);
    std::vector<Integral> list = {
        {"volume", volume_unit, surface_.volume()},
        {"volume_target", volume_unit, target},
        {"kinetic_energy", "J" + per_depth, kinetic_energy(u, rho)},
        {"potential_energy", "J" + per_depth, potential_energy(gravity, rho)},
        {"momentum_x", "kg m/s" + per_depth, p[0]},
        {"momentum_y", "kg m/s" + per_depth, p[1]},
    };
    if constexpr (D == 3) list.push_back({"momentum_z", "kg m/s", p[2]});
    list.push_back({"front_x", "m", furthest(0)});
    list.push_back({"top", "m", furthest(up)});
    list.push_back({"height_at_x_min", "m", height_at_lower_end(up)});
    return list;
}

template class Measure<2>;
template class Measure<3>;

}  // namespace weir::free_surface
