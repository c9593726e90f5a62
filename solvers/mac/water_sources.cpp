// What enters and leaves: emitters, open sides, the repair of the markers' distribution, and solids that move.
#include "mac/water.hpp"

namespace weir::mac {

template <int D>
void Water<D>::move_solids(real dt) {
    if (solids_.empty()) return;
    (void)dt;
}

template <int D>
void Water<D>::set_velocity_in_solids() {}

template <int D>
void Water<D>::pour_and_drain() {
    const auto timed = passes_.time("sort markers");
    volume_target_ -= markers_.volume * static_cast<real>(remove_departed(markers_, frame_, state_.sides));
    markers_.sort(frame_);
}

template <int D>
void Water<D>::redistribute_markers() {}

#define WEIR_INSTANTIATE(D)                           \
    template void Water<D>::move_solids(real);        \
    template void Water<D>::set_velocity_in_solids(); \
    template void Water<D>::pour_and_drain();         \
    template void Water<D>::redistribute_markers();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
