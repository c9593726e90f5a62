// Communication of a scene with liquid and gas distributed over several ranks. Each rank owns the planes of its slab and computes them as
// one process would: ghost planes are filled before every sweep, before heights, and after every pass whose values neighbours read.
#include "two_phase/solver.hpp"

namespace weir::two_phase {

/// Ghost planes of the faces' response to pressure; where the pressure solve is replicated, all planes of the matrix.
template <int D>
void TwoPhase<D>::exchange_densities() {
    if (!own().distributed()) return;
    if (own().distributed_storage()) {
        std::vector<Planes> all;
        for (auto& mobility : state_.mobility) all.push_back(planes_of(mobility));
        communicator().refresh(own().partition(), all, planes_beside, around_.repeats());
    } else {
        for (auto& mobility : state_.mobility) gather(mobility);
        gather(state_.fields[0].values);
    }
}

/// Ghost planes of all fields, or the planes of all ranks where whole fields are read.
template <int D>
void TwoPhase<D>::synchronize() {
    if (whole_) return;
    const auto timed = passes_.time("exchange");
    update_distance();
    std::vector<Grid<real, D>*> shown{&state_.p, &state_.fields[0].values, &distance_};
    for (int a = 0; a < D; ++a) shown.push_back(&state_.u[a]);
    if (own().distributed_storage()) {
        std::vector<Planes> all;
        for (auto* grid : shown) all.push_back(planes_of(*grid));
        communicator().refresh(own().partition(), all, planes_beside, around_.repeats());
    } else {
        for (auto* grid : shown) gather(*grid);
    }
    whole_ = true;
}

template void TwoPhase<2>::exchange_densities();
template void TwoPhase<3>::exchange_densities();
template void TwoPhase<2>::synchronize();
template void TwoPhase<3>::synchronize();

}  // namespace weir::two_phase
