// Rewords the TOML parser's messages. Unknown ones are passed on unchanged.
#include "scene/names.hpp"
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

/// An earlier line with this key under the same header; 0 where there is none.
int first_given(const SourceText& text, int line, std::string_view key) {
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
    if (const int first = first_given(text, place.line, key_of(line))) problem.hint = fmt::format("first given in line {}", first);
    return problem;
}

/// "grid.periodic = ..." below "grid = { ... }": keys cannot be added to an inline table.
Problem added_to_braces(Place place, const SourceText& text) {
    const auto key = key_of(text.line(place.line));
    const std::string name(key.substr(0, key.find('.')));
    Problem problem = given_twice(name, place, text);
    if (const int first = first_given(text, place.line, name))
        problem.hint = fmt::format("\"{}\" is defined in braces in line {}: add {} there", name, first, key.substr(key.find('.') + 1));
    return problem;
}

/// The text at a position: up to a comma, a bracket, a comment or the end of the line.
std::string_view phrase_at(std::string_view line, std::size_t begin) {
    const auto end = std::min(line.find_first_of(",=#[]{}\"'", begin), line.size());
    return trimmed(line.substr(begin, end - begin));
}

/// A value without quotes: the parser stops in its middle, the message shows all of it.
Problem bare_word(Place place, const SourceText& text) {
    const auto line = text.line(place.line);
    std::size_t begin = std::min(byte_of_column(line, place.column), line.size());
    while (begin > 0 && is_word(line[begin - 1])) --begin;
    const std::string phrase(phrase_at(line, begin));
    Problem problem{.place = {place.line, count_characters(line.substr(0, begin)) + 1}, .message = "this is not a value"};
    problem.width = std::max(1, count_characters(phrase));
    std::string lower = phrase;
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (lower == "true" || lower == "false") {
        problem.message = fmt::format("{} is not a value; did you mean {}?", phrase, lower);
    } else if (!phrase.empty() && std::isalpha(static_cast<unsigned char>(phrase[0]))) {
        problem.message = fmt::format("{} is not a value", phrase);
        problem.hint = fmt::format("write a text in quotes: \"{}\"", phrase);
    }
    return problem;
}

/// Returns whether the word at a position is a key: '=' follows it.
bool is_key_at(Place place, const SourceText& text) {
    auto rest = text.line(place.line);
    rest = rest.substr(std::min(byte_of_column(rest, place.column), rest.size()));
    while (!rest.empty() && (is_word(rest.front()) || rest.front() == '.')) rest.remove_prefix(1);
    return trimmed(rest).starts_with('=');
}

char letter_at(Place place, const SourceText& text) {
    const auto line = text.line(place.line);
    const auto at = byte_of_column(line, place.column);
    return at < line.size() ? line[at] : '\0';
}

/// From the opening quote to the end of the line.
Problem open_quote(Place place, const SourceText& text) {
    const auto line = text.line(place.line);
    std::size_t opened = 0;
    char quote = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (quote == '"' && line[i] == '\\')
            ++i;
        else if (quote ? line[i] == quote : line[i] == '"' || line[i] == '\'')
            quote = quote ? '\0' : line[i], opened = quote ? i : opened;
    }
    return {.place = {place.line, count_characters(line.substr(0, opened)) + 1},
            .width = count_characters(line.substr(opened)),
            .message = "this text is not closed on its line",
            .hint = "a quote is missing"};
}

Problem unclosed(Place open, const SourceText& text, const std::string& hint) {
    const char c = letter_at(open, text);
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
    const std::size_t byte = std::min(byte_of_column(line, place.column), line.size());
    const Place open = text.open_at(place);
    const auto is = [&](std::string_view part) { return has(description, part); };

    if (is("cannot redefine existing")) {
        const std::string name = after(description, "'");
        if (name.empty()) return added_to_braces(place, text);
        return given_twice(name.substr(0, name.find('\'')), place, text);
    }
    if (open.line > 0 && letter_at(open, text) == '[' && is_key_at(place, text)) return unclosed(open, text, "']' is missing");
    if (open.line > 0 && letter_at(open, text) == '{' && is("'\n'"))
        return unclosed(open, text, "'}' is missing; a table in braces ends on its line");
    if (is("end-of-file")) {
        if (const Place left_open = text.end_of_text(); left_open.line > 0) return unclosed(left_open, text, "the file ends inside it");
        if (line.find_first_of("\"'") != std::string_view::npos) return open_quote(place, text);
        return {.place = place, .width = 1, .message = "the file ends in the middle of a statement"};
    }
    if (is("could not determine value type") || is("expected 'true'") || is("expected 'false'") || is("expected 'inf'") ||
        is("expected 'nan'"))
        return bare_word(place, text);
    if (is("control characters") && byte >= line.size()) return open_quote(place, text);
    if (is("expected a comment or whitespace, saw"))
        return {
            .place = place,
            .message = fmt::format("unexpected {} after the value",
                                   quote(line.substr(byte, byte_of_column(line, place.column + token_width(line, place.column)) - byte))),
            .hint = "each key = value has its own line"};
    if (is("expected '=', saw")) {
        const std::string saw = byte >= line.size() ? " the end of the line" : after(description, "saw");
        return {.place = place, .width = 1, .message = "expected '=' after the key, found" + saw, .hint = "key = value"};
    }
    if (is("dangling comma")) return {.place = place, .width = 1, .message = "a table in braces must not end with a comma"};
    if (const auto saw = description.find(", saw "); saw != std::string::npos) description.replace(saw, 6, ", found ");
    if (is("'\n'")) description.replace(description.find("'\n'"), 3, "the end of the line");
    return {.place = place, .message = description};
}

}  // namespace weir::scene
