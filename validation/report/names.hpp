// Where names fit beside the points of a diagram.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace weir::validation {

struct Box {
    double x0, y0, x1, y1;
    bool meets(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

/// The end of a name that its place is given for.
enum class Anchor { left, centre, right };
struct Place {
    double x, y;  // of the base line
    Anchor anchor;
};

/// Finds places for names beside points: the first of ten where they cover nothing, or else no point and no name; none where all are taken.
class Names {
public:
    explicit Names(Box paper) : paper_(paper) {}
    void keep_free(const Box& box) { taken_.push_back(box); }
    void keep_free(double x, double y) { taken_.push_back({x - 4, y - 4, x + 4, y + 4}); }
    /// Lines are covered only where there is no other place.
    void avoid_line(double x0, double y0, double x1, double y1) {
        const int pieces = 1 + static_cast<int>(std::hypot(x1 - x0, y1 - y0) / 6);
        for (int i = 0; i <= pieces; ++i) {
            const double x = x0 + (x1 - x0) * i / pieces, y = y0 + (y1 - y0) * i / pieces;
            lines_.push_back({x - 1, y - 1, x + 1, y + 1});
        }
    }
    std::optional<Place> beside(double x, double y, const std::string& name) {
        const double w = 6.2 * static_cast<double>(name.size()), h = 14;
        for (const bool over_lines : {false, true})
            for (const auto& [dx, dy, anchor] : {std::tuple{8.0, -8.0, Anchor::left},
                                                 {-8.0, 16.0, Anchor::right},
                                                 {8.0, 16.0, Anchor::left},
                                                 {-8.0, -8.0, Anchor::right},
                                                 {0.0, -12.0, Anchor::centre},
                                                 {0.0, 22.0, Anchor::centre},
                                                 {0.0, -26.0, Anchor::centre},
                                                 {0.0, 36.0, Anchor::centre},
                                                 {-8.0, -22.0, Anchor::right},
                                                 {8.0, 30.0, Anchor::left}}) {
                const double x0 = anchor == Anchor::left ? x + dx : anchor == Anchor::centre ? x - w / 2 : x + dx - w;
                const Box box{x0, y + dy - h + 3, x0 + w, y + dy + 3};
                const auto meets = [&](const Box& b) { return b.meets(box); };
                if (box.x0 < paper_.x0 || box.x1 > paper_.x1 || box.y0 < paper_.y0 || box.y1 > paper_.y1) continue;
                if (std::any_of(taken_.begin(), taken_.end(), meets)) continue;
                if (!over_lines && std::any_of(lines_.begin(), lines_.end(), meets)) continue;
                taken_.push_back(box);
                return Place{x + dx, y + dy, anchor};
            }
        return std::nullopt;
    }

private:
    Box paper_;
    std::vector<Box> taken_, lines_;
};

}  // namespace weir::validation
