// Enclosed air in the pressure equation. Cells of a pocket are fluid of a light fluid without momentum transport: faces between them have
// the weight ρ_l/ρ_g, faces to liquid 1/θ as at open air, with the pressure of the gas cell instead of 0. Gas that can be squeezed has
//     ∇·u = −(p' − p)/(γ p β dt),   p = (Q/V)^γ,   p' = p + β dt dp/dt
// with the pressure p of the pocket's volume: a coupling of its cells to p = 0 (poisson/zero_coupling.hpp). The scheme is stable for any
// stiffness from β = ½ on, and first order in dt.
#include "water/pressure.hpp"

#include <algorithm>
#include <cmath>

namespace weir::water {

using poisson::Cell;

namespace {
constexpr real ahead = 0.5;      // β
constexpr real light = 1000;     // ρ_l/ρ_g of enclosed gas
constexpr real restored = 0.25;  // part of a lost or gained volume that incompressible gas gets back in a step, or in the time √(h/g)
}  // namespace

template <int D>
void SurfacePressure<D>::enclose_air(std::unique_ptr<AirPockets<D>> pockets, real acceleration) {
    pockets_ = std::move(pockets);
    restoring_time_ = acceleration > 0 ? std::sqrt(frame_.h_min() / acceleration) : 0;
    for (std::size_t a = 0; a < D; ++a) gas_velocity_[a] = Grid<real, D>(A_.weight[a].extent());
    if (pockets_->law()) zero_ = Grid<real, D>(frame_.cells);
}

/// Makes the cells of pockets unknowns, and extends the lines of liquid to them.
template <int D>
void SurfacePressure<D>::add_pockets(const MacState<D>& state) {
    pockets_->find(state);
    gas_weight_ = light;
    const int n = frame_.cells[0];
    for_each_line(frame_.cells, [&](const Index<D>&, std::size_t at) {
        Segment& extent = liquid_[at / static_cast<std::size_t>(n)];
        for (int i = 0; i < n; ++i) {
            const std::size_t cell = at + static_cast<std::size_t>(i);
            if (!pockets_->pocket(cell)) continue;
            A_.cells[cell] = Cell::fluid;
            extent = extent.empty() ? Segment{i, i + 1} : Segment{std::min(extent.begin, i), std::max(extent.end, i + 1)};
        }
    });
}

/// f(face) for every face with gas of pockets on both sides.
template <int D>
template <class F>
void SurfacePressure<D>::for_each_gas_face(const MacState<D>& state, int a, F&& f) const {
    const auto is_gas = [&](std::size_t cell) { return A_.cells[cell] == Cell::fluid && state.cells[cell] == Cell::air; };
    const auto stride = static_cast<std::size_t>(A_.cells.stride(a));
    for_faces_of_liquid(
        a,
        [&](std::size_t face, std::size_t cell, int count) {
            for (const std::size_t end = face + static_cast<std::size_t>(count); face < end; ++face, ++cell)
                if (is_gas(cell) && is_gas(cell - stride)) f(face);
        },
        [&](const Index<D>& I, std::size_t face) {
            if (frame_.periodic(a) && is_gas(A_.cells.linear(frame_.near(I, a, -1))) && is_gas(A_.cells.linear(frame_.near(I, a, 0))))
                f(face);
        });
}

/// u* of the gas: the velocity that the last projection left.
template <int D>
void SurfacePressure<D>::set_gas_velocity(MacState<D>& state) const {
    if (!pockets_) return;
    for (int a = 0; a < D; ++a) {
        const Grid<real, D>& gas = gas_velocity_[static_cast<std::size_t>(a)];
        for_each_gas_face(state, a, [&](std::size_t face) { state.u[a][face] = gas[face]; });
    }
}

template <int D>
void SurfacePressure<D>::keep_gas_velocity(const MacState<D>& state) {
    if (!pockets_) return;
    for (int a = 0; a < D; ++a) {
        Grid<real, D>& gas = gas_velocity_[static_cast<std::size_t>(a)];
        gas.fill(0);
        for_faces_of_liquid(
            a, [&](std::size_t face, std::size_t, int count) { std::copy_n(state.u[a].data() + face, count, gas.data() + face); },
            [&](const Index<D>&, std::size_t face) { gas[face] = state.u[a][face]; });
    }
}

/// The coupling of squeezable gas to p = 0 for a step of dt.
template <int D>
void SurfacePressure<D>::couple_gas(real rho, real dt) {
    if (!pockets_ || !pockets_->law()) return;
    const real scale = h2_ * rho / (dt * dt * ahead * pockets_->law()->exponent * frame_.cell_volume());
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        const auto* pocket = pockets_->pocket(A_.cells.linear(I));
        zero_(I) = pocket && pocket->resolved ? scale * pocket->volume / pocket->pressure * pockets_->capacity(I) / pocket->capacity : 0;
    });
    poisson::zero_coupling(*solver_)->couple_to_zero(&zero_);
}

/// Sources of the gas: its pressure before the step, or the volume that incompressible gas has lost.
template <int D>
void SurfacePressure<D>::add_gas_sources(real rho, real dt) {
    if (!pockets_) return;
    const auto& law = pockets_->law();
    const real rate = restored / std::max(dt, restoring_time_), scale = h2_ * rho / dt * rate;
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        const auto* pocket = pockets_->pocket(A_.cells.linear(I));
        if (!pocket) return;
        if (law) {
            b_(I) += zero_(I) * (pocket->pressure - law->pressure);
            return;
        }
        const real lost = (pocket->content - pocket->volume) / frame_.cell_volume() / pocket->capacity;
        b_(I) += scale * pockets_->capacity(I) * std::clamp(lost, real(-1), real(1));
    });
}

/// Where no air is open and the gas is incompressible, the pressure is relative to that of the largest pocket.
template <int D>
void SurfacePressure<D>::set_pressure_level(MacState<D>& state) const {
    if (!pockets_ || pockets_->law() || pockets_->has_open_air() || pockets_->pockets().empty()) return;
    const real level = pockets_->mean_pressure(state.p);
    for_each_cell(frame_.cells, [&](const Index<D>& I) {
        if (A_.cells(I) == Cell::fluid) state.p(I) -= level;
    });
}

template <int D>
std::vector<Integral> SurfacePressure<D>::pocket_integrals(const MacState<D>& state) const {
    if (!pockets_) return {};
    const auto* largest = pockets_->largest();
    const real pressure = !largest ? 0 : pockets_->law() ? largest->pressure : pockets_->mean_pressure(state.p);
    std::vector<Integral> list{{"air_pockets", "", static_cast<real>(pockets_->pockets().size())},
                               {"largest_pocket_volume", D == 2 ? "m^2" : "m^3", largest ? largest->volume : 0},
                               {"largest_pocket_pressure", "Pa", pressure}};
    if (pockets_->law()) list.push_back({"elastic_energy", D == 2 ? "J/m" : "J", pockets_->elastic_energy()});
    return list;
}

template <int D>
void SurfacePressure<D>::save(Checkpoint& to) const {
    if (!pockets_) return;
    pockets_->save(to);
    for (std::size_t a = 0; a < D; ++a) to.put("water.gas_velocity." + std::to_string(a), gas_velocity_[a].values());
}

template <int D>
void SurfacePressure<D>::restore(const Checkpoint& from) {
    if (!pockets_ || !from.has("water.air_labels")) return;
    pockets_->restore(from);
    for (std::size_t a = 0; a < D; ++a) from.get("water.gas_velocity." + std::to_string(a), gas_velocity_[a].values());
}

template <int D>
std::size_t SurfacePressure<D>::pocket_bytes() const {
    if (!pockets_) return 0;
    std::size_t total = pockets_->bytes() + zero_.bytes();
    for (const auto& gas : gas_velocity_) total += gas.bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)                                                                        \
    template void SurfacePressure<D>::enclose_air(std::unique_ptr<AirPockets<D>>, real);           \
    template void SurfacePressure<D>::add_pockets(const MacState<D>&);                             \
    template void SurfacePressure<D>::set_gas_velocity(MacState<D>&) const;                        \
    template void SurfacePressure<D>::keep_gas_velocity(const MacState<D>&);                       \
    template void SurfacePressure<D>::couple_gas(real, real);                                      \
    template void SurfacePressure<D>::add_gas_sources(real, real);                                 \
    template void SurfacePressure<D>::set_pressure_level(MacState<D>&) const;                      \
    template std::vector<Integral> SurfacePressure<D>::pocket_integrals(const MacState<D>&) const; \
    template void SurfacePressure<D>::save(Checkpoint&) const;                                     \
    template void SurfacePressure<D>::restore(const Checkpoint&);                                  \
    template std::size_t SurfacePressure<D>::pocket_bytes() const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::water
