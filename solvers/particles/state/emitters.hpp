// Emitters: particles enter layer by layer at the upstream end of a shape, one layer for each spacing that the flow has moved, so that the
// mass flow is rho0 times area times speed. Sinks: shapes in which particles are removed.
#pragma once
#include "particles/state/fluid.hpp"

#include <algorithm>

namespace weir::particles {

template <int D>
class Emitters {
public:
    Emitters() = default;
    /// From "emitters" and "sinks".
    Emitters(const scene::Scene& scene, const Domain<D>& domain);
    bool empty() const { return emitters_.empty() && sinks_.empty(); }
    /// Adds particles that enter in (time, time + dt], and removes those in sinks.
    void apply(Fluid<D>& fluid, real dt);
    /// add(x, u, enthalpy) for each particle that enters in (time, time + dt].
    template <class F>
    void emit(real time, real dt, F&& add);
    /// Number of particles that have entered until `time`.
    real entered(real time) const;
    const std::vector<geometry::ShapePtr<D>>& sinks() const { return sinks_; }
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);

private:
    struct Emitter {
        Vec<D> velocity{};
        real enthalpy = 0;  // specific enthalpy, where particles have heat [J/kg]
        real start = 0, end = infinity, period = infinity;
        std::vector<Vec<D>> sites;  // of one layer
    };
    std::vector<Emitter> emitters_;
    std::vector<geometry::ShapePtr<D>> sinks_;
    std::vector<std::int64_t> layers_;  // number of layers that each emitter has emitted
};

template <int D>
template <class F>
void Emitters<D>::emit(real time, real dt, F&& add) {
    for (std::size_t e = 0; e < emitters_.size(); ++e) {
        const Emitter& emitter = emitters_[e];
        for (;; ++layers_[e]) {
            const real born = emitter.start + static_cast<real>(layers_[e]) * emitter.period;
            if (born > emitter.end || born > time + dt) break;
            const real age = std::max<real>(0, time - born);  // layers due within a step are spread along the flow
            for (const auto& site : emitter.sites) add(site + age * emitter.velocity, emitter.velocity, emitter.enthalpy);
        }
    }
}

}  // namespace weir::particles
