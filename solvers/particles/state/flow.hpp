// The interface between effects and particles: the state, and the pairs once positions are final. Forces act before the prediction (v += dt
// f); XSPH and vorticity confinement after it.
#pragma once
#include "core/effects.hpp"
#include "particles/state/fluid.hpp"
#include "particles/threads/pairs.hpp"

#include <vector>

namespace weir::particles {

template <int D>
struct Flow {
    Fluid<D>& fluid;
    Pairs& pairs;
    const single::PbfParams& params;
    std::vector<float> velocity, change;  // float4 of sorted particles, scratch of the velocity effects
    int kernel = 0;                       // of the passes: Müller's, cubic, Wendland

    /// In parallel, fills the velocities of ghost particles.
    void share_velocity();
    /// Velocities in the layout of the passes, including images.
    void load_velocity();
    FinishPass pass(const std::vector<float>& values, std::vector<float>& to);
    /// v += factor * change.
    void add_change(real factor);
    std::size_t bytes() const { return (velocity.capacity() + change.capacity()) * sizeof(float); }
};

/// The effects of every particle method (effects.cpp).
std::vector<scene::Variant> effect_schemas();
template <int D>
void add_effects(const scene::Scene& scene, Effects<Flow<D>>& effects);

/// initial.velocity: constant, strain, rotation.
scene::Key initial_key();
/// "sinks": shapes in which particles are removed.
scene::Key sinks_key();
template <int D>
void set_initial_velocity(const scene::Scene& scene, Fluid<D>& fluid);
/// The scene's liquid with its initial velocity.
template <int D>
Fluid<D> initial_fluid(const scene::Scene& scene);

}  // namespace weir::particles
