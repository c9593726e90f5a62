// Heat sources of the fluid on a grid: heaters with a power, walls with a flux, walls with heat transfer to the surroundings.
#pragma once
#include "core/brush.hpp"
#include "mac/grid/state.hpp"
#include "mac/heat/conduction.hpp"
#include "thermo/ambient.hpp"

#include <memory>

namespace weir::mac {

template <int D>
class HeatSupply {
public:
    HeatSupply() = default;
    /// Rejects invalid sides and heaters. Sets the sides with heat transfer in `conduction`.
    HeatSupply(const scene::Scene& scene, const MacState<D>& s, const thermo::Melting& melting, Conduction<D>& conduction);
    /// For static cells: a heater must cover some fluid.
    void refuse_heaters_without_fluid(const scene::Scene& scene, const MacState<D>& s) const;

    /// Interactive heating: the enthalpy under the brush relaxes to that of its temperature. `enthalpy` is the cells'; both arguments must
    /// outlive this object.
    void follow(std::shared_ptr<BrushForcing> forcing, const thermo::Melting& melting, const Grid<real, D>& enthalpy);

    /// q [W/m³] in fluid cells from t to t + dt, empty where the scene has no source. Sets the outside temperature of `conduction`, at the
    /// middle of that time. A heater's power is shared by the fluid cells that it covers; if there are none, it adds no heat.
    const Grid<real, D>& at(real t, real dt, const MacState<D>& s, Conduction<D>& conduction);
    /// Time to the next switching of a heater or keyframe [s]; no step should cross it.
    real to_next_change(real t) const;
    const thermo::Ambient& ambient() const { return ambient_; }
    std::size_t bytes() const;

private:
    struct Heater {
        real start, end, power;  // [s], [s], [W; in 2D per metre of depth]
        std::vector<std::size_t> cells;
    };
    struct Flux {
        int axis, end;
        real density;  // [W/m²]
    };
    void read_side(const scene::Scene& scene, const MacState<D>& s, const thermo::Melting& melting, Conduction<D>& conduction, int a,
                   int end);
    void heat_with_brush(real t, real dt, const MacState<D>& s);
    void read_heater(const scene::Scene& scene, const MacState<D>& s, std::size_t i);

    thermo::Ambient ambient_;
    std::vector<Heater> heaters_;
    std::vector<Flux> fluxes_;
    std::vector<std::array<int, 2>> exchanging_;  // axis, end
    Grid<real, D> source_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr: no interactive heating
    const thermo::Melting* melting_ = nullptr;
    const Grid<real, D>* enthalpy_ = nullptr;
};

}  // namespace weir::mac
