// Boiling and condensation of particles. A particle whose enthalpy exceeds the liquid's end at its local pressure absorbs the latent heat
// while becoming vapour, and expands to the vapour's density; on cooling the process reverses. Enthalpy is the only variable: fractions,
// densities and temperatures follow from it and from the position (kernels/heat_state.inl, kernels/vapour.inl).
//     p = p(t) + rho0 g d,   d: liquid volume above the particle over area, in its column of four spacings across
// that is the weight above it, of liquid or vapour, and the depth below the surface for a liquid at rest.
#pragma once
#include "particles/state/fluid.hpp"
#include "thermo/ambient.hpp"
#include "thermo/substance.hpp"

#include <string>
#include <vector>

namespace weir::particles {

#define WEIR_FN inline
#define WEIR_PARAM const
// clang-format off
#include "particles/kernels/heat_params.h"
#include "particles/kernels/heat_state.inl"
#include "particles/kernels/vapour_params.h"
#include "particles/kernels/vapour.inl"
// clang-format on
#undef WEIR_FN
#undef WEIR_PARAM

bool vapour_is_named(const scene::Scene& scene);
/// "heat.vapour"
scene::Key vapour_key();

template <int D>
class Vapour {
public:
    /// states: of the substance at the lowest pressure of the scene.
    Vapour(const scene::Scene& scene, const Domain<D>& domain, thermo::SubstancePtr substance, const HeatStates& states);

    /// Finds the depths of all particles and their rest densities; false: all are liquid at any depth.
    bool find(const Fluid<D>& fluid, const HeatStates& states);
    /// For particle i, as found: increase of the boiling enthalpy relative to zero depth [J/kg]; density relative to the liquid's.
    real shift(int i) const { return !boils_ ? 0 : shift_[static_cast<std::size_t>(i)]; }
    real rest(int i) const { return !boils_ ? 1 : rest_[static_cast<std::size_t>(i)]; }

    bool boils() const { return boils_; }

    const VapourParams& params() const { return params_; }
    /// Sets the pressure of time t; returns whether it varies with time.
    bool set_time(real t);
    /// Maximum over all depths and times [J/kg].
    real highest_shift() const { return highest_shift_; }
    int columns() const;
    int rows() const { return params_.cells[params_.axis]; }
    /// A warning where the vapour's density is not the physical one.
    const std::string& concern() const { return concern_; }
    std::size_t bytes() const {
        return (shift_.capacity() + rest_.capacity()) * sizeof(real) + (above_.capacity() + entry_.capacity()) * sizeof(int);
    }

private:
    void set_columns(const scene::Scene& scene, const Domain<D>& domain);
    void set_shifts(real pressure);

    VapourParams params_{};
    thermo::Ambient ambient_;
    thermo::SubstancePtr substance_;
    real per_c_ = 0;                 // of the liquid [kg K/J]
    real weight_ = 0, deepest_ = 0;  // rho0 g [Pa/m]; the height of the domain [m]
    real highest_shift_ = 0;
    std::string concern_;
    std::vector<real> shift_, rest_;
    std::vector<int> above_;  // number of particles above each row of each column
    std::vector<int> entry_;  // index of each particle in it
    bool boils_ = false;
};

}  // namespace weir::particles
