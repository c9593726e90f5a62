// The hand on particles: it pushes those that it covers, fills what is empty in its brush with particles a spacing apart, or takes them
// out.
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
    /// What it adds and takes in the step that begins now: before the neighbours are found.
    void pour_and_drain(Fluid<D>& fluid);
    /// What it heats in that step; the heat that it gives [J].
    real warm(Fluid<D>& fluid, const Heat<D>& heat, real dt);

private:
    void pour(Fluid<D>& fluid, const Brush<D>& brush);
    void drain(Fluid<D>& fluid, const Brush<D>& brush);
    void mark_taken(const Fluid<D>& fluid, const Index<D>& lo, const Index<D>& extent);
    void account(const Vec<D>& u, real mass);

    std::shared_ptr<Hand> hand_;
    Brush<D> brush_;                   // of the step that goes on
    std::vector<std::uint8_t> taken_;  // places of the lattice in the brush's box beside which there is no room
};

}  // namespace weir::particles
