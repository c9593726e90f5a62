// The schemas against which bad scenes are read.
#pragma once
#include "unit/scene/schema.hpp"

namespace weir::test {

inline std::vector<scene::SolverSchema> schemas() {
    auto list = scene::made_up::schemas();
    list[0].name = "mac";
    list[1].name = "mac_water";
    return list;
}

}  // namespace weir::test
