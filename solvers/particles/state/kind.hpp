// Registration of a particle method: the common part of all schemas, and construction of its solver for the backend and dimension of a
// scene.
#pragma once
#include "particles/state/flow.hpp"
#include "particles/state/scheme.hpp"
#include "scene/solver_kind.hpp"

namespace weir::particles {

/// own: the method's name, its "scheme" and effects; in_initial: its keys of "initial"; plain: fields and passes.
scene::SolverSchema schema_of(scene::SolverSchema own, const std::vector<scene::Key>& in_initial);
/// Rejects keys that are supported in one process only.
void refuse_in_parallel(const scene::Scene& scene);
scene::PlainStep plain_step(std::vector<std::string> more_fields, std::vector<std::string> passes);

template <template <int> class On>
std::unique_ptr<Solver> make_in(int dim, const scene::Scene& scene) {
    if (dim == 2) return std::make_unique<On<2>>(scene);
    return std::make_unique<On<3>>(scene);
}

/// Particles have their own partition, which moves with them.
template <template <int> class OnThreads, template <int> class OnReference, template <int> class OnDevice>
std::unique_ptr<Solver> make_solver(const scene::Scene& scene, const Partition&) {
    switch (backend_of(scene).kind) {
        case backend::Choice::Kind::opencl:
            return make_in<OnDevice>(scene.dim(), scene);
        case backend::Choice::Kind::reference:
            return make_in<OnReference>(scene.dim(), scene);
        default:
            return make_in<OnThreads>(scene.dim(), scene);
    }
}

}  // namespace weir::particles
