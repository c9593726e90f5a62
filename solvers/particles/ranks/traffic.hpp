// Estimate of what ranks with distributed particles send: equal ranges of the sorted particles (particles/ranks/shares.hpp).
#pragma once
#include "parallel/traffic.hpp"
#include "scene/scene.hpp"

namespace weir::particles {

/// The particles of a plane of cells, which a neighbour reads: approximate, since the liquid moves.
struct SharedParticles {
    std::size_t beside = 0;
};
SharedParticles shared_particles(const scene::Scene& scene, const RankOf& of, const StepShape& shape);

/// Counts `times` halo exchanges of `bytes` per particle.
void tally_halos(const SharedParticles& particles, const RankOf& of, std::size_t bytes, std::int64_t times, Tally& tally);
/// Counts the messages before a neighbour search: ranks of particles, numbers of migrating and ghost particles, and `numbers` values of
/// ghost particles.
void tally_migration(const SharedParticles& particles, const RankOf& of, int numbers, Tally& tally);
/// Counts the collective check at the end of a step.
void tally_end(const RankOf& of, Tally& tally);
/// Keys whose messages the estimates of both methods do not include: these effects, probes.
std::vector<std::string> not_counted(const scene::Scene& scene, std::initializer_list<const char*> effects);

}  // namespace weir::particles
