// Solids on a device: their shapes as program text, their poses as numbers, and the passes that use them.
#include "particles/opencl/device_fluid.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace weir::particles {

namespace {

#include "particles/kernels/state_params.h"

template <int D>
SolidPose pose_of(const geometry::Solids<D>& solids, std::size_t k) {
    const auto& pose = solids.pose(k);
    SolidPose p{};
    for (std::size_t a = 0; a < D; ++a) {
        p.centre[a] = pose.centre[a];
        p.offset[a] = pose.offset[a];
        p.velocity[a] = pose.velocity[a];
        for (std::size_t b = 0; b < D; ++b) p.rotation[3 * a + b] = pose.rotation[a][b];
    }
    std::copy(pose.spin.begin(), pose.spin.end(), p.spin);
    p.no_slip = solids[k].no_slip ? 1 : 0;
    return p;
}

}  // namespace

template <int D>
std::string text_of(const geometry::Solids<D>& solids) {
    std::string cases;
    for (std::size_t k = 0; k < solids.count(); ++k) {
        const std::string distance = solids[k].shape->code();
        cases += k + 1 < solids.count() ? "    if (k == " + std::to_string(k) + ") return " + distance + ";\n"
                                        : "    return " + distance + ";\n";
    }
    return "#define WEIR_SOLIDS " + std::to_string(solids.count()) + "\nWEIR_FN double solid_at_rest(int k, double4 x) {\n" + cases + "}\n";
}

template <int D>
void DeviceFluid<D>::take_series(const plain::WallParams& walls) {
    SolidSeries series{};
    series.inv_h = walls.inv_h;
    std::copy(std::begin(walls.fraction), std::end(walls.fraction), series.fraction);
    std::copy(std::begin(walls.slope), std::end(walls.slope), series.slope);
    solid_series_ = constant(series);
}

template <int D>
void DeviceFluid<D>::place_solids() {
    const auto& solids = host_.domain.solids;
    constexpr std::size_t each = sizeof(SolidPose) / sizeof(double);
    static_assert(each * sizeof(double) == sizeof(SolidPose));
    host_poses_.resize(each * solids.count());
    for (std::size_t k = 0; k < solids.count(); ++k) {
        const SolidPose pose = pose_of(solids, k);
        std::memcpy(host_poses_.data() + each * k, &pose, sizeof pose);
    }
    if (!poses.handle) poses = device_->alloc(host_poses_.size() * sizeof(double));
    device_->upload(poses, host_poses_.data(), host_poses_.size() * sizeof(double));
}

template <int D>
void DeviceFluid<D>::pass_time(real dt) {
    host_.time += dt;
    auto& solids = host_.domain.solids;
    if (solids.empty() || !solids.moving()) return;
    solids.set_time(host_.time);
    place_solids();
}

template <int D>
void DeviceFluid<D>::meet_solids() {
    if (solid_) run("meet_solids", {count(), state_params, solid_series_, poses, a, near_solid, terms});
}

template <int D>
void DeviceFluid<D>::leave_solids() {
    if (solid_) run("leave_solids", {count(), state_params, solid_series_, poses, corrections, a, near_solid, terms});
    keep_frozen_positions();
}

template <int D>
void DeviceFluid<D>::renew_terms() {
    run("renew_terms", {count(), state_params, solid_series_, poses, a, near_solid, terms});
}

template std::string text_of(const geometry::Solids<2>&);
template std::string text_of(const geometry::Solids<3>&);
template void DeviceFluid<2>::take_series(const plain::WallParams&);
template void DeviceFluid<3>::take_series(const plain::WallParams&);
template void DeviceFluid<2>::place_solids();
template void DeviceFluid<3>::place_solids();
template void DeviceFluid<2>::pass_time(real);
template void DeviceFluid<3>::pass_time(real);
template void DeviceFluid<2>::meet_solids();
template void DeviceFluid<3>::meet_solids();
template void DeviceFluid<2>::leave_solids();
template void DeviceFluid<2>::renew_terms();
template void DeviceFluid<3>::renew_terms();
template void DeviceFluid<3>::leave_solids();

}  // namespace weir::particles
