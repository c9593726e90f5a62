// Work of a step that every rank of a parallel run repeats.
#pragma once
#include <string>
#include <vector>

namespace weir::scene {

enum class ReplicatedWork {
    everything,             // the domain cannot be partitioned
    surface_row,            // the only row of the surface in 2D
    pressure,               // the pressure solve
    pressure_matrix,        // assembling the matrix for PETSc
    pressure_levels,        // all multigrid levels of the pressure
    small_pressure_levels,  // those of fewer than 20,000 unknowns
    level_set_in_solids,    // extrapolation of the level set into solids
};
using ReplicatedWorks = std::vector<ReplicatedWork>;

/// The identifier in run.json: "pressure_matrix".
const char* name_of(ReplicatedWork work);
/// For people: "the matrix of the pressure, extrapolation of the level set into solids"; empty for none.
std::string text_of(const ReplicatedWorks& works);

}  // namespace weir::scene
