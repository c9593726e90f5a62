// The hand on columns of water. The brush is round in the plane, and takes each column as a whole, whatever its height: it pushes and pulls
// what flows in it, and lets the surface rise or fall with `speed` in the brush's middle, as fast as its weight elsewhere.
#pragma once
#include "geometry/hand.hpp"
#include "heightfield/state.hpp"

#include <functional>
#include <memory>

namespace weir::heightfield {

/// The brush seen from above: weights of columns.
Brush<3> brush_from_above(const Hand& hand, const State& s);

/// On water that flows.
std::unique_ptr<Effect<State>> hand_effect(std::shared_ptr<Hand> hand);
/// On columns that only pull their neighbours: it pours and drains. `surface` is changed where `covered` does not say that something
/// floats; the still depth is halved at the most.
void pour_and_drain(Hand& hand, State& s, Field& surface, real dt, const std::function<bool(std::size_t)>& covered);

}  // namespace weir::heightfield
