#include "sim/make_solver.hpp"

#include "core/parallel.hpp"

namespace weir::sim {

namespace {

long cells_of(const scene::Scene& scene) {
    long cells = 1;
    for (const real n : scene.root().numbers("grid.cells")) cells *= static_cast<long>(n);
    return cells;
}

}  // namespace

std::unique_ptr<Solver> make_solver(const scene::Scene& scene, const scene::SolverKind& kind, const Partition& cut) {
    const ProblemSizeScope size(cells_of(scene));
    return kind.make(scene, cut);
}

int threads_for(const scene::Scene& scene) {
    const ProblemSizeScope size(cells_of(scene));
    return weir::threads();
}

}  // namespace weir::sim
