#include "scene/source_text.hpp"

#include "scene/document.hpp"
#include "scene/names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace weir::scene {
namespace {

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

bool is_text_byte(char c) { return static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

std::size_t sequence_length(std::string_view s) {
    const auto byte = [&](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0U; };
    const auto tail = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) { return byte(i) >= low && byte(i) <= high; };
    const unsigned b = byte(0);
    if (b < 0x80) return 1;
    if (b >= 0xC2 && b <= 0xDF) return tail(1) ? 2 : 0;
    if (b >= 0xE0 && b <= 0xEF) return tail(1, b == 0xE0 ? 0xA0 : 0x80, b == 0xED ? 0x9F : 0xBF) && tail(2) ? 3 : 0;
    if (b >= 0xF0 && b <= 0xF4) return tail(1, b == 0xF0 ? 0x90 : 0x80, b == 0xF4 ? 0x8F : 0xBF) && tail(2) && tail(3) ? 4 : 0;
    return 0;
}

int count_characters(std::string_view text) {
    return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

std::size_t byte_of_column(std::string_view line, int column) {
    std::size_t i = 0;
    for (int c = 1; i < line.size(); ++i) {
        if (is_continuation(line[i])) continue;
        if (c++ == column) return i;
    }
    return line.size();
}

int token_width(std::string_view line, int column) {
    const std::string_view rest = line.substr(byte_of_column(line, column));
    if (rest.empty() || rest[0] == '{') return 1;  // a table in braces may be long, and the error is its presence
    std::size_t end = 0;
    int depth = 0;
    char quote = 0;
    for (; end < rest.size(); ++end) {
        const char c = rest[end];
        if (quote) {
            if (c == '\\' && quote == '"')
                ++end;
            else if (c == quote)
                quote = 0;
            if (!quote && depth == 0) return count_characters(rest.substr(0, end + 1));
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == '{') {
            ++depth;
        } else if (c == ']' || c == '}') {
            if (--depth <= 0) return count_characters(rest.substr(0, depth < 0 ? std::max<std::size_t>(end, 1) : end + 1));
        } else if (c == '#' && depth > 0) {
            break;
        } else if (depth == 0 && (c == ',' || c == '=' || c == ' ' || c == '\t' || c == '#' ||
                                  (c == '.' && end > 0 && (std::isalpha(static_cast<unsigned char>(rest[0])) || rest[0] == '_')))) {
            return count_characters(rest.substr(0, std::max<std::size_t>(end, 1)));
        }
    }
    std::string_view token = rest.substr(0, std::min(end, rest.size()));
    while (token.size() > 1 && (token.back() == ' ' || token.back() == '\t')) token.remove_suffix(1);
    return std::max(1, count_characters(token));
}

/// One pass over the text that recognizes strings, comments and brackets: finds the starts of lines and what is open there. It also finds
/// text that must not reach the parser: nesting that would make recursion too deep, and characters outside texts and comments for which its
/// behaviour is undefined (toml++ 3.3 calls std::unreachable on some).
class SourceText::Scan {
public:
    explicit Scan(SourceText& text) : to_(text), s_(text.text_) {}

    void run() {
        to_.starts_ = {0};
        to_.line_starts_ = {{}};
        for (; i_ < s_.size(); ++i_) {
            if (!is_continuation(s_[i_])) ++column_;
            if (s_[i_] == '\n')
                end_line();
            else if (in_ == In::nothing)
                outside(s_[i_]);
            else
                inside(s_[i_]);
        }
        to_.line_starts_.push_back({is_long(), open_});
    }

private:
    enum class In { nothing, comment, basic, literal, long_basic, long_literal };
    static constexpr int max_dots = 16;
    static constexpr std::size_t max_depth = 32;

    bool is_long() const { return in_ == In::long_basic || in_ == In::long_literal; }
    bool tripled() const { return s_.substr(i_, 3) == std::string(3, s_[i_]); }
    void skip(int n) { i_ += static_cast<std::size_t>(n), column_ += n; }
    void refuse(std::string message, std::string hint = "") {
        if (!to_.refused_)
            to_.refused_ = Problem{.place = {line_, column_}, .width = 1, .message = std::move(message), .hint = std::move(hint)};
    }

    void end_line() {
        if (!is_long()) in_ = In::nothing;
        to_.starts_.push_back(i_ + 1);
        to_.line_starts_.push_back({is_long(), open_});
        ++line_, column_ = 0, dots_ = 0;
    }

    void inside(char c) {
        const bool basic = in_ == In::basic || in_ == In::long_basic;
        if (in_ == In::comment) return;
        if (c == '\\' && basic) {
            if (i_ + 1 < s_.size() && s_[i_ + 1] != '\n') skip(1);
        } else if (c == (basic ? '"' : '\'') && (!is_long() || tripled())) {
            if (is_long()) skip(2);
            for (int more = 0; is_long() && more < 2 && i_ + 1 < s_.size() && s_[i_ + 1] == c; ++more)
                skip(1);  // """a"""" ends with a quote
            in_ = In::nothing;
        }
    }

    void outside(char c) {
        if (c == '#') {
            in_ = In::comment;
        } else if (c == '"' || c == '\'') {
            const bool is_triple = tripled();
            in_ = c == '"' ? (is_triple ? In::long_basic : In::basic) : (is_triple ? In::long_literal : In::literal);
            if (is_triple) to_.text_began_ = {line_, column_}, skip(2);
        } else if (c == '[' || c == '{') {
            if (open_.size() < max_depth)
                open_.push_back({line_, column_});
            else
                refuse(fmt::format("lists and tables nested more than {} deep", max_depth));
        } else if ((c == ']' || c == '}') && !open_.empty()) {
            open_.pop_back();
        } else if (c == '.' && ++dots_ > max_dots) {
            refuse(fmt::format("a key of more than {} parts", max_dots));
        } else if (static_cast<unsigned char>(c) >= 0x80) {
            const auto letter = s_.substr(i_, std::max<std::size_t>(1, sequence_length(s_.substr(i_, 4))));
            refuse(fmt::format("{} is allowed only in a text or a comment", quote(letter)), "keys are letters, digits, '_' and '-'");
        }
        if (std::string_view(",=[]{}").find(c) != std::string_view::npos) dots_ = 0;
    }

    SourceText& to_;
    std::string_view s_;
    In in_ = In::nothing;
    std::vector<Place> open_;
    std::size_t i_ = 0;
    int line_ = 1, column_ = 0, dots_ = 0;
};

SourceText::SourceText(std::string_view text) : text_(text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text) {  // a byte order mark
    if (text_.size() <= max_source_bytes) Scan(*this).run();
}

std::string_view SourceText::line(int number) const {
    if (number < 1 || number > line_count()) return {};
    const auto i = static_cast<std::size_t>(number - 1);
    const std::size_t end = i + 1 < starts_.size() ? starts_[i + 1] : text_.size();
    std::string_view line = std::string_view(text_).substr(starts_[i], end - starts_[i]);
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    return line;
}

std::optional<Problem> SourceText::unreadable() const {
    if (text_.size() > max_source_bytes)
        return Problem{.message = fmt::format("the text is {} bytes long; at most {} are read", text_.size(), max_source_bytes)};
    if (text_.find('\0') != std::string::npos)
        return Problem{.message = "this is not a text file", .hint = "a scene is a text file in UTF-8"};
    int line = 1, column = 1;
    for (std::size_t i = 0; i < text_.size();) {
        const auto length = sequence_length(std::string_view(text_).substr(i, 4));
        const auto byte = static_cast<unsigned char>(text_[i]);
        if (length == 0)
            return Problem{.place = {line, column},
                           .width = 1,
                           .message = fmt::format("byte 0x{:02x} is not valid UTF-8", byte),
                           .hint = "a scene is a text file in UTF-8"};
        if (!is_text_byte(text_[i]))
            return Problem{.place = {line, column},
                           .width = 1,
                           .message = fmt::format("control character 0x{:02x}", byte),
                           .hint = "a scene is a text file in UTF-8"};
        ++column;
        if (text_[i] == '\n') ++line, column = 1;
        i += length;
    }
    return refused_;
}

bool SourceText::blank_statement(int number) {
    if (number < 1 || number > line_count()) return false;
    const auto i = static_cast<std::size_t>(number);
    const auto closed = [](const LineStart& start) { return !start.in_text && start.open.empty(); };
    if (!closed(line_starts_[i - 1]) || !closed(line_starts_[i])) return false;
    const auto content = line(number);
    const auto first = content.find_first_not_of(" \t");
    if (first == std::string_view::npos || content[first] == '[') return false;
    std::fill_n(text_.begin() + static_cast<std::ptrdiff_t>(starts_[i - 1]), content.size(), ' ');
    return true;
}

Place SourceText::open_at(Place place) const {
    if (place.line < 1 || place.line > line_count()) return {};
    auto open = line_starts_[static_cast<std::size_t>(place.line - 1)].open;
    const auto before = line(place.line).substr(0, byte_of_column(line(place.line), place.column));
    char quote = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        const char c = before[i];
        if (quote) {
            if (c == '\\' && quote == '"')
                ++i;
            else if (c == quote)
                quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == '{') {
            open.push_back({place.line, count_characters(before.substr(0, i)) + 1});
        } else if ((c == ']' || c == '}') && !open.empty()) {
            open.pop_back();
        }
    }
    return open.empty() ? Place{} : open.back();
}

Place SourceText::open_at(int number) const {
    if (number < 1 || number > line_count() + 1) return {};
    const LineStart& start = line_starts_[static_cast<std::size_t>(number - 1)];
    if (start.in_text) return text_began_;
    return start.open.empty() ? Place{} : start.open.back();
}

}  // namespace weir::scene
