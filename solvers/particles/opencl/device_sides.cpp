// Changes of the number of particles on a device: emitters and sinks, open sides; and periodic sides.
#include "particles/opencl/device_fluid.hpp"

#include <algorithm>

namespace weir::particles {

template <int D>
std::string text_of(const std::vector<geometry::ShapePtr<D>>& sinks) {
    std::string any = "0";
    for (const auto& sink : sinks) any += " || " + sink->code() + " < 0";
    return "WEIR_FN int in_a_sink(double4 x) { return " + any + "; }\n";
}

template <int D>
void DeviceFluid<D>::add_inflow(real dt) {
    auto& emitters = effects_.emitters;
    if (emitters.empty()) return;
    std::array<std::vector<real>, D> places, velocities;
    std::vector<real> enthalpies;
    emitters.emit(host_.time, dt, [&](const Vec<D>& at, const Vec<D>& velocity, real h) {
        enthalpies.push_back(h);
        const Vec<D> kept = host_.domain.kept(at, host_.corrections);
        for (std::size_t axis = 0; axis < D; ++axis) places[axis].push_back(kept[axis]), velocities[axis].push_back(velocity[axis]);
    });
    append(places, velocities, enthalpies);
    if (!emitters.sinks().empty() && count() > 0) take_out("find_what_is_in_no_sink");
}

/// Appends particles. Where the capacity is exceeded, the state goes through the host, which reallocates before the next upload.
template <int D>
void DeviceFluid<D>::append(const std::array<std::vector<real>, D>& places, const std::array<std::vector<real>, D>& velocities,
                            const std::vector<real>& enthalpies) {
    const auto n = places[0].size();
    if (n == 0) return;
    if (device_is_old_ || static_cast<std::size_t>(count_) + n > static_cast<std::size_t>(stride_)) {
        Fluid<D>& fluid = change();
        for (std::size_t i = 0; i < n; ++i) {
            Vec<D> at, velocity;
            for (std::size_t axis = 0; axis < D; ++axis) at[axis] = places[axis][i], velocity[axis] = velocities[axis][i];
            fluid.add(at, velocity, enthalpies[i]);
        }
        return;
    }
    const auto first = static_cast<std::size_t>(count_), row = static_cast<std::size_t>(stride_);
    for (std::size_t axis = 0; axis < D; ++axis) {
        device_->upload(x, places[axis].data(), n * sizeof(real), (axis * row + first) * sizeof(real));
        device_->upload(v, velocities[axis].data(), n * sizeof(real), (axis * row + first) * sizeof(real));
    }
    std::vector<int> ids(n);
    for (int& id : ids) id = static_cast<int>(host_.next_id++);
    device_->upload(id_, ids.data(), n * sizeof(int), first * sizeof(int));
    device_->upload(density, std::vector<real>(n, host_.rho0).data(), n * sizeof(real), first * sizeof(real));
    device_->upload(carried, std::vector<real>(n, 0).data(), n * sizeof(real), first * sizeof(real));
    if (host_.warm) device_->upload(enthalpy, enthalpies.data(), n * sizeof(real), first * sizeof(real));
    count_ += static_cast<int>(n);
    host_is_old_ = true;
}

template <int D>
void DeviceFluid<D>::cross_sides() {
    if (count() == 0) return;
    if (repeats_) run("wrap", {count(), stride_, state_params, x});
    if (open_ && take_out("find_what_stays")) max_speed();  // of the remaining particles: the step limit uses it
}

/// Removes particles; the others keep their order. Waits for their number. Returns whether there are fewer.
template <int D>
bool DeviceFluid<D>::take_out(std::string_view find_stayers) {
    run(find_stayers, {count(), stride_, state_params, x, cell_});
    exclusive_sums(count(), cell_, names_);
    int before = 0, last = 0;
    const auto end = static_cast<std::size_t>(count() - 1) * sizeof(int);
    device_->download(&before, names_, sizeof before, end);
    device_->download(&last, cell_, sizeof last, end);
    if (before + last == count()) return false;
    run("list_stayers", {count(), cell_, names_, order});
    count_ = before + last;
    if (count_ > 0) reorder();
    return true;
}

/// Largest number of particles expected in the scene: the initial ones and those that enter, but no more than fill the domain, plus a
/// tenth. (With sinks or open sides the total that enters may be far larger.)
template <int D>
std::size_t DeviceFluid<D>::most_particles() const {
    const auto& domain = host_.domain;
    real cells = 1;
    for (int axis = 0; axis < D; ++axis) cells *= std::round((domain.hi[axis] - domain.lo[axis]) / domain.spacing);
    const real first = host_.count(), entering = effects_.emitters.entered(effects_.end);
    return static_cast<std::size_t>(std::min(first + entering, std::max(first, 1.1 * cells)));
}

template std::string text_of(const std::vector<geometry::ShapePtr<2>>&);
template std::string text_of(const std::vector<geometry::ShapePtr<3>>&);
template void DeviceFluid<2>::add_inflow(real);
template void DeviceFluid<3>::add_inflow(real);
template void DeviceFluid<2>::cross_sides();
template void DeviceFluid<3>::cross_sides();
template std::size_t DeviceFluid<2>::most_particles() const;
template std::size_t DeviceFluid<3>::most_particles() const;

}  // namespace weir::particles
