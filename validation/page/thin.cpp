#include "validation/page/thin.hpp"

#include "validation/page/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace weir::validation {
namespace {

struct Point {
    double x, y;
};
using Line = std::vector<Point>;

constexpr double visible = 0.5;        // pixels off the straight line
constexpr double column = 1.0;         // pixels
constexpr double mark_distance = 1.5;  // pixels

void replace_all(std::string& s, std::string_view from, std::string_view to) {
    for (std::size_t at = 0; (at = s.find(from, at)) != std::string::npos; at += to.size()) s.replace(at, from.size(), to);
}

/// Of each run of points within a column: the first, the lowest, the highest, the last, in their order.
Line by_columns(const Line& line) {
    Line kept;
    for (std::size_t begin = 0; begin < line.size();) {
        std::size_t end = begin + 1;
        while (end < line.size() && std::floor(line[end].x / column) == std::floor(line[begin].x / column)) ++end;
        std::size_t low = begin, high = begin;
        for (std::size_t i = begin; i < end; ++i) low = line[i].y < line[low].y ? i : low, high = line[i].y > line[high].y ? i : high;
        for (const std::size_t i : std::set<std::size_t>{begin, low, high, end - 1}) kept.push_back(line[i]);
        begin = end;
    }
    return kept;
}

double distance(Point p, Point a, Point b) {
    const double dx = b.x - a.x, dy = b.y - a.y, squared = dx * dx + dy * dy;
    const double s = squared > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
    return std::hypot(p.x - a.x - s * dx, p.y - a.y - s * dy);
}

/// Douglas & Peucker 1973, with a list of open pieces in place of recursion.
Line straightened(const Line& line) {
    if (line.size() < 3) return line;
    std::vector<char> keep(line.size(), 0);
    keep.front() = keep.back() = 1;
    std::vector<std::pair<std::size_t, std::size_t>> open = {{0, line.size() - 1}};
    while (!open.empty()) {
        const auto [a, b] = open.back();
        open.pop_back();
        std::size_t farthest = a;
        double most = visible;
        for (std::size_t i = a + 1; i < b; ++i)
            if (const double d = distance(line[i], line[a], line[b]); d > most) most = d, farthest = i;
        if (farthest == a) continue;
        keep[farthest] = 1;
        open.push_back({a, farthest});
        open.push_back({farthest, b});
    }
    Line kept;
    for (std::size_t i = 0; i < line.size(); ++i)
        if (keep[i]) kept.push_back(line[i]);
    return kept;
}

/// Tenths of a pixel, as short as SVG reads them: 12 is 1.2, 10 is 1, −5 is −.5.
std::string tenths(long value) {
    const long whole = std::abs(value) / 10, digit = std::abs(value) % 10;
    std::string text = value < 0 ? "-" : "";
    if (whole > 0 || digit == 0) text += std::to_string(whole);
    return digit > 0 ? text + "." + std::to_string(digit) : text;
}

/// Each line from its first point on by steps: their numbers are shorter than those of points.
std::string path_of(const std::vector<Line>& lines) {
    std::string d;
    for (const Line& line : lines) {
        const char* command = "M";
        long x = 0, y = 0;
        for (const Point p : straightened(by_columns(line))) {
            const long to_x = std::lround(10 * p.x), to_y = std::lround(10 * p.y);
            d += command + tenths(to_x - x) + "," + tenths(to_y - y);
            command = *command == 'M' ? "l" : " ";
            x = to_x, y = to_y;
        }
    }
    return d;
}

/// The path with fewer corners; itself where it holds anything but absolute M and L.
std::string thinner_path(std::string_view d) {
    std::vector<Line> lines;
    const char* at = d.data();
    const char* const end = d.data() + d.size();
    const auto number = [&](double& value) {
        char* after = nullptr;
        value = std::strtod(at, &after);  // the text goes on behind the path, so it ends in a quote
        if (after == at || after > end) return false;
        at = after;
        return true;
    };
    while (at < end) {
        if (std::isspace(static_cast<unsigned char>(*at)) || *at == ',') {
            ++at;
            continue;
        }
        if (*at == 'M')
            lines.emplace_back(), ++at;
        else if (*at == 'L')
            ++at;
        Point p{};
        if (lines.empty() || !number(p.x) || at >= end || *at != ',') return std::string(d);
        ++at;
        if (!number(p.y)) return std::string(d);
        lines.back().push_back(p);
    }
    return path_of(lines);
}

/// Text between `from` and the next `until`, from `at` on; empty where there is none.
std::string_view between(std::string_view s, std::size_t at, std::string_view from, char until) {
    const auto begin = s.find(from, at);
    if (begin == std::string_view::npos) return {};
    const auto end = s.find(until, begin + from.size());
    return end == std::string_view::npos ? std::string_view{} : s.substr(begin + from.size(), end - begin - from.size());
}

/// Marks seen so far: a second one in the same square of the same kind is not seen.
class Marks {
public:
    bool hidden(std::string_view tag) {
        const auto where = between(tag, 0, "transform='translate(", ')');
        const auto comma = where.find(',');
        if (where.empty() || comma == std::string_view::npos) return false;
        const double x = std::atof(std::string(where.substr(0, comma)).c_str());
        const double y = std::atof(std::string(where.substr(comma + 1)).c_str());
        const std::string kind = std::string(between(tag, 0, "href='", '\'')) + std::string(between(tag, 0, "color='", '\''));
        return !seen_.insert({kind, std::lround(x / mark_distance), std::lround(y / mark_distance)}).second;
    }
    void forget() { seen_.clear(); }

private:
    std::set<std::tuple<std::string, long, long>> seen_;
};

/// Of groups that hold nothing, or nothing but such groups, nothing is left.
std::string without_empty_groups(const std::string& svg) {
    constexpr std::string_view closes = "</g>";
    std::string out;
    for (std::size_t at = 0; at < svg.size();) {
        const auto end = std::min(svg.find(closes, at), svg.size());
        out.append(svg, at, end - at);
        at = end + closes.size();
        if (end == svg.size()) break;
        const auto last = out.find_last_not_of(" \n"), begins = out.rfind('<');
        const bool empty = last != std::string::npos && begins != std::string::npos && out[last] == '>' && out[last - 1] != '/' &&
                           out.find('>', begins) == last && (out.compare(begins, 3, "<g ") == 0 || out.compare(begins, 3, "<g>") == 0);
        if (empty)
            out.erase(begins);
        else
            out += closes;
    }
    return out;
}

}  // namespace

std::string thin_svg(const std::string& svg) {
    std::string out;
    out.reserve(svg.size() / 2);
    Marks marks;
    for (std::size_t at = 0; at < svg.size();) {
        const auto tag = svg.find('<', at);
        if (tag == std::string::npos) return out + svg.substr(at);
        const auto close = svg.find('>', tag);
        if (close == std::string::npos) return out + svg.substr(at);
        out.append(svg, at, tag - at);
        const std::string_view whole(svg.data() + tag, close + 1 - tag);
        at = close + 1;
        if (whole.starts_with("<g id=")) marks.forget();  // the next curve
        if (whole.starts_with("<use") && marks.hidden(whole)) continue;
        const auto d = whole.starts_with("<path") ? between(whole, 0, " d='", '\'') : std::string_view{};
        if (d.size() < 80) {
            out += whole;
            continue;
        }
        out += whole.substr(0, static_cast<std::size_t>(d.data() - whole.data()));
        out += thinner_path(d);
        out += whole.substr(static_cast<std::size_t>(d.data() - whole.data()) + d.size());
    }
    return out;
}

namespace {

/// The definitions between <defs> and </defs> as gnuplot writes them: one on a line, or a filter over several.
std::vector<std::string> definitions_of(const std::string& defs) {
    std::vector<std::string> list;
    std::istringstream in(defs);
    bool in_filter = false;
    for (std::string line; std::getline(in, line);) {
        if (line.find_first_not_of(" \t") == std::string::npos) continue;
        if (in_filter)
            list.back() += "\n" + line;
        else
            list.push_back(line);
        if (line.find("<filter") != std::string::npos) in_filter = true;
        if (line.find("</filter>") != std::string::npos) in_filter = false;
    }
    return list;
}

/// Whether `text` refers to the element that `definition` defines.
bool refers_to(const std::string& text, const std::string& definition) {
    const auto id = definition.find("id='");
    if (id == std::string::npos) return true;
    const std::string name = definition.substr(id + 4, definition.find('\'', id + 4) - id - 4);
    for (const char* form : {"#{}'", "#{}\"", "#{})"})
        if (text.find(fmt::format(fmt::runtime(form), name)) != std::string::npos) return true;
    return false;
}

/// Without marks and filters that nothing uses: gnuplot defines all of them in each file.
std::string without_unused_definitions(const std::string& svg) {
    const auto begin = svg.find("<defs>"), end = svg.find("</defs>");
    if (begin == std::string::npos || end == std::string::npos || end < begin) return svg;
    std::vector<std::string> left = definitions_of(svg.substr(begin + 6, end - begin - 6)), kept;
    const std::string head = svg.substr(0, begin), tail = svg.substr(end);
    std::string using_text = head + tail;
    for (bool found = true; found;) {  // a mark may use another one
        found = false;
        for (auto it = left.begin(); it != left.end();) {
            if (!refers_to(using_text, *it)) {
                ++it;
                continue;
            }
            using_text += *it;
            kept.push_back(*it);
            it = left.erase(it), found = true;
        }
    }
    std::string defs;
    for (const auto& definition : kept) defs += "\n" + definition;
    return head + "<defs>" + defs + "\n" + tail;
}

}  // namespace

std::string inline_svg(const std::string& svg, std::string_view prefix) {
    const auto begin = svg.find("<svg");
    std::string s = without_unused_definitions(begin == std::string::npos ? svg : svg.substr(begin));
    if (const auto desc = s.find("<desc>"); desc != std::string::npos && s.find("</desc>") != std::string::npos)
        s.erase(desc, s.find("</desc>") + 7 - desc);
    if (const auto title = s.find("<title>Gnuplot</title>"); title != std::string::npos) s.erase(title, 22);
    for (const char* quote : {"'", "\""}) replace_all(s, fmt::format("id={}", quote), fmt::format("id={}{}-", quote, prefix));
    replace_all(s, "href='#", fmt::format("href='#{}-", prefix));
    for (const auto& [from, to] : {std::pair{"fill=\"#ffffff\"", "fill=\"none\""},
                                   {"fill=\"black\"", "fill=\"currentColor\""},
                                   {"color=\"black\"", ""},
                                   {"stroke='black'", "stroke='currentColor'"},
                                   {"stroke=\"black\"", "stroke=\"currentColor\""},
                                   {"rgb(  0,   0,   0)", "currentColor"},
                                   {"xlink:href", "href"},
                                   {" font-family=\"sans\"", ""},
                                   {" stroke-width=\"1.00\"", ""},  // as without, like the next two
                                   {" stroke-linecap=\"butt\"", ""},
                                   {" stroke-linejoin=\"miter\"", ""},
                                   {" class=\"gridline\"", ""},
                                   {"  '/>", "'/>"}})
        replace_all(s, from, to);
    std::string one_line;  // no blank lines, no indentation
    bool line_begins = true;
    for (const char c : s) {
        if (line_begins && (c == ' ' || c == '\t' || c == '\n')) continue;
        one_line += c;
        line_begins = c == '\n';
    }
    return without_empty_groups(one_line);
}

std::string plot_figure(const std::string& svg, std::string_view prefix) {
    return "<figure class=\"scroll\">" + inline_svg(thin_svg(svg), prefix) + "</figure>\n";
}

std::string published_plot(const std::filesystem::path& svg, const std::string& prefix) {
    const std::string text = bytes_of(svg);
    if (text.empty()) return "<p>No plot is published.</p>";
    return plot_figure(text, prefix);
}

}  // namespace weir::validation
