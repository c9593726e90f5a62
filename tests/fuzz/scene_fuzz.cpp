// libFuzzer's way into the scene reader: any bytes give a scene or a BadScene, never anything else. A scene that is accepted is also
// written out and read back.
// The first line of the input may be overrides ("#! key=value" each); the rest is the file.
#include "fuzz/read_any.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    weir::test::read_any({reinterpret_cast<const char*>(data), size});
    return 0;
}
