// The common base of particle solvers, for any method and backend: output, integrals, checkpoints. A backend (threaded_solver.hpp,
// reference_solver.hpp, device_solver.hpp) stores the particles; a method (pbf, sph) defines the step and its additions. None of these
// virtual calls is per particle.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "particles/heat/heat.hpp"
#include "particles/heat/ice.hpp"
#include "particles/state/emitters.hpp"
#include "particles/state/fluid.hpp"

namespace weir::particles {

/// Relative density excess of particles over rest [1].
struct Compression {
    real mean = 0, worst = 0;
};
inline Compression compression_of(const SumAndMost& excess, int count) {
    return count > 0 ? Compression{excess.sum() / count, excess.most} : Compression{};
}
/// From the densities of the last step; vapour: gives the rest densities of boiling particles.
template <int D>
SumAndMost excess_of(const Fluid<D>& fluid, real rest_density, const Vapour<D>* vapour = nullptr);
template <int D>
Compression compression_of(const Fluid<D>& fluid, real rest_density, const Vapour<D>* vapour = nullptr);

template <int D>
class ParticleSolver : public Solver {
public:
    static constexpr int dim = D;

    FieldSet fields() const final;
    std::vector<Integral> integrals() const final;
    void save(Checkpoint& to) const final;
    void restore(const Checkpoint& from) final;
    const Passes& passes() const final { return passes_; }
    Passes& passes() final { return passes_; }
    std::vector<EditableField> editable() final;
    void edited(const EditableField& field) final;
    bool add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) final;
    bool remove_particles(std::string_view set, std::span<const unsigned char> gone) final;
    /// Bodies in the liquid; nullptr where the scene has none.
    const BodiesInLiquid<D>* carried() const { return bodies_.get(); }

protected:
    // implemented by backends
    /// The current state, and the part that is available without downloading particles (its box, its constants).
    virtual const Fluid<D>& state() const = 0;
    virtual const Fluid<D>& setting() const = 0;
    /// The state for writing between two steps; after written() derived data are valid again.
    virtual Fluid<D>& writable() = 0;
    virtual void written() {}
    /// Maximum speed of the particles [m/s].
    virtual real speed() const = 0;
    virtual Pairs::NeighbourCounts neighbour_counts() const = 0;
    /// The largest step advised by its effects [s].
    virtual real max_dt() const { return infinity; }
    virtual void save_state(Checkpoint& to) const = 0;
    virtual void restore_state(const Checkpoint& from) = 0;

    // implemented by methods
    virtual const char* method() const = 0;
    virtual void show(const Fluid<D>&, FieldSet&) const {}
    virtual void sum_up(std::vector<Integral>&) const {}
    virtual void save_more(Checkpoint& to) const = 0;
    virtual void restore_more(const Checkpoint& from) = 0;
    /// The stability limit and warnings for this maximum speed; NaN before the first step.
    virtual StepLimit stable_at(real speed) const = 0;
    virtual std::string concern_at(real) const { return {}; }

    /// Conduction over dt [s], heaters and walls: where the scene names a substance.
    virtual void conduct(real dt) = 0;

    /// nullptr: no boiling.
    Vapour<D>* vapour() const { return heat_ ? heat_->vapour() : nullptr; }

    Passes passes_;
    mutable bool in_parts_ = false;              // whether state() is this rank's part of the output
    std::shared_ptr<Heat<D>> heat_;              // where the scene names a substance
    std::unique_ptr<Ice<D>> ice_;                // where frozen pieces move
    std::shared_ptr<BodiesInLiquid<D>> bodies_;  // where the scene has bodies
};

/// A particle solver whose state is in host memory.
template <int D>
class HostSolver : public ParticleSolver<D> {
public:
    StepLimit stable_dt() const final {
        return this->stable_at(fluid_.shared && std::isnan(speed_) ? speed() : speed_);  // over all ranks
    }
    std::string concern() const final {
        const std::string concern = this->concern_at(speed_);
        return concern.empty() && this->heat_ ? this->heat_->concern() : concern;
    }
    real time() const final { return fluid_.time; }
    Fluid<D>& fluid() { return fluid_; }
    std::unique_ptr<Solver::DistributedView> distributed_view() const final;
    bool checks_itself() const final { return fluid_.shared; }
    BrushForcing* brush() const final { return brush_forcing_.get(); }

protected:
    explicit HostSolver(Fluid<D>&& start) : fluid_(std::move(start)) { this->bodies_ = BodiesInLiquid<D>::make(fluid_); }
    const Fluid<D>& state() const final { return fluid_.shared ? whole() : fluid_; }
    const Fluid<D>& setting() const final { return fluid_; }
    Fluid<D>& writable() final { return fluid_; }
    void written() final { speed_ = speed(); }
    /// Including bodies.
    real speed() const override {
        const real fastest = fluid_.max_speed();
        return this->bodies_ ? std::max(fastest, this->bodies_->speed()) : fastest;
    }
    void save_state(Checkpoint& to) const final;
    void restore_state(const Checkpoint& from) final;
    void take_heat(const scene::Scene& scene);
    /// Frozen particles get zero velocity, or that of their piece, which is found here; other changes of their velocities are discarded.
    void stop_frozen();
    /// The same where no particle has melted or frozen since.
    void stop_frozen_again();
    /// Returns whether particle i of the state is frozen and fixed, if stop_frozen() found any.
    bool held(int i) const {
        if (!this->heat_ || this->heat_->frozen() == 0) return false;
        return this->ice_ ? this->ice_->fixed(i) : this->heat_->frozen(fluid_.enthalpy[static_cast<std::size_t>(i)]);
    }
    /// Returns whether pieces of ice move in this step.
    bool ice_moves() const { return this->ice_ && this->heat_->frozen() > 0; }
    /// The rest density of particle i relative to the liquid's where frozen pieces move; otherwise 1.
    real ice_rest(int i) const { return this->ice_ ? this->heat_->rest(fluid_.enthalpy[static_cast<std::size_t>(i)]) : 1; }

    /// With distributed particles: those of all ranks, in the order of one process.
    const Fluid<D>& whole() const;
    /// A step begins: releases the gathered copy.
    void forget_whole() { whole_.reset(); }

    Fluid<D> fluid_;
    Emitters<D> emitters_;
    std::shared_ptr<BrushForcing> brush_forcing_;  // nullptr where the scene has none
    real speed_ = not_applicable;                  // maximum of particles and bodies after the last step; unknown before the first [m/s]

private:
    class DistributedView;
    mutable std::unique_ptr<Fluid<D>> whole_;  // as long as it is in use
};

}  // namespace weir::particles
