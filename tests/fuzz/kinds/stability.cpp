#include "core/error.hpp"
#include "fuzz/targets.hpp"
#include "sim/registry.hpp"
#include "validation/stability/limit.hpp"

#include <algorithm>

/// With the scenes at either end of each axis.
bool weir::fuzz::stability(std::string_view bytes) {
    using namespace validation;
    bool good = false;
    for (const Size size : {Size::ci, Size::full}) try {
            const StressStudy study = parse_stability(bytes, "stability.toml", WEIR_SOURCE_DIR "/tests/fuzz/case", size);
            for (std::size_t s = 0; s < std::min<std::size_t>(study.stresses.size(), 8); ++s)
                for (const real value : {study.stresses[s].low, study.stresses[s].high})
                    (void)scene_of(pushed_to(study.stresses[s], value), 0, sim::schemas());
            good = true;
        } catch (const BadInput&) {
        }
    return good;
}
