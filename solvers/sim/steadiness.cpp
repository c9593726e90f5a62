#include "sim/steadiness.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sim {

std::vector<std::vector<real>> grid_velocity(const FieldSet& fields) {
    std::vector<std::vector<real>> copy;
    for (const auto& component : fields.find("", "velocity")->data) copy.emplace_back(component.begin(), component.end());
    return copy;
}

real change_and_keep(const FieldSet& fields, std::vector<std::vector<real>>& before) {
    real change = 0;
    const auto& velocity = fields.find("", "velocity")->data;
    for (std::size_t c = 0; c < velocity.size(); ++c)
        for (std::size_t i = 0; i < velocity[c].size(); ++i) {
            change = std::max(change, std::abs(velocity[c][i] - before[c][i]));
            before[c][i] = velocity[c][i];
        }
    return change;
}

}  // namespace weir::sim
