// The TOML parser's complaints in our words. What it says that is not known here is passed on as it is.
#include "scene/source_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace weir::scene {
namespace {

std::string_view trimmed(std::string_view s) {
    while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
    while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
    return s;
}

bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; }

/// The statement's key ("grid.cells" of "grid.cells = 1", "[grid]" of a header).
std::string_view key_of(std::string_view line) {
    line = trimmed(line);
    if (!line.empty() && line.front() == '[')
        return line.substr(0, line.rfind(']') == std::string_view::npos ? line.size() : line.rfind(']') + 1);
    const auto equals = line.find('=');
    return equals == std::string_view::npos ? std::string_view{} : trimmed(line.substr(0, equals));
}

/// An earlier line with the same key under the same header; 0 where none is seen.
int first_given(const SourceText& text, int line) {
    const auto key = key_of(text.line(line));
    if (key.empty()) return 0;
    for (int n = line - 1; n >= 1; --n) {
        const auto other = key_of(text.line(n));
        if (other == key) return n;
        if (!other.empty() && other.front() == '[' && key.front() != '[') return 0;
    }
    return 0;
}

Problem given_twice(const std::string& name, Place place, const SourceText& text) {
    const auto line = text.line(place.line);
    auto at = line.substr(0, byte_of_column(line, place.column)).rfind(name);
    if (at == std::string_view::npos) at = line.find(name);
    Problem problem{.place = place, .message = fmt::format("\"{}\" is given twice", name)};
    if (at != std::string_view::npos) {
        problem.place.column = count_characters(line.substr(0, at)) + 1;
        problem.width = count_characters(name);
    }
    if (const int first = first_given(text, place.line)) problem.hint = fmt::format("first given in line {}", first);
    return problem;
}

/// A value that is a bare word: the parser stops in its middle, the message shows all of it.
Problem bare_word(Place place, const SourceText& text) {
    const auto line = text.line(place.line);
    std::size_t begin = std::min(byte_of_column(line, place.column), line.size());
    while (begin > 0 && is_word(line[begin - 1])) --begin;
    std::size_t end = begin;
    while (end < line.size() && is_word(line[end])) ++end;
    const std::string word(line.substr(begin, end - begin));
    Problem problem{.place = {place.line, count_characters(line.substr(0, begin)) + 1}, .message = "this is not a value"};
    problem.width = std::max(1, count_characters(word));
    std::string lower = word;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (lower == "true" || lower == "false") {
        problem.message = fmt::format("{} is not a value; did you mean {}?", word, lower);
    } else if (!word.empty() && std::isalpha(static_cast<unsigned char>(word[0]))) {
        problem.message = fmt::format("{} is not a value", word);
        problem.hint = fmt::format("a text stands in quotes: \"{}\"", word);
    }
    return problem;
}

Problem unclosed(Place open, const SourceText& text, const std::string& hint) {
    const auto line = text.line(open.line);
    const std::size_t at = byte_of_column(line, open.column);
    const char c = at < line.size() ? line[at] : '"';
    const std::string what = c == '[' ? "this list is" : c == '{' ? "this table is" : "this text is";
    return {.place = open, .width = 1, .message = what + " not closed", .hint = hint};
}

std::string after(const std::string& s, std::string_view mark) {
    const auto at = s.find(mark);
    return at == std::string::npos ? std::string() : s.substr(at + mark.size());
}

bool has(std::string_view s, std::string_view part) { return s.find(part) != std::string::npos; }

}  // namespace

Problem word_syntax_error(std::string description, Place place, const SourceText& text) {
    if (description.starts_with("Error while parsing ") && has(description, ": ")) description = after(description, ": ");
    const auto line = text.line(place.line);
    const bool at_line_end = byte_of_column(line, place.column) >= line.size();
    const Place open = text.open_at(place.line);

    if (has(description, "cannot redefine existing")) {
        std::string name = after(description, "'");
        return given_twice(name.substr(0, name.find('\'')), place, text);
    }
    if (has(description, "end-of-file")) {
        const Place at_end = text.open_at(text.line_count() + 1);
        if (at_end.line > 0) return unclosed(at_end, text, "the file ends inside it");
        return {.place = place, .width = 1, .message = "the file ends in the middle of a statement"};
    }
    if (open.line > 0 && open.line < place.line && has(line, "="))
        return unclosed(open, text, fmt::format("a bracket is missing before line {}", place.line));
    if (has(description, "could not determine value type") || has(description, "expected 'true'") || has(description, "expected 'false'") ||
        has(description, "expected 'inf'") || has(description, "expected 'nan'"))
        return bare_word(place, text);
    if (has(description, "control characters") && at_line_end)
        return {.place = {place.line, std::max(1, place.column - 1)},
                .width = 1,
                .message = "the text is not closed on its line",
                .hint = "a closing quote is missing"};
    if (has(description, "expected a comment or whitespace, saw"))
        return {.place = place,
                .message = "unexpected after the value" + after(description, "saw"),
                .hint = "each key = value has its own line"};
    if (has(description, "expected '=', saw"))
        return {.place = place, .message = "expected '=' after the key, found" + after(description, "saw")};
    if (has(description, "dangling comma")) return {.place = place, .width = 1, .message = "a table in braces must not end with a comma"};
    for (std::string saw = ", saw "; has(description, saw);) description.replace(description.find(saw), saw.size(), ", found ");
    if (has(description, "'\n'")) description.replace(description.find("'\n'"), 3, "the end of the line");
    return {.place = place, .message = description};
}

}  // namespace weir::scene
