// The size of the tests: ci, unless the variable WEIR_TEST_SIZE is "full".
#pragma once
#include <cstdlib>
#include <string_view>

namespace weir {

inline bool full_size() {
    const char* size = std::getenv("WEIR_TEST_SIZE");
    return size && std::string_view(size) == "full";
}

}  // namespace weir
