// A particle solver with the whole step on a device (device_fluid.hpp).
#pragma once
#include "particles/opencl/device_bodies.hpp"
#include "particles/opencl/device_fluid.hpp"
#include "particles/state/scheme.hpp"
#include "particles/state/solver.hpp"

namespace weir::particles {

template <int D>
class DeviceSolver : public ParticleSolver<D> {
public:
    bool checks_itself() const final { return true; }
    std::string concern() const final { return this->heat_ ? this->heat_->concern() : std::string(); }
    real time() const final { return fluid_.time(); }
    std::size_t bytes() const final { return fluid_.bytes() + (this->bodies_ ? this->bodies_->bytes() + beside_->bytes() : 0); }
    std::vector<EffectPlan> effects() const final { return fluid_.effects(); }
    Fluid<D>& fluid() { return fluid_.change(); }
    const DeviceFluid<D>& on_device() const { return fluid_; }

protected:
    using Memory = backend::Memory;
    using Reduced = typename DeviceFluid<D>::Reduced;
    DeviceSolver(const Scheme& scheme, const Fluid<D>& start, const DeviceEffects<D>& effects, const DeviceSetup& own)
        : fluid_(start, effects, with_scheme(own, scheme, start.domain)) {
        this->heat_ = effects.heat;
        if (this->heat_) this->heat_->count_frozen(start);
        this->bodies_ = BodiesInLiquid<D>::make(fluid_.setting());
        if (this->bodies_)
            beside_ = std::make_unique<BodiesOnDevice<D>>(fluid_, *this->bodies_, wall_params<plain::WallParams>(scheme, fluid_.domain()));
    }
    const Fluid<D>& state() const final { return fluid_.host(); }
    const Fluid<D>& setting() const final { return fluid_.setting(); }
    Fluid<D>& writable() final { return fluid_.change(); }
    /// Including bodies.
    real speed() const final { return this->bodies_ ? std::max(fluid_.speed(), this->bodies_->speed()) : fluid_.speed(); }
    /// The same, after a step.
    real find_speed() { return fluid_.max_speed(), speed(); }
    Pairs::NeighbourCounts neighbour_counts() const final { return fluid_.neighbour_counts(); }
    real max_dt() const final { return fluid_.max_dt(); }
    void save_state(Checkpoint& to) const final { fluid_.save(to); }
    void restore_state(const Checkpoint& from) final {
        fluid_.restore(from);
        if (this->bodies_) this->bodies_->restore(from, fluid_.domain());
    }

    void conduct(real dt) final {
        if (this->heat_) fluid_.conduct(*this->heat_, dt);
    }

    DeviceFluid<D> fluid_;
    std::unique_ptr<BodiesOnDevice<D>> beside_;  // where the scene has bodies
};

}  // namespace weir::particles
