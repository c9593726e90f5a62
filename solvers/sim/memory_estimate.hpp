// Memory and disk estimate of a scene without building it. One or two small copies of at most some ten thousand cells are built instead.
// Their bytes per cell and per particle, and how both grow, are extrapolated. Solvers, effects and pressure methods report their own
// allocations; this file keeps no table of them.
#pragma once
#include "core/solver.hpp"
#include "parallel/partition.hpp"
#include "scene/scene.hpp"
#include "scene/solver_kind.hpp"

#include <string>
#include <vector>

namespace weir::sim {

struct EstimatedField {
    std::string name, unit;
    Where where = Where::cell;
    int components = 1;
    double values = 0;  // of all components
};

struct MemoryEstimate {
    double bytes = 0;  // of state and scratch, after the first step, in which lists and solves allocate their memory
    double bytes_at_start = 0;
    double surface_bytes = 0;  // peak memory of making output.surface
    double cells = 0, particles = 0;
    bool particle_solver = false;  // a solver made of particles
    bool exact = false;            // the scene was small enough to be built itself
    std::vector<EstimatedField> fields{};
    std::vector<EffectPlan> effects{};
};

/// Cells of the larger copy: ghosts and padding are a small part of its rows, and it is built within some tenths of a second.
inline constexpr double cells_of_copy = 131072;

/// Throws BadInput where not even a copy can be built.
MemoryEstimate estimate_memory(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double copy_cells = cells_of_copy);

/// Memory that can be allocated now without swapping [bytes].
double available_memory();
/// Number of frames of a scene, first and last included; bytes of an uncompressed frame; bytes of its largest array.
struct OutputEstimate {
    double frames = 0, bytes_of_frame = 0, bytes_of_array = 0;
    double bytes() const { return frames * bytes_of_frame; }
};
OutputEstimate estimate_output(const scene::Scene& scene, const FieldSet& fields);
OutputEstimate estimate_output(const scene::Scene& scene, const MemoryEstimate& estimate);

/// Memory of a run [bytes]: the solver, the last good state kept by the time loop (its fields), and, where frames are written, one array as
/// it is written to disk (compressed arrays are no larger).
double bytes_of_run(const scene::Scene& scene, const MemoryEstimate& estimate, bool frames);

/// Ghost planes that a rank stores, where nothing crosses more than one cell in a step: 4 on each side, and one.
inline constexpr double planes_near_cuts = 9;
/// The part of a solver's memory per plane of the slowest axis: its cells, and the liquid in them at the start. It is fitted to two copies,
/// one with half the liquid. Empty: all planes are equal.
std::vector<double> parts_of_planes(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds);
/// The part of the memory of one process that a rank needs with distributed storage: its own planes and its ghost planes.
double bytes_of_rank(double bytes, const Partition& cut, int rank, const std::vector<double>& parts);

/// The same for making output.surface: the planes of samples that the rank owns and the ghost particles that it reads.
double surface_bytes_of_rank(const scene::Scene& scene, const MemoryEstimate& estimate, int rank, int ranks);

enum class Use { solver, run, run_with_frames };
/// Rejects a scene that needs more memory than is available, at grid.cells, with both numbers. Small scenes are not estimated.
void require_memory(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, Use use = Use::solver,
                    double available = available_memory());

}  // namespace weir::sim
