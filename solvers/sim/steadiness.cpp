#include "sim/steadiness.hpp"

#include "sim/owners.hpp"

#include <algorithm>
#include <cmath>

namespace weir::sim {

std::vector<std::vector<real>> grid_velocity(const FieldSet& fields) {
    std::vector<std::vector<real>> copy;
    const FieldView& velocity = *fields.find("", "velocity");
    for (std::size_t c = 0; c < velocity.data.size(); ++c) {
        const auto own = own_values(fields, velocity, c);
        copy.emplace_back(own.begin(), own.end());
    }
    return copy;
}

real change_and_keep(const FieldSet& fields, std::vector<std::vector<real>>& before) {
    real change = 0;
    const FieldView& velocity = *fields.find("", "velocity");
    for (std::size_t c = 0; c < velocity.data.size(); ++c) {
        const auto own = own_values(fields, velocity, c);
        for (std::size_t i = 0; i < own.size(); ++i) {
            change = std::max(change, std::abs(own[i] - before[c][i]));
            before[c][i] = own[i];
        }
    }
    return largest_of_owners(fields, change);
}

}  // namespace weir::sim
