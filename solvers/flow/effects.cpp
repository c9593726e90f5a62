#include "flow/effects.hpp"

namespace weir::flow {

const EffectKinds& effect_kinds() {
    static const EffectKinds kinds{gravity(), buoyancy(), confinement(), diffusion(), cooling(), decay(), viscosity()};
    return kinds;
}

}  // namespace weir::flow
