#include "app/picture/canvas.hpp"

#include "output/image_file.hpp"

#include <map>
#include <string>

namespace weir::picture {

Canvas Canvas::smaller(int factor) const {
    Canvas small(width_ / factor, height_ / factor);
    for (int y = 0; y < small.height_; ++y)
        for (int x = 0; x < small.width_; ++x) {
            Colour sum{};
            for (int j = 0; j < factor; ++j)
                for (int i = 0; i < factor; ++i) sum += at(factor * x + i, factor * y + j);
            small.at(x, y) = sum / (factor * factor);
        }
    return small;
}

void Canvas::paste(const Canvas& other, int x, int y) {
    for (int j = 0; j < other.height_ && y + j < height_; ++j)
        for (int i = 0; i < other.width_ && x + i < width_; ++i) at(x + i, y + j) = other.at(i, j);
}

void Canvas::write(const std::filesystem::path& png, const std::string& made_as) const {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * pixels_.size());
    for (const auto& pixel : pixels_)
        for (int c = 0; c < 3; ++c)
            bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * std::pow(std::clamp(pixel[c], 0.0, 1.0), 1 / 2.2))));
    output::write_png(png, width_, height_, bytes, made_as);
}

Colour colour_of(std::string_view map, real s) {
    static const std::map<std::string, std::vector<unsigned>, std::less<>> maps = {
        {"viridis", {0x440154, 0x3b528b, 0x21918c, 0x5ec962, 0xfde725}},
        {"inferno", {0x000004, 0x56106e, 0xbb3754, 0xf98c0a, 0xfcffa4}},
        {"coolwarm", {0x3b4cc0, 0x8db0fe, 0xdddddd, 0xf49a7b, 0xb40426}},
        {"water", {0x0b3d78, 0x1766ad, 0x3f97d3, 0x9fd2ef, 0xf4fbff}},
    };
    const auto& colours = maps.find(map)->second;
    const real place = std::clamp(std::isfinite(s) ? s : 0.0, 0.0, 1.0) * static_cast<real>(colours.size() - 1);
    const auto lower = std::min(static_cast<std::size_t>(place), colours.size() - 2);
    return mix(hex(colours[lower]), hex(colours[lower + 1]), place - static_cast<real>(lower));
}

}  // namespace weir::picture
