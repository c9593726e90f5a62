#include "particles/reference_solver.hpp"

namespace weir::particles {

void refuse_what_the_reference_lacks(const scene::Scene& scene, const ReferenceEffects& effects) {
    std::vector<std::string> names;
    for (const auto& [name, pass] : effects) names.push_back(name);
    refuse_what_lacks("reference", scene, names);
}

template <int D, class Physics>
ReferenceSolver<D, Physics>::ReferenceSolver(const Scheme& scheme, Fluid<D>&& start) : HostSolver<D>(std::move(start)) {
    reference_.walls = wall_params<plain::WallParams>(scheme, fluid_.domain);
    reference_.kernel = scheme.kernel();
    reference_.period = fluid_.domain.frame().period;
}

template <int D, class Physics>
void ReferenceSolver<D, Physics>::take(const scene::Scene& scene, const ReferenceEffects& effects) {
    this->emitters_ = Emitters<D>(scene, fluid_.domain);
    for (const auto& [name, pass] : effects)
        if (scene.effect(name)) plans_.push_back({.name = name, .inside = pass});
}

template <int D, class Physics>
void ReferenceSolver<D, Physics>::end_step() {
    ++fluid_.steps;
    fluid_.cross_sides();
}

template <int D, class Physics>
std::size_t ReferenceSolver<D, Physics>::bytes() const {
    return fluid_.bytes() + own_bytes() + bytes_of(reference_.neighbours);
}

template class ReferenceSolver<2, ReferencePbf>;
template class ReferenceSolver<3, ReferencePbf>;
template class ReferenceSolver<2, ReferenceSph>;
template class ReferenceSolver<3, ReferenceSph>;

}  // namespace weir::particles
