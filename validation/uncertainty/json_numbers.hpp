// Numbers in JSON, which has no NaN and no infinity: they are null.
#pragma once
#include "core/types.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <vector>

namespace weir::validation {

inline nlohmann::json json_number(real value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); }
inline real number_of(const nlohmann::json& value) { return value.is_null() ? std::nan("") : value.get<real>(); }

inline nlohmann::json json_numbers(const std::vector<real>& values) {
    nlohmann::json list = nlohmann::json::array();
    for (const real v : values) list.push_back(json_number(v));
    return list;
}
inline std::vector<real> numbers_of(const nlohmann::json& list) {
    std::vector<real> values;
    for (const nlohmann::json& v : list) values.push_back(number_of(v));
    return values;
}

}  // namespace weir::validation
