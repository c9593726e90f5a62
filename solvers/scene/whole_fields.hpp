// Over ranks that hold their own planes alone, who looks at more than those.
#pragma once
#include "scene/scene.hpp"

#include <initializer_list>
#include <string_view>

namespace weir::scene {

/// Does a scene look at whole fields: to see whether they are steady, or by a probe of another kind than these?
bool looks_at_whole_fields(const Scene& scene, std::initializer_list<std::string_view> local_probes);

}  // namespace weir::scene
