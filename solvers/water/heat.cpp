#include "water/heat.hpp"

#include "core/error.hpp"
#include "geometry/shape.hpp"
#include "mac/grid/initial.hpp"
#include "scene/names.hpp"
#include "thermo/heat_keys.hpp"
#include "thermo/scene_substance.hpp"

#include <algorithm>

namespace weir::water {

using poisson::Cell;
using scene::Key;
using scene::Type;

template <int D>
std::vector<Key> LiquidHeat<D>::keys() {
    const auto none_or_more = [](const char* name, const char* unit, const char* doc) {
        return Key{.name = name, .type = Type::number, .doc = doc, .unit = unit, .fallback = 0.0, .min = 0};
    };
    return thermo::keys_on_a_grid(
        "the liquid carry heat, freeze and evaporate",
        {none_or_more("surface_exchange", "W/(m^2 K)", "Heat transfer coefficient between heat.ambient and the free surface."),
         none_or_more("evaporation", "kg/(m^2 s Pa)",
                      "Evaporation rate of the surface per pascal of saturation pressure above vapour_pressure. The liquid is removed with "
                      "its enthalpy and the heat of evaporation; the integrals record both."),
         none_or_more("vapour_pressure", "Pa", "Pressure of the substance's vapour above the liquid."), thermo::ClosedGas::key()},
        "the liquid's cells whose centres they cover; none where there is no liquid.");
}

namespace {

/// Rejects sides and effects that would transport heat without a known enthalpy.
template <int D>
void refuse_open(const scene::Scene& scene, const MacState<D>& s) {
    if (!scene.root().tables("emitters").empty())
        scene.refuse("emitters[0]", "an emitter without a temperature in a scene with a substance, whose heat is conserved");
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end)
            if (const auto kind = s.sides.side(a, end).kind; kind == geometry::SideKind::inflow || kind == geometry::SideKind::outflow)
                scene.refuse(std::string("sides.") + "xyz"[a] + (end == 0 ? "_min" : "_max"),
                             "the heat balance of a substance requires a closed domain, and this side is open");
    for (std::size_t i = 0; scene.has("solids") && i < scene.root().tables("solids").size(); ++i)
        if (scene.root().tables("solids")[i].has("motion"))
            scene.refuse("solids[" + std::to_string(i) + "].motion", "moving solids cannot be combined with a melting substance");
}

}  // namespace

template <int D>
LiquidHeat<D>::LiquidHeat(const scene::Scene& scene, MacState<D>& s, const Frame<D>& frame, real volume)
    : substance_(thermo::substance_of(scene)),
      melting_(thermo::melting_of(scene, "mac_water")),
      frame_(frame),
      drag_(scene.number("heat.drag")),
      exchange_(scene.number("heat.surface_exchange")),
      evaporation_(scene.number("heat.evaporation")),
      vapour_pressure_(scene.number("heat.vapour_pressure")),
      enthalpy_(s.extent()),
      temperature_(s.extent()),
      liquid_(s.extent(), 1),
      moved_(s.extent()),
      source_(s.extent()),
      known_(s.extent()),
      known_next_(s.extent()) {
    refuse_open(scene, s);
    s.sides.read(scene, "temperature");
    conduction_ = Conduction<D>(melting_, s.extent(), s.u.h, s.rho, field_boundary(s.sides, "temperature"));
    supply_ = HeatSupply<D>(scene, s, melting_, conduction_);
    if (exchange_ > 0 && !supply_.ambient().has_temperature())
        scene.refuse("heat.surface_exchange", "the surface exchanges heat with surroundings that are not defined",
                     "add heat.ambient with a temperature or keyframes");
    set_initial_field(temperature_, s.u, scene, "temperature");
    const char* place = scene.has("initial.temperature") ? "initial.temperature" : "substance";
    const real coldest = -max_over(s.extent(), [&](const Index<D>& I) { return -temperature_(I); });
    if (!(coldest > 0))
        scene.refuse(place, "the lowest temperature is " + scene::number_text(coldest) + " K at the start", "it must be greater than 0 K");
    for_each_cell(s.extent(), [&](const Index<D>& I) { enthalpy_(I) = melting_.enthalpy(temperature_(I)); });
    const real most = max_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? enthalpy_(I) : -infinity; });
    if (most > melting_.boils_above)
        scene.refuse(place, "at " + scene::number_text(melting_.temperature(most)) + " K the liquid boils",
                     "solver \"mac_water\" evaporates at its surface, and has no bubbles");
    find_surface(s);
    mean_ = mean(s);
    note(s);
    if (!thermo::ClosedGas::named(scene)) return;
    if (surface_cells_.empty()) scene.refuse("heat.enclosed_vapour", "the liquid has no surface");
    const auto open =
        static_cast<real>(std::count_if(s.cells.values().begin(), s.cells.values().end(), [](Cell cell) { return cell != Cell::solid; }));
    gas_.emplace(scene, substance_, melting_, open * frame_.cell_volume(), volume, surface_temperature());
}

template <int D>
real LiquidHeat<D>::mean(const MacState<D>& s) const {
    const real sum = sum_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? enthalpy_(I) : 0; });
    return cells_ > 0 ? sum / static_cast<real>(cells_) : mean_;
}

/// Finds the liquid cells beside air, and counts all liquid cells.
template <int D>
void LiquidHeat<D>::find_surface(const MacState<D>& s) {
    surface_cells_.clear();
    cells_ = 0;
    for (std::size_t c = 0; c < s.cells.size(); ++c) {
        if (s.cells[c] != Cell::fluid) continue;
        ++cells_;
        const Index<D> I = frame_.index_of(c);
        bool air = false;
        for (int a = 0; a < D; ++a)
            for (const int by : {-1, 1}) {
                Index<D> J = I;
                air = air || (frame_.step(J, a, by) && s.cells(J) == Cell::air);
            }
        if (air) surface_cells_.push_back(c);
    }
}

/// Computes temperature and liquid fraction from the enthalpies; cells outside the liquid count as melt.
template <int D>
void LiquidHeat<D>::note(const MacState<D>& s) {
    for_each_cell(s.extent(), [&](const Index<D>& I) {
        temperature_(I) = melting_.temperature(enthalpy_(I));
        liquid_(I) = s.cells(I) == Cell::fluid ? melting_.liquid(enthalpy_(I)) : 1;
    });
    const auto most = [&](real sign, const Grid<real, D>& q) {
        return sign * max_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? sign * q(I) : -infinity; });
    };
    coldest_ = most(-1, temperature_), hottest_ = most(1, temperature_);
    const real hottest = most(1, enthalpy_);
    if (!(hottest <= melting_.boils_above))
        throw NumericalFailure("temperature", std::isnan(hottest) ? "the enthalpy is not finite"
                                                                  : "the liquid begins to boil, and solver \"mac_water\" has no bubbles");
}

/// H of cells near the liquid is the mean of their neighbours, layer by layer.
template <int D>
void LiquidHeat<D>::continue_outwards(const MacState<D>& s, int layers) {
    for_each_cell(s.extent(), [&](const Index<D>& I) { known_(I) = s.cells(I) == Cell::fluid ? 1 : 0; });
    for (int layer = 2; layer < layers + 2; ++layer) {
        for_each_cell(s.extent(), [&](const Index<D>& I) {  // reads earlier layers only: independent of the order
            std::uint8_t& mark = known_next_(I) = known_(I);
            if (mark != 0) return;
            real sum = 0;
            int count = 0;
            for (int a = 0; a < D; ++a)
                for (const int by : {-1, 1}) {
                    Index<D> J = I;
                    if (frame_.step(J, a, by) && known_(J) != 0) sum += enthalpy_(J), ++count;
                }
            if (count > 0) enthalpy_(I) = sum / count, mark = static_cast<std::uint8_t>(layer);
        });
        known_.swap(known_next_);
    }
}

template <int D>
void LiquidHeat<D>::carry(const MacState<D>& s, const LevelSet<D>& surface, real dt, Trace order) {
    continue_outwards(s, surface.layers());
    const real near = 2 * frame_.h_max();
    for_each_cell(s.extent(), [&](const Index<D>& I) {
        moved_(I) = enthalpy_(I);
        if (!(surface.phi(I) < near) || s.cells(I) == Cell::solid) return;
        const Vec<D> from = trace(s.u, frame_, frame_.centre(I), -dt, order);
        moved_(I) = sample_cells(enthalpy_, Stencil<D>(frame_, frame_.wrap(from)));
    });
    enthalpy_.swap(moved_);  // moved_: the previous values
}

/// Restores the mean enthalpy. The deficit is distributed over cells in proportion to their change, limited by the previous range. Where
/// that is not enough, it is distributed in proportion to the distance from the end of that range.
template <int D>
void LiquidHeat<D>::keep_mean(const MacState<D>& s) {
    if (cells_ == 0) return;
    const real lacks = (mean_ - mean(s)) * static_cast<real>(cells_), sign = lacks < 0 ? -1 : 1;
    const auto is_liquid = [&](const Index<D>& I) { return s.cells(I) == Cell::fluid; };
    const real end =
        std::max(sign * mean_, max_over(s.extent(), [&](const Index<D>& I) { return is_liquid(I) ? sign * moved_(I) : -infinity; }));
    const auto room = [&](const Index<D>& I) { return is_liquid(I) ? std::max(end - sign * enthalpy_(I), real(0)) : 0; };
    const auto bears = [&](const Index<D>& I) { return is_liquid(I) ? std::min(std::abs(enthalpy_(I) - moved_(I)), room(I)) : 0; };
    const auto give = [&](auto&& part) {
        const real all = sum_over(s.extent(), part);
        if (!(all >= std::abs(lacks)) || all == 0) return false;
        for_each_cell(s.extent(), [&](const Index<D>& I) { enthalpy_(I) += lacks * (part(I) / all); });
        return true;
    };
    if (give(bears) || give(room)) return;
    for_each_cell(s.extent(), [&](const Index<D>& I) {  // all are at the end of the range, up to rounding
        if (is_liquid(I)) enthalpy_(I) += lacks / static_cast<real>(cells_);
    });
}

template <int D>
real LiquidHeat<D>::surface_temperature() const {
    real sum = 0;
    for (const std::size_t c : surface_cells_) sum += temperature_[c];
    return sum / static_cast<real>(surface_cells_.size());
}

/// Heat capacity of the cells at the surface [J/K].
template <int D>
real LiquidHeat<D>::surface_capacity(const MacState<D>& s) const {
    return s.rho * std::min(melting_.c_solid, melting_.c_liquid) * static_cast<real>(surface_cells_.size()) * frame_.cell_volume();
}

template <int D>
real LiquidHeat<D>::evaporates(const MacState<D>& s, real area, real dt) {
    if (evaporation_ == 0 || surface_cells_.empty()) return 0;
    const real T = surface_temperature(), K = area * evaporation_;
    if (gas_) return gas_->evaporates(K, T, surface_capacity(s), dt) / s.rho;
    return dt * K * (substance_->pressure(thermo::line_to_vapour(*substance_, T), T) - vapour_pressure_) / s.rho;
}

template <int D>
void LiquidHeat<D>::leaves(const MacState<D>& s, real lost, real volume) {
    if (surface_cells_.empty() || !(volume > lost)) return;
    const real T = surface_temperature(), h = melting_.enthalpy(T), m = s.rho * lost;
    const real taken =
        gas_ ? gas_->take(m, melting_, T, volume - lost) : m * (h + substance_->latent_heat(thermo::line_to_vapour(*substance_, T), T));
    evaporated_ += lost;
    vapour_heat_ += taken;
    pending_ += taken - m * h;
    mean_ = (mean_ * volume - lost * h) / (volume - lost);
}

template <int D>
void LiquidHeat<D>::conduct(const MacState<D>& s, real volume, real area, real dt) {
    find_surface(s);
    if (cells_ == 0) return;
    keep_mean(s);
    if (supply_.ambient().pressure_changes()) {
        melting_ = thermo::melting_at(*substance_, supply_.ambient().pressure(s.time + dt));
        conduction_.set_melting(melting_);
    }
    conduction_.set_density(s.rho * volume / (static_cast<real>(cells_) * frame_.cell_volume()));
    const auto& given = supply_.at(s.time, dt, s, conduction_);
    if (given.empty())
        source_.fill(0);
    else
        for_each_cell(s.extent(), [&](const Index<D>& I) { source_(I) = given(I); });
    if (!surface_cells_.empty()) {
        const real cell = static_cast<real>(surface_cells_.size()) * frame_.cell_volume();
        const real outside = exchange_ > 0 ? supply_.ambient().temperature(s.time + 0.5 * dt) : 0;
        for (const std::size_t c : surface_cells_)
            source_[c] += (exchange_ * area * (outside - melting_.temperature(enthalpy_[c])) - pending_ / dt) / cell;
        added_ += pending_, pending_ = 0;  // not from outside: recorded as the vapour's
    }
    added_ += conduction_.step(enthalpy_, {s.cells, true, source_}, dt);
    mean_ = mean(s);
    note(s);
}

template <int D>
bool LiquidHeat<D>::apply_ice_drag(MacState<D>& s, real dt) {
    const bool ice = max_over(s.extent(), [&](const Index<D>& I) { return -liquid_(I); }) > -1;
    if (!std::exchange(any_ice_, ice) && !ice) return false;
    ice_.apply_drag(s, liquid_, dt * drag_ / s.rho);
    return true;
}

template <int D>
real LiquidHeat<D>::max_dt(const MacState<D>& s, real area) const {
    real limit = supply_.to_next_change(s.time);
    if (surface_cells_.empty()) return limit;
    const real capacity = surface_capacity(s);
    if (exchange_ > 0) limit = std::min(limit, 0.5 * capacity / (exchange_ * area));
    if (evaporation_ > 0) {  // limits: a tenth of a cell, and one kelvin of the surface cells
        const real T = surface_temperature(), K = evaporation_ * area;
        const auto line = thermo::line_to_vapour(*substance_, T);
        const real latent = substance_->latent_heat(line, T);
        const real most = std::min(0.1 * frame_.h_min() * s.rho * area, capacity / latent);  // [kg]
        if (gas_ && std::abs(gas_->evaporates(K, T, capacity, infinity)) <= most) return limit;
        const real rate = K * std::abs(substance_->pressure(line, T) - (gas_ ? gas_->pressure() : vapour_pressure_));  // [kg/s]
        if (rate > 0) limit = std::min(limit, most / rate);
    }
    return limit;
}

template <int D>
std::vector<Integral> LiquidHeat<D>::integrals(const MacState<D>& s, real volume) const {
    const std::string depth = D == 2 ? "/m" : "", m = D == 2 ? "m^2" : "m^3";
    const real melt = sum_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? liquid_(I) : 0; });
    const real heat = s.rho * volume * mean_ - pending_;
    std::vector<Integral> list = {{"heat", "J" + depth, heat},
                                  {"heat_added", "J" + depth, added_},
                                  {"vapour_heat", "J" + depth, vapour_heat_},
                                  {"evaporated", m, evaporated_},
                                  {"liquid_volume", m, cells_ > 0 ? volume * melt / static_cast<real>(cells_) : 0},
                                  {"coldest", "K", coldest_},
                                  {"hottest", "K", hottest_}};
    if (!gas_) return list;
    list.insert(list.end(), {{"pressure", "Pa", gas_->pressure()},
                             {"temperature", "K", surface_cells_.empty() ? not_applicable : surface_temperature()},
                             {"vapour_mass", "kg" + depth, gas_->mass()},
                             {"liquid_mass", "kg" + depth, s.rho * volume},
                             {"internal_energy", "J" + depth, heat + gas_->energy()}});
    return list;
}

template <int D>
void LiquidHeat<D>::save(Checkpoint& to) const {
    to.put("water.enthalpy", enthalpy_.values());
    to.put_value("water.heat", std::array<real, 5>{mean_, pending_, added_, evaporated_, vapour_heat_});
    if (gas_) to.put_value("water.gas", gas_->saved());
}

template <int D>
void LiquidHeat<D>::restore(const Checkpoint& from, const MacState<D>& s) {
    from.get("water.enthalpy", enthalpy_.values());
    const auto reals = from.template get_value<std::array<real, 5>>("water.heat");
    mean_ = reals[0], pending_ = reals[1], added_ = reals[2], evaporated_ = reals[3], vapour_heat_ = reals[4];
    find_surface(s);
    note(s);
    if (gas_) gas_->restore(from.template get_value<std::array<real, 4>>("water.gas"));
}

template <int D>
std::size_t LiquidHeat<D>::bytes() const {
    std::size_t count = conduction_.bytes() + supply_.bytes() + ice_.bytes() + known_.size() + known_next_.size() +
                        surface_cells_.capacity() * sizeof(std::size_t);
    for (const auto* grid : {&enthalpy_, &temperature_, &liquid_, &moved_, &source_}) count += grid->size() * sizeof(real);
    return count;
}

template class LiquidHeat<2>;
template class LiquidHeat<3>;

}  // namespace weir::water
