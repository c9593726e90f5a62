#include "core/checkpoint.hpp"

#include "core/error.hpp"
#include "core/slabs.hpp"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>

namespace weir {

namespace {

constexpr char magic[8] = {'w', 'e', 'i', 'r', 'c', 'p', '0', '1'};

/// FNV-1a over 64 bits: finds truncation and altered bytes; no defence against an adversary.
constexpr std::uint64_t checksum_of_nothing = 0xcbf29ce484222325ull;
std::uint64_t checksum(const std::byte* data, std::size_t count, std::uint64_t hash = checksum_of_nothing) {
    for (std::size_t i = 0; i < count; ++i) hash = (hash ^ std::to_integer<std::uint64_t>(data[i])) * 0x100000001b3ull;
    return hash;
}

/// A file with its checksum behind it, as it is written.
class Writer {
public:
    explicit Writer(const std::filesystem::path& path) : file_(path, std::ios::binary | std::ios::trunc) {}
    void put(const void* data, std::size_t count) {
        hash_ = checksum(static_cast<const std::byte*>(data), count, hash_);
        file_.write(static_cast<const char*>(data), static_cast<std::streamsize>(count));
    }
    /// Whether all of it has been written.
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

/// Reads from a byte image; throws BadInput past its end.
class Cursor {
public:
    Cursor(const std::vector<std::byte>& image, std::size_t end, const std::filesystem::path& path)
        : image_(image), end_(end), path_(path) {}
    void take(void* to, std::size_t count) {
        if (count > end_ - at_) throw BadInput(path_.string() + ": truncated checkpoint");
        if (count > 0) std::memcpy(to, image_.data() + at_, count);
        at_ += count;
    }
    std::uint64_t number() {
        std::uint64_t n = 0;
        take(&n, sizeof n);
        return n;
    }
    std::size_t left() const { return end_ - at_; }

private:
    const std::vector<std::byte>& image_;
    std::size_t end_, at_ = 0;
    const std::filesystem::path& path_;
};

}  // namespace

void Checkpoint::write(const std::filesystem::path& path) const {
    auto temporary = path;
    temporary += ".part";
    std::optional<Writer> file;
    if (slabs().rank() == 0) file.emplace(temporary);
    const auto put = [&](const void* data, std::size_t count) {
        if (file) file->put(data, count);
    };
    const auto put_number = [&](std::uint64_t n) { put(&n, sizeof n); };
    put(magic, sizeof magic);
    put_number(blocks_.size());
    for (const auto& [name, block] : blocks_) {
        const auto part = parts_.find(name);
        put_number(name.size());
        put(name.data(), name.size());
        put_number(part == parts_.end() ? block.size() : part->second.all);
        if (part == parts_.end())
            put(block.data(), block.size());
        else
            slabs().stream_to_first(block.data(), block.size(), put);
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
    std::ifstream file(path, std::ios::binary);
    if (!file) throw BadInput(path.string() + ": cannot read checkpoint");
    const std::vector<char> text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    std::vector<std::byte> image(text.size());
    if (!text.empty()) std::memcpy(image.data(), text.data(), text.size());
    if (image.size() < sizeof magic + 16 || std::memcmp(image.data(), magic, sizeof magic) != 0)
        throw BadInput(path.string() + ": not a checkpoint of this version");
    const std::size_t end = image.size() - sizeof(std::uint64_t);
    std::uint64_t stored = 0;
    std::memcpy(&stored, image.data() + end, sizeof stored);
    if (stored != checksum(image.data(), end)) throw BadInput(path.string() + ": checkpoint is truncated or altered (checksum differs)");

    Cursor cursor(image, end, path);
    char found[sizeof magic];
    cursor.take(found, sizeof found);
    Checkpoint result;
    const std::uint64_t count = cursor.number();
    for (std::uint64_t b = 0; b < count; ++b) {
        const auto size_within = [&] {
            const std::uint64_t n = cursor.number();
            if (n > cursor.left()) throw BadInput(path.string() + ": truncated checkpoint");
            return static_cast<std::size_t>(n);
        };
        std::string name(size_within(), '\0');
        cursor.take(name.data(), name.size());
        std::vector<std::byte> block(size_within());
        cursor.take(block.data(), block.size());
        result.blocks_[name] = std::move(block);
    }
    return result;
}

}  // namespace weir
