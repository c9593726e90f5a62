// The part of smoothed particle hydrodynamics common to all backends: options, rest density and initial pressure, advised and stable steps,
// additions to fields and checkpoints. The step itself: solver.cpp, reference_solver.cpp, device_solver.cpp.
#pragma once
#include "particles/boundaries/squeezed.hpp"
#include "particles/state/solver.hpp"
#include "sph/options.hpp"
#include "sph/state.hpp"

#include <algorithm>
#include <utility>

namespace weir::sph {

using particles::Compression;

/// Backend: particles::ThreadedSolver<D>, ReferenceSolver<D, ...> or DeviceSolver<D>.
template <class Backend>
class Sph : public Backend {
public:
    real advised_dt() const final {
        return std::min({step_limit(options_, this->setting(), this->speed(), max_acceleration_), max_dt_, this->max_dt(),
                         tension_limit(options_, this->setting())});
    }
    const Options& options() const { return options_; }
    real rest_density() const { return rho_rest_; }

protected:
    template <class... Arguments>
    explicit Sph(const Options& options, Arguments&&... arguments)
        : Backend(options, std::forward<Arguments>(arguments)...),
          options_(options),
          rest_density_(this->setting().rho0),
          rho_rest_(this->setting().rho0) {}
    /// Settings of the scene besides the options.
    void start_from(const scene::Scene& scene, particles::Fluid<Backend::dim>& fluid) {
        rest_density_ = RestDensity(scene, fluid.rho0);
        max_dt_ = scene.root().number_or("time.max_dt", infinity);
        hint_ = start_pressure(scene, options_, fluid);
    }

    /// Rest density of particle i [kg/m^3].
    real rest_of(int i) const {
        if (this->vapour()) return rho_rest_ * this->vapour()->rest(i);
        const auto& heat = this->heat_;
        return heat && heat->free() ? rho_rest_ * heat->rest(this->setting().enthalpy[static_cast<std::size_t>(i)]) : rho_rest_;
    }

    const char* method() const final { return "sph"; }
    StepLimit stable_at(real speed) const final { return stable_step(options_, this->setting(), speed); }
    std::string concern_at(real speed) const final {
        std::string fast = too_fast(options_, speed, this->time());
        return fast.empty() ? hint_ : fast;
    }
    void show(const particles::Fluid<Backend::dim>& fluid, FieldSet& set) const final {
        set.fields.push_back({"pressure", "Pa", Where::particle, "particles", {std::span<const real>(fluid.carried)}});
    }
    void sum_up(std::vector<Integral>& list) const final {
        const auto& fluid = this->state();
        list.push_back({"elastic_energy", Backend::dim == 2 ? "J/m" : "J", particles::block_sum(fluid.count(), [&](int i) {
                            return fluid.mass * options_.elastic_energy(fluid.density[static_cast<std::size_t>(i)], rest_of(i));
                        })});
    }
    void save_more(Checkpoint& to) const final { to.put_value("sph.max_acceleration", max_acceleration_); }
    void restore_more(const Checkpoint& from) final { max_acceleration_ = from.get_value<real>("sph.max_acceleration"); }

    /// After the drift of particles: moves pieces of ice as bodies.
    void carry_ice(real dt) {
        if (!this->ice_moves()) return;
        this->ice_->advance_free(dt);
        this->ice_->finish_motion(this->fluid_, dt);
    }
    StepReport report(real dt, real speed, const Compression& c) const {
        particles::require_room(this->setting(), c.mean);
        return {.dt = dt,
                .cfl = dt * (speed + options_.sound) / this->setting().domain.spacing,
                .density_error = c.mean,
                .max_density_error = c.worst};
    }

    Options options_;
    RestDensity rest_density_;
    real rho_rest_ = 1;  // now [kg/m^3]
    real max_acceleration_ = 0, max_dt_ = infinity;
    std::string hint_;  // about the initial state
};

}  // namespace weir::sph
