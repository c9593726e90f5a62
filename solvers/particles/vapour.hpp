// Boiling and condensation of particles: one whose enthalpy is beyond the liquid's end at the pressure of its place takes the latent heat
// up in becoming vapour, and expands to the vapour's density; cooled, it goes back the same way. Enthalpy is all that is kept: shares,
// densities and temperatures follow from it and from the place (kernels/heat_state.inl, kernels/vapour.inl).
//     p = p(t) + rho0 g d,   d: liquid volume above the particle over area, in its column of four spacings across
// which is the weight above it, whether of liquid or vapour, and the depth below the surface of a liquid at rest.
#pragma once
#include "matter/ambient.hpp"
#include "particles/fluid.hpp"
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
    /// states: of the substance at the lowest pressure that the scene tells of.
    Vapour(const scene::Scene& scene, const Domain<D>& domain, thermo::SubstancePtr substance, const HeatStates& states);

    /// How deep every particle is, and what density it is to have; false: all are liquid at any depth, and nothing needs to know.
    bool find(const Fluid<D>& fluid, const HeatStates& states);
    /// Of particle i, as found: how much more enthalpy boiling takes than at no depth [J/kg]; its density over the liquid's.
    real shift(int i) const { return !boils_ ? 0 : shift_[static_cast<std::size_t>(i)]; }
    real rest(int i) const { return !boils_ ? 1 : rest_[static_cast<std::size_t>(i)]; }

    bool boils() const { return boils_; }

    const VapourParams& params() const { return params_; }
    /// To the pressure of that moment; whether it changes in the course of time.
    bool set_time(real t);
    /// The largest of all depths and times [J/kg].
    real highest_shift() const { return highest_shift_; }
    int columns() const;
    int rows() const { return params_.cells[params_.axis]; }
    /// That the vapour's density is not the physical one, where that is so.
    const std::string& concern() const { return concern_; }
    std::size_t bytes() const {
        return (shift_.capacity() + rest_.capacity()) * sizeof(real) + (above_.capacity() + entry_.capacity()) * sizeof(int);
    }

private:
    void set_columns(const scene::Scene& scene, const Domain<D>& domain);
    void set_shifts(real pressure);

    VapourParams params_{};
    matter::Ambient ambient_;
    thermo::SubstancePtr substance_;
    real per_c_ = 0;                 // of the liquid [kg K/J]
    real weight_ = 0, deepest_ = 0;  // rho0 g [Pa/m]; the height of the domain [m]
    real highest_shift_ = 0;
    std::string concern_;
    std::vector<real> shift_, rest_;
    std::vector<int> above_;  // particles above each row of each column
    std::vector<int> entry_;  // of each particle in it
    bool boils_ = false;
};

}  // namespace weir::particles
