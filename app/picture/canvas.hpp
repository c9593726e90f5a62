// Colours and canvases of pictures. Colours are linear light until they are written.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace weir::picture {

using Colour = Vec<3>;

/// Pictures are drawn so many times as wide and high as they are written: smooth edges.
inline constexpr int oversampling = 2;

inline Colour mix(const Colour& a, const Colour& b, real s) { return (1 - s) * a + s * b; }
inline Colour times(const Colour& a, const Colour& b) { return {{a[0] * b[0], a[1] * b[1], a[2] * b[2]}}; }
/// An sRGB colour 0xrrggbb as linear light.
inline Colour hex(unsigned code) {
    const auto linear = [](unsigned byte) { return std::pow((byte & 255u) / 255.0, 2.2); };
    return {{linear(code >> 16), linear(code >> 8), linear(code)}};
}

class Canvas {
public:
    Canvas(int width, int height, const Colour& background = {})
        : width_(width), height_(height), pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), background) {}
    int width() const { return width_; }
    int height() const { return height_; }
    /// Row 0 is the top.
    Colour& at(int x, int y) {
        return pixels_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
    }
    const Colour& at(int x, int y) const { return const_cast<Canvas*>(this)->at(x, y); }
    /// Every block of factor x factor pixels becomes one: smooth edges for what was drawn larger.
    Canvas smaller(int factor) const;
    void paste(const Canvas& other, int x, int y);
    /// made_as: see output::write_png().
    void write(const std::filesystem::path& png, const std::string& made_as = {}) const;

private:
    int width_, height_;
    std::vector<Colour> pixels_;
};

/// viridis, inferno (van der Walt & Smith 2015), coolwarm (Moreland 2009), water: s in [0, 1], by a few colours and straight lines between.
Colour colour_of(std::string_view map, real s);

}  // namespace weir::picture
