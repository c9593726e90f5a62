#include "mac/heat/heat_supply.hpp"

#include "geometry/shape.hpp"
#include "scene/names.hpp"
#include "thermo/heat_keys.hpp"

#include <algorithm>

namespace weir::mac {

namespace {

using poisson::Cell;

std::string side_path(int axis, int end) { return std::string("sides.") + "xyz"[axis] + (end == 0 ? "_min" : "_max"); }

/// t < moment, up to rounding of a sum of steps that ends at the moment.
bool before(real t, real moment) { return t < moment * (1 - 1e-9); }

}  // namespace

template <int D>
HeatSupply<D>::HeatSupply(const scene::Scene& scene, const MacState<D>& s, const thermo::Melting& melting, Conduction<D>& conduction)
    : ambient_(scene) {
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) read_side(scene, s, melting, conduction, a, end);
    for (std::size_t i = 0; i < scene.root().tables("heaters").size(); ++i) read_heater(scene, s, i);
    if (!heaters_.empty() || !fluxes_.empty()) source_ = Grid<real, D>(s.extent());
}

template <int D>
void HeatSupply<D>::read_side(const scene::Scene& scene, const MacState<D>& s, const thermo::Melting& melting, Conduction<D>& conduction,
                              int a, int end) {
    const auto& side = s.sides.side(a, end);
    const std::string path = side_path(a, end);
    if (side.temperature) {
        const real T = *side.temperature;
        thermo::check_temperature(scene, path + ".temperature", T);
        if (melting.enthalpy(T) > melting.boils_above)
            scene.refuse(path + ".temperature", "at " + scene::number_text(T) + " K the liquid boils",
                         "solver \"" + scene.text("solver") + "\" has no vapour");
    }
    for (const char* key : {".heat_flux", ".exchange"})
        if (side.temperature && scene.has(path + key))
            scene.refuse(path + key, "the wall has a temperature, which determines the heat flux");
    if (scene.has(path + ".heat_flux")) fluxes_.push_back({a, end, scene.number(path + ".heat_flux")});
    if (!scene.has(path + ".exchange")) return;
    if (!ambient_.has_temperature())
        scene.refuse(path + ".exchange", "the wall exchanges heat with surroundings that are not defined",
                     "add heat.ambient with a temperature or keyframes");
    conduction.exchange_through(a, end, scene.number(path + ".exchange"));
    exchanging_.push_back({a, end});
}

template <int D>
void HeatSupply<D>::read_heater(const scene::Scene& scene, const MacState<D>& s, std::size_t i) {
    thermo::check_heater(scene, i);
    const auto& table = scene.root().tables("heaters")[i];
    Heater heater{table.number("start"), table.number_or("end", infinity), table.number("power"), {}};
    const auto shape = geometry::make_shape<D>(table);
    for (std::size_t c = 0; c < product(s.extent()); ++c)
        if (shape->contains(s.u.cell_centre(index_of<D>(s.extent(), c)))) heater.cells.push_back(c);
    if (heater.cells.empty()) scene.refuse("heaters[" + std::to_string(i) + "]", "the heater covers the centre of no cell");
    heaters_.push_back(std::move(heater));
}

template <int D>
void HeatSupply<D>::refuse_heaters_without_fluid(const scene::Scene& scene, const MacState<D>& s) const {
    for (std::size_t i = 0; i < heaters_.size(); ++i)
        if (std::none_of(heaters_[i].cells.begin(), heaters_[i].cells.end(), [&](std::size_t c) { return s.cells[c] == Cell::fluid; }))
            scene.refuse("heaters[" + std::to_string(i) + "]", "the heater lies inside solids: it heats no fluid");
}

template <int D>
void HeatSupply<D>::follow(std::shared_ptr<BrushForcing> forcing, const thermo::Melting& melting, const Grid<real, D>& enthalpy) {
    brush_forcing_ = std::move(forcing), melting_ = &melting, enthalpy_ = &enthalpy;
    if (source_.empty()) source_ = Grid<real, D>(enthalpy.extent());
}

template <int D>
void HeatSupply<D>::heat_with_brush(real t, real dt, const MacState<D>& s) {
    const auto brush = brush_forcing_->at<D>(t);
    if (brush.kind != BrushKind::heat) return;
    const real wanted = std::min(melting_->enthalpy(brush.temperature), melting_->boils_above);
    brush_forcing_->heat += s.u.cell_volume() * dt * sum_over(s.extent(), [&](const Index<D>& I) -> real {
                                const real weight = s.cells(I) == Cell::fluid ? brush.weight(s.u.cell_centre(I)) : 0;
                                if (weight == 0) return 0;
                                const real power = s.rho * brush_forcing_->share(weight, dt) * (wanted - (*enthalpy_)(I)) / dt;
                                source_(I) += power;
                                return power;
                            });
}

template <int D>
const Grid<real, D>& HeatSupply<D>::at(real t, real dt, const MacState<D>& s, Conduction<D>& conduction) {
    for (const auto [axis, end] : exchanging_) conduction.set_outside(axis, end, ambient_.temperature(t + 0.5 * dt));
    if (source_.empty()) return source_;
    source_.fill(0);
    for (const Flux& flux : fluxes_) {
        Extent<D> side = s.extent();
        side[flux.axis] = 1;
        for_each_cell(side, [&](Index<D> I) {
            if (flux.end == 1) I[flux.axis] = s.extent()[flux.axis] - 1;
            if (s.cells(I) == Cell::fluid) source_(I) += flux.density / s.u.h[flux.axis];
        });
    }
    for (const Heater& heater : heaters_) {
        if (before(t, heater.start) || !before(t, heater.end)) continue;
        const auto is_fluid = [&](std::size_t c) { return s.cells[c] == Cell::fluid; };
        const auto covered = std::count_if(heater.cells.begin(), heater.cells.end(), is_fluid);
        const real density = heater.power / (static_cast<real>(std::max<std::ptrdiff_t>(covered, 1)) * s.u.cell_volume());
        for (const std::size_t c : heater.cells)
            if (is_fluid(c)) source_[c] += density;
    }
    if (brush_forcing_) heat_with_brush(t, dt, s);
    return source_;
}

template <int D>
real HeatSupply<D>::to_next_change(real t) const {
    real least = ambient_.to_next_frame(t);
    for (const Heater& heater : heaters_)
        for (const real moment : {heater.start, heater.end})
            if (before(t, moment)) least = std::min(least, moment - t);
    return least;
}

template <int D>
std::size_t HeatSupply<D>::bytes() const {
    std::size_t count = source_.size() * sizeof(real);
    for (const Heater& heater : heaters_) count += heater.cells.size() * sizeof(std::size_t);
    return count;
}

template class HeatSupply<2>;
template class HeatSupply<3>;

}  // namespace weir::mac
