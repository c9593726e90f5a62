#include "validation/page/chart.hpp"

#include "validation/page/names.hpp"
#include "validation/page/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace weir::validation {
namespace {

constexpr int colours = 8;  // --c0 to --c7 of the page
constexpr double width = 620, height = 400, left = 74, right = 20, top = 16, bottom = 58;

/// One axis on the paper: from data to pixels.
struct Scale {
    bool log = false;
    double low = 0, high = 1, from = 0, to = 1;
    double operator()(double v) const {
        const double s = log ? std::log10(v / low) / std::log10(high / low) : (v - low) / (high - low);
        return from + s * (to - from);
    }
};

bool drawable(const Panel& p, real x, real y) { return std::isfinite(x) && std::isfinite(y) && (!p.x.log || x > 0) && (!p.y.log || y > 0); }

/// Wide enough for all values, with a little room; a logarithmic axis covers a factor 3 at least.
Scale scale_of(bool log, std::vector<double> values, double from, double to) {
    Scale s{.log = log, .from = from, .to = to};
    if (values.empty()) values = {1};
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (log) {
        const double room = std::max(1.15, std::pow(*high / *low, 0.06));
        s.low = *low / room, s.high = *high * room;
        if (s.high / s.low < 3) s.low /= 1.8, s.high *= 1.8;
    } else {
        const double room = *high > *low ? 0.05 * (*high - *low) : std::max(1.0, std::abs(*low));
        s.low = *low - room, s.high = *high + room;
    }
    return s;
}

/// 1, 2, 5 steps on a linear axis; on a logarithmic one powers of ten, with 2 and 5 between where these are few, and more within a decade.
std::vector<double> ticks_of(const Scale& s) {
    std::vector<double> ticks;
    if (!s.log) {
        const double raw = (s.high - s.low) / 6, power = std::pow(10, std::floor(std::log10(raw)));
        const double step = power * (raw / power < 1.5 ? 1 : raw / power < 3.5 ? 2 : raw / power < 7.5 ? 5 : 10);
        for (double t = std::ceil(s.low / step) * step; t <= s.high; t += step) ticks.push_back(std::abs(t) < 1e-9 * step ? 0 : t);
        return ticks;
    }
    const double decades = std::log10(s.high / s.low);
    const int stride = std::max(1, static_cast<int>(std::ceil(decades / 8)));
    for (int e = static_cast<int>(std::floor(std::log10(s.low))); e <= std::log10(s.high); ++e)
        for (const double digit : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
            const bool one = digit == 1, one_two_five = one || digit == 2 || digit == 5;
            if ((!one && decades > 2.5) || (!one_two_five && decades > 1)) continue;
            if (one && e % stride != 0) continue;
            const double t = digit * std::pow(10, e);
            if (t >= s.low && t <= s.high) ticks.push_back(t);
        }
    return ticks;
}

std::string tick_text(double t, bool log) {
    const double e = std::log10(std::abs(t));
    if (log && (e < -3.5 || e > 4.5) && std::abs(e - std::round(e)) < 1e-9)
        return fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{:.0f}</tspan>", e);
    return fmt::format("{:g}", t);
}

std::string axes(const Panel& p, const Scale& sx, const Scale& sy) {
    std::string s;
    for (const double t : ticks_of(sx))
        s += fmt::format("<path class=\"grid\" d=\"M{0:.1f},{1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4}</text>\n",
                         sx(t), top, height - bottom, height - bottom + 18, tick_text(t, p.x.log));
    for (const double t : ticks_of(sy))
        s += fmt::format("<path class=\"grid\" d=\"M{0},{1:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
                         left, sy(t), width - right, left - 7, sy(t) + 4, tick_text(t, p.y.log));
    s += fmt::format("<path class=\"frame\" d=\"M{},{}V{}H{}\"/>\n", left, top, height - bottom, width - right);
    s += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", (left + width - right) / 2, height - 14,
                     escaped(p.x.label));
    return s + fmt::format("<text class=\"label\" transform=\"translate(16,{}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                           (top + height - bottom) / 2, escaped(p.y.label));
}

/// Colours have been used up once: the line is broken.
bool again(std::size_t number) { return number >= colours; }

std::string curve_svg(const Panel& p, const Curve& c, std::size_t number, const Scale& sx, const Scale& sy, Names& names) {
    std::string line, dots;
    double before_x = 0, before_y = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        if (!drawable(p, c.x[i], c.y[i])) continue;
        const double x = sx(c.x[i]), y = sy(c.y[i]);
        if (!line.empty() && !c.points) names.avoid_line(before_x, before_y, x, y);
        before_x = x, before_y = y;
        line += fmt::format("{}{:.1f},{:.1f}", line.empty() ? "M" : "L", x, y);
        if (c.dashed) continue;
        names.keep_free(x, y);
        const std::string name = i < c.names.size() ? c.names[i] : c.label;
        dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"><title>{}: {:.4g}, {:.4g}</title></circle>", x, y, escaped(name),
                            c.x[i], c.y[i]);
    }
    if (c.dashed) return fmt::format("<path class=\"guide\" d=\"{}\"/>\n", line);
    const std::string path = c.points ? "" : fmt::format("<path{} d=\"{}\"/>", again(number) ? " stroke-dasharray=\"8 3\"" : "", line);
    return fmt::format("<g class=\"k{}\">{}{}</g>\n", number % colours, path, dots);
}

std::string opening(double w, double h, const std::string& title) {
    return fmt::format(
        "<svg class=\"chart\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\" xmlns=\"http://www.w3.org/2000/svg\">\n", w, h,
        escaped(title));
}

}  // namespace

std::string chart_svg(const Panel& p, const std::vector<Mark>& marks) {
    std::vector<double> xs, ys;
    for (const Curve& c : p.curves)
        for (std::size_t i = 0; i < c.size(); ++i)
            if (drawable(p, c.x[i], c.y[i])) xs.push_back(c.x[i]), ys.push_back(c.y[i]);
    if (p.shade.below > 0) ys.push_back(p.shade.below);
    const Scale sx = scale_of(p.x.log, xs, left, width - right), sy = scale_of(p.y.log, ys, height - bottom, top);
    std::string s = opening(width, height, p.title);
    if (p.shade.below > 0)
        s += fmt::format("<rect class=\"shade\" x=\"{}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"><title>{}</title></rect>\n", left,
                         sy(p.shade.below), width - right - left, height - bottom - sy(p.shade.below), escaped(p.shade.label));
    s += axes(p, sx, sy);
    Names names({left, 0, width - 4, height - bottom});
    for (const Mark& mark : marks)
        if (mark.at > sx.low && mark.at < sx.high)
            s += fmt::format("<path class=\"mark\" d=\"M{0:.1f},{1}V{2}\"/><text class=\"name\" x=\"{3:.1f}\" y=\"{4}\">{5}</text>\n",
                             sx(mark.at), top, height - bottom, sx(mark.at) + 5, height - bottom - 6, escaped(mark.label));
    std::size_t number = 0;
    for (const Curve& c : p.curves) s += curve_svg(p, c, c.dashed ? 0 : number++, sx, sy, names);
    for (const Curve& c : p.curves)
        if (c.dashed)
            for (std::size_t i = 0; i < c.names.size(); ++i)
                if (drawable(p, c.x[i], c.y[i])) s += names.beside(sx(c.x[i]), sy(c.y[i]), c.names[i]);
    return s + "</svg>\n";
}

namespace {

std::string legend_item(std::size_t number, const std::string& label) {
    return fmt::format("<li><i class=\"k{}\"{}></i>{}</li>", number % colours, again(number) ? " style=\"border-top-style:dashed\"" : "",
                       escaped(label));
}

}  // namespace

std::string chart_legend(const Panel& p) {
    std::string s = "<ul class=\"legend\">";
    std::size_t number = 0;
    for (const Curve& c : p.curves)
        s += c.dashed ? fmt::format("<li><i class=\"dash\"></i>{}</li>", escaped(c.label)) : legend_item(number++, c.label);
    if (p.shade.below > 0) s += fmt::format("<li><i class=\"shade\"></i>{}</li>", escaped(p.shade.label));
    return s + "</ul>\n";
}

std::string map_svg(const Map& m) {
    constexpr double cell_h = 34, x0 = 104, y0 = 34, letter = 7.4;
    double cell_w = 56;  // no wider than what stands in it, so that a map of many columns can be read on a narrow page
    const auto room_for = [&](const std::string& text) { cell_w = std::max(cell_w, letter * static_cast<double>(text.size()) + 12); };
    for (const std::string& x : m.x) room_for(x);
    for (const auto& column : m.cells)
        for (const MapCell& c : column) room_for(c.text);
    const double w = x0 + cell_w * static_cast<double>(m.x.size()) + 16, rows = static_cast<double>(m.y.size());
    const double below = y0 + cell_h * rows, legend = below + 56, full = std::max(w, 560.0);
    std::string s = opening(full, legend + 22 * static_cast<double>(m.kinds.size() + 1) + 4, m.title);
    s += fmt::format("<text class=\"label\" x=\"8\" y=\"20\">{}</text>\n", escaped(m.title));
    for (std::size_t i = 0; i < m.x.size(); ++i) {
        s += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n", x0 + cell_w * (static_cast<double>(i) + 0.5),
                         below + 18, escaped(m.x[i]));
        for (std::size_t j = 0; j < m.y.size(); ++j) {
            const MapCell& c = m.cells[i][j];
            const double x = x0 + cell_w * static_cast<double>(i), y = below - cell_h * (static_cast<double>(j) + 1);
            s += fmt::format("<g class=\"cell {}\"><rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{}\" height=\"{}\"><title>{}</title></rect>",
                             c.stable ? std::string("held") : fmt::format("k{}", c.kind % colours), x, y, cell_w - 2, cell_h - 2,
                             escaped(c.detail));
            s += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text></g>\n", x + cell_w / 2 - 1,
                             y + cell_h / 2 + 4, escaped(c.text));
        }
    }
    for (std::size_t j = 0; j < m.y.size(); ++j)
        s += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"end\">{}</text>\n", x0 - 8,
                         below - cell_h * (static_cast<double>(j) + 0.5) + 4, escaped(m.y[j]));
    s += fmt::format("<text class=\"label\" x=\"{:.0f}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n",
                     x0 + cell_w * static_cast<double>(m.x.size()) / 2, below + 38, escaped(m.x_label));
    s += fmt::format("<text class=\"label\" transform=\"translate(18,{:.0f}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
                     (y0 + below) / 2, escaped(m.y_label));
    for (std::size_t k = 0; k <= m.kinds.size(); ++k) {
        const double y = legend + 22 * static_cast<double>(k);
        s += fmt::format(
            "<g class=\"cell {}\"><rect x=\"8\" y=\"{:.0f}\" width=\"16\" height=\"16\"/></g><text x=\"30\" y=\"{:.0f}\">{}</text>\n",
            k == 0 ? std::string("held") : fmt::format("k{}", (k - 1) % colours), y, y + 13,
            k == 0 ? "no failure" : escaped("first failure: " + m.kinds[k - 1] + " (step)"));
    }
    return s + "</svg>\n";
}

std::string standalone(const std::string& svg) {
    static constexpr const char* style = R"(<style>
text{font:12.5px sans-serif;fill:#1c2430}.label{font-weight:600}.name{font-size:11.5px}
.chart g path{stroke-width:1.8}.grid{stroke:#e2e6ea;fill:none}.frame{stroke:#5b6673;fill:none}.guide{stroke:#7a8591;fill:none;stroke-dasharray:5 4}
.mark{stroke:#7a8591;fill:none}.shade{fill:#eceff2}.cell text{fill:#fff}.held rect{fill:#cfe8dc}.held text{fill:#1c5a3d}
.k0 path{stroke:#0072b2;fill:none}.k0 rect,.k0 circle{fill:#0072b2}.k1 path{stroke:#c24d00;fill:none}.k1 rect,.k1 circle{fill:#c24d00}
.k2 path{stroke:#00805c;fill:none}.k2 rect,.k2 circle{fill:#00805c}.k3 path{stroke:#b0578a;fill:none}.k3 rect,.k3 circle{fill:#b0578a}
.k4 path{stroke:#a87400;fill:none}.k4 rect,.k4 circle{fill:#a87400}.k5 path{stroke:#2f8fc4;fill:none}.k5 rect,.k5 circle{fill:#2f8fc4}
.k6 path{stroke:#444;fill:none}.k6 rect,.k6 circle{fill:#444}.k7 path{stroke:#8a6fc0;fill:none}.k7 rect,.k7 circle{fill:#8a6fc0}
</style>
<rect width="100%" height="100%" fill="#fff"/>
)";
    const auto head = svg.find('\n');
    return svg.substr(0, head + 1) + style + svg.substr(head + 1);
}

namespace {

/// Words in lines of at most `most` letters.
std::vector<std::string> lines_of(const std::string& text, std::size_t most) {
    std::vector<std::string> lines{""};
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > most) lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

/// Entries of the legend from left to right in rows below `y`; gives where the last row ends.
double draw_legend(const Panel& p, double y, std::string& s) {
    constexpr double letter = 7.2, swatch = 24, gap = 16, row = 20;
    double x = 12;
    const auto entry = [&](const std::string& sign, const std::string& label) {
        const double w = swatch + 6 + letter * static_cast<double>(label.size());
        if (x > 12 && x + w > width) x = 12, y += row;
        s += fmt::format("<g transform=\"translate({:.0f} {:.0f})\">{}<text x=\"{}\" y=\"4\">{}</text></g>\n", x, y, sign, swatch + 6,
                         escaped(label));
        x += w + gap;
    };
    std::size_t number = 0;
    for (const Curve& c : p.curves) {
        const std::string line =
            fmt::format("<path d=\"M0,0H{}\"{}/>", swatch, !c.dashed && again(number) ? " stroke-dasharray=\"8 3\"" : "");
        entry(c.dashed ? fmt::format("<path class=\"guide\" d=\"M0,0H{}\"/>", swatch)
                       : fmt::format("<g class=\"k{}\">{}<circle cx=\"{}\" r=\"4\"/></g>", number % colours, line, swatch / 2),
              c.label);
        number += c.dashed ? 0 : 1;
    }
    if (p.shade.below > 0) entry(fmt::format("<rect class=\"shade\" y=\"-7\" width=\"{}\" height=\"14\"/>", swatch), p.shade.label);
    return y + row;
}

}  // namespace

std::string chart_file(const Panel& p, const std::vector<Mark>& marks) {
    std::string body;
    double y = 6;
    for (const std::string& line : lines_of(p.title, 72))
        body += fmt::format("<text class=\"label\" x=\"{}\" y=\"{:.0f}\" text-anchor=\"middle\">{}</text>\n", width / 2, y += 17,
                            escaped(line));
    const std::string chart = chart_svg(p, marks), head = "<svg class=\"chart\" ";
    body += fmt::format("<svg y=\"{:.0f}\" width=\"{}\" height=\"{}\" ", y += 8, width, height) + chart.substr(head.size());
    const double end = draw_legend(p, y + height + 8, body);
    return standalone(opening(width, end, p.title) + body + "</svg>\n");
}

}  // namespace weir::validation
