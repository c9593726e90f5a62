// Heat on a device: the passes of heat.cl over the state's enthalpies.
#include "particles/opencl/device_fluid.hpp"

namespace weir::particles {

template <int D>
std::string text_of(const std::vector<typename Heat<D>::Heater>& heaters) {
    std::string text = "WEIR_FN int in_heater(int which, double4 x) {\n    switch (which) {\n";
    for (std::size_t i = 0; i < heaters.size(); ++i)
        text += "        case " + std::to_string(i) + ": return " + heaters[i].shape->code() + " < 0;\n";
    return text + "    }\n    return 0;\n}\n";
}

template <int D>
void DeviceFluid<D>::feed(Heat<D>& heat, real dt) {
    int which = -1;
    for (const auto& heater : heat.heaters()) {
        ++which;
        const real joules = heater.gives(host_.time - dt, dt);
        if (joules == 0) continue;
        const real inside = reduce("count_in_heater", {count(), stride_, which, x, parts_}).sum;
        if (inside == 0) continue;
        run("feed_heater", {count(), stride_, which, joules / (inside * host_.mass), x, enthalpy});
        heat.add(joules);
    }
    for (const auto& wall : heat.fluxes()) {
        const real each = dt * wall.flux / host_.rho0, plane = (wall.end ? host_.domain.hi : host_.domain.lo)[wall.axis];
        const real sign = wall.end ? -1 : 1, spacing = host_.domain.spacing;
        heat.add(host_.mass * each * reduce("count_at_wall", {count(), stride_, wall.axis, plane, sign, spacing, x, parts_}).sum);
        run("feed_wall", {count(), stride_, wall.axis, plane, sign, spacing, each, x, enthalpy});
    }
}

template <int D>
void DeviceFluid<D>::exchange(Heat<D>& heat, real outside, real part) {
    const real spacing = host_.domain.spacing;
    for (const auto& wall : heat.exchanges()) {
        const real plane = (wall.end ? host_.domain.hi : host_.domain.lo)[wall.axis], sign = wall.end ? -1 : 1;
        run("exchange_at_wall", {count(), stride_, heat_states_, wall.axis, plane, sign, spacing, wall.coefficient, outside,
                                 part / host_.rho0, x, shift_, enthalpy, by_walls_});
        heat.add(host_.mass * reduce("sum_numbers", {count(), by_walls_, parts_}).sum);
    }
}

template <int D>
void DeviceFluid<D>::expand() {
    if (ice_ && count() > 0) run("rests_of_ice", {count(), heat_states_, order, enthalpy, rests});
    if (!effects_.heat || !effects_.heat->vapour() || count() == 0) return;
    auto& vapour = *effects_.heat->vapour();
    if (vapour.set_time(host_.time)) device_->upload(vapour_, &vapour.params(), sizeof(VapourParams));
    const int columns = vapour.columns(), rows = vapour.rows();
    device_->fill_zero(above_, above_.bytes);
    run("count_in_columns", {count(), stride_, vapour_, x, above_});
    device_->launch("sum_columns", static_cast<std::size_t>(columns), device_group, {columns, rows, above_});
    run("find_shifts", {count(), stride_, vapour_, x, above_, shift_});
    run("find_rests", {count(), vapour_, heat_states_, order, enthalpy, shift_, rests});
}

template <int D>
void DeviceFluid<D>::stop_frozen() {
    if (!effects_.heat || count() == 0) return;
    if (device_is_old_) upload();
    if (ice_) return find_ice();
    effects_.heat->set_frozen(static_cast<int>(reduce("count_frozen", {count(), heat_states_, enthalpy, parts_}).sum));
    if (effects_.heat->frozen() > 0) run("stop_frozen", {count(), stride_, heat_states_, enthalpy, v});
}

template <int D>
void DeviceFluid<D>::keep_frozen_prediction(real dt) {
    if (ice_ && count() > 0) return predict_ice(dt);
    stop_frozen();
    if (effects_.heat && effects_.heat->frozen() > 0) run("keep_frozen_prediction", {count(), stride_, heat_states_, enthalpy, x, x_star});
}

template <int D>
void DeviceFluid<D>::keep_frozen_positions() {
    if (ice_moves()) return place_ice();
    if (effects_.heat && effects_.heat->frozen() > 0)
        run("keep_frozen_positions", {count(), stride_, state_params, heat_states_, order, enthalpy, x, a});
}

template <int D>
void DeviceFluid<D>::conduct(Heat<D>& heat, real dt) {
    if (count() == 0) return;
    feed(heat, dt);
    const int parts = heat.parts(dt);
    const real part = dt / parts;
    const real outside = heat.exchanges().empty() ? 0 : heat.surroundings(host_.time - 0.5 * dt);
    for (int p = 0; p < parts; ++p) {
        exchange(heat, outside, part);
        run("load_theta", {count(), heat_states_, order, enthalpy, shift_, a});
        run("conduct", {count(), stride_, heat_pairs_, heat_walls_, a, neighbours, list, warming_, by_walls_});
        run("warm", {count(), part, order, warming_, enthalpy});
        if (heat.held()) heat.add(host_.mass * part * reduce("sum_numbers", {count(), by_walls_, parts_}).sum);
    }
    heat.check(reduce("sum_numbers", {count(), enthalpy, parts_}).largest);
}

template std::string text_of<2>(const std::vector<Heat<2>::Heater>&);
template std::string text_of<3>(const std::vector<Heat<3>::Heater>&);
template void DeviceFluid<2>::feed(Heat<2>&, real);
template void DeviceFluid<3>::feed(Heat<3>&, real);
template void DeviceFluid<2>::exchange(Heat<2>&, real, real);
template void DeviceFluid<3>::exchange(Heat<3>&, real, real);
template void DeviceFluid<2>::expand();
template void DeviceFluid<3>::expand();
template void DeviceFluid<2>::stop_frozen();
template void DeviceFluid<3>::stop_frozen();
template void DeviceFluid<2>::keep_frozen_prediction(real);
template void DeviceFluid<3>::keep_frozen_prediction(real);
template void DeviceFluid<2>::keep_frozen_positions();
template void DeviceFluid<3>::keep_frozen_positions();
template void DeviceFluid<2>::conduct(Heat<2>&, real);
template void DeviceFluid<3>::conduct(Heat<3>&, real);

}  // namespace weir::particles
