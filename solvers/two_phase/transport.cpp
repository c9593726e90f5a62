#include "two_phase/transport.hpp"

#include "mac/grid/rows.hpp"

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
Transport<D>::Transport(const MacState<D>& state, const EnteringFractions<D>& entering, const EnteringFractions<D>& returning)
    : spacing_(state.u.h),
      sides_(state.sides),
      returning_(returning),
      cell_ghosts_(state.sides, -1, entering),
      velocity_(state.u),
      liquid_flux_(flux_extent(state), 0, 1),
      momentum_flux_(liquid_flux_) {
    for (int a = 0; a < D; ++a) {
        face_ghosts_[static_cast<std::size_t>(a)] = FractionGhosts<D>(state.sides, a, entering);
        face_fraction_[static_cast<std::size_t>(a)] = Padded<D>(state.u[a].extent());
    }
}

namespace {

/// Of the parts of volumes that one fluid fills: slopes of what it carries are used inside it. A mixed cell may lose nearly all of one
/// fluid in a step, and a slope would take more than it has.
constexpr real alike = 0.99;

/// F through a row of faces with pure donors. Returns whether any donor is mixed. `f`: of the volumes above the faces.
bool find_pure_fluxes(const real* f, std::ptrdiff_t by, const real* C, int count, real* F) {
    real mixed = 0;
#pragma omp simd reduction(+ : mixed)
    for (int i = 0; i < count; ++i) {
        const real below = f[i - by], above = f[i], donor = C[i] > 0 ? below : above;
        const real part = donor >= 1 - pure ? 1 : 0;
        F[i] = C[i] == 0 ? 0 : C[i] * part;
        mixed += part == 0 && !(donor <= pure) ? 1 : 0;
    }
    return mixed > 0;
}

/// The momentum that the mass ρ_l F + ρ_g (C − F) carries through a row of faces: by the velocity that leaves the donor during the step,
/// from a limited linear reconstruction (van Leer 1977, harmonic) among similar volumes.
void find_momentum_fluxes(const Densities& rho, real nearness, const real* f, const real* q, std::ptrdiff_t by, const real* C,
                          const real* F, int count, real* momentum) {
#pragma omp simd
    for (int i = 0; i < count; ++i) {
        const real q0 = q[i - 2 * by], q1 = q[i - by], q2 = q[i], q3 = q[i + by];
        const real f0 = f[i - 2 * by], f1 = f[i - by], f2 = f[i], f3 = f[i + by];
        const bool upwards = C[i] > 0;
        const real donor = upwards ? q1 : q2, a = donor - (upwards ? q0 : q3), b = (upwards ? q2 : q1) - donor;
        const real r0 = rho.of(upwards ? f0 : f3), r1 = rho.of(f1), r2 = rho.of(f2);
        const real lower = r1 < r2 ? r1 : r2, higher = r1 < r2 ? r2 : r1;
        const real least = r0 < lower ? r0 : lower, most = r0 < higher ? higher : r0;
        const bool sloped = a * b > 0;
        const real slope = (sloped ? 2 * a * b : 0) / (sloped ? a + b : 1);
        const real leaving = donor + 0.5 * (1 - std::abs(C[i])) * slope;
        momentum[i] = (rho.liquid * F[i] + rho.gas * (C[i] - F[i])) * (least >= nearness * most ? leaving : donor);
    }
}

}  // namespace

template <int D>
Vec<D> Transport<D>::per_cell(real dt) const {
    Vec<D> ratio;
    for (int d = 0; d < D; ++d) ratio[d] = dt / spacing_[d];
    return ratio;
}

template <int D>
real Transport<D>::advect_fraction(const Motion<D>& motion, Padded<D>& padded, Grid<real, D>& f, PhaseValues<D>* carried) {
    if (carried) carried->entered = {};
    for (std::size_t phase = 0; carried && phase < 2; ++phase) carried->ghosts.fill_all(carried->padded[phase], carried->values[phase]);
    return run_sweeps({-1, motion, per_cell(motion.dt), f, padded, nullptr, {}, f, carried}, cell_ghosts_, nullptr);
}

template <int D>
void Transport<D>::advect_momentum(int a, const Motion<D>& motion, const Grid<real, D>& fractions, const Boundary<D>& carried,
                                   const Densities& rho, Grid<real, D>& to) {
    const auto at = static_cast<std::size_t>(a);
    face_ghosts_[at].fill_all(face_fraction_[at], fractions);
    fill(velocity_[a], to, carried);
    run_sweeps({a, motion, per_cell(motion.dt), fractions, face_fraction_[at], &velocity_[a], rho, to}, face_ghosts_[at], &carried);
}

template <int D>
real Transport<D>::run_sweeps(const Volumes& v, const FractionGhosts<D>& of_fraction, const Boundary<D>* of_velocity) {
    real entered = 0;
    for (int number = 0; number < D; ++number) {
        if (number > 0) {
            of_fraction.fill_outer(v.f);
            if (v.q) fill_ghosts(*v.q, *of_velocity);
            if (v.carried)
                for (auto& values : v.carried->padded) v.carried->ghosts.fill_outer(values);
        }
        const int d = v.motion.order[static_cast<std::size_t>(number)];
        find_fluxes(v, d);
        if (v.component < 0) entered += inflow(liquid_flux_, v.f.extent(), d);
        for (std::size_t phase = 0; v.carried && phase < 2; ++phase)
            v.carried->entered[phase] += inflow(v.carried->flux[phase], v.f.extent(), d);
        add_fluxes(v, number);
    }
    return entered;
}

/// Of the fluxes of a sweep over cells, through the two sides of its axis.
template <int D>
real Transport<D>::inflow(const Grid<real, D>& flux, const Extent<D>& cells, int d) const {
    real sum = 0;
    for (const int end : {0, 1}) {
        const auto kind = sides_.side(d, end).kind;
        if (kind != geometry::SideKind::outflow && kind != geometry::SideKind::inflow) continue;
        Extent<D> plane = d == D - 1 ? replicated<D>(cells) : cells;
        plane[d] = 1;
        const int at = end == 0 ? 0 : cells[d];
        const auto sum_of_side = [&] {
            return sum_over(plane, [&](Index<D> I) {
                I[d] = at;
                return flux(I);
            });
        };
        const real through = d == D - 1 ? of_rank_at(cells.own, end, sum_of_side) : sum_of_side();
        sum += end == 0 ? through : -through;
    }
    return sum;
}

template <int D>
void Transport<D>::Volumes::find_courants(int d, const Index<D>& first, int count, real* C) const {
    const real *u = motion.flow[d].at(first), ratio = per_cell[d];
    if (component < 0) {
        for (int i = 0; i < count; ++i) C[i] = ratio * u[i];
        return;
    }
    const real* below = motion.flow[d].at(first - e<D>(component));
#pragma omp simd
    for (int i = 0; i < count; ++i) C[i] = ratio * (0.5 * (below[i] + u[i]));
}

template <int D>
void Transport<D>::Volumes::add_dilation(int d, const Index<D>& first, int count, real sign, real* sum) const {
    alignas(64) real lower[row_block], upper[row_block];
    find_courants(d, first, count, lower);
    find_courants(d, first + e<D>(d), count, upper);
#pragma omp simd
    for (int i = 0; i < count; ++i) sum[i] += sign * (upper[i] - lower[i]);
}

template <int D>
void Transport<D>::Volumes::find_dilation(int number, const Index<D>& first, int count, real* dilation) const {
    std::fill_n(dilation, count, 0.0);
    const auto axis = [&](int k) { return motion.order[static_cast<std::size_t>(k)]; };
    if (number + 1 < D) return add_dilation(axis(number), first, count, 1, dilation);
    for (int k = 0; k < number; ++k) add_dilation(axis(k), first, count, -1, dilation);
}

template <int D>
void Transport<D>::Volumes::find_driven_out(const Index<D>& first, int count, real* out) const {
    std::fill_n(out, count, 0.0);
    for (int d = 0; d < D; ++d) add_dilation(d, first, count, 1, out);
}

/// What flows in through an open side along axis d is not what stands beside it within: a wave that touches an open top would draw liquid
/// from outside. The volumes of faces on the side itself are half outside; they keep their mirrored ghosts.
template <int D>
void Transport<D>::set_returning(const Volumes& v, int d, const Index<D>& first, int count, const real* C, real* F) const {
    if (v.component == d) return;
    for (const int end : {0, 1}) {
        const auto& fraction = returning_[static_cast<std::size_t>(d)][static_cast<std::size_t>(end)];
        const int side = end == 0 ? 0 : v.f.extent()[d], inwards = end == 0 ? 1 : -1;
        if (!fraction) continue;
        for (int i = 0; i < count; ++i)
            if ((d == 0 ? first[0] + i : first[d]) == side && inwards * C[i] > 0) F[i] = *fraction * C[i];
    }
}

/// Through the lower face of every volume along axis d.
template <int D>
void Transport<D>::find_fluxes(const Volumes& v, int d) {
    const Strides<D> stride = strides_of(v.f);
    const std::ptrdiff_t by = stride[static_cast<std::size_t>(d)];
    Extent<D> faces = v.f.extent() + e<D>(d);
    if (d == D - 1) faces.own = faces.own.with_upper_faces();
    for_each_row(Index<D>{}, faces, [&](const Index<D>& first, int count) {
        alignas(64) real C[row_block];
        v.find_courants(d, first, count, C);
        const real *f = v.f.at(first), *room = v.component < 0 && v.motion.room ? v.motion.room->at(first) : nullptr;
        real* F = &liquid_flux_(first);
        if (find_pure_fluxes(f, by, C, count, F))
            for (int i = 0; i < count; ++i) {
                const std::ptrdiff_t donor = i - (C[i] > 0 ? by : 0);
                const real width = std::abs(C[i]) / (room ? room[donor] : 1);
                if (is_mixed(f[donor]) && C[i] != 0) F[i] = C[i] * fraction_of_slab<D>(f + donor, stride, d, C[i] > 0 ? 1 : 0, width);
            }
        set_returning(v, d, first, count, C, F);
        if (v.q) find_momentum_fluxes(v.rho, similar, f, v.q->at(first), by, C, F, count, &momentum_flux_(first));
        for (std::size_t phase = 0; v.carried && phase < 2; ++phase)
            find_momentum_fluxes(densities_of_part[phase], alike, f, v.carried->padded[phase].at(first), by, C, F, count,
                                 &v.carried->flux[phase](first));
    });
}

/// Adds c dC except in the last sweep, which takes back that of the earlier ones. The velocity is momentum over mass.
template <int D>
void Transport<D>::add_fluxes(const Volumes& v, int number) {
    const std::ptrdiff_t up = liquid_flux_.stride(v.motion.order[static_cast<std::size_t>(number)]);
    const Densities rho = v.rho;
    const real least = 0.1 * rho.lightest();  // f may be below 0 by the divergence that the pressure left
    const bool last = number + 1 == D;
    for_each_row(Index<D>{}, v.f.extent(), [&](const Index<D>& first, int count) {
        alignas(64) real dilation[row_block], driven_out[row_block];
        v.find_dilation(number, first, count, dilation);
        const bool shrinks = last && v.motion.room;
        if (shrinks) v.find_driven_out(first, count, driven_out);
        if (!v.q && v.motion.room) return add_fluxes_in_rooms(v, number, first, count, dilation, shrinks ? driven_out : nullptr);
        const real *F = &liquid_flux_(first), *start = &v.start(first), *f = v.f.at(first);
        if (!v.q) {
            for (int phase = 0; v.carried && phase < 2; ++phase) add_phase_fluxes(v, number, phase, first, count, dilation);
            real* to = last ? &v.to(first) : v.f.at(first);
#pragma omp simd
            for (int i = 0; i < count; ++i) to[i] = f[i] + (F[i] - F[i + up] + (start[i] > 0.5 ? dilation[i] : 0));
            return;
        }
        const real *momentum = &momentum_flux_(first), *before = v.motion.u[v.component].at(first), *q = v.q->at(first);
        real *to = last ? &v.to(first) : v.q->at(first), *new_f = v.f.at(first);
        const auto add = [&](auto is_shrinking) {
#pragma omp simd
            for (int i = 0; i < count; ++i) {
                const bool mostly_liquid = start[i] > 0.5;
                const real mass = rho.of(f[i]);
                real fraction = f[i] + (F[i] - F[i + up] + (mostly_liquid ? dilation[i] : 0));
                real restored = (mostly_liquid ? rho.liquid : rho.gas) * before[i] * dilation[i];
                if constexpr (is_shrinking)  // what stays has the fraction and the velocity of the start
                    fraction += start[i] * driven_out[i], restored += rho.of(start[i]) * before[i] * driven_out[i];
                const real density = rho.of(fraction);
                new_f[i] = fraction;
                to[i] = (mass * q[i] + momentum[i] - momentum[i + up] + restored) / (density < least ? least : density);
            }
        };
        shrinks ? add(std::true_type{}) : add(std::false_type{});
    });
}

/// The liquid of a cell is V f, V its room. In the last sweep the room shrinks by what solids drive out: f of what stays is in [0, 1].
template <int D>
void Transport<D>::add_fluxes_in_rooms(const Volumes& v, int number, const Index<D>& first, int count, const real* dilation,
                                       const real* driven_out) {
    const std::ptrdiff_t up = liquid_flux_.stride(v.motion.order[static_cast<std::size_t>(number)]);
    const real *F = &liquid_flux_(first), *start = &v.start(first), *f = v.f.at(first), *room = v.motion.room->at(first);
    real* to = driven_out ? &v.to(first) : v.f.at(first);
    for (int i = 0; i < count; ++i) {
        const real gained = F[i] - F[i + up] + (start[i] > 0.5 ? dilation[i] : 0), out = driven_out ? driven_out[i] : 0;
        to[i] = room[i] > out ? (room[i] * f[i] + gained) / (room[i] - out) : start[i];
    }
}

template <int D>
std::size_t Transport<D>::bytes() const {
    std::size_t total = liquid_flux_.bytes() + momentum_flux_.bytes();
    for (int a = 0; a < D; ++a) total += face_fraction_[static_cast<std::size_t>(a)].bytes() + velocity_[a].bytes();
    return total;
}

template std::array<int, 2> sweep_order<2>(std::int64_t);
template std::array<int, 3> sweep_order<3>(std::int64_t);
template class Transport<2>;
template class Transport<3>;

}  // namespace weir::two_phase
