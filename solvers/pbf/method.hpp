// The part of Position Based Fluids common to all backends: options, advised and stable steps, relaxation of the initial state, additions
// to integrals and checkpoints. The step itself: solver.cpp, reference_solver.cpp, device_solver.cpp.
#pragma once
#include "particles/boundaries/squeezed.hpp"
#include "particles/state/solver.hpp"
#include "pbf/options.hpp"

#include <algorithm>
#include <utility>

namespace weir::pbf {

using particles::Compression;

/// Relaxation of the initial state: iterations between neighbour searches. It ends when the compression of the densest particle is a tenth
/// of what a step leaves.
inline constexpr int settle_between_lists = 5;
inline constexpr real settle_good_enough = 1e-3;

/// Backend: particles::ThreadedSolver<D>, ReferenceSolver<D, ...> or DeviceSolver<D>.
template <class Backend>
class Pbf : public Backend {
public:
    real advised_dt() const final { return std::min(step_, this->max_dt()); }
    const Options& options() const { return options_; }

protected:
    template <class... Arguments>
    explicit Pbf(const Options& options, Arguments&&... arguments)
        : Backend(options, std::forward<Arguments>(arguments)...), options_(options) {}

    const char* method() const final { return "pbf"; }
    StepLimit stable_at(real speed) const final { return stable_step(options_, this->setting(), speed); }
    void sum_up(std::vector<Integral>& list) const final {
        const Compression c = compression();
        list.push_back({"mean_compression", "1", c.mean});
        list.push_back({"max_compression", "1", c.worst});
    }
    void save_more(Checkpoint& to) const final { to.put_value("pbf.last_dt", last_dt_); }
    void restore_more(const Checkpoint& from) final { last_dt_ = from.get_value<real>("pbf.last_dt"); }

    int most_iterations() const { return options_.tolerance > 0 ? options_.max_iterations : options_.iterations; }
    StepReport report(real dt, real speed, int iterations, const Compression& c) const {
        particles::require_room(this->setting(), c.mean);
        return {.dt = dt,
                .cfl = dt * speed / this->setting().domain.spacing,
                .iterations = iterations,
                .density_error = c.mean,
                .max_density_error = c.worst};
    }
    void settle();

    // implemented by the backend's step
    virtual Compression compression() const = 0;
    /// Compression of the densest particle.
    virtual real worst_compression() { return compression().worst; }
    /// x* = x, and the pairs there.
    virtual void predict_at_rest() = 0;
    /// One iteration with zero initial multipliers.
    virtual void iterate_afresh() = 0;
    virtual void update(real dt, real slow) = 0;

    Options options_;
    real step_ = infinity;  // advised [s]
    real last_dt_ = 0;      // [s]
};

/// Removes the density error of the initial lattice (a few per cent at walls) by moving positions only. In the first step it would become
/// velocity, error / dt, the larger the better that step is solved. Stabilisation of Macklin et al. 2014, section 4.4.
template <class Backend>
void Pbf<Backend>::settle() {
    for (int i = 0; i < options_.settle; ++i) {
        if (i % settle_between_lists == 0) {
            if (i > 0 && worst_compression() <= settle_good_enough) break;
            predict_at_rest();
        }
        iterate_afresh();
        if ((i + 1) % settle_between_lists == 0 || i + 1 == options_.settle) update(0, 0);
    }
}

}  // namespace weir::pbf
