#include "core/error.hpp"
#include "fuzz/targets.hpp"
#include "sim/registry.hpp"
#include "validation/harness/case.hpp"

#include <algorithm>

/// At either size, with the scenes of its first runs.
bool weir::fuzz::validation_case(std::string_view bytes) {
    using namespace validation;
    bool good = false;
    for (const Size size : {Size::ci, Size::full}) try {
            const Case c = parse_case(bytes, "case.toml", WEIR_SOURCE_DIR "/tests/fuzz/case", size);
            for (std::size_t v = 0; v < std::min<std::size_t>(c.variants.size(), 8); ++v)
                for (std::size_t i = 0; i < std::min<std::size_t>(c.variants[v].runs(), 8); ++i) {
                    (void)frames_folder(c, c.variants[v], i);
                    (void)scene_of(c.variants[v], i, sim::schemas());
                }
            good = true;
        } catch (const BadInput&) {
        }
    return good;
}
