#include "output/png_read.hpp"

#include "core/error.hpp"
#include "core/words.hpp"
#include "output/silent_vtk.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include <vtkNew.h>
#include <vtkZLibDataCompressor.h>

namespace weir::output {

namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);
constexpr std::uint32_t longest_side = 1 << 15;
constexpr std::size_t most_inflation = 1100;  // zlib's maximum is 1032

std::uint32_t number_at(std::string_view bytes, std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) n = n << 8 | static_cast<std::uint8_t>(bytes[at + i]);
    return n;
}

/// CRC-32 of ISO 3309, as in Annex D of the standard.
std::uint32_t crc_of(std::string_view bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> all{};
        for (std::uint32_t n = 0; n < all.size(); ++n) {
            std::uint32_t c = n;
            for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
            all[n] = c;
        }
        return all;
    }();
    std::uint32_t c = 0xffffffffu;
    for (const char byte : bytes) c = table[(c ^ static_cast<std::uint8_t>(byte)) & 0xff] ^ (c >> 8);
    return ~c;
}

struct Chunks {
    std::string_view header{};
    std::string data{};  // of all IDAT chunks
};

/// The chunks that define the picture, up to IEND, with verified checksums.
std::optional<Chunks> chunks_of(std::string_view bytes) {
    if (!bytes.starts_with(signature)) return std::nullopt;
    Chunks chunks;
    for (std::size_t at = signature.size(); bytes.size() - at >= 12;) {
        const std::size_t length = number_at(bytes, at);
        if (length > bytes.size() - at - 12) return std::nullopt;
        const auto kind = bytes.substr(at + 4, 4), content = bytes.substr(at + 8, length);
        if (crc_of(bytes.substr(at + 4, 4 + length)) != number_at(bytes, at + 8 + length)) return std::nullopt;
        if (chunks.header.empty() != (kind == "IHDR")) return std::nullopt;  // it must be first and unique
        if (kind == "IHDR") chunks.header = content;
        if (kind == "IDAT") chunks.data += content;
        if (kind == "IEND") return chunks;
        at += 12 + length;
    }
    return std::nullopt;
}

/// A filter's prediction of a byte from those to the left, above, and above left (Paeth 1991).
int predicted(int filter, int left, int above, int corner) {
    if (filter == 1) return left;
    if (filter == 2) return above;
    if (filter == 3) return (left + above) / 2;
    if (filter != 4) return 0;
    const int p = left + above - corner, a = std::abs(p - left), b = std::abs(p - above), c = std::abs(p - corner);
    return a <= b && a <= c ? left : b <= c ? above : corner;
}

/// Converts stored rows, each preceded by a filter byte, to rows of values. Returns false for an unknown filter.
bool unfilter(const std::vector<std::uint8_t>& stored, ReadPicture& picture) {
    const std::size_t row = 3 * static_cast<std::size_t>(picture.width), rows = static_cast<std::size_t>(picture.height);
    picture.rgb.resize(row * rows);
    for (std::size_t y = 0; y < rows; ++y) {
        const std::uint8_t* from = stored.data() + y * (row + 1);
        std::uint8_t* to = picture.rgb.data() + y * row;
        const int filter = *from++;
        if (filter > 4) return false;
        for (std::size_t i = 0; i < row; ++i) {
            const int left = i < 3 ? 0 : to[i - 3], above = y == 0 ? 0 : *(to + i - row),
                      corner = i < 3 || y == 0 ? 0 : *(to + i - row - 3);
            to[i] = static_cast<std::uint8_t>(from[i] + predicted(filter, left, above, corner));
        }
    }
    return true;
}

}  // namespace

std::optional<ReadPicture> read_png(const std::filesystem::path& file) {
    std::string bytes;
    try {
        bytes = bytes_of(file);
    } catch (const BadInput&) {
        return std::nullopt;
    }
    const auto chunks = chunks_of(bytes);
    constexpr std::string_view eight_bits_rgb("\x08\x02\0\0\0", 5);
    if (!chunks || chunks->header.size() != 13 || chunks->header.substr(8) != eight_bits_rgb) return std::nullopt;
    const std::uint32_t width = number_at(chunks->header, 0), height = number_at(chunks->header, 4);
    if (width < 1 || height < 1 || width > longest_side || height > longest_side) return std::nullopt;
    ReadPicture picture{static_cast<int>(width), static_cast<int>(height)};
    const std::size_t size = (1 + 3 * std::size_t{width}) * height;
    if (size / most_inflation > chunks->data.size()) return std::nullopt;
    std::vector<std::uint8_t> stored(size);
    const SilentVtk silent;
    vtkNew<vtkZLibDataCompressor> zlib;
    const auto* from = reinterpret_cast<const unsigned char*>(chunks->data.data());
    if (zlib->Uncompress(from, chunks->data.size(), stored.data(), size) != size || !unfilter(stored, picture)) return std::nullopt;
    return picture;
}

}  // namespace weir::output
