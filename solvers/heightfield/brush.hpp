// Interactive forcing of columns of water. The brush is a disc in the plane and acts on whole columns, at any height. It pushes and pulls
// the flow, and raises or lowers the surface at `speed` in its centre, weighted elsewhere.
#pragma once
#include "geometry/brush.hpp"
#include "heightfield/state.hpp"

#include <functional>
#include <memory>

namespace weir::heightfield {

/// The brush seen from above, as weights of columns.
Brush<3> brush_from_above(const BrushForcing& forcing, const State& s);

/// For shallow water.
std::unique_ptr<Effect<State>> brush_effect(std::shared_ptr<BrushForcing> forcing);
/// For the wave equation on columns: pouring and draining only. `surface` is changed where `covered` returns false; the still depth is at
/// most halved.
void apply_sources_and_sinks(BrushForcing& forcing, State& s, Field& surface, real dt, const std::function<bool(std::size_t)>& covered);

}  // namespace weir::heightfield
