#include "particles/opencl/device_bodies.hpp"

#include "particles/boundaries/solid_terms.hpp"

namespace weir::particles {

template <int D>
void BodiesOnDevice<D>::find_near() {
    fluid_.read(fluid_.near_solid, flags_);
    fluid_.read(fluid_.order, owners_);
    near_.clear();
    for (std::size_t k = 0; k < flags_.size(); ++k)
        if (flags_[k]) near_.push_back(static_cast<int>(k));
}

template <int D>
std::vector<float>& BodiesOnDevice<D>::meet(const backend::Memory& positions) {
    fluid_.read(positions, four_, 4);
    fluid_.read(fluid_.terms, terms_, 4);
    meet_bodies(fluid_.domain(), walls_, near_, four_.data(), terms_.data(), bodies_.meetings());
    return four_;
}

template <int D>
const std::vector<float>& BodiesOnDevice<D>::places() {
    fluid_.read(fluid_.a, four_, 4);
    places_.clear();
    for (const int k : near_) places_.insert(places_.end(), four_.data() + 4 * k, four_.data() + 4 * k + D);
    return places_;
}

template class BodiesOnDevice<2>;
template class BodiesOnDevice<3>;

}  // namespace weir::particles
