// The text of a scene as lines and columns of characters, for messages, with the part of TOML's lexical rules (strings, comments, brackets)
// needed to find the beginnings and ends of statements.
#pragma once
#include "scene/scene.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::scene {

class SourceText {
public:
    explicit SourceText(std::string_view text);

    const std::string& text() const { return text_; }
    std::string_view line(int number) const;  // 1 is the first; without its line end; empty beyond the last
    int line_count() const { return static_cast<int>(starts_.size()); }

    /// The reason why this is not a valid text: too long, not UTF-8, control characters, excessive nesting.
    std::optional<Problem> unreadable() const;
    /// Clears a line that is a complete statement (not a table header, nothing open before or after it); returns false otherwise.
    bool blank_statement(int line);
    /// The bracket or text that is still open at the start of a line; line 0: none.
    Place open_at(int line) const;
    /// The same in the middle of a line, for brackets.
    Place open_at(Place place) const;
    Place end_of_text() const { return open_at(line_count() + 1); }

private:
    struct LineStart {
        bool in_text = false;       // inside a multi-line string
        std::vector<Place> open{};  // brackets
    };
    class Scan;

    std::string text_;
    std::vector<std::size_t> starts_;     // offset of each line
    std::vector<LineStart> line_starts_;  // one more than lines: the last is the end of the file
    Place text_began_{};
    std::optional<Problem> refused_;
};

/// Characters of UTF-8 text (bytes that are not continuations).
int count_characters(std::string_view text);
/// Length of the UTF-8 sequence at the start of a text (Unicode 15, table 3-7), 0 where it is invalid.
std::size_t sequence_length(std::string_view text);
/// The byte offset of a 1-based column.
std::size_t byte_of_column(std::string_view line, int column);
/// Length in characters of the word, text, list or table that starts at a column; at least 1, never beyond the line.
int token_width(std::string_view line, int column);

/// Rewords a message of the TOML parser, with the position of the text to change.
Problem word_syntax_error(std::string description, Place place, const SourceText& text);

}  // namespace weir::scene
