// Interactive forcing of particles: pushes those under the brush, fills empty space with particles at the rest spacing, or removes them.
#pragma once
#include "geometry/brush.hpp"
#include "particles/heat/heat.hpp"
#include "particles/state/flow.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace weir::particles {

template <int D>
class BrushOnParticles final : public Effect<Flow<D>> {
public:
    explicit BrushOnParticles(std::shared_ptr<BrushForcing> forcing) : brush_forcing_(std::move(forcing)) {}
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override;
    std::size_t bytes() const override { return taken_.capacity(); }
    /// Adds and removes particles in the step that begins now: before the neighbour search.
    void apply_sources_and_sinks(Fluid<D>& fluid);
    /// Heats particles in that step; returns the heat added [J].
    real warm(Fluid<D>& fluid, const Heat<D>& heat, real dt);

private:
    void pour(Fluid<D>& fluid, const Brush<D>& brush);
    void drain(Fluid<D>& fluid, const Brush<D>& brush);
    void mark_taken(const Fluid<D>& fluid, const Index<D>& lo, const Index<D>& extent);
    void account(const Vec<D>& u, real mass);

    std::shared_ptr<BrushForcing> brush_forcing_;
    Brush<D> brush_;                   // of the present step
    std::vector<std::uint8_t> taken_;  // lattice sites in the brush's box without free space
};

}  // namespace weir::particles
