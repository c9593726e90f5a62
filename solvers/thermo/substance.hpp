// Properties of a substance at temperature T and pressure p: its state, phase boundaries, densities and heats. Phase boundaries obey the
// Clapeyron equation, dp/dT = L / (T Δv), which gives latent heats from slopes and densities, or slopes from latent heats.
#pragma once
#include "core/types.hpp"
#include "thermo/heat_curve.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace weir::thermo {

struct Point {
    real T = 0, p = 0;  // [K], [Pa]
};

/// A phase boundary: solid-vapour, solid-liquid, liquid-vapour.
enum class Boundary { sublimation, melting, saturation };
const char* name_of(Boundary boundary);

/// Constants of one state.
struct Conduction {
    real heat_capacity = 0;  // at constant pressure [J/(kg K)]
    real conductivity = 0;   // [W/(m K)]
};

class Substance {
public:
    virtual ~Substance() = default;
    virtual const char* name() const = 0;

    /// The triple point, and the critical point; nullopt where the substance has none.
    virtual std::optional<Point> triple() const { return {}; }
    virtual std::optional<Point> critical() const { return {}; }
    /// Limits of the formulas; beyond, state() and heat_curve() throw BadInput, which names the limit.
    virtual Point lowest() const { return {}; }
    virtual Point highest() const { return {infinity, infinity}; }

    virtual bool has(Boundary boundary) const = 0;
    /// The temperature range of the phase boundary [K].
    virtual std::pair<real, real> ends(Boundary boundary) const = 0;
    virtual real pressure(Boundary boundary, real T) const = 0;  // [Pa]
    virtual real slope(Boundary boundary, real T) const = 0;     // dp/dT [Pa/K]
    /// The inverse of pressure(), to round-off. Throws BadInput where the boundary does not reach p.
    virtual real temperature(Boundary boundary, real p) const;

    /// Density [kg/m^3]: for a liquid that of saturation at T, for a vapour at its own pressure.
    virtual real density(State state, const Point& at) const = 0;
    /// Densities of the two states on a phase boundary, the one without and the one with the latent heat [kg/m^3].
    virtual real colder_density(Boundary boundary, real T) const;
    virtual real warmer_density(Boundary boundary, real T) const;
    /// L = T dp/dT (1/ρ_warmer − 1/ρ_colder) [J/kg]
    virtual real latent_heat(Boundary boundary, real T) const;

    virtual Conduction conduction(State state) const = 0;
    /// Of the liquid (or the gas) at constant pressure, −(1/ρ) ∂ρ/∂T [1/K].
    virtual real expansion(real T) const = 0;

    /// On a phase boundary the state is the warmer one. Above the critical pressure the liquid ends at the critical temperature; above that
    /// temperature and below that pressure there is vapour.
    virtual State state(const Point& at) const;
    /// Enthalpy and temperature at one pressure. The enthalpy is zero for the liquid at the triple point (otherwise at boiling, otherwise
    /// for the gas at 0 K).
    virtual HeatCurve heat_curve(real p) const;

protected:
    void check_range(const Point& at) const;
};

using SubstancePtr = std::shared_ptr<const Substance>;

/// Water by the IAPWS formulas: SR1-86(1992) saturation, R14-08(2011) sublimation and melting (water.cpp has the equations).
SubstancePtr water();

/// Water at the equilibrium of liquid and vapour, with enthalpies: the energy in a closed vessel is u = h − p/ρ.
struct Saturation {
    real p, dpdT;                           // [Pa], [Pa/K]
    real liquid_density, vapour_density;    // [kg/m^3]
    real liquid_enthalpy, vapour_enthalpy;  // relative to zero internal energy of the liquid at the triple point [J/kg]
};
Saturation water_at_saturation(real T);

/// A substance defined by constants. The saturation curve passes through both points by the Clausius-Clapeyron equation with constant
/// latent heat and ideal vapour, ln(p/p₃) = (L/R) (1/T₃ − 1/T), which defines the gas constant. Sublimation has the same R. Melting is p −
/// p₃ = (L/Δv) ln(T/T₃), vertical for equal densities of solid and liquid.
struct Constants {
    Point triple, critical;
    real fusion = 0, vaporisation = 0;           // latent heats [J/kg]
    real solid_density = 0, liquid_density = 0;  // [kg/m^3]
    Conduction solid, liquid, vapour;
    real expansion = 0;  // of the liquid [1/K]
};
/// An invalid constant: its name ("triple", "critical", "fusion") and the problem.
struct Fault {
    std::string constant, message;
};
std::vector<Fault> faults(const Constants& constants);
/// Throws BadInput with the first fault.
SubstancePtr of_constants(const Constants& constants);

/// The ideal gas p = ρ R T.
SubstancePtr ideal_gas(real gas_constant, const Conduction& vapour);

/// The van der Waals fluid p = ρ R T / (1 − b ρ) − a ρ² with the given critical point; boiling by Maxwell's rule of equal areas.
SubstancePtr van_der_waals(real gas_constant, const Point& critical, const Conduction& liquid, const Conduction& vapour);

}  // namespace weir::thermo
