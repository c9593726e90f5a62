#include "fuzz/read_any.hpp"
#include "fuzz/targets.hpp"
#include "sim/registry.hpp"

/// What run.json keeps of it is text as well, and so is the scene that a session writes: both are read back.
bool weir::fuzz::scene(std::string_view bytes) {
    const auto read = read_any(bytes, sim::schemas());
    if (!read) return false;
    (void)scene::to_json(read->root());
    require_same(scene::to_scene_text(read->root()), *read, sim::schemas());
    return true;
}
