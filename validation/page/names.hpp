// Where names fit beside the points of a diagram.
#pragma once
#include "validation/page/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

namespace weir::validation {

struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// Writes names beside points, at the first of ten places where they cover nothing, or else no point and no name; one without room is left
/// to the pointer.
class Names {
public:
    explicit Names(Box paper) : paper_(paper) {}
    void keep_free(double x, double y) { taken_.push_back({x - 4, y - 4, x + 4, y + 4}); }
    /// Lines are covered only where there is no other place.
    void avoid_line(double x0, double y0, double x1, double y1) {
        const int pieces = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 6);
        for (int i = 0; i <= pieces; ++i) {
            const double x = x0 + (x1 - x0) * i / pieces, y = y0 + (y1 - y0) * i / pieces;
            lines_.push_back({x - 1, y - 1, x + 1, y + 1});
        }
    }
    std::string beside(double x, double y, const std::string& name) {
        const double w = 6.6 * static_cast<double>(name.size()), h = 14;
        for (const bool over_lines : {false, true})
            for (const auto& [dx, dy, anchor] : {std::tuple{8.0, -8.0, "start"},
                                                 {-8.0, 16.0, "end"},
                                                 {8.0, 16.0, "start"},
                                                 {-8.0, -8.0, "end"},
                                                 {0.0, -12.0, "middle"},
                                                 {0.0, 22.0, "middle"},
                                                 {0.0, -26.0, "middle"},
                                                 {0.0, 36.0, "middle"},
                                                 {-8.0, -22.0, "end"},
                                                 {8.0, 30.0, "start"}}) {
                const double x0 = anchor[0] == 's' ? x + dx : anchor[0] == 'm' ? x - w / 2 : x + dx - w;
                const Box box{x0, y + dy - h + 3, x0 + w, y + dy + 3};
                const auto meets = [&](const Box& b) { return b.meets(box); };
                if (box.x0 < paper_.x0 || box.x1 > paper_.x1 || box.y0 < paper_.y0 || box.y1 > paper_.y1) continue;
                if (std::any_of(taken_.begin(), taken_.end(), meets)) continue;
                if (!over_lines && std::any_of(lines_.begin(), lines_.end(), meets)) continue;
                taken_.push_back(box);
                return fmt::format("<text class=\"name\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x + dx, y + dy, anchor,
                                   escaped(name));
            }
        return "";
    }

private:
    Box paper_;
    std::vector<Box> taken_, lines_;
};

}  // namespace weir::validation
