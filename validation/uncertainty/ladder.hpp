// Grids of a scene from coarse to fine, for a study of grid convergence: cells stay square, the time step shrinks with the cell, and keys
// that count cells are scaled with them.
#pragma once
#include "scene/scene.hpp"
#include "validation/harness/runner.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// One way to simulate a scene: its own solver, or another one.
struct Method {
    std::string name{};
    std::vector<scene::Override> overrides{};  // of the user, then the solver's
    std::string solver{};
    real formal_order = 1;
};

/// The method `word` of a scene: a solver; "SOLVER:KEY=VALUE"; or a model of height fields ("shallow_water", "columns"). Another solver
/// takes the scene without its table `scheme`; height fields and waves have one cell along the vertical. An empty word: the scene's own.
/// Throws BadInput for an unknown solver; whether it can simulate the scene shows when its ladder is made.
Method method_of(const scene::Scene& scene, const std::string& word, const Solvers& solvers);
/// The scene with a method's solver, at the scene's own grid.
scene::Scene scene_of(const scene::Scene& scene, const Method& method, const Solvers& solvers);

/// One grid of a method.
struct Grid {
    int number = 1;  // cells = number times the smallest grid of these proportions
    std::vector<int> cells{};
    real h = 0;       // width of a cell [m]
    real factor = 1;  // over that of the scene's own grid
    std::vector<scene::Override> overrides{};
    std::string text() const;  // "40 x 24"
};

/// The grids of a method: multiples of the smallest grid whose cells have the proportions of the scene's own.
class Ladder {
public:
    Ladder(const scene::Scene& scene, Method method, const Solvers& solvers);

    const Method& method() const { return method_; }
    /// Multiples of the smallest grid that the scene's own grid is.
    int own() const { return own_; }
    /// Multiples of the smallest grid from which on the scene can be resolved: at least four cells along each axis, two across each solid,
    /// and what the solver requires. The reason why coarser ones are left out is in `left_out`.
    int coarsest(std::string& left_out) const;
    /// The grid of this number. Its time.dt and time.max_dt are those of the scene times the ratio of the cells; with `dt` and `dt_number`,
    /// the mean step of that coarser grid, steps are at most dt times the ratio of the cells. Probes have at least 300 rows.
    Grid grid(int number, real dt = 0, int dt_number = 1) const;
    /// The scene on this grid, with more overrides. Throws BadInput where the solver does not accept it.
    scene::Scene scene(const Grid& grid, const std::vector<scene::Override>& more = {}) const;

private:
    scene::Scene scene_;
    Method method_;
    const Solvers* solvers_;
    int own_ = 1;
};

/// Numbers of a ladder of `count` grids from coarse to fine, each about `ratio` times finer, that ends with `finest` and begins at or above
/// `coarsest`; fewer where there is no room.
std::vector<int> numbers_of_ladder(int coarsest, int finest, int count, real ratio = 1.45);

}  // namespace weir::validation
