// What each fluid carries for itself in the geometric fluxes of the cells, as tracers of a phase (López-Herrera, Gañán-Calvo, Popinet &
// Herrada 2015): c q += G(lower) q_donor − G(upper) q_donor + [c is the larger part] q dC, with c = f, G = F of the liquid and c = 1 − f,
// G = C − F of the gas.
#include "two_phase/transport.hpp"

#include <cmath>

namespace weir::two_phase {

/// As for momentum, with the part of the cells that a fluid fills for its density. Where it fills nothing, the value is without meaning.
template <int D>
void Transport<D>::add_phase_fluxes(const Volumes& v, int number, int phase, const Index<D>& first, int count, const real* dilation) const {
    const auto at = static_cast<std::size_t>(phase);
    PhaseValues<D>& carried = *v.carried;
    const std::ptrdiff_t up = liquid_flux_.stride(v.motion.order[static_cast<std::size_t>(number)]);
    const Densities part = densities_of_part[at];
    const real *F = &liquid_flux_(first), *flux = &carried.flux[at](first), *start = &v.start(first), *f = v.f.at(first),
               *q = carried.padded[at].at(first), *before = &carried.values[at](first);
    real* to = number + 1 == D ? &carried.values[at](first) : carried.padded[at].at(first);
#pragma omp simd
    for (int i = 0; i < count; ++i) {
        const bool mostly_liquid = start[i] > 0.5;
        const real fraction = f[i] + (F[i] - F[i + up] + (mostly_liquid ? dilation[i] : 0)), fills = part.of(fraction);
        const real restored = (mostly_liquid ? part.liquid : part.gas) * before[i] * dilation[i];
        to[i] = (part.of(f[i]) * q[i] + flux[i] - flux[i + up] + restored) / (std::abs(fills) < pure ? pure : fills);
    }
}

template <int D>
std::size_t PhaseValues<D>::bytes() const {
    std::size_t total = 0;
    for (std::size_t phase = 0; phase < 2; ++phase) total += values[phase].bytes() + padded[phase].bytes() + flux[phase].bytes();
    return total;
}

#define WEIR_INSTANTIATE(D)         \
    template struct PhaseValues<D>; \
    template void Transport<D>::add_phase_fluxes(const Volumes&, int, int, const Index<D>&, int, const real*) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::two_phase
