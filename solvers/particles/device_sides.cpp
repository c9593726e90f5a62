// What crosses the sides of the domain on a device: back into the period, or out of the state.
#include "particles/device_fluid.hpp"

namespace weir::particles {

template <int D>
void DeviceFluid<D>::cross_sides() {
    if (count() == 0) return;
    if (repeats_) run("wrap", {count(), stride_, state_params, x});
    if (open_) take_out();
}

/// The others keep their order. Waits for how many they are.
template <int D>
void DeviceFluid<D>::take_out() {
    run("find_stayers", {count(), stride_, state_params, x, cell_});
    exclusive_sums(count(), cell_, names_);
    int before = 0, last = 0;
    const auto end = static_cast<std::size_t>(count() - 1) * sizeof(int);
    device_->download(&before, names_, sizeof before, end);
    device_->download(&last, cell_, sizeof last, end);
    if (before + last == count()) return;
    run("list_stayers", {count(), cell_, names_, order});
    count_ = before + last;
    if (count_ > 0) reorder();
    max_speed();  // of what is left: steps are advised by it
}

template void DeviceFluid<2>::cross_sides();
template void DeviceFluid<3>::cross_sides();

}  // namespace weir::particles
