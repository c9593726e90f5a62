// Curves and the panels they are drawn in: what references give, metrics compare, and figures show.
#pragma once
#include "core/types.hpp"

#include <string>
#include <utility>
#include <vector>

namespace weir::validation {

/// Pairs (x, y) under one name. Data of others are drawn as points, our own results as lines, guides to the eye dashed.
struct Curve {
    std::string label{};
    std::vector<real> x{}, y{};
    bool points = false;
    bool dashed = false;
    std::vector<std::string> names{};  // of its points, written beside them; empty: none
    std::vector<real> half_widths{};   // of the band of each point, drawn as a vertical bar; empty: none
    std::size_t size() const { return x.size(); }
};

/// y at `at` on the straight line between neighbours; NaN outside the curve (no extrapolation). x must ascend.
inline real interpolate(const Curve& c, real at) {
    if (c.x.empty() || !(at >= c.x.front()) || !(at <= c.x.back())) return std::nan("");
    std::size_t i = 1;
    while (i < c.x.size() && c.x[i] < at) ++i;
    if (i == c.x.size() || c.x[i] == c.x[i - 1]) return c.y[i - 1];
    const real s = (at - c.x[i - 1]) / (c.x[i] - c.x[i - 1]);
    return (1 - s) * c.y[i - 1] + s * c.y[i];
}

struct Axis {
    std::string label{};  // quantity and unit: "y [m]"
    bool log = false;
    // Not an aggregate: where a later part of a Panel throws (a curve that is not there), GCC 12 frees the text of an axis in braces twice.
    Axis() = default;
    Axis(std::string its_label, bool is_log = false) : label(std::move(its_label)), log(is_log) {}
};

/// Where differences mean nothing: shaded from the bottom of a diagram up to `below`; 0: nowhere.
struct Shade {
    real below = 0;
    std::string label{};
};

/// A line across a diagram at one abscissa: "real time".
struct Mark {
    real at = 0;
    std::string label{};
};

/// One diagram of a case's figure.
struct Panel {
    std::string title{};
    Axis x{}, y{};
    std::vector<Curve> curves{};
    Shade shade{};
    std::vector<Mark> marks{};
};

}  // namespace weir::validation
