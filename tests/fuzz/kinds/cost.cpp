#include "core/error.hpp"
#include "fuzz/targets.hpp"
#include "sim/registry.hpp"
#include "validation/cost/study.hpp"

#include <algorithm>

bool weir::fuzz::cost(std::string_view bytes) {
    using namespace validation;
    bool good = false;
    for (const Size size : {Size::ci, Size::full}) try {
            const Study study = parse_study(bytes, "cost.toml", WEIR_SOURCE_DIR "/tests/fuzz/case", size);
            for (std::size_t m = 0; m < std::min<std::size_t>(study.methods.size(), 8); ++m)
                for (std::size_t i = 0; i < std::min<std::size_t>(study.methods[m].runs(), 8); ++i) {
                    (void)study_of_row(study, study.methods[m].name, i);
                    (void)scene_of(study.methods[m], i, sim::schemas());
                }
            good = true;
        } catch (const BadInput&) {
        }
    return good;
}
