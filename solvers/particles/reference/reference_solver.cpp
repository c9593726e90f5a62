#include "particles/reference/reference_solver.hpp"

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
    this->take_heat(scene);
    for (const auto& [name, pass] : effects)
        if (scene.effect(name)) plans_.push_back({.name = name, .inside = pass});
}

template <int D, class Physics>
void ReferenceSolver<D, Physics>::end_step() {
    ++fluid_.steps;
    fluid_.cross_sides();
}

template <int D, class Physics>
void ReferenceSolver<D, Physics>::expand() {
    if (!this->vapour() && !this->ice_) return;
    if (this->vapour()) this->heat_->place(fluid_);
    reference_.rest.clear();
    for (int i = 0; i < fluid_.count(); ++i) reference_.rest.push_back(this->ice_ ? this->ice_rest(i) : this->vapour()->rest(i));
}

template <int D, class Physics>
void ReferenceSolver<D, Physics>::conduct_at(const std::vector<Point>& x, real dt) {
    if (!this->heat_) return;
    const auto timed = this->passes_.time("heat");
    Heat<D>& heat = *this->heat_;
    heat.feed(fluid_, dt);
    const int parts = heat.parts(dt);
    const real part = dt / parts;
    std::vector<double> theta(x.size());
    const real outside = heat.exchanges().empty() ? 0 : heat.surroundings(fluid_.time - 0.5 * dt);
    for (int p = 0; p < parts; ++p) {
        heat.exchange(fluid_, outside, part);
        for (std::size_t i = 0; i < x.size(); ++i) theta[i] = heat.theta(static_cast<int>(i), fluid_.enthalpy[i]);
        const auto warming = reference_.warming(x, theta, heat.plain_pairs(), heat.plain_walls());
        for (std::size_t i = 0; i < x.size(); ++i) {
            fluid_.enthalpy[i] += part * warming.rate[i];
            heat.add(fluid_.mass * part * warming.by_walls[i]);
        }
    }
    heat.check(fluid_);
}

template <int D, class Physics>
std::size_t ReferenceSolver<D, Physics>::bytes() const {
    return fluid_.bytes() + own_bytes() + bytes_of(reference_.neighbours) + (this->heat_ ? this->heat_->bytes() : 0) +
           (this->bodies_ ? this->bodies_->bytes() : 0);
}

template class ReferenceSolver<2, ReferencePbf>;
template class ReferenceSolver<3, ReferencePbf>;
template class ReferenceSolver<2, ReferenceSph>;
template class ReferenceSolver<3, ReferenceSph>;

}  // namespace weir::particles
