// What a particle solver is, whatever its method and wherever it runs: what it shows, sums up, keeps and restores. A backend
// (threaded_solver.hpp, reference_solver.hpp, device_solver.hpp) says where the particles are; a method (pbf, sph) says its step, and what
// it adds. No call of these is made for a particle.
#pragma once
#include "core/passes.hpp"
#include "core/solver.hpp"
#include "particles/bodies_in_liquid.hpp"
#include "particles/emitters.hpp"
#include "particles/fluid.hpp"
#include "particles/heat.hpp"
#include "particles/ice.hpp"

namespace weir::particles {

/// How much denser than at rest particles are [1].
struct Compression {
    real mean = 0, worst = 0;
};
inline Compression compression_of(const SumAndMost& excess, int count) {
    return count > 0 ? Compression{excess.sum() / count, excess.most} : Compression{};
}
/// Of the densities of the last step; vapour: what else particles are to have than the rest density.
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
    /// Bodies in the liquid; nullptr where the scene names none.
    const BodiesInLiquid<D>* carried() const { return bodies_.get(); }

protected:
    // A backend's part.
    /// The state as it is now, and as far as it is known without asking for particles (its box, its constants).
    virtual const Fluid<D>& state() const = 0;
    virtual const Fluid<D>& setting() const = 0;
    /// The state to be written between two steps; what follows from it is known again after written().
    virtual Fluid<D>& writable() = 0;
    virtual void written() {}
    /// Of the fastest particle [m/s].
    virtual real speed() const = 0;
    virtual Pairs::NeighbourCounts neighbour_counts() const = 0;
    /// The largest step that the effects which it applies advise [s].
    virtual real max_dt() const { return infinity; }
    virtual void save_state(Checkpoint& to) const = 0;
    virtual void restore_state(const Checkpoint& from) = 0;

    // A method's part.
    virtual const char* method() const = 0;
    virtual void show(const Fluid<D>&, FieldSet&) const {}
    virtual void sum_up(std::vector<Integral>&) const {}
    virtual void save_more(Checkpoint& to) const = 0;
    virtual void restore_more(const Checkpoint& from) = 0;
    /// What is stable, and what is wrong, where the fastest particle has this speed; not a number before the first step.
    virtual StepLimit stable_at(real speed) const = 0;
    virtual std::string concern_at(real) const { return {}; }

    /// Conduction over dt [s], heaters and walls: where the scene names a substance, else nothing.
    virtual void conduct(real dt) = 0;

    /// nullptr: nothing boils.
    Vapour<D>* vapour() const { return heat_ ? heat_->vapour() : nullptr; }

    Passes passes_;
    mutable bool in_parts_ = false;              // whether state() is this rank's part of what is shown
    std::shared_ptr<Heat<D>> heat_;              // where the scene names a substance
    std::unique_ptr<Ice<D>> ice_;                // where what is frozen moves
    std::shared_ptr<BodiesInLiquid<D>> bodies_;  // where it names bodies
};

/// A particle solver whose state is in the processor's memory.
template <int D>
class HostSolver : public ParticleSolver<D> {
public:
    StepLimit stable_dt() const final {
        return this->stable_at(fluid_.shared && std::isnan(speed_) ? speed() : speed_);  // of all ranks
    }
    std::string concern() const final {
        const std::string concern = this->concern_at(speed_);
        return concern.empty() && this->heat_ ? this->heat_->concern() : concern;
    }
    real time() const final { return fluid_.time; }
    Fluid<D>& fluid() { return fluid_; }
    std::unique_ptr<Solver::Brought> show_in_parts() const final;
    bool checks_itself() const final { return fluid_.shared; }
    Hand* hand() const final { return hand_.get(); }

protected:
    explicit HostSolver(Fluid<D>&& start) : fluid_(std::move(start)) { this->bodies_ = BodiesInLiquid<D>::make(fluid_); }
    const Fluid<D>& state() const final { return fluid_.shared ? whole() : fluid_; }
    const Fluid<D>& setting() const final { return fluid_; }
    Fluid<D>& writable() final { return fluid_; }
    void written() final { speed_ = speed(); }
    /// Of bodies too.
    real speed() const override {
        const real fastest = fluid_.max_speed();
        return this->bodies_ ? std::max(fastest, this->bodies_->speed()) : fastest;
    }
    void save_state(Checkpoint& to) const final;
    void restore_state(const Checkpoint& from) final;
    void take_heat(const scene::Scene& scene);
    /// Particles that are frozen do not move, or move with their pieces, which it finds: forgets what else was done to their velocities.
    void hold();
    /// The same where nothing has melted or frozen since.
    void hold_again();
    /// Whether particle i of the state is frozen and does not move, where hold() has found any.
    bool held(int i) const {
        if (!this->heat_ || this->heat_->frozen() == 0) return false;
        return this->ice_ ? this->ice_->fixed(i) : this->heat_->frozen(fluid_.enthalpy[static_cast<std::size_t>(i)]);
    }
    /// Whether pieces of ice move in this step.
    bool ice_moves() const { return this->ice_ && this->heat_->frozen() > 0; }
    /// The rest density of particle i over the liquid's where what is frozen moves; else 1.
    real ice_rest(int i) const { return this->ice_ ? this->heat_->rest(fluid_.enthalpy[static_cast<std::size_t>(i)]) : 1; }

    /// Over ranks that share particles: those of all, as one process has them.
    const Fluid<D>& whole() const;
    /// A step begins: nobody looks any more.
    void forget_whole() { whole_.reset(); }

    Fluid<D> fluid_;
    Emitters<D> emitters_;
    std::shared_ptr<Hand> hand_;   // none where the scene names none
    real speed_ = not_applicable;  // of the fastest particle or body after the last step; not known before the first [m/s]

private:
    class Brought;
    mutable std::unique_ptr<Fluid<D>> whole_;  // as long as somebody looks
};

}  // namespace weir::particles
