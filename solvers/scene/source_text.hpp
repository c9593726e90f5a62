// The text of a scene as lines and columns of characters: what messages show, and just enough of TOML's lexical rules (strings,
// comments, brackets) to know where statements begin and end.
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

    /// What keeps this from being text at all: too long, not UTF-8, control characters, absurd nesting.
    std::optional<Problem> unreadable() const;
    /// Empties a line that is a statement by itself (not a table's header, nothing open before or after it); false if it is not.
    bool blank_statement(int line);
    /// The bracket or text that is still open where a line begins; line 0: none.
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
/// Length of the UTF-8 sequence that begins a text (Unicode 15, table 3-7), 0 where it is not valid.
std::size_t sequence_length(std::string_view text);
/// The byte at which a 1-based column begins.
std::size_t byte_of_column(std::string_view line, int column);
/// Length in characters of the word, text, list or table that begins at a column; at least 1, never beyond the line.
int token_width(std::string_view line, int column);

/// A message of the TOML parser in our words, pointing at what the user would change.
Problem word_syntax_error(std::string description, Place place, const SourceText& text);

}  // namespace weir::scene
