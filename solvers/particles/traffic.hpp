// What ranks that share particles send: ranges of the sorted ones, as many to each (particles/shares.hpp).
#pragma once
#include "core/traffic.hpp"
#include "scene/scene.hpp"

namespace weir::particles {

/// Those of a plane of cells, which a neighbour reads: about, since what is liquid moves.
struct SharedParticles {
    std::size_t beside = 0;
};
SharedParticles shared_particles(const scene::Scene& scene, const RankOf& of, const StepShape& shape);

/// So many passes whose results neighbours read, of so many bytes a particle.
void tally_halos(const SharedParticles& particles, const RankOf& of, std::size_t bytes, std::int64_t times, Tally& tally);
/// What finding neighbours begins with: where each rank's particles are, how many go and are shown, and so many numbers of those shown.
void tally_migration(const SharedParticles& particles, const RankOf& of, int numbers, Tally& tally);
/// How the step went, at its end.
void tally_end(const RankOf& of, Tally& tally);
/// Keys whose messages the formulas of both methods do not know: these effects, probes.
std::vector<std::string> not_counted(const scene::Scene& scene, std::initializer_list<const char*> effects);

}  // namespace weir::particles
