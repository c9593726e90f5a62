#include "core/error.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/targets.hpp"
#include "output/image_file.hpp"

#include <cstdint>

namespace {

std::uint32_t crc_of(std::string_view bytes) {
    std::uint32_t c = 0xffffffffu;
    for (const char byte : bytes) {
        c ^= static_cast<std::uint8_t>(byte);
        for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
    }
    return ~c;
}

/// Checksums of chunks made right: a fuzzer would never find them.
std::string with_checksums(std::string bytes) {
    const auto byte = [&](std::size_t at) -> std::size_t { return static_cast<std::uint8_t>(bytes[at]); };
    for (std::size_t at = 8; at + 12 <= bytes.size();) {
        const std::size_t length = byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3);
        if (length > bytes.size() - at - 12) break;
        const std::uint32_t crc = crc_of(std::string_view(bytes).substr(at + 4, 4 + length));
        for (std::size_t i = 0; i < 4; ++i) bytes[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i));
        at += 12 + length;
    }
    return bytes;
}

}  // namespace

bool weir::fuzz::image(std::string_view bytes) {
    try {
        return !output::jpeg_of(written("picture.png", with_checksums(std::string(bytes)))).empty();
    } catch (const BadInput&) {
        return false;
    }
}
