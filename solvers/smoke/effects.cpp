#include "smoke/effects.hpp"

namespace weir::smoke {

const EffectKinds& effect_kinds() {
    static const EffectKinds kinds{gravity(), buoyancy(), confinement(), cooling(), decay(), diffusion(), viscosity()};
    return kinds;
}

}  // namespace weir::smoke
