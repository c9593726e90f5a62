#include "particles/ranks/traffic.hpp"

#include "geometry/liquid_fraction.hpp"
#include "geometry/sides.hpp"

#include <algorithm>
#include <cmath>

namespace weir::particles {

namespace {

/// Planes of the grid, one particle thick, with liquid at the start.
template <int D>
int wet_planes(const scene::Scene& scene) {
    constexpr int looks = 64;
    const int planes = scene.index<D>("grid.cells")[D - 1], count = std::min(planes, looks);
    int wet = 0;
    for (int k = 0; k < count; ++k) wet += geometry::liquid_fraction_of_plane<D>(scene, k * planes / count) > 0;
    return std::max(1, wet * planes / count);
}

}  // namespace

SharedParticles shared_particles(const scene::Scene& scene, const RankOf& of, const StepShape& shape) {
    const int planes = scene.dim() == 2 ? wet_planes<2>(scene) : wet_planes<3>(scene);
    const double beside = shape.particles * std::min(1.0, scene.number("scheme.support") / planes);
    const auto whole = [](double x) { return static_cast<std::size_t>(std::llround(x)); };
    return {whole(shape.beside > 0 ? shape.beside : std::min(beside, shape.particles / of.ranks))};
}

void tally_halos(const SharedParticles& particles, const RankOf& of, std::size_t bytes, std::int64_t times, Tally& tally) {
    const int peers = std::min(of.ranks - 1, of.rank > 0 && of.rank + 1 < of.ranks ? 2 : 1);
    tally.message(particles.beside * bytes, times * peers);
}

void tally_migration(const SharedParticles& particles, const RankOf& of, int numbers, Tally& tally) {
    const auto ranks = static_cast<std::size_t>(of.ranks);
    constexpr std::size_t box_and_count = 7 * sizeof(real), going_and_shown = 2 * sizeof(int);
    tally.everywhere(box_and_count, 1, box_and_count * ranks);
    tally.everywhere(going_and_shown * ranks, 1, going_and_shown * ranks * ranks);
    tally_halos(particles, of, static_cast<std::size_t>(numbers) * sizeof(real), 1, tally);
}

void tally_end(const RankOf& of, Tally& tally) {
    constexpr std::size_t told = 80;  // compression's sum and maximum, boundary corrections, speed, pace, acceleration, failed quantity
    tally.everywhere(told, 1, told * static_cast<std::size_t>(of.ranks));
}

std::vector<std::string> not_counted(const scene::Scene& scene, std::initializer_list<const char*> effects) {
    std::vector<std::string> keys;
    for (const char* effect : effects)
        if (scene.effect(effect)) keys.push_back(std::string("effects.") + effect);
    if (scene.has("probes") && !scene.root().tables("probes").empty()) keys.emplace_back("probes");
    return keys;
}

}  // namespace weir::particles
