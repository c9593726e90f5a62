// Maps of two axes as a gnuplot program: a coloured cell per pair of values with its text, the kinds of failure below.
#include "validation/report/gnuplot.hpp"
#include "validation/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace weir::validation {

namespace {

using namespace gnuplot;

constexpr const char* held_colour = "#cfe8dc";
constexpr double cell_height = 34, axes_left = 104, axes_top = 36, outcome_row = 22, narrowest = 560;  // pixels

/// No narrower than the texts in it.
double cell_width(const Map& m) {
    std::size_t longest = 6;
    for (const std::string& x : m.x) longest = std::max(longest, x.size());
    for (const auto& column : m.cells)
        for (const MapCell& c : column) longest = std::max(longest, c.text.size());
    return letter_width(13) * static_cast<double>(longest) + 14;
}

const char* colour_of(const MapCell& c) { return c.stable ? held_colour : colours[static_cast<std::size_t>(c.kind) % std::size(colours)]; }

std::string cells(const Map& m) {
    std::string s;
    for (std::size_t i = 0; i < m.cells.size(); ++i)
        for (std::size_t j = 0; j < m.cells[i].size(); ++j) {
            const MapCell& c = m.cells[i][j];
            s += fmt::format("set object rectangle from first {},{} to first {},{} fc rgb '{}' fs solid 1 border lc rgb '#ffffff'\n", i, j,
                             i + 1, j + 1, colour_of(c));
            s += fmt::format("set label {} at first {},{} center tc rgb '{}' front noenhanced\n", quoted(c.text),
                             static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5, c.stable ? "#1c5a3d" : "#ffffff");
        }
    return s;
}

std::string tics(const char* axis, const std::vector<std::string>& names) {
    std::string s = fmt::format("set {0}range [0:{1}]\nset {0}tics scale 0 noenhanced (", axis, names.size());
    for (std::size_t i = 0; i < names.size(); ++i)
        s += fmt::format("{}{} {}", i == 0 ? "" : ", ", quoted(names[i]), static_cast<double>(i) + 0.5);
    return s + ")\n";
}

}  // namespace

std::string gnuplot_program(const Map& m) {
    const double axes_right = axes_left + cell_width(m) * static_cast<double>(m.x.size());
    const double axes_bottom = axes_top + cell_height * static_cast<double>(m.y.size()), legend = axes_bottom + 60;
    const Paper paper{std::max(axes_right + 16, narrowest), legend + outcome_row * static_cast<double>(m.kinds.size() + 1) + 6};
    std::string s = fmt::format("set terminal svg size {:.0f},{:.0f} font 'sans,13' background '#ffffff'\n", paper.width, paper.height);
    s += "unset key; unset border\n" + margins(paper, axes_left, axes_right, axes_top, axes_bottom) + tics("x", m.x) + tics("y", m.y) +
         cells(m);
    s += label(paper, m.title, 8, 16, "left") + label(paper, m.x_label, (axes_left + axes_right) / 2, axes_bottom + 40, "center") +
         label(paper, m.y_label, 16, (axes_top + axes_bottom) / 2, "center rotate by 90");
    for (std::size_t k = 0; k <= m.kinds.size(); ++k) {
        const double y = legend + outcome_row * static_cast<double>(k);
        s += fmt::format("set object rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} fc rgb '{}' fs solid 1 noborder\n",
                         paper.x(8), paper.y(y), paper.x(24), paper.y(y + 16),
                         colour_of({.stable = k == 0, .kind = static_cast<int>(k) - 1}));
        s += label(paper, k == 0 ? "no failure" : "first failure: " + m.kinds[k - 1] + " (step)", 30, y + 8, "left");
    }
    return s + "plot NaN notitle\n";
}

}  // namespace weir::validation
