// Panels as a gnuplot program. Each panel has its place on the paper in pixels, so that legends, titles and names lie where nothing else
// is.
#include "validation/report/gnuplot.hpp"
#include "validation/report/names.hpp"
#include "validation/report/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace weir::validation {
namespace {

using namespace gnuplot;

constexpr int symbols[] = {7, 5, 9, 13};  // disk, square, triangle, diamond: for each round through the colours
constexpr double panel_width = 560, left_margin = 84, right_margin = 22, plot_height = 300;  // pixels
constexpr double below_axis = 66;                                                            // of ticks and the axis title
constexpr double legend_font = 11, legend_row = 17, line_height = 17, swatch = 24, margin = 14;
constexpr std::size_t title_letters = 68;                                                            // per line
constexpr const char *shade_colour = "#5b6673", *shade_fill = "fs transparent solid 0.12 noborder";  // on light and on dark paper

/// A point can be drawn: finite, and positive where an axis is logarithmic.
bool drawable(const Panel& p, real x, real y) { return std::isfinite(x) && std::isfinite(y) && (!p.x.log || x > 0) && (!p.y.log || y > 0); }

/// A curve that has more points than the panel has pixels, thinned: of each stretch the lowest and the highest point, so that no peak is
/// lost.
Curve thinned(const Curve& c) {
    constexpr auto stretches = static_cast<std::size_t>(panel_width);
    if (c.size() <= 4 * stretches || c.points || !c.names.empty() || !c.half_widths.empty()) return c;
    Curve thin = c;
    thin.x.clear(), thin.y.clear();
    const auto keep = [&](std::size_t i) { thin.x.push_back(c.x[i]), thin.y.push_back(c.y[i]); };
    for (std::size_t s = 0; s < stretches; ++s) {
        const auto first = c.y.begin() + static_cast<std::ptrdiff_t>(c.size() * s / stretches);
        const auto last = c.y.begin() + static_cast<std::ptrdiff_t>(c.size() * (s + 1) / stretches);
        const auto [low, high] = std::minmax_element(first, last);
        keep(static_cast<std::size_t>(std::min(low, high) - c.y.begin()));
        if (low != high) keep(static_cast<std::size_t>(std::max(low, high) - c.y.begin()));
    }
    keep(c.size() - 1);
    return thin;
}

/// The curves that have a point to draw, without the points that cannot be drawn, thinned.
std::vector<Curve> drawn_curves(const Panel& p) {
    std::vector<Curve> curves;
    for (const Curve& whole : p.curves) {
        Curve c = thinned(whole), kept{.label = c.label, .points = c.points, .dashed = c.dashed};
        for (std::size_t i = 0; i < c.size(); ++i) {
            if (!drawable(p, c.x[i], c.y[i])) continue;
            kept.x.push_back(c.x[i]), kept.y.push_back(c.y[i]);
            if (!c.names.empty()) kept.names.push_back(c.names[i]);
            if (!c.half_widths.empty()) kept.half_widths.push_back(c.half_widths[i]);
        }
        if (kept.size() > 0) curves.push_back(std::move(kept));
    }
    return curves;
}

/// The range of one axis.
struct Range {
    bool log = false;
    real low = infinity, high = -infinity;
    void include(real value) { low = std::min(low, value), high = std::max(high, value); }
    /// Some room beside the data; a flat line, but for round-off, lies in the middle of the panel.
    void widen() {
        if (!(low <= high)) low = high = log ? 1 : 0;
        const bool flat = high - low <= 1e-7 * std::max(std::abs(low), std::abs(high));  // ticks have nine digits
        if (log && flat)
            low /= 10, high *= 10;
        else if (log) {
            const real room = std::max(1.3, std::pow(high / low, 0.05));
            low /= room, high *= room;
        } else if (const real room = flat ? std::max(1e-12, std::abs(low)) : 0.05 * (high - low); true)
            low -= room, high += room;
    }
    /// 0 at the low end, 1 at the high end.
    double part(real value) const { return log ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low); }
};

/// Ticks and scale of one axis.
std::string axis(const char* name, const Range& r) {
    std::string s = fmt::format("set {0}tics auto; set format {0} '%g'\nset {0}range [{1:.9g}:{2:.9g}]\n", name, r.low, r.high);
    if (!r.log) return s;
    s += fmt::format("set logscale {}\n", name);
    if (r.high / r.low > 1700) return s + fmt::format("set format {} '10^{{%T}}'\n", name);
    // Less than three decades: ticks at some digits of each, or the axis would have few labels or none.
    const std::vector<real> digits = r.high / r.low < 4    ? std::vector<real>{1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9}
                                     : r.high / r.low < 13 ? std::vector<real>{1, 1.5, 2, 3, 4, 5, 7}
                                                           : std::vector<real>{1, 2, 5};
    s += fmt::format("set {}tics (", name);
    const char* comma = "";
    for (real decade = std::pow(10.0, std::floor(std::log10(r.low))); decade <= r.high; decade *= 10)
        for (const real digit : digits) {
            if (digit * decade < r.low || digit * decade > r.high) continue;
            s += fmt::format("{0}'{1:.4g}' {1:.4g}", comma, digit * decade), comma = ", ";
        }
    return s + ")\n";
}

/// How a curve is drawn, in the diagram and in the legend.
struct Style {
    std::string line{};    // "lw 2 dt 1"; empty: none
    std::string symbol{};  // "pt 7 ps 0.6"; empty: none
    std::string colour{};

    std::string with() const {
        const char* kind = line.empty() ? "points" : symbol.empty() ? "lines" : "linespoints";
        return fmt::format("with {} {} {} lc rgb '{}'", kind, symbol, line, colour);
    }
};

Style style_of(const Curve& c, std::size_t number) {
    const std::string colour = colours[number % std::size(colours)];
    const auto round = number / std::size(colours);
    if (c.points) return {.symbol = fmt::format("pt {} ps 0.8", 4 + 2 * (number % 6)), .colour = colour};
    if (c.dashed) return {.line = "lw 1.5 dt 2", .colour = "#777777"};
    const std::string line = round == 0 ? "lw 2 dt 1" : fmt::format("lw 1.5 dt ({},3)", 4 + 4 * (round % 3));
    if (c.size() > 12) return {.line = line, .colour = colour};
    return {.line = line, .symbol = fmt::format("pt {} ps 0.6", symbols[round % std::size(symbols)]), .colour = colour};
}

/// A panel and the room that it needs.
class Drawing {
public:
    explicit Drawing(const Panel& panel)
        : panel_(panel),
          curves_(drawn_curves(panel)),
          title_(lines_of(panel.title, title_letters)),
          x_{.log = panel.x.log},
          y_{.log = panel.y.log} {
        for (const Curve& c : curves_)
            for (std::size_t i = 0; i < c.size(); ++i) {
                const real half = c.half_widths.empty() ? 0 : c.half_widths[i];
                x_.include(c.x[i]), y_.include(c.y[i] - half), y_.include(c.y[i] + half);
            }
        if (panel.shade.below > 0) y_.include(panel.shade.below);
        x_.widen(), y_.widen();
        std::size_t number = 0;
        for (const Curve& c : curves_) entries_.push_back({style_of(c, c.dashed ? 0 : number++), c.label});
        if (panel.shade.below > 0) entries_.push_back({{.colour = shade_colour}, panel.shade.label});
        for (Entry& entry : entries_) {  // from left to right, in rows
            const double w = swatch + 8 + letter_width(legend_font) * static_cast<double>(entry.label.size());
            if (legend_end_ > margin && legend_end_ + w > panel_width - margin) ++rows_, legend_end_ = margin;
            entry.x = legend_end_, entry.row = rows_ - 1;
            legend_end_ += w + 14;
        }
    }
    bool empty() const { return curves_.empty(); }
    double above() const { return 12 + line_height * static_cast<double>(title_.size()); }
    double height() const { return above() + plot_height + below_axis + legend_row * rows_ + 4; }

    /// With its upper left corner at (x0, y0) and the axes `above` below it.
    std::string program(const Paper& paper, double x0, double y0, double above, std::size_t number) {
        const double x1 = x0 + left_margin, x2 = x0 + panel_width - right_margin, y1 = y0 + above, y2 = y1 + plot_height;
        std::string s = "unset logscale; unset label; unset arrow; unset object\n" + margins(paper, x1, x2, y1, y2);
        s += axis("x", x_) + axis("y", y_);
        for (std::size_t i = 0; i < title_.size(); ++i)
            s +=
                label(paper, title_[i], x0 + panel_width / 2, y1 - 12 - line_height * static_cast<double>(title_.size() - 1 - i), "center");
        s += label(paper, panel_.x.label, (x1 + x2) / 2, y2 + 40, "center");
        s += label(paper, panel_.y.label, x0 + 14, (y1 + y2) / 2, "center rotate by 90");
        s += "unset key\n" + legend(paper, x0, y2 + below_axis);
        const std::string names = names_of(paper, x1, x2, y1, y2);
        return s + names + marks() + curves(number) + "\n";
    }

private:
    std::string curves(std::size_t number) const {
        std::string data, plots;
        if (panel_.shade.below > 0)
            plots =
                fmt::format("plot {:.9g} with filledcurves y1={:.9g} fc rgb '{}' {}", panel_.shade.below, y_.low, shade_colour, shade_fill);
        for (std::size_t k = 0; k < curves_.size(); ++k) {
            const Curve& c = curves_[k];
            const std::string block = fmt::format("$p{}c{}", number, k);
            data += block + " << EOD\n";
            for (std::size_t i = 0; i < c.size(); ++i)
                data +=
                    fmt::format("{:.9g} {:.9g}{}\n", c.x[i], c.y[i], c.half_widths.empty() ? "" : fmt::format(" {:.9g}", c.half_widths[i]));
            data += "EOD\n";
            const char* next = ", \\\n     ";
            if (!c.half_widths.empty())  // below the curve: gnuplot clears a box around each of their points
                plots += fmt::format("{}{} using 1:2:3 with yerrorbars lw 1.2 pt 0 lc rgb '{}'", plots.empty() ? "plot " : next, block,
                                     entries_[k].style.colour);
            plots += fmt::format("{}{} using 1:2 {}", plots.empty() ? "plot " : next, block, entries_[k].style.with());
        }
        return data + plots;
    }
    std::string legend(const Paper& paper, double x0, double y0) const {
        std::string s;
        for (const Entry& e : entries_) {
            const double x = x0 + e.x, y = y0 + legend_row * e.row;
            if (!e.style.line.empty())
                s += fmt::format("set arrow from screen {:.5f},{:.5f} rto screen {:.5f},0 nohead {} lc rgb '{}'\n", paper.x(x), paper.y(y),
                                 swatch / paper.width, e.style.line, e.style.colour);
            if (!e.style.symbol.empty())
                s += label(paper, "", x + swatch / 2, y, fmt::format("point {} lc rgb '{}'", e.style.symbol, e.style.colour));
            if (e.style.line.empty() && e.style.symbol.empty())
                s += fmt::format("set object rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} fc rgb '{}' {}\n", paper.x(x),
                                 paper.y(y + 6), paper.x(x + swatch), paper.y(y - 6), e.style.colour, shade_fill);
            s += label(paper, e.label, x + swatch + 6, y, fmt::format("left font ',{}'", legend_font));
        }
        return s;
    }
    std::string marks() const {
        std::string s;
        for (const Mark& mark : panel_.marks)
            if (mark.at > x_.low && mark.at < x_.high)
                s += fmt::format("set arrow from first {0:.9g},graph 0 to first {0:.9g},graph 1 nohead lc rgb '#7a8591'\n", mark.at);
        return s;
    }
    /// Names of the points of dashed curves, and of the marks, where there is room.
    std::string names_of(const Paper& paper, double x1, double x2, double y1, double y2) const {
        Names names({x1 + 2, y1 + 2, x2 + right_margin - 4, y2 - 2});
        const auto at = [&](real x, real y) { return std::pair{x1 + x_.part(x) * (x2 - x1), y2 - y_.part(y) * (y2 - y1)}; };
        for (const Curve& c : curves_)
            for (std::size_t i = 0; i < c.size(); ++i) {
                const auto [x, y] = at(c.x[i], c.y[i]);
                if (!c.dashed) names.keep_free(x, y);
                if (i == 0 || c.points) continue;
                const auto [before_x, before_y] = at(c.x[i - 1], c.y[i - 1]);
                names.avoid_line(before_x, before_y, x, y);
            }
        std::string s;
        const auto put = [&](double x, double y, const std::string& name) {
            constexpr std::array anchors{"left", "center", "right"};
            if (const auto place = names.beside(x, y, name))
                s += label(paper, name, place->x, place->y - 4,
                           fmt::format("{} font ',10' front", anchors[static_cast<std::size_t>(place->anchor)]));
        };
        for (const Mark& mark : panel_.marks)
            if (mark.at > x_.low && mark.at < x_.high) put(at(mark.at, y_.low).first, y2 - 2, mark.label);
        for (const Curve& c : curves_)
            for (std::size_t i = 0; i < c.names.size() && c.dashed; ++i) {
                const auto [x, y] = at(c.x[i], c.y[i]);
                put(x, y, c.names[i]);
            }
        return s;
    }

    const Panel& panel_;
    std::vector<Curve> curves_;
    std::vector<std::string> title_;
    Range x_, y_;
    struct Entry {
        Style style;
        std::string label;
        double x = 0;  // from the left side of the panel
        int row = 0;
    };
    std::vector<Entry> entries_{};
    int rows_ = 1;
    double legend_end_ = margin;
};

}  // namespace

std::string gnuplot_program(const std::string& title, const std::vector<Panel>& panels) {
    std::vector<Drawing> drawings;
    for (const Panel& panel : panels)
        if (Drawing drawing(panel); !drawing.empty()) drawings.push_back(std::move(drawing));
    const std::size_t columns = drawings.size() > 1 ? 2 : 1;
    const double head = title.empty() ? 0 : 30;
    double height = head;
    std::vector<double> tops, aboves;  // of each row
    for (std::size_t i = 0; i < drawings.size(); i += columns) {
        const Drawing &one = drawings[i], &other = drawings[std::min(i + columns, drawings.size()) - 1];
        tops.push_back(height), aboves.push_back(std::max(one.above(), other.above()));
        height += std::max(one.height() - one.above(), other.height() - other.above()) + aboves.back();
    }
    const Paper paper{panel_width * static_cast<double>(columns), std::max(height, 60.0)};
    std::string s = fmt::format("set terminal svg size {:.0f},{:.0f} font 'sans,13' background '#ffffff'\n", paper.width, paper.height);
    s += "set grid lc rgb '#dddddd'; set border lw 1\nset multiplot\n";
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        std::string panel =
            drawings[i].program(paper, panel_width * static_cast<double>(i % columns), tops[i / columns], aboves[i / columns], i);
        if (i == 0 && !title.empty())  // a label needs a plot that draws it
            panel.insert(panel.find("unset key"), label(paper, title, paper.width / 2, 18, "center font ',16'"));
        s += panel;
    }
    return s + "unset multiplot\n";
}

}  // namespace weir::validation
