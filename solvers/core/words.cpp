#include "core/words.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <new>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weir {

namespace {
bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
}  // namespace

namespace {

/// An open file.
class Descriptor {
public:
    /// Opens without waiting for the other end of a pipe.
    explicit Descriptor(const std::filesystem::path& path) : number_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }

private:
    int number_;
};

[[noreturn]] void refuse_long(const std::string& name, std::uintmax_t size, std::size_t most) {
    throw BadInput(name + ": holds " + (size > most ? std::to_string(size) : "more than " + std::to_string(most)) + " bytes; at most " +
                   std::to_string(most) + " are read");
}

/// Reads everything, in pieces, because a file may grow and some files report no size.
std::string read_all(int file, const std::string& name, std::size_t size, std::size_t most) {
    std::string all;
    constexpr std::size_t piece = std::size_t{1} << 16;
    for (std::size_t wanted = size + 1;; wanted = std::max(all.size() + piece, 2 * all.size())) {  // one byte more, to detect the end
        const std::size_t had = all.size();
        all.resize(std::min(wanted, most + 1));
        for (std::size_t at = had; at < all.size();) {
            const ssize_t got = read(file, all.data() + at, all.size() - at);
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) throw BadInput(name + ": cannot be read to its end: " + std::strerror(errno));
            if (got == 0) return all.resize(at), all;
            at += static_cast<std::size_t>(got);
        }
        if (all.size() > most) refuse_long(name, 0, most);
    }
}

/// Throws BadInput where the file does not exist, is a folder, or is neither a regular file nor, with `pipes`, a pipe.
struct stat status_of(const Descriptor& file, const std::string& name, bool pipes) {
    struct stat status {};
    if (file.number() < 0 || fstat(file.number(), &status) != 0) throw BadInput(name + ": cannot be read: " + std::strerror(errno));
    if (S_ISDIR(status.st_mode)) throw BadInput(name + ": this is a folder, not a file");
    if (S_ISREG(status.st_mode) || (pipes && S_ISFIFO(status.st_mode))) return status;
    throw BadInput(name + (pipes ? ": this is a device or a socket; regular files and pipes are read"
                                 : ": this is a device or a pipe; only regular files are read, which have an end"));
}

/// Waits until there are bytes or the other end is closed.
void wait_for_bytes(int file) {
    pollfd wanted{file, POLLIN, 0};
    while (poll(&wanted, 1, -1) < 0 && errno == EINTR) {
    }
}

}  // namespace

std::string first_bytes_of(const std::filesystem::path& path, std::size_t most) {
    const std::string name = path.string();
    const Descriptor file(path);
    const bool pipe = S_ISFIFO(status_of(file, name, true).st_mode);
    std::string all;
    std::vector<char> block(std::size_t{1} << 16);
    bool waited = false;
    while (all.size() < most) {
        const ssize_t got = read(file.number(), block.data(), std::min(block.size(), most - all.size()));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0 && errno == EAGAIN) {  // a program has opened the other end but not written yet
            waited = true, wait_for_bytes(file.number());
            continue;
        }
        if (got < 0) throw BadInput(name + ": cannot be read to its end: " + std::strerror(errno));
        if (got == 0 && pipe && all.empty() && !waited) throw BadInput(name + ": no program writes to this pipe");
        if (got == 0) break;
        all.append(block.data(), static_cast<std::size_t>(got));
    }
    return all;
}

std::string bytes_of(const std::filesystem::path& path, std::size_t most) {
    const std::string name = path.string();
    if (name.empty()) throw BadInput("a file name must not be empty");
    const Descriptor file(path);
    const struct stat status = status_of(file, name, false);
    const auto size = static_cast<std::uintmax_t>(status.st_size);
    if (size > most) refuse_long(name, size, most);
    try {
        return read_all(file.number(), name, static_cast<std::size_t>(size), most);
    } catch (const std::bad_alloc&) {
        throw BadInput(name + ": holds " + std::to_string(size) + " bytes, for which there is not enough memory");
    }
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
