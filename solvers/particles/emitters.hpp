// Emitters: particles enter layer by layer at the upstream end of a shape, one layer each time the flow has moved by the spacing, so that
// the mass flow is rho0 times area times speed. Sinks: shapes that take particles out.
#pragma once
#include "particles/fluid.hpp"

namespace weir::particles {

template <int D>
class Emitters {
public:
    Emitters() = default;
    /// From "emitters" and "sinks".
    Emitters(const scene::Scene& scene, const Domain<D>& domain);
    bool empty() const { return emitters_.empty() && sinks_.empty(); }
    /// Everything that enters in (time, time + dt], and everything that has reached a sink.
    void apply(Fluid<D>& fluid, real dt);
    void save(Checkpoint& to) const;
    void restore(const Checkpoint& from);

private:
    struct Emitter {
        Vec<D> velocity{};
        real start = 0, end = infinity, period = infinity;
        std::vector<Vec<D>> sites;  // of one layer
    };
    std::vector<Emitter> emitters_;
    std::vector<geometry::ShapePtr<D>> sinks_;
    std::vector<std::int64_t> layers_;  // that each emitter has let in
};

}  // namespace weir::particles
