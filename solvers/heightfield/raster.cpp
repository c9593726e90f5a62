#include "heightfield/raster.hpp"

#include "core/error.hpp"
#include "core/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

namespace weir::heightfield {

namespace {

constexpr long most_cells = 1L << 28;
constexpr std::size_t most_bytes = std::size_t{16} * most_cells;  // fifteen characters and a space per cell

/// Checks the file size before allocation: each cell takes at least one character and one space.
void require_text_of(std::size_t cells, std::size_t bytes, const Words& words) {
    if (bytes < 2 * cells - 1) words.fail(fmt::format("the header declares {} cells; the file has only {} bytes", cells, bytes));
}

std::string lower(std::string_view word) {
    std::string text(word);
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

struct AscHeader {
    std::optional<int> columns, rows;
    std::optional<real> x, z, cell, nodata;
    bool x_of_centre = false, z_of_centre = false;
};

AscHeader read_header(Words& words, std::size_t bytes) {
    AscHeader h;
    while (!words.peek().empty() && std::isalpha(static_cast<unsigned char>(words.peek()[0]))) {
        const std::string key = lower(words.next());
        if (key == "ncols")
            h.columns = words.count("ncols", static_cast<real>(most_cells));
        else if (key == "nrows")
            h.rows = words.count("nrows", static_cast<real>(most_cells));
        else if (key == "xllcorner" || key == "xllcenter")
            h.x = words.number(key), h.x_of_centre = key == "xllcenter";
        else if (key == "yllcorner" || key == "yllcenter")
            h.z = words.number(key), h.z_of_centre = key == "yllcenter";
        else if (key == "cellsize") {
            h.cell = words.number(key);
            if (!(*h.cell > 0)) words.fail("cellsize must be greater than 0");
        } else if (key == "nodata_value")
            h.nodata = words.number(key);
        else
            words.fail(
                fmt::format("\"{}\" is not a key of an ESRI ASCII grid; known: ncols, nrows, xllcorner, xllcenter, yllcorner, yllcenter, "
                            "cellsize, NODATA_value",
                            Words::shown(key)));
    }
    (void)words.next();
    const std::pair<bool, const char*> needed[] = {{h.columns.has_value(), "ncols"},
                                                   {h.rows.has_value(), "nrows"},
                                                   {h.x.has_value(), "xllcorner"},
                                                   {h.z.has_value(), "yllcorner"},
                                                   {h.cell.has_value(), "cellsize"}};
    for (const auto& [given, key] : needed)
        if (!given) words.fail(fmt::format("the header ends here and lacks {}", key));
    if (static_cast<long>(*h.columns) * *h.rows > most_cells) words.fail("the grid has too many cells; at most 2^28");
    require_text_of(static_cast<std::size_t>(*h.columns) * static_cast<std::size_t>(*h.rows), bytes, words);
    return h;
}

}  // namespace

real Raster::operator()(real x, real z) const {
    const real fx = std::clamp((x - x0) / dx - 0.5, 0.0, static_cast<real>(nx - 1));
    const real fz = std::clamp((z - z0) / dz - 0.5, 0.0, static_cast<real>(nz - 1));
    const int i = std::min(static_cast<int>(fx), std::max(0, nx - 2)), k = std::min(static_cast<int>(fz), std::max(0, nz - 2));
    const real s = fx - i, t = fz - k;
    const auto v = [&](int a, int b) {
        return value[static_cast<std::size_t>(std::min(b, nz - 1)) * static_cast<std::size_t>(nx) +
                     static_cast<std::size_t>(std::min(a, nx - 1))];
    };
    return (1 - t) * ((1 - s) * v(i, k) + s * v(i + 1, k)) + t * ((1 - s) * v(i, k + 1) + s * v(i + 1, k + 1));
}

Raster read_asc(const std::filesystem::path& path, std::optional<real> nodata) {
    const std::string text = bytes_of(path, most_bytes);
    Words words(path, text, false), start = words;
    const AscHeader h = read_header(start, text.size());
    for (std::string_view word = words.peek(); !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])); word = words.peek())
        (void)words.next(), (void)words.next();
    Raster r{.nx = *h.columns, .nz = *h.rows, .dx = *h.cell, .dz = *h.cell};
    r.x0 = *h.x - (h.x_of_centre ? 0.5 * r.dx : 0), r.z0 = *h.z - (h.z_of_centre ? 0.5 * r.dz : 0);
    r.value.resize(static_cast<std::size_t>(r.nx) * static_cast<std::size_t>(r.nz));
    for (int row = 0; row < r.nz; ++row)  // the file begins in the north: at the largest z
        for (int i = 0; i < r.nx; ++i) {
            real value = words.number(fmt::format("height {} of row {} ({} x {} are announced)", i + 1, row + 1, r.nx, r.nz));
            if (h.nodata && value == *h.nodata) {
                if (!nodata) words.fail("missing data; terrain.nodata gives a height to such cells");
                value = *nodata;
            }
            r.value[static_cast<std::size_t>(r.nz - 1 - row) * static_cast<std::size_t>(r.nx) + static_cast<std::size_t>(i)] = value;
        }
    if (const std::string_view more = words.next(); !more.empty())
        words.fail(fmt::format("\"{}\" follows the last of {} x {} heights", Words::shown(more), r.nx, r.nz));
    return r;
}

Raster read_pgm(const std::filesystem::path& path) {
    const std::string text = bytes_of(path, most_bytes);
    Words words(path, text, true);
    const std::string_view magic = words.next();
    if (magic != "P2" && magic != "P5")
        words.fail(fmt::format("\"{}\" is not the beginning of a grey map; known: P2, P5 (PGM)", Words::shown(magic)));
    const bool binary = magic == "P5";
    Raster r;
    r.nx = words.count("the width", static_cast<real>(most_cells)), r.nz = words.count("the height", static_cast<real>(most_cells));
    if (static_cast<long>(r.nx) * r.nz > most_cells) words.fail("the picture has too many pixels; at most 2^28");
    const int most = words.count("the value of white", 65535);
    const std::size_t cells = static_cast<std::size_t>(r.nx) * static_cast<std::size_t>(r.nz);
    if (!binary) {
        require_text_of(cells, text.size(), words);
        r.value.resize(cells);
        for (real& v : r.value) {
            v = words.number("a shade of grey");
            if (v < 0 || v > most || v != std::floor(v)) words.fail(fmt::format("{} is not a grey value from 0 to {}", v, most));
            v /= most;
        }
        return r;
    }
    const std::size_t bytes = most > 255 ? 2 : 1, first = words.position() + 1;
    if (text.size() < first + bytes * cells)
        throw BadInput(fmt::format("{}: the picture ends after {} of {} bytes", path.string(), text.size() - std::min(text.size(), first),
                                   bytes * cells));
    r.value.resize(cells);
    for (std::size_t i = 0; i < r.value.size(); ++i) {
        const auto byte = [&](std::size_t b) { return static_cast<std::uint8_t>(text[first + bytes * i + b]); };
        const int shade = bytes == 2 ? 256 * byte(0) + byte(1) : byte(0);
        if (shade > most) throw BadInput(fmt::format("{}: pixel {} is brighter than white ({} > {})", path.string(), i, shade, most));
        r.value[i] = static_cast<real>(shade) / most;
    }
    return r;
}

}  // namespace weir::heightfield
