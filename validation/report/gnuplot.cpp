#include "validation/report/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace weir::validation::gnuplot {

namespace {

/// One line without control characters.
std::string plain(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, ' ');
    return text;
}

}  // namespace

double letter_width(double font_size) { return 0.52 * font_size; }

std::string quoted(const std::string& text) {
    std::string all = "'";
    for (const char c : plain(text)) all += c == '\'' ? "''" : std::string(1, c);
    return all + "'";
}

std::string quoted_datum(std::string text) {
    std::replace(text.begin(), text.end(), '"', '\'');
    std::replace(text.begin(), text.end(), '\\', '/');
    return '"' + plain(text) + '"';
}

std::vector<std::string> lines_of(const std::string& text, std::size_t most) {
    std::vector<std::string> lines;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (lines.empty() || lines.back().size() + 1 + word.size() > most)
            lines.push_back(word);
        else
            lines.back() += ' ' + word;
    }
    return lines;
}

std::string label(const Paper& paper, const std::string& text, double x, double y, const std::string& options) {
    return fmt::format("set label {} at screen {:.5f},{:.5f} {} noenhanced\n", quoted(text), paper.x(x), paper.y(y), options);
}

std::string margins(const Paper& paper, double left, double right, double top, double bottom) {
    return fmt::format(
        "set lmargin at screen {:.5f}; set rmargin at screen {:.5f}; set tmargin at screen {:.5f}; set bmargin at screen {:.5f}\n",
        paper.x(left), paper.x(right), paper.y(top), paper.y(bottom));
}

}  // namespace weir::validation::gnuplot
