// What each effect of each solver costs: the same step with it and without it, taken in turns.
#pragma once
#include "sim/registry.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace weir::validation {

struct EffectCost {
    std::string solver;
    int dim = 2;
    int cells = 0;  // along each axis
    std::string effect;
    std::string inside{};  // the pass of which it is a term; empty: it is a pass of its own
    double ms_without = 0, ms_with = 0;
    double ratio = 1;   // median over pairs of steps taken one after the other
    double spread = 0;  // of that ratio: half the distance of its quartiles
    std::size_t bytes_without = 0, bytes_with = 0;
    std::vector<std::string> fields{};  // that it asks for
    std::string failure{};
};

struct EffectCostOptions {
    int cells_2d = 64, cells_3d = 24;
    int pairs = 21;             // of steps
    double enough_seconds = 1;  // for one effect; at least five pairs are taken
    std::string solver{};       // only this one
};

/// Every effect of every solver in the registry, in its scene of effect_scene.hpp, all at one time step.
std::vector<EffectCost> measure_effects(const std::vector<scene::SolverKind>& kinds, const EffectCostOptions& options,
                                        const std::function<void(const std::string&)>& progress = nullptr);

std::string effects_csv(const std::vector<EffectCost>& list);
std::string effects_markdown(const std::vector<EffectCost>& list, const std::string& machine);
/// `weir cost --effects`: measures, prints, writes effects.csv and effects.md into each folder.
int effects_command(const EffectCostOptions& options, const std::vector<std::filesystem::path>& folders, bool quiet);

}  // namespace weir::validation
