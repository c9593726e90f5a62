// The liquid of a frame as what makes surfaces asks for it.
#pragma once
#include "app/picture/view.hpp"
#include "core/solver.hpp"
#include "surfaces/options.hpp"

namespace weir::picture {

/// They point into the frame. Of a run without a grid the markers are its particles.
FieldSet fields_of(const output::FrameData& frame, const scene::Scene& scene);
/// As the picture is wished, else as the scene says; else from particles by stretched kernels, which are smoothest, else from the level
/// set.
surfaces::Options options_for(const View& view, const FieldSet& fields);

}  // namespace weir::picture
