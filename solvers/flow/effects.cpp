#include "flow/effects.hpp"

namespace weir::flow {

const EffectKinds& effect_kinds() {
    static const EffectKinds kinds{gravity(), buoyancy(), confinement(), cooling(), decay(), diffusion(), viscosity()};
    return kinds;
}

}  // namespace weir::flow
