// A scene's problems as shown to the user: position and message, the line, an underline with known names.
#include "scene/names.hpp"
#include "scene/source_text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::scene {
namespace {

constexpr int tab_width = 4;
constexpr int shown_width = 110;  // characters shown around the error in a long line

/// The shown part of a line, and the underline's first column and width in it.
struct Excerpt {
    std::string text;
    int column = 0, width = 0;
};

/// Returns whether a character may be printed: no control characters or invalid UTF-8.
bool is_shown(std::string_view letter) {
    return sequence_length(letter) == letter.size() && static_cast<unsigned char>(letter[0]) >= 0x20 && letter[0] != 0x7F;
}

Excerpt excerpt(std::string_view line, int column, int width) {
    const int length = count_characters(line);
    column = std::clamp(column, 1, length + 1);
    width = std::clamp(width, 1, std::max(1, length + 1 - column));
    int first = 1;
    if (length > shown_width && column > shown_width / 2) first = std::min(column - shown_width / 3, length - shown_width + 1);
    Excerpt out{first > 1 ? "..." : "", 0, 0};
    int shown = count_characters(out.text);
    for (int c = first; c <= std::min(length, first + shown_width - 1); ++c) {
        const auto begin = byte_of_column(line, c);
        const auto letter = line.substr(begin, byte_of_column(line, c + 1) - begin);
        const bool tab = letter == "\t", shown_as_it_is = is_shown(letter);
        const int step = tab ? tab_width : 1;
        if (c == column) out.column = shown;
        if (c >= column && c < column + width) out.width += step;
        out.text += tab ? std::string(tab_width, ' ') : shown_as_it_is ? std::string(letter) : "?";
        shown += step;
    }
    if (column > length) out.column = shown, out.width = 1;
    if (first + shown_width - 1 < length) out.text += "...";
    return out;
}

std::string underline(const Excerpt& e, const std::string& hint) {
    std::string line =
        std::string(static_cast<std::size_t>(e.column), ' ') + "^" + std::string(static_cast<std::size_t>(std::max(0, e.width - 1)), '~');
    if (!hint.empty()) line += "   " + hint;
    return line;
}

std::string show(const Problem& p, const SourceText& source) {
    const bool override_text = p.place.line == 0 && p.place.column > 0 && p.file.starts_with("--set ");
    std::string out = p.file;
    if (p.place.line > 0) out += fmt::format(":{}:{}", p.place.line, p.place.column);
    out += ": " + p.message + "\n";
    if (p.place.line <= 0 && !override_text) return p.hint.empty() ? out : out + fmt::format("      | {}\n", p.hint);
    const std::string_view line = override_text ? std::string_view(p.file).substr(6) : source.line(p.place.line);
    const auto e = excerpt(line, p.place.column, p.width > 0 ? p.width : token_width(line, p.place.column));
    out += override_text ? fmt::format("      | {}\n", e.text) : fmt::format("{:5} | {}\n", p.place.line, e.text);
    return out + fmt::format("      | {}\n", underline(e, p.hint));
}

std::string report(const std::vector<Problem>& problems, std::string_view source) {
    constexpr std::size_t max_shown = 50;
    const SourceText text{source};
    std::string out;
    for (std::size_t i = 0; i < std::min(problems.size(), max_shown); ++i) out += show(problems[i], text);
    if (problems.size() > max_shown) out += fmt::format("... and {} more\n", problems.size() - max_shown);
    if (problems.size() > 1) out += fmt::format("{} problems\n", problems.size());
    if (!out.empty()) out.pop_back();
    return out;
}

std::vector<Problem> in_order(std::vector<Problem> problems) {
    const auto rank = [](const Problem& p) {  // the file from top to bottom, then overrides in order
        return std::array<int, 3>{p.place.override_number, p.place.line, p.place.column};
    };
    std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) { return rank(a) < rank(b); });
    return problems;
}

}  // namespace

BadScene::BadScene(std::vector<Problem> list, std::string_view source)
    : BadInput(report(in_order(list), source)), problems(in_order(list)) {}

}  // namespace weir::scene
