// What an effect on particles sees: the state, and after the positions are final the pairs. Forces act before the prediction (v += dt f);
// XSPH and vorticity confinement after it.
#pragma once
#include "core/effects.hpp"
#include "particles/fluid.hpp"
#include "particles/pairs.hpp"

#include <vector>

namespace weir::particles {

template <int D>
struct Flow {
    Fluid<D>& fluid;
    Pairs& pairs;
    const single::PbfParams& params;
    std::vector<float> velocity, change;  // float4 of sorted particles, scratch of the finish effects
    int kernel = 0;                       // of the passes: Müller's, cubic, Wendland

    /// Over ranks, the velocities of particles that this one reads.
    void share_velocity();
    /// Velocities as the passes read them, images included.
    void load_velocity();
    FinishPass pass(const std::vector<float>& values, std::vector<float>& to);
    /// v += factor * change.
    void add_change(real factor);
    std::size_t bytes() const { return (velocity.capacity() + change.capacity()) * sizeof(float); }
};

/// What every particle method can be asked for (effects.cpp).
std::vector<scene::Variant> effect_schemas();
template <int D>
void add_effects(const scene::Scene& scene, Effects<Flow<D>>& effects);

/// initial.velocity: constant, strain, rotation.
scene::Key initial_key();
/// "sinks": shapes that take particles out.
scene::Key sinks_key();
template <int D>
void set_initial_velocity(const scene::Scene& scene, Fluid<D>& fluid);
/// The scene's liquid with its initial velocity.
template <int D>
Fluid<D> initial_fluid(const scene::Scene& scene);

}  // namespace weir::particles
