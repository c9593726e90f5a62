// What a scene will hold in memory and write to disk, without building it: one or two copies of it with at most some ten thousand cells
// are built in its place, hold what it would hold a cell and a particle, and tell how both grow. Whatever solvers, effects and pressure
// methods allocate is counted as they count it; no table of theirs is kept here.
#pragma once
#include "core/halo.hpp"
#include "core/solver.hpp"
#include "scene/scene.hpp"
#include "scene/solver_kind.hpp"

#include <string>
#include <vector>

namespace weir::sim {

struct ForetoldField {
    std::string name, unit;
    Where where = Where::cell;
    int components = 1;
    double values = 0;  // of all components
};

struct Foretold {
    double bytes = 0;  // of state and scratch, after the first step, in which lists and solves take what they need
    double bytes_at_start = 0;
    double surface_bytes = 0;  // what making output.surface takes
    double cells = 0, particles = 0;
    bool particle_solver = false;  // it consists of particles
    bool exact = false;            // a scene so small that it was built itself
    std::vector<ForetoldField> fields{};
    std::vector<EffectPlan> effects{};
};

/// Cells of the larger copy: of a row of them ghosts and padding are a small part, and it is built within some tenths of a second.
inline constexpr double cells_of_copy = 131072;

/// Throws BadInput where not even a copy can be built.
Foretold foretell(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double copy_cells = cells_of_copy);

/// How a copy is made smaller: of a scene of particles by one factor; of a grid so that rows of cells are padded alike and halve as often;
/// of one whose columns are held whole, by fewer columns of the same height.
enum class Copy { similar, like_rows, like_columns };
/// The scene with about so many cells, in a box that contains the scene's own, with liquid in about the same part of it. Where that many
/// are no fewer than it has, the scene itself.
scene::Scene small_copy(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double cells, Copy how);

/// The part of the domain's cells whose centres lie in liquid and outside solids, from a sample.
double wet_part(const scene::Scene& scene);

/// Memory that programs can have now without swapping [bytes].
double available_memory();
/// Frames of a scene, first and last included, and what one takes without compression, and the largest array in it [bytes].
struct ForetoldOutput {
    double frames = 0, bytes_of_frame = 0, bytes_of_array = 0;
    double bytes() const { return frames * bytes_of_frame; }
};
ForetoldOutput foretell_output(const scene::Scene& scene, const FieldSet& fields);
ForetoldOutput foretell_output(const scene::Scene& scene, const Foretold& foretold);

/// Memory of a run [bytes]: the solver's, the last good state that the loop keeps (its fields), and, where frames are written, one array as
/// it goes to the disk: compressed arrays are no larger than that.
double bytes_of_run(const scene::Scene& scene, const Foretold& foretold, bool frames);

/// Planes that a rank holds of those that others own, where nothing crosses more than a cell in a step: 4 beyond either cut, and one.
inline constexpr double planes_near_cuts = 9;
/// What part of a solver's memory each plane of the slowest axis takes: its cells, and the liquid in them, as a scene begins; from two
/// copies, one with half the liquid. Empty: all the same.
std::vector<double> parts_of_planes(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds);
/// Of what one process would hold, the part of a rank that holds its own planes and those near its cuts alone.
double bytes_of_rank(double bytes, const Cut& cut, int rank, const std::vector<double>& parts);

/// The same of what making output.surface takes, by the planes of samples that are its own and the particles that it reads beside them.
double surface_bytes_of_rank(const scene::Scene& scene, const Foretold& foretold, int rank, int ranks);

enum class Use { solver, run, run_with_frames };
/// Refuses a scene that needs more memory than is available, at grid.cells, with both numbers. Costs nothing for scenes that cannot.
void require_memory(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, Use use = Use::solver,
                    double available = available_memory());

}  // namespace weir::sim
