// Interactive forcing of particles: pushes those under the brush, fills empty space with particles at the rest spacing, or removes them.
#pragma once
#include "geometry/hand.hpp"
#include "particles/flow.hpp"
#include "particles/heat.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace weir::particles {

template <int D>
class HandOnParticles final : public Effect<Flow<D>> {
public:
    explicit HandOnParticles(std::shared_ptr<Hand> hand) : hand_(std::move(hand)) {}
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override;
    std::size_t bytes() const override { return taken_.capacity(); }
    /// Adds and removes particles in the step that begins now: before the neighbour search.
    void pour_and_drain(Fluid<D>& fluid);
    /// Heats particles in that step; returns the heat added [J].
    real warm(Fluid<D>& fluid, const Heat<D>& heat, real dt);

private:
    void pour(Fluid<D>& fluid, const Brush<D>& brush);
    void drain(Fluid<D>& fluid, const Brush<D>& brush);
    void mark_taken(const Fluid<D>& fluid, const Index<D>& lo, const Index<D>& extent);
    void account(const Vec<D>& u, real mass);

    std::shared_ptr<Hand> hand_;
    Brush<D> brush_;                   // of the present step
    std::vector<std::uint8_t> taken_;  // lattice sites in the brush's box without free space
};

}  // namespace weir::particles
