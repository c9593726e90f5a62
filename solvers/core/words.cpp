#include "core/words.hpp"

#include "core/error.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>

namespace weir {

namespace {
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
}  // namespace

std::string bytes_of(const std::filesystem::path& path, std::size_t most) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) throw BadInput(path.string() + ": cannot be read");
    std::error_code unknown;
    if (const auto size = std::filesystem::file_size(path, unknown); !unknown && size > most)
        throw BadInput(path.string() + ": holds " + std::to_string(size) + " bytes; at most " + std::to_string(most) + " are read");
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
}

void Words::skip(bool lines) {
    while (at_ < text_.size()) {
        if (text_[at_] == '\n') {
            if (!lines) return;
            ++line_, begin_of_line_ = ++at_;
        } else if (is_space(text_[at_])) {
            ++at_;
        } else if (comments_ && text_[at_] == '#') {
            while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        } else {
            return;
        }
    }
}

std::string_view Words::word() {
    line_of_word_ = line_, column_of_word_ = static_cast<int>(at_ - begin_of_line_) + 1;
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
}

std::string_view Words::next() {
    skip(true);
    return word();
}

std::string_view Words::next_of_line() {
    skip(false);
    return word();
}

std::string_view Words::peek() {
    const Words before = *this;
    const std::string_view word = next();
    *this = before;
    return word;
}

void Words::skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) ++line_, begin_of_line_ = ++at_;
}

real Words::number_in(std::string_view word, std::string_view what) const {
    if (word.empty()) fail((at_ < text_.size() ? "the line ends where " : "the file ends where ") + std::string(what) + " is expected");
    real value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        fail('"' + shown(word) + "\" stands where " + std::string(what) + " is expected");
    return value;
}

int Words::count(std::string_view what, real most) {
    const std::string_view word = next();
    const real value = number_in(word, what);
    if (value != std::floor(value) || value < 1 || value > most)
        fail(std::string(what) + " is " + shown(word) + "; it is a whole number from 1 to " + std::to_string(static_cast<long>(most)));
    return static_cast<int>(value);
}

void Words::fail(const std::string& what) const {
    throw BadInput(file_ + ':' + std::to_string(line_of_word_) + ':' + std::to_string(column_of_word_) + ": " + what);
}

std::string Words::shown(std::string_view word) {
    std::string text(word.substr(0, 24));
    for (char& c : text)
        if (!std::isprint(static_cast<unsigned char>(c))) c = '?';
    return text;
}

}  // namespace weir
