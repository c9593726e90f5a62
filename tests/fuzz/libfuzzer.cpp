// libFuzzer's way into one kind of file: WEIR_FUZZ_KIND.
#include "fuzz/targets.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    weir::fuzz::WEIR_FUZZ_KIND({reinterpret_cast<const char*>(data), size});
    return 0;
}
