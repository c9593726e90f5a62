#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace weir::scene {

int edit_distance(std::string_view a, std::string_view b) {
    const auto letter = [](std::string_view s, std::size_t i) { return std::tolower(static_cast<unsigned char>(s[i])); };
    std::array<std::vector<int>, 3> row;  // for the letters i - 2, i - 1, i of a
    for (auto& r : row) r.assign(b.size() + 1, 0);
    for (std::size_t j = 0; j <= b.size(); ++j) row[2][j] = static_cast<int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::rotate(row.begin(), row.begin() + 1, row.end());
        row[2][0] = static_cast<int>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const int replaced = row[1][j - 1] + (letter(a, i - 1) != letter(b, j - 1));
            row[2][j] = std::min({row[1][j] + 1, row[2][j - 1] + 1, replaced});
            if (i > 1 && j > 1 && letter(a, i - 1) == letter(b, j - 2) && letter(a, i - 2) == letter(b, j - 1))
                row[2][j] = std::min(row[2][j], row[0][j - 2] + 1);
        }
    }
    return row[2][b.size()];
}

namespace {

/// "rotate" and "rotation": the longer word starts with most of the shorter one.
bool same_beginning(std::string_view a, std::string_view b) {
    const std::size_t shorter = std::min(a.size(), b.size());
    std::size_t same = 0;
    while (same < shorter && a[same] == b[same]) ++same;
    return same >= 4 && same + 1 >= shorter;
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& names) {
    constexpr std::size_t longest = 64;  // a longer word is not a typo
    if (word.empty() || word.size() > longest) return {};
    std::string best;
    int best_distance = 1 + static_cast<int>((std::max<std::size_t>(word.size(), 3)) / 3);
    for (const auto& name : names)
        if (const int d = edit_distance(word, name); d < best_distance) best = name, best_distance = d;
    if (!best.empty()) return best;
    const auto begins = std::find_if(names.begin(), names.end(), [&](const auto& name) { return same_beginning(word, name); });
    return begins == names.end() ? std::string() : *begins;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& names) {
    const auto name = nearest(word, names);
    return name.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", name);
}

std::string known(const std::vector<std::string>& names) {
    if (names.empty()) return "none is known";
    return fmt::format("known: {}", fmt::join(names, ", "));
}

std::string quote(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string out = "\"";
    std::size_t i = 0;
    for (; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (i >= longest && (c & 0xC0U) != 0x80U) break;
        if (c == '\n')
            out += "\\n";
        else if (c < 0x20 || c == 0x7F)
            out += fmt::format("\\x{:02x}", c);
        else
            out += text[i];
    }
    return out + (i < text.size() ? "...\"" : "\"");
}

std::string quote_all(const std::vector<std::string>& names) {
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) out += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + quote(names[i]);
    return out;
}

std::string number_text(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    return fmt::format("{}", value);
}

std::string side_key(int axis, int end) { return std::string("sides.") + "xyz"[axis] + (end == 0 ? "_min" : "_max"); }

}  // namespace weir::scene
