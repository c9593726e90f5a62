#include "scene/replicated_work.hpp"

namespace weir::scene {

namespace {

struct Words {
    const char *name, *text;
};

Words words_of(ReplicatedWork work) {
    switch (work) {
        case ReplicatedWork::everything:
            return {"everything", "all of it"};
        case ReplicatedWork::surface_row:
            return {"surface_row", "the surface's one row"};
        case ReplicatedWork::pressure:
            return {"pressure", "the pressure"};
        case ReplicatedWork::pressure_matrix:
            return {"pressure_matrix", "the matrix of the pressure"};
        case ReplicatedWork::pressure_levels:
            return {"pressure_levels", "the levels of the pressure, all of them"};
        case ReplicatedWork::small_pressure_levels:
            return {"small_pressure_levels", "the levels of the pressure of fewer than 20,000 unknowns"};
        case ReplicatedWork::level_set_in_solids:
            return {"level_set_in_solids", "extrapolation of the level set into solids"};
    }
    return {"", ""};
}

}  // namespace

const char* name_of(ReplicatedWork work) { return words_of(work).name; }

std::string text_of(const ReplicatedWorks& works) {
    std::string text;
    for (const ReplicatedWork work : works) text += (text.empty() ? "" : ", ") + std::string(words_of(work).text);
    return text;
}

}  // namespace weir::scene
