#include "mac/grid/diagnostics.hpp"

#include "mac/grid/projection.hpp"

namespace weir::mac {

namespace {

const char* const letters[3] = {"x", "y", "z"};

/// Fluid fraction of a face's control volume: a half on closed or open sides, zero for the second copy of a periodic face.
template <int D>
real face_share(const MacState<D>& s, int a, const Index<D>& I) {
    const real open = s.solid.any() ? s.solid.open[static_cast<std::size_t>(a)](I) : 1;
    if (I[a] > 0 && I[a] < s.u.cells[a]) return open;
    if (s.sides.periodic(a)) return I[a] == 0 ? open : 0;
    return 0.5 * open;
}

/// Σ f(u) over all faces of an axis, weighted by their volumes.
template <int D, class F>
real sum_over_faces(const MacState<D>& s, int a, F f) {
    return s.u.cell_volume() * sum_over(s.u[a].extent(), [&](const Index<D>& I) { return face_share(s, a, I) * f(s.u[a](I)); });
}

std::string unit_of(const std::string& field) { return field == "temperature" ? "K" : field == "enthalpy" ? "J/kg" : ""; }

}  // namespace

template <int D>
real kinetic_energy(const MacState<D>& s) {
    real sum = 0;
    for (int a = 0; a < D; ++a) sum += sum_over_faces(s, a, [](real u) { return u * u; });
    return 0.5 * s.rho * sum;
}

template <int D>
Vec<D> momentum(const MacState<D>& s) {
    Vec<D> m;
    for (int a = 0; a < D; ++a) m[a] = s.rho * sum_over_faces(s, a, [](real u) { return u; });
    return m;
}

template <int D>
real enstrophy(const MacState<D>& s) {
    real sum = 0;
    for (int a = 0; a < D; ++a) {
        for (int b = a + 1; b < D; ++b) {
            const auto below = [&](Index<D> I, int axis) {  // the lower neighbour along an axis, across the boundary of a periodic one
                I[axis] = I[axis] > 0 ? I[axis] - 1 : s.u.cells[axis] - 1;
                return I;
            };
            sum += sum_over(s.extent(), [&](const Index<D>& I) -> real {
                if ((I[a] == 0 && !s.sides.periodic(a)) || (I[b] == 0 && !s.sides.periodic(b))) return 0;
                const real omega = (s.u[b](I) - s.u[b](below(I, a))) / s.u.h[a] - (s.u[a](I) - s.u[a](below(I, b))) / s.u.h[b];
                return omega * omega;
            });
        }
    }
    return 0.5 * s.u.cell_volume() * sum;
}

template <int D>
real integral(const MacState<D>& s, const Grid<real, D>& q) {
    return s.u.cell_volume() * sum_over(q.extent(), [&](const Index<D>& I) { return s.cells(I) == poisson::Cell::fluid ? q(I) : 0; });
}

template <int D>
std::string times_volume(const std::string& unit) {
    return (unit.empty() ? "" : unit + ' ') + (D == 2 ? "m^2" : "m^3");
}

template <int D>
std::vector<Integral> integrals(const MacState<D>& s) {
    real speed = 0;
    for (int a = 0; a < D; ++a) speed = std::max(speed, max_over(s.u[a].extent(), [&](const Index<D>& I) { return std::abs(s.u[a](I)); }));
    std::vector<Integral> list{{"kinetic_energy", D == 2 ? "J/m" : "J", kinetic_energy(s)},
                               {"enstrophy", D == 2 ? "m^2/s^2" : "m^3/s^2", enstrophy(s)},
                               {"max_speed", "m/s", speed},
                               {"max_divergence", "1/s", max_divergence(s)}};
    const Vec<D> m = momentum(s);
    for (int a = 0; a < D; ++a) list.push_back({std::string("momentum_") + letters[a], D == 2 ? "kg/s" : "kg m/s", m[a]});
    for (const auto& field : s.fields)
        list.push_back({"total_" + field.name, times_volume<D>(unit_of(field.name)), integral(s, field.values)});
    return list;
}

template <int D>
void vorticity(const MacState<D>& s, const Extent<D>& cells, std::vector<Grid<real, D>>& omega) {
    const auto centre = [&](int a, const Index<D>& I) { return 0.5 * (s.u[a](I) + s.u[a](I + e<D>(a))); };
    const auto slope = [&](int a, int b, const Index<D>& I) {
        Index<D> lo = I, hi = I;
        lo[b] = std::max(I[b] - 1, 0);
        hi[b] = std::min(I[b] + 1, s.u.cells[b] - 1);
        return hi[b] > lo[b] ? (centre(a, hi) - centre(a, lo)) / ((hi[b] - lo[b]) * s.u.h[b]) : 0;
    };
    omega.resize(D == 2 ? 1 : 3);
    for (std::size_t c = 0; c < omega.size(); ++c) {
        if (omega[c].empty()) omega[c] = Grid<real, D>(s.extent());
        const int a = D == 2 ? 0 : (static_cast<int>(c) + 1) % 3, b = D == 2 ? 1 : (static_cast<int>(c) + 2) % 3;
        for_each_cell(cells, [&](const Index<D>& I) { omega[c](I) = slope(b, a, I) - slope(a, b, I); });
    }
}

template <int D>
GridView grid_view(const MacVelocity<D>& u) {
    GridView view;
    view.dim = D;
    for (int d = 0; d < D; ++d) {
        const auto at = static_cast<std::size_t>(d);
        view.cells[at] = u.cells[d];
        view.origin[at] = u.origin[d];
        view.spacing[at] = u.h[d];
    }
    return view;
}

template <int D>
FieldSet field_set(const MacState<D>& s) {
    FieldSet set;
    set.grid = grid_view(s.u);
    FieldView velocity{"velocity", "m/s", Where::face, "", {}};
    for (int a = 0; a < D; ++a) velocity.data.push_back(s.u[a].values());
    set.fields.push_back(std::move(velocity));
    set.fields.push_back({"pressure", "Pa", Where::cell, "", {s.p.values()}});
    for (const auto& field : s.fields) set.fields.push_back({field.name, unit_of(field.name), Where::cell, "", {field.values.values()}});
    return set;
}

#define WEIR_INSTANTIATE(D)                                                                     \
    template real kinetic_energy(const MacState<D>&);                                           \
    template Vec<D> momentum(const MacState<D>&);                                               \
    template real enstrophy(const MacState<D>&);                                                \
    template real integral(const MacState<D>&, const Grid<real, D>&);                           \
    template std::vector<Integral> integrals(const MacState<D>&);                               \
    template void vorticity(const MacState<D>&, const Extent<D>&, std::vector<Grid<real, D>>&); \
    template GridView grid_view(const MacVelocity<D>&);                                         \
    template FieldSet field_set(const MacState<D>&);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
