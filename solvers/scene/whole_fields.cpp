#include "scene/whole_fields.hpp"

#include <algorithm>

namespace weir::scene {

bool looks_at_whole_fields(const Scene& scene, std::initializer_list<std::string_view> local_probes) {
    if (scene.root().number_or("time.stop_when_steady", 0) > 0) return true;
    const auto& probes = scene.root().tables("probes");
    return std::any_of(probes.begin(), probes.end(), [&](const Table& probe) {
        return std::find(local_probes.begin(), local_probes.end(), probe.text("kind")) == local_probes.end();
    });
}

}  // namespace weir::scene
