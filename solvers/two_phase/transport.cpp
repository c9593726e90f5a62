#include "two_phase/transport.hpp"

#include <algorithm>
#include <cmath>

namespace weir::two_phase {

template <int D>
std::array<int, D> sweep_order(std::int64_t step) {
    std::array<int, D> order{};
    const int first = static_cast<int>(step % D), by = step / D % 2 == 0 ? 1 : D - 1;
    for (int k = 0; k < D; ++k) order[static_cast<std::size_t>(k)] = (first + k * by) % D;
    return order;
}

template <int D>
Transport<D>::Transport(const MacState<D>& state, const EnteringFractions<D>& entering)
    : spacing_(state.u.h),
      sides_(state.sides),
      cell_ghosts_(state.sides, -1, entering),
      cell_fraction_(state.extent()),
      velocity_(state.u),
      liquid_flux_(state.u.cells + Index<D>::constant(2), 0, 1),
      momentum_flux_(liquid_flux_) {
    for (int a = 0; a < D; ++a) {
        face_ghosts_[static_cast<std::size_t>(a)] = FractionGhosts<D>(state.sides, a, entering);
        face_fraction_[static_cast<std::size_t>(a)] = Padded<D>(state.u[a].extent());
    }
}

namespace {

template <int D>
void copy(const Padded<D>& from, Grid<real, D>& to) {
    for_each_cell(to.extent(), [&](const Index<D>& I) { to(I) = from(I); });
}

/// Beyond this ratio between the densities of neighbouring volumes, slopes across them are not used: a gas volume beside a liquid one would
/// receive a value extrapolated from the other phase.
constexpr real similar = 0.1;

bool are_similar(real a, real b, real c) { return std::min({a, b, c}) >= similar * std::max({a, b, c}); }

/// The velocity that leaves a donor volume during a step: limited linear reconstruction (van Leer 1977, harmonic).
real leaving(real behind, real donor, real ahead, real courant) {
    const real a = donor - behind, b = ahead - donor;
    const real slope = a * b > 0 ? 2 * a * b / (a + b) : 0;
    return donor + 0.5 * (1 - courant) * slope;
}

}  // namespace

template <int D>
Vec<D> Transport<D>::per_cell(real dt) const {
    Vec<D> ratio;
    for (int d = 0; d < D; ++d) ratio[d] = dt / spacing_[d];
    return ratio;
}

template <int D>
real Transport<D>::advect_fraction(const Motion<D>& motion, Grid<real, D>& f) {
    cell_ghosts_.fill_all(cell_fraction_, f);
    const real entered = run_sweeps({-1, motion, per_cell(motion.dt), f, cell_fraction_, nullptr, {}}, cell_ghosts_, nullptr);
    copy(cell_fraction_, f);
    return entered;
}

template <int D>
void Transport<D>::advect_momentum(int a, const Motion<D>& motion, const Grid<real, D>& fractions, const Boundary<D>& carried,
                                   const Densities& rho, Grid<real, D>& to) {
    const auto at = static_cast<std::size_t>(a);
    face_ghosts_[at].fill_all(face_fraction_[at], fractions);
    fill(velocity_[a], to, carried);
    run_sweeps({a, motion, per_cell(motion.dt), fractions, face_fraction_[at], &velocity_[a], rho}, face_ghosts_[at], &carried);
    copy(velocity_[a], to);
}

template <int D>
real Transport<D>::run_sweeps(const Volumes& v, const FractionGhosts<D>& of_fraction, const Boundary<D>* of_velocity) {
    real entered = 0;
    for (int number = 0; number < D; ++number) {
        if (number > 0) {
            of_fraction.fill_outer(v.f);
            if (v.q) fill_ghosts(*v.q, *of_velocity);
        }
        const int d = v.motion.order[static_cast<std::size_t>(number)];
        find_fluxes(v, d);
        if (v.component < 0) entered += inflow(d);
        add_fluxes(v, number);
    }
    return entered;
}

/// Of the fluxes of a sweep over cells, through the two sides of its axis.
template <int D>
real Transport<D>::inflow(int d) const {
    real sum = 0;
    for (const int end : {0, 1}) {
        const auto kind = sides_.side(d, end).kind;
        if (kind != geometry::SideKind::outflow && kind != geometry::SideKind::inflow) continue;
        const Extent<D>& cells = cell_fraction_.extent();
        Extent<D> plane = d == D - 1 ? replicated<D>(cells) : cells;
        plane[d] = 1;
        const int at = end == 0 ? 0 : cells[d];
        const auto sum_of_side = [&] {
            return sum_over(plane, [&](Index<D> I) {
                I[d] = at;
                return liquid_flux_(I);
            });
        };
        const real through = d == D - 1 ? of_rank_at(cells.own, end, sum_of_side) : sum_of_side();
        sum += end == 0 ? through : -through;
    }
    return sum;
}

/// Through the lower face of every volume along axis d: F, and the momentum that the mass ρ_l F + ρ_g (C − F) carries.
template <int D>
void Transport<D>::find_fluxes(const Volumes& v, int d) {
    const Strides<D> stride = strides_of(v.f);
    const std::ptrdiff_t by = stride[static_cast<std::size_t>(d)];
    Extent<D> faces = v.f.extent() + e<D>(d);
    if (d == D - 1) faces.own = faces.own.with_upper_faces();
    for_each_cell(faces, [&](const Index<D>& I) {
        const real C = v.courant(d, I), width = std::abs(C);
        const std::ptrdiff_t out = C > 0 ? by : -by;
        const real* f = v.f.at(I) - (C > 0 ? by : 0);  // of the donor
        const real F = width == 0 ? 0 : C * fraction_of_slab<D>(f, stride, d, C > 0 ? 1 : 0, width);
        liquid_flux_(I) = F;
        if (!v.q) return;
        const real* q = v.q->at(I) - (C > 0 ? by : 0);
        const bool smooth = are_similar(v.rho.of(f[-out]), v.rho.of(*f), v.rho.of(f[out]));
        momentum_flux_(I) = (v.rho.liquid * F + v.rho.gas * (C - F)) * (smooth ? leaving(q[-out], *q, q[out], width) : *q);
    });
}

/// Adds c dC except in the last sweep, which takes back that of the earlier ones. The velocity is momentum over mass.
template <int D>
void Transport<D>::add_fluxes(const Volumes& v, int number) {
    const int d = v.motion.order[static_cast<std::size_t>(number)];
    const real least = 0.1 * v.rho.lightest();  // f may be below 0 by the divergence that the pressure left
    for_each_cell(v.f.extent(), [&](const Index<D>& I) {
        const Index<D> upper = I + e<D>(d);
        real dilation = 0;
        if (number + 1 < D)
            dilation = v.dilation(d, I);
        else
            for (int k = 0; k < number; ++k) dilation -= v.dilation(v.motion.order[static_cast<std::size_t>(k)], I);
        const bool mostly_liquid = v.start(I) > 0.5;
        real& f = v.f(I);
        const real mass = v.rho.of(f);
        f += liquid_flux_(I) - liquid_flux_(upper) + (mostly_liquid ? dilation : 0);
        if (!v.q) return;
        const real restored = (mostly_liquid ? v.rho.liquid : v.rho.gas) * v.motion.u[v.component](I) * dilation;
        real& q = (*v.q)(I);
        q = (mass * q + momentum_flux_(I) - momentum_flux_(upper) + restored) / std::max(v.rho.of(f), least);
    });
}

template <int D>
std::size_t Transport<D>::bytes() const {
    std::size_t total = cell_fraction_.bytes() + liquid_flux_.bytes() + momentum_flux_.bytes();
    for (int a = 0; a < D; ++a) total += face_fraction_[static_cast<std::size_t>(a)].bytes() + velocity_[a].bytes();
    return total;
}

template std::array<int, 2> sweep_order<2>(std::int64_t);
template std::array<int, 3> sweep_order<3>(std::int64_t);
template class Transport<2>;
template class Transport<3>;

}  // namespace weir::two_phase
