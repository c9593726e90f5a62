#include "particles/threaded_solver.hpp"

namespace weir::particles {

template <int D>
ThreadedSolver<D>::ThreadedSolver(const Scheme& scheme, const scene::Scene& scene, Fluid<D>&& start)
    : HostSolver<D>(std::move(start)),
      walls_(wall_params<single::WallParams>(scheme, fluid_.domain)),
      pairs_(passes_for(scheme.backend.isa), fluid_.domain.frame()),
      solids_(fluid_.domain, wall_params<plain::WallParams>(scheme, fluid_.domain)),
      flow_{fluid_, pairs_, kernels_, {}, {}, scheme.kernel()} {
    this->emitters_ = Emitters<D>(scene, fluid_.domain);
    add_effects(scene, effects_);
    this->hand_ = geometry::make_hand(scene);
    if (!this->hand_) return;
    auto hand = std::make_unique<HandOnParticles<D>>(this->hand_);
    sources_ = hand.get();
    effects_.add("hand", std::move(hand));
}

template <int D>
void ThreadedSolver<D>::end_step() {
    if (++fluid_.steps % steps_between_reorders == 0) fluid_.reorder(pairs_.particle_order());
    fluid_.cross_sides();
}

template <int D>
std::size_t ThreadedSolver<D>::bytes() const {
    return fluid_.bytes() + pairs_.bytes() + own_bytes() + flow_.bytes() + effects_.bytes();
}

template class ThreadedSolver<2>;
template class ThreadedSolver<3>;

}  // namespace weir::particles
