#include "smoke/heat.hpp"

#include "core/error.hpp"
#include "mac/grid/rows.hpp"

#include <algorithm>
#include <utility>

namespace weir::smoke {

namespace {

using poisson::Cell;

}  // namespace

/// Computes temperature and liquid fraction from the enthalpies.
template <int D>
void Heat<D>::note(MacState<D>& s) {
    const auto& h = s["enthalpy"];
    auto& T = s["temperature"];
    const Melting m = melting_;
    const real per_solid = 1 / m.c_solid, per_liquid = 1 / m.c_liquid;
    const real per_heat = 1 / std::max(m.h_liquid - m.h_solid, std::numeric_limits<real>::min());
    const int planes = s.extent()[D - 1];
    const std::size_t plane = h.size() / static_cast<std::size_t>(planes);
    const real hottest = parallel_max(planes, [&](int k) {
        const std::size_t first = static_cast<std::size_t>(k) * plane;
        const real* at = h.data() + first;
        real *t = T.data() + first, *f = liquid_.data() + first;
        real most = -infinity, least = infinity, poison = 0;  // x - x is 0, or NaN where x is not finite
#pragma omp simd reduction(max : most) reduction(min : least) reduction(+ : poison)
        for (std::size_t i = 0; i < plane; ++i) {
            t[i] = m.T + ((std::min(at[i], m.h_solid) - m.h_solid) * per_solid + (std::max(at[i], m.h_liquid) - m.h_liquid) * per_liquid);
            f[i] = std::clamp((at[i] - m.h_solid) * per_heat, real(0), real(1));
            most = std::max(most, at[i]), least = std::min(least, at[i]), poison += at[i] - at[i];
        }
        coldest_[static_cast<std::size_t>(k)] = least;
        return most + poison;
    });
    any_ice_ = *std::min_element(coldest_.begin(), coldest_.end()) < m.h_liquid;
    if (!(hottest <= m.boils_above))
        throw NumericalFailure("temperature", std::isnan(hottest) ? "the enthalpy is not finite"
                                                                  : "the liquid begins to boil, and solver \"mac\" has no vapour");
}

template <int D>
void Heat<D>::conduct(MacState<D>& s, real dt) {
    if (supply_.ambient().pressure_changes()) {
        melting_ = thermo::melting_at(*substance_, supply_.ambient().pressure(s.time + dt));
        conduction_.set_melting(melting_);
    }
    const auto& source = supply_.at(s.time, dt, s, conduction_);
    auto& h = s.field("enthalpy");
    const typename Conduction<D>::Given given{s.cells, false, source, beside_flow_ ? &h.before : nullptr};
    added_ += explicit_ ? conduction_.euler_step(h.values, given, dt) : conduction_.step(h.values, given, dt);
    note(s);
}

template <int D>
void Heat<D>::apply_buoyancy(MacState<D>& s, real dt) const {
    if (!lightness_) return;
    constexpr int up = 1;
    const thermo::Lightness& light = *lightness_;
    const auto& T = s["temperature"];
    const Nodes<D> faces = free_faces(s.u, s.sides, up);
    for_each_row(faces.lo, faces.hi, [&](const Index<D>& first, int count) {
        Index<D> above = first, under = first - e<D>(up);  // on a side the single adjacent cell, or the one across a periodic boundary
        above[up] = std::min(above[up], T.extent()[up] - 1);
        if (under[up] < 0) under[up] = s.sides.periodic(up) ? T.extent()[up] - 1 : 0;
        const real *here = &T(above), *below = &T(under);
        real* v = &s.u[up](first);
        for (int i = 0; i < count; ++i) v[i] += 0.5 * dt * gravity_ * (light(below[i]) + light(here[i]));
    });
}

/// Returns at once where everything is liquid now and was in the last step.
template <int D>
bool Heat<D>::apply_ice_drag(MacState<D>& s, real dt) {
    const bool was_ice = std::exchange(slows_, any_ice_);
    if (!any_ice_ && !was_ice) return false;
    ice_.apply_drag(s, liquid_, dt * drag_ / s.rho);
    return true;
}

template <int D>
real Heat<D>::stable_dt(const MacState<D>&) const {
    return explicit_ ? conduction_.longest_euler_step() : infinity;
}

/// In one step buoyancy from rest crosses at most `cfl` cells. No step crosses a time at which a heater is switched or the surroundings
/// change their rate.
template <int D>
real Heat<D>::max_dt(const MacState<D>& s) const {
    real limit = stable_dt(s);
    if (lightness_) {
        const auto& T = *s.find("temperature");
        const real most = max_over(s.extent(), [&](const Index<D>& I) { return std::abs((*lightness_)(T(I))); });
        limit = std::min(limit, acceleration_limit(std::abs(gravity_) * most, s.u.h[1], cfl_));
    }
    limit = std::min(limit, supply_.to_next_change(s.time));
    return limit;
}

template <int D>
std::vector<Integral> Heat<D>::integrals(const MacState<D>& s) const {
    const auto over = [&](const Grid<real, D>& q) {
        return s.u.cell_volume() * sum_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? q(I) : 0; });
    };
    const auto& T = *s.find("temperature");
    const auto most = [&](real sign) {
        return sign * max_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? sign * T(I) : -infinity; });
    };
    const char* joule = D == 2 ? "J/m" : "J";
    return {{"heat", joule, s.rho * over(*s.find("enthalpy"))},
            {"heat_added", joule, added_},
            {"liquid_volume", D == 2 ? "m^2" : "m^3", over(liquid_)},
            {"coldest", "K", most(-1)},
            {"hottest", "K", most(1)}};
}

template <int D>
void Heat<D>::restore(const Checkpoint& from, MacState<D>& s) {
    added_ = from.template get_value<real>("heat_added");
    note(s);
}

template <int D>
std::size_t Heat<D>::bytes() const {
    return conduction_.bytes() + supply_.bytes() + ice_.bytes() + (liquid_.size() + coldest_.size()) * sizeof(real);
}

template class Heat<2>;
template class Heat<3>;

}  // namespace weir::smoke
