#include "core/hex_number.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace weir {

std::string hex_number(double value) {
    if (std::isinf(value)) return value > 0 ? "(double)INFINITY" : "-(double)INFINITY";
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%a", value);
    return text.data();
}

}  // namespace weir
