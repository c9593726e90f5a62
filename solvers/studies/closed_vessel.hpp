// Solver "closed_vessel": water and its vapour in a rigid vessel, with one temperature and without flow. The gas has one pressure,
// determined by its mass, temperature and volume; liquid evaporates or vapour condenses until that is the saturation pressure:
//     dm_v/dt = K (p_sat(T) − p),   dU/dt = G (T_outside − T),   U = m_l u_l(T) + m_v u_v(T),   V_v = V − m_l/ρ_l(T).
// At constant volume evaporation takes u_v − u_l, less than the heat of evaporation, since there is no work of expansion: T follows from U.
// The cells of the grid are the vessel, filled up to the liquid's level.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"
#include "thermo/ambient.hpp"
#include "thermo/substance.hpp"

namespace weir::studies {

class ClosedVessel final : public Solver {
public:
    explicit ClosedVessel(const scene::Scene& scene);
    static std::vector<scene::Key> keys();

    StepReport step(real dt) override;
    real advised_dt() const override;
    FieldSet fields() const override;
    std::vector<Integral> integrals() const override;
    real time() const override { return time_; }
    void save(Checkpoint& to) const override;
    void restore(const Checkpoint& from) override;
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return (temperature_.size() + liquid_.size()) * sizeof(real); }

private:
    real liquid_mass() const { return mass_ - vapour_; }
    real gas_volume(real T) const;
    real energy(real T) const;
    void find_temperature();
    real pressure_of_gas() const;
    real fastest() const;
    void show();

    thermo::SubstancePtr water_;
    thermo::Ambient ambient_;
    GridView grid_;
    real volume_, mass_, transfer_, exchange_;  // [m³], [kg], K [kg/(s Pa)], G [W/K]
    real vapour_ = 0, T_ = 0, U_ = 0, p_ = 0;   // [kg], [K], [J], [Pa]
    real added_ = 0;                            // since the start [J]
    real time_ = 0;
    std::vector<real> temperature_, liquid_;
    Passes passes_;
};

}  // namespace weir::studies
