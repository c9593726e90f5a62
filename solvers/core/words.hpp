// Words of a text file, one after another, each with its line and column: the base of every reader of input files.
#pragma once
#include "core/types.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace weir {

/// The whole content of a regular file. Throws BadInput where it cannot be read, has no end (a device, a pipe) or holds more than `most`
/// bytes; a million triangles take a fifth of the gibibyte as text.
std::string bytes_of(const std::filesystem::path& file, std::size_t most = std::size_t{1} << 30);

/// Up to `most` bytes of a regular file, or of a pipe, for whose data it waits. Throws BadInput as bytes_of does, and where no process has
/// opened the other end of a pipe.
std::string first_bytes_of(const std::filesystem::path& file, std::size_t most);

class Words {
public:
    /// The text must outlive this object.
    Words(const std::filesystem::path& file, std::string_view text, bool hash_is_comment)
        : file_(file.string()), text_(text), comments_(hash_is_comment) {}
    /// Empty at the end of the file.
    std::string_view next();
    std::string_view peek();
    /// The next word of this line; empty at its end.
    std::string_view next_of_line();
    void skip_line();
    /// `what` describes the expected value in the error message: "a height".
    real number(std::string_view what) { return number_in(next(), what); }
    real number_in(std::string_view word, std::string_view what) const;
    int count(std::string_view what, real most);
    /// Throws BadInput at the last word.
    [[noreturn]] void fail(const std::string& what) const;
    /// Number of bytes that were read.
    std::size_t position() const { return at_; }
    /// A word as it appears in messages: short and printable.
    static std::string shown(std::string_view word);

private:
    void skip(bool lines);
    std::string_view word();
    std::string file_;
    std::string_view text_;
    bool comments_;
    std::size_t at_ = 0, begin_of_line_ = 0;
    int line_ = 1, line_of_word_ = 1, column_of_word_ = 1;
};

}  // namespace weir
