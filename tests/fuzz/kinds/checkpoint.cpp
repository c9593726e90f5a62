#include "core/checkpoint.hpp"

#include "fuzz/scratch.hpp"
#include "fuzz/small.hpp"
#include "fuzz/targets.hpp"

#include <cstdint>
#include <new>

namespace {

/// FNV-1a, as parallel/checkpoint_file.cpp has it: a fuzzer would never find it.
std::string with_checksum(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325ull;
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    return std::string(bytes) + std::string(reinterpret_cast<const char*>(&hash), sizeof hash);
}

}  // namespace

bool weir::fuzz::checkpoint(std::string_view bytes) {
    try {
        const Checkpoint checkpoint = Checkpoint::read(written("checkpoint.weir", with_checksum(bytes)));
        scene::Scene scene = scene_of(checkpoint);
        require_small(scene);
        Simulation simulation(std::move(scene));
        simulation.restore(checkpoint);
        simulation.step();
        simulation.step();
        return true;
    } catch (const BadInput&) {
        return false;
    } catch (const NumericalFailure&) {
        return false;
    }
}
