// What gives heat to the fluid of a grid: heaters with a power, walls with a flux, walls that exchange heat with the surroundings.
#pragma once
#include "core/hand.hpp"
#include "matter/ambient.hpp"
#include "staggered/conduction.hpp"
#include "staggered/state.hpp"

#include <memory>

namespace weir::staggered {

template <int D>
class HeatSupply {
public:
    HeatSupply() = default;
    /// Refuses sides and heaters that cannot be. `conduction` learns which sides exchange heat.
    HeatSupply(const scene::Scene& scene, const MacState<D>& s, const matter::Melting& melting, Conduction<D>& conduction);
    /// Where cells stay what they are: a heater must have some of fluid.
    void refuse_heaters_without_fluid(const scene::Scene& scene, const MacState<D>& s) const;

    /// What is under the hand goes towards the enthalpy of its temperature; `enthalpy` is that of the cells, and both outlive this.
    void follow(std::shared_ptr<Hand> hand, const matter::Melting& melting, const Grid<real, D>& enthalpy);

    /// q [W/m³] in the cells of fluid from t to t + dt, empty where nothing ever gives any; and `conduction` is told how warm it is
    /// outside, in the middle of that time. A heater gives its power to the cells of fluid that it covers; where it covers none, it gives
    /// nothing.
    const Grid<real, D>& at(real t, real dt, const MacState<D>& s, Conduction<D>& conduction);
    /// No step should cross the moment at which a heater is switched, or a keyframe [s].
    real to_next_change(real t) const;
    const matter::Ambient& ambient() const { return ambient_; }
    std::size_t bytes() const;

private:
    struct Heater {
        real start, end, power;  // [s], [s], [W; in 2D a metre]
        std::vector<std::size_t> cells;
    };
    struct Flux {
        int axis, end;
        real density;  // [W/m²]
    };
    void read_side(const scene::Scene& scene, const MacState<D>& s, const matter::Melting& melting, Conduction<D>& conduction, int a,
                   int end);
    void heat_by_hand(real t, real dt, const MacState<D>& s);
    void read_heater(const scene::Scene& scene, const MacState<D>& s, std::size_t i);

    matter::Ambient ambient_;
    std::vector<Heater> heaters_;
    std::vector<Flux> fluxes_;
    std::vector<std::array<int, 2>> exchanging_;  // axis, end
    Grid<real, D> source_;
    std::shared_ptr<Hand> hand_;  // none: nobody heats by hand
    const matter::Melting* melting_ = nullptr;
    const Grid<real, D>* enthalpy_ = nullptr;
};

}  // namespace weir::staggered
