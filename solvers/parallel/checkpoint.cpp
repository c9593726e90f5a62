#include "core/checkpoint.hpp"

#include "core/error.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace weir {

namespace {

constexpr char magic[8] = {'w', 'e', 'i', 'r', 'c', 'p', '0', '1'};
constexpr std::size_t piece = std::size_t{1} << 20;  // bytes of a file held in memory at once

/// FNV-1a over 64 bits: detects truncation and altered bytes; it does not protect against an adversary.
constexpr std::uint64_t checksum_of_nothing = 0xcbf29ce484222325ull;
std::uint64_t checksum(const std::byte* data, std::size_t count, std::uint64_t hash) {
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ std::to_integer<std::uint64_t>(data[i])) * 0x100000001b3ull;
    return hash;
}

/// A file being written, followed by its checksum.
class Writer {
public:
    explicit Writer(const std::filesystem::path& path) : file_(path, std::ios::binary | std::ios::trunc) {}
    void put(const void* data, std::size_t count) {
        hash_ = checksum(static_cast<const std::byte*>(data), count, hash_);
        file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(count));
    }
    /// Returns whether every byte was written.
    bool close() {
        const std::uint64_t hash = hash_;
        file_.write(reinterpret_cast<const char*>(&hash), sizeof hash);
        file_.flush();
        return static_cast<bool>(file_);
    }

private:
    std::ofstream file_;
    std::uint64_t hash_ = checksum_of_nothing;
};

}  // namespace

/// A file that is read in parts. The open file stays unchanged when another file replaces its name.
class Checkpoint::File {
public:
    enum Fault : int { none, missing, foreign, altered };  // the worst last

    explicit File(const std::filesystem::path& path) : path_(path), descriptor_(open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {
        struct stat status {};
        if (descriptor_ >= 0 && fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode))
            size_ = static_cast<std::uint64_t>(status.st_size);
        else
            is_file_ = false;
    }
    ~File() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    /// Offset at which the blocks end and the checksum begins.
    std::uint64_t end() const { return size_ - sizeof(std::uint64_t); }
    std::size_t bytes_read() const { return bytes_read_; }

    /// Throws BadInput past the end.
    void read(std::uint64_t at, void* to, std::size_t count) {
        for (std::size_t done = 0; done < count;) {
            const ssize_t got = pread(descriptor_, static_cast<char*>(to) + done, count - done, static_cast<off_t>(at + done));
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) refuse(altered);
            done += static_cast<std::size_t>(got);
            bytes_read_ += static_cast<std::size_t>(got);
        }
    }
    std::uint64_t number(std::uint64_t& at) {
        std::uint64_t n = 0;
        read(at, &n, sizeof n);
        at += sizeof n;
        return n;
    }

    /// Checks the file as a whole; the result is the same on all ranks. Each rank sums one part and passes the running checksum to the next
    /// rank.
    Fault examine() {
        char found[sizeof magic] = {};
        Fault fault = is_file_ ? none : missing;
        if (fault == none && size_ < sizeof magic + 16) fault = foreign;
        if (fault == none) {
            read(0, found, sizeof found);
            if (std::memcmp(found, magic, sizeof magic) != 0) fault = foreign;
        }
        if ((fault = static_cast<Fault>(communicator().largest(fault))) != none) return fault;
        const std::vector<std::uint64_t> sizes = of_ranks(size_);
        if (std::any_of(sizes.begin(), sizes.end(), [&](std::uint64_t size) { return size != sizes[0]; })) return altered;
        return static_cast<Fault>(communicator().largest(sum_is_right() ? none : altered));
    }

    [[noreturn]] void refuse(Fault fault) const {
        throw BadInput(path_.string() + (fault == missing   ? ": cannot read checkpoint"
                                         : fault == foreign ? ": not a checkpoint of this version of weir"
                                                            : ": checkpoint is truncated or altered (checksum differs)"));
    }

private:
    /// Compares the checksum; only the last rank sees its end, the others return true.
    bool sum_is_right() {
        const auto rank = static_cast<std::uint64_t>(communicator().rank()), ranks = static_cast<std::uint64_t>(communicator().ranks());
        const std::uint64_t last = end() * (rank + 1) / ranks;
        std::uint64_t hash = checksum_of_nothing;
        const int peer = communicator().rank();
        const Message from_before{peer - 1, nullptr, 0, &hash, sizeof hash}, to_next{peer + 1, &hash, sizeof hash, nullptr, 0};
        if (rank > 0) communicator().exchange({&from_before, 1});
        std::vector<std::byte> room(piece);
        bool whole = true;
        try {
            for (std::uint64_t at = end() * rank / ranks; at < last; at += piece) {
                const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(piece, last - at));
                read(at, room.data(), count);
                hash = checksum(room.data(), count, hash);
            }
        } catch (const BadInput&) {  // the next rank waits for its part of the checksum
            whole = false;
        }
        if (rank + 1 < ranks) communicator().exchange({&to_next, 1});
        if (!whole || rank + 1 < ranks) return whole;
        std::uint64_t at = end();
        return number(at) == hash;
    }

    std::filesystem::path path_;
    int descriptor_;
    bool is_file_ = true;
    std::uint64_t size_ = 0;
    std::size_t bytes_read_ = 0;
};

const Checkpoint::Block& Checkpoint::find(const std::string& name) const {
    const auto at = blocks_.find(name);
    if (at == blocks_.end()) throw std::runtime_error("checkpoint has no block \"" + name + "\"");
    return at->second;
}

void Checkpoint::refuse_size(const std::string& name) { throw std::runtime_error("checkpoint block \"" + name + "\" has another size"); }

void Checkpoint::require_finite(const std::string& name, std::span<const double> values) {
    for (const double value : values)
        if (!std::isfinite(value)) throw std::runtime_error("checkpoint block \"" + name + "\" holds a value that is not finite");
}

void Checkpoint::require_within(const std::string& name, std::int64_t value, std::int64_t least, std::int64_t most) {
    if (value < least || value > most)
        throw std::runtime_error("checkpoint block \"" + name + "\" holds " + std::to_string(value) + "; from " + std::to_string(least) +
                                 " to " + std::to_string(most) + " can be");
}

void Checkpoint::copy(const std::string& name, std::size_t begin, void* to, std::size_t count) const {
    const Block& block = find(name);
    if (begin < block.begin || begin - block.begin > block.size() || count > block.size() - (begin - block.begin)) refuse_size(name);
    if (count == 0) return;
    if (block.in_file())
        file_->read(block.at + begin, to, count);
    else
        std::memcpy(to, block.bytes.data() + (begin - block.begin), count);
}

void Checkpoint::write(const std::filesystem::path& path) const {
    auto temporary = path;
    temporary += ".part";
    std::optional<Writer> file;
    if (communicator().rank() == 0) file.emplace(temporary);
    const auto put = [&](const void* data, std::size_t count) {
        if (file) file->put(data, count);
    };
    const auto put_number = [&](std::uint64_t n) { put(&n, sizeof n); };
    put(magic, sizeof magic);
    put_number(blocks_.size());
    for (const auto& [name, block] : blocks_) {
        put_number(name.size());
        put(name.data(), name.size());
        put_number(block.all);
        std::vector<std::byte> read(block.in_file() && file ? block.all : 0);
        if (!read.empty()) copy(name, 0, read.data(), read.size());
        if (block.part)
            communicator().stream_to_first(block.bytes.data(), block.bytes.size(), put);
        else
            put(read.empty() ? block.bytes.data() : read.data(), block.size());
    }
    by_first_rank([&] {
        const bool whole = file->close();
        file.reset();
        if (!whole) {
            std::error_code ignored;
            std::filesystem::remove(temporary, ignored);
            throw OutputError("cannot write checkpoint " + path.string() + ": disk full or folder not writable");
        }
        std::error_code failed;
        std::filesystem::rename(temporary, path, failed);
        if (failed) throw OutputError("cannot write checkpoint " + path.string() + ": " + failed.message());
    });
}

Checkpoint Checkpoint::read(const std::filesystem::path& path) {
    Checkpoint result;
    result.file_ = std::make_shared<File>(path);
    if (const File::Fault fault = result.file_->examine(); fault != File::none) result.file_->refuse(fault);
    result.list_blocks();
    return result;
}

/// Records the offset of each block in the file.
void Checkpoint::list_blocks() {
    std::uint64_t at = sizeof magic;
    const auto size_within = [&] {
        const std::uint64_t n = file_->number(at);
        if (at > file_->end() || n > file_->end() - at) file_->refuse(File::altered);
        return static_cast<std::size_t>(n);
    };
    const std::uint64_t count = file_->number(at);
    for (std::uint64_t b = 0; b < count; ++b) {
        std::string name(size_within(), '\0');
        file_->read(at, name.data(), name.size());
        at += name.size();
        const std::size_t size = size_within();
        blocks_[name] = {.all = size, .at = at};
        at += size;
    }
}

std::size_t Checkpoint::bytes_read() const { return file_ ? file_->bytes_read() : 0; }

}  // namespace weir
