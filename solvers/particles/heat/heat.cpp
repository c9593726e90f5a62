#include "particles/heat/heat.hpp"

#include "core/error.hpp"

#include <algorithm>

namespace weir::particles {

namespace {

/// Relative to the step at which no particle of a lattice becomes warmer than its neighbours. The sums grow where particles are closer than
/// in a lattice; they were never observed to double. Cleary & Monaghan's 0.15 ρ c h²/k is of this size.
constexpr real stable_part = 0.5;
constexpr int most_parts = 10000;  // substeps of a step: more would be a run that does not end

}  // namespace

template <int D>
LatticeSums lattice_sums(const Scheme& scheme, real spacing) {
    const Kernel<D> w = gradient_kernel<D>(scheme, spacing);
    const int reach = static_cast<int>(std::ceil(scheme.support));
    LatticeSums sums{0, 0};
    const real volume = cell_volume<D>(spacing);
    const int last = D == 3 ? reach : 0;
    for (int z = -last; z <= last; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                const real r = spacing * std::sqrt(static_cast<real>(x * x + y * y + z * z));
                if (r == 0) continue;
                const real g = -volume * w.derivative(r) / r;
                sums.moment += g * (x * spacing) * (x * spacing);
                sums.diagonal += 2 * g;
            }
    sums.diagonal /= sums.moment;
    return sums;
}

namespace {

/// Coefficient of a particle in the lowest row of a lattice, `height` above a wall of fixed temperature: its image, mirrored in temperature
/// too, counts twice.
template <int D>
real diagonal_at_wall(const Kernel<D>& w, real spacing, int reach, real height) {
    const auto weight = [&](real r) {
        r = std::max(r, 1e-5 * w.support());  // as HeatParams::guard
        return -2 * cell_volume<D>(spacing) * w.derivative(r) / r;
    };
    real sum = 0;
    const int last = D == 3 ? reach : 0;
    for (int z = -last; z <= last; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = 0; x <= reach; ++x) {
                const real along = spacing * std::sqrt(static_cast<real>(y * y + z * z));
                const bool own = x == 0 && along == 0;
                sum += own ? 2 * weight(2 * height)
                           : weight(std::hypot(along, x * spacing)) + weight(std::hypot(along, x * spacing + 2 * height));
            }
    return sum;
}

}  // namespace

/// At most 1 / stable_part times the diagonal for a lattice.
template <int D>
real closest_to_wall(const Scheme& scheme, real spacing) {
    const Kernel<D> w = gradient_kernel<D>(scheme, spacing);
    const LatticeSums sums = lattice_sums<D>(scheme, spacing);
    const auto too_close = [&](real height) {
        return diagonal_at_wall<D>(w, spacing, static_cast<int>(std::ceil(scheme.support)), height) >
               sums.diagonal * sums.moment / stable_part;
    };
    if (!too_close(0)) return 0;
    real close = 0, far = 0.5 * spacing;
    for (int i = 0; i < 30; ++i) {
        const real middle = 0.5 * (close + far);
        (too_close(middle) ? close : far) = middle;
    }
    return far;
}

HeatStates heat_states(const thermo::HeatCurve& curve, const std::array<real, 3>& conductivity) {
    constexpr real far = 1e300;
    HeatStates s{far, far, far, far, {0, 0, 0}, {0, 0, 0}, 0, {conductivity[0], conductivity[1], conductivity[2]}, far, 0};
    for (int i = 0; i < curve.states(); ++i) {
        const auto state = static_cast<std::size_t>(std::min(curve.state(i), thermo::State::vapour));  // or supercritical
        s.per_c[state] = 1 / curve.heat_capacity(i);
        s.k_c[state] = conductivity[state] / curve.heat_capacity(i);
        if (curve.state(i) == thermo::State::liquid) {
            s.T = i > 0 ? curve.begins_at(i) : 0;  // a substance that does not freeze continues linearly to 0 K
            s.liquid_begin = i > 0 ? curve.lowest(i) : curve.enthalpy(0.0);
            s.solid_end = i > 0 ? curve.highest(i - 1) : s.liquid_begin;
            if (i + 1 < curve.states()) s.liquid_end = curve.highest(i), s.vapour_begin = curve.lowest(i + 1);
        }
    }
    return s;
}

template <int D>
void Heat<D>::set_pairs(const Scheme& scheme) {
    const LatticeSums sums = lattice_sums<D>(scheme, spacing_);
    const real h = scheme.support * spacing_;
    const real conduct = -2 * cell_volume<D>(spacing_) * profile_factors<D>(scheme, spacing_).gradient / (sums.moment * rho0_);
    const auto fill = [&](auto& p) {
        using Number = std::remove_reference_t<decltype(p.h)>;
        p.h = static_cast<Number>(h), p.h2 = static_cast<Number>(h * h), p.guard = static_cast<Number>(1e-10 * h * h);
        p.conduct = static_cast<Number>(conduct);
    };
    fill(single_pairs_), fill(plain_pairs_);
    const real closest = closest_to_wall<D>(scheme, spacing_);
    single_walls_.closest = static_cast<float>(closest), plain_walls_.closest = closest;
    real fastest = *std::max_element(std::begin(states_.k_c), std::end(states_.k_c)) / rho0_;  // [m²/s]
    if (vapour_) fastest = std::max(fastest, states_.k[1] * states_.per_c[2] / rho0_);         // it boils below T_vapour in some places
    stable_dt_ = fastest > 0 ? stable_part / (fastest * sums.diagonal) : infinity;
}

template <int D>
int Heat<D>::parts(real dt) {
    const real wanted = std::ceil(dt / stable_dt_ * (1 - 1e-9));
    if (!(wanted <= most_parts))
        throw NumericalFailure("temperature", "heat conduction requires more than " + std::to_string(most_parts) +
                                                  " substeps per step: it is stable up to " + std::to_string(stable_dt_) + " s");
    return parts_ = std::max(1, static_cast<int>(wanted));
}

template <int D>
int Heat<D>::count_frozen(const Fluid<D>& fluid) {
    return frozen_ = static_cast<int>(
               block_sum(fluid.count(), [&](int i) { return frozen(fluid.enthalpy[static_cast<std::size_t>(i)]) ? 1.0 : 0.0; }));
}

template <int D>
std::string Heat<D>::concern() const {
    std::string text = vapour_ ? vapour_->concern() : "";
    if (frozen_ > 0 && !free_)
        text += (text.empty() ? "" : "; ") + std::to_string(frozen_) +
                " particles are frozen: heat.frozen = \"held\" fixes their positions, so ice neither floats nor sinks";
    return text;
}

template <int D>
void Heat<D>::feed(Fluid<D>& fluid, real dt) {
    for (const Heater& heater : heaters_) {
        const real joules = heater.gives(fluid.time - dt, dt);
        if (joules == 0) continue;
        const auto inside = [&](int i) { return heater.shape->contains(fluid.position(i)); };
        const real count = block_sum(fluid.count(), [&](int i) { return inside(i) ? 1.0 : 0.0; });
        if (count == 0) continue;
        const real each = joules / (count * fluid.mass);
        parallel_for(0, fluid.count(), [&](int i) {
            if (inside(i)) fluid.enthalpy[static_cast<std::size_t>(i)] += each;
        });
        added_ += joules;
    }
    for (const Flux& wall : fluxes_) {
        const real each = dt * wall.flux / rho0_;
        const auto weight_of = [&](int i) { return weight(height(wall, fluid.position(i))); };
        parallel_for(0, fluid.count(), [&](int i) { fluid.enthalpy[static_cast<std::size_t>(i)] += each * weight_of(i); });
        added_ += fluid.mass * each * block_sum(fluid.count(), weight_of);
    }
}

template <int D>
void Heat<D>::exchange(Fluid<D>& fluid, real outside, real part) {
    for (const Exchange& wall : exchanges_) {
        const Flux place{wall.axis, wall.end, 0};
        const real given = block_sum(fluid.count(), [&](int i) -> real {
            const real up = height(place, fluid.position(i)), share = weight(up);
            if (share == 0) return 0;
            real& h = fluid.enthalpy[static_cast<std::size_t>(i)];
            const real gain = part / rho0_ * share * heat_exchanged(h, shift(i), up, outside, wall.coefficient, spacing_, &states_);
            h += gain;
            return gain;
        });
        added_ += fluid.mass * given;
    }
}

template <int D>
void Heat<D>::check(const Fluid<D>& fluid) const {
    check(fluid.count() ? block_max(fluid.count(), [&](int i) { return fluid.enthalpy[static_cast<std::size_t>(i)]; }) : 0);
}

template <int D>
void Heat<D>::check(real most) const {
    if (std::isnan(most)) throw NumericalFailure("temperature", "the enthalpy is not finite");
    if (most > states_.liquid_end && !vapour_)
        throw NumericalFailure("temperature", "the liquid begins to boil, and the scene names no heat.vapour");
}

template <int D>
void Heat<D>::show(const Fluid<D>& fluid, FieldSet& set) const {
    place(fluid);
    for (auto* numbers : {&temperature_, &liquid_}) numbers->resize(fluid.enthalpy.size());
    if (vapour_) evaporated_.resize(fluid.enthalpy.size());
    parallel_for(0, fluid.count(), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const real h = fluid.enthalpy[at], vapour = heat_vapour(h, shift(i), &states_);
        temperature_[at] = heat_temperature(h, shift(i), &states_);
        liquid_[at] = heat_melted(h, &states_) - vapour;
        if (vapour_) evaporated_[at] = vapour;
    });
    const auto number = [&](const char* name, const char* unit, const std::vector<real>& values) {
        set.fields.push_back({name, unit, Where::particle, "particles", {std::span<const real>(values)}});
    };
    number("temperature", "K", temperature_);
    number("enthalpy", "J/kg", fluid.enthalpy);
    number("liquid", "", liquid_);
    if (vapour_) number("vapour", "", evaporated_);
}

template <int D>
void Heat<D>::sum_up(const Fluid<D>& fluid, std::vector<Integral>& list) const {
    const char* joule = D == 2 ? "J/m" : "J";
    const auto h = [&](int i) { return fluid.enthalpy[static_cast<std::size_t>(i)]; };
    const auto vapour = [&](int i) { return heat_vapour(h(i), shift(i), &states_); };
    const real heat = fluid.mass * block_sum(fluid.count(), h);
    list.push_back({"heat", joule, heat});
    list.push_back({"heat_added", joule, added_});
    list.push_back({"heat_kept", joule, heat - added_});
    const auto T = [&](int i) { return heat_temperature(h(i), shift(i), &states_); };
    list.push_back({"warmest", "K", block_max(fluid.count(), T)});
    list.push_back({"coldest", "K", -block_max(fluid.count(), [&](int i) { return -T(i); })});
    list.push_back({"liquid_volume", D == 2 ? "m^2" : "m^3",
                    fluid.mass / rho0_ * block_sum(fluid.count(), [&](int i) { return heat_melted(h(i), &states_) - vapour(i); })});
    if (vapour_) list.push_back({"vapour_mass", D == 2 ? "kg/m" : "kg", fluid.mass * block_sum(fluid.count(), vapour)});
    list.push_back({"conduction_parts", "1", static_cast<real>(parts_)});
}

template LatticeSums lattice_sums<2>(const Scheme&, real);
template LatticeSums lattice_sums<3>(const Scheme&, real);
template real closest_to_wall<2>(const Scheme&, real);
template real closest_to_wall<3>(const Scheme&, real);
template class Heat<2>;
template class Heat<3>;

}  // namespace weir::particles
