// Pieces of ice on a device. Their sums are computed on the host, in the order of the state. Positions and velocities are transferred once
// or twice per step; in PBF sorted positions in each iteration. This costs little on a device that shares the host's memory; over a bus it
// is 16 bytes per particle, direction and iteration.
#include "particles/opencl/device_fluid.hpp"

namespace weir::particles {

template <int D>
void DeviceFluid<D>::fetch(const Memory& from, std::array<std::vector<real>, D>& to) const {
    for (std::size_t axis = 0; axis < D; ++axis) {
        to[axis].resize(static_cast<std::size_t>(count_));
        device_->download(to[axis].data(), from, to[axis].size() * sizeof(real), axis * static_cast<std::size_t>(stride_) * sizeof(real));
    }
}

template <int D>
void DeviceFluid<D>::send(const std::array<std::vector<real>, D>& from, const Memory& to) {
    for (std::size_t axis = 0; axis < D; ++axis)
        device_->upload(to, from[axis].data(), from[axis].size() * sizeof(real), axis * static_cast<std::size_t>(stride_) * sizeof(real));
}

template <int D>
void DeviceFluid<D>::find_ice() {
    host_.resize(count_);
    fetch(x, host_.x), fetch(v, host_.v);
    device_->download(host_.enthalpy.data(), enthalpy, host_.enthalpy.size() * sizeof(real));
    host_is_old_ = true;
    effects_.heat->count_frozen(host_);
    ice_->find(host_);
    send(host_.v, v);
}

template <int D>
void DeviceFluid<D>::predict_ice(real dt) {
    find_ice();
    ice_->advance_free(dt);
    fetch(x_star, ice_places_);
    for (int i = 0; i < count_; ++i)
        if (ice_->fixed(i)) Fluid<D>::put(ice_places_, i, host_.position(i));
    ice_->each_place([&](int i, const Vec<D>& place) { Fluid<D>::put(ice_places_, i, place); });
    send(ice_places_, x_star);
}

template <int D>
void DeviceFluid<D>::place_ice() {
    ice_sorted_.resize(static_cast<std::size_t>(count_)), ice_four_.resize(4 * static_cast<std::size_t>(count_));
    std::vector<int>& owners = ice_order_;
    owners.resize(static_cast<std::size_t>(count_));
    device_->download(owners.data(), order, owners.size() * sizeof(int));
    for (std::size_t k = 0; k < owners.size(); ++k) ice_sorted_[static_cast<std::size_t>(owners[k])] = static_cast<int>(k);
    device_->download(ice_four_.data(), a, ice_four_.size() * sizeof(float));
    const auto at = [&](int i) { return ice_four_.data() + 4 * ice_sorted_[static_cast<std::size_t>(i)]; };
    const Vec<D> centre = host_.domain.centre();
    const auto local = [&](const Vec<D>& place, int axis) { return static_cast<float>(place[axis] - centre[axis]); };
    ice_->follow([&](int i, const Vec<D>& from) {
        Vec<D> by;
        for (int axis = 0; axis < D; ++axis) by[axis] = static_cast<real>(at(i)[axis]) - static_cast<real>(local(from, axis));
        return by;
    });
    const auto put = [&](int i, const Vec<D>& to) {
        for (int axis = 0; axis < D; ++axis) at(i)[axis] = local(to, axis);
    };
    ice_->each_place(put);
    for (int i = 0; i < count_; ++i)
        if (ice_->fixed(i)) put(i, host_.position(i));
    device_->upload(a, ice_four_.data(), ice_four_.size() * sizeof(float));
}

template <int D>
void DeviceFluid<D>::finish_ice_motion(real dt) {
    if (!ice_moves()) return;
    fetch(x, host_.x), fetch(v, host_.v);
    ice_->finish_motion(host_, dt);
    send(host_.x, x), send(host_.v, v);
}

template <int D>
void DeviceFluid<D>::carry_ice(real dt) {
    if (!ice_moves()) return;
    ice_->advance_free(dt);
    finish_ice_motion(dt);
}

template <int D>
void DeviceFluid<D>::stop_frozen_again() {
    if (!ice_) return stop_frozen();
    if (!ice_moves()) return;
    fetch(x, host_.x), fetch(v, host_.v);
    ice_->move_as_one(host_);
    send(host_.v, v);
}

#define WEIR_INSTANTIATE(D)                                                                      \
    template void DeviceFluid<D>::fetch(const Memory&, std::array<std::vector<real>, D>&) const; \
    template void DeviceFluid<D>::send(const std::array<std::vector<real>, D>&, const Memory&);  \
    template void DeviceFluid<D>::find_ice();                                                    \
    template void DeviceFluid<D>::predict_ice(real);                                             \
    template void DeviceFluid<D>::place_ice();                                                   \
    template void DeviceFluid<D>::finish_ice_motion(real);                                       \
    template void DeviceFluid<D>::carry_ice(real);                                               \
    template void DeviceFluid<D>::stop_frozen_again();
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::particles
