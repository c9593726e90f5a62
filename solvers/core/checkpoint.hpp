// A checkpoint is a list of named byte blocks. It is written under a temporary name, carries a checksum, and is renamed when complete. A
// truncated or altered file is rejected as a whole. When a checkpoint is read, blocks stay in the file until all or part of one is
// requested. In parallel (MPI) each rank reads only what it owns.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace weir {

class Checkpoint {
public:
    template <class T>
    void put(const std::string& name, std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        const auto bytes = std::as_bytes(values);
        blocks_[name] = {.bytes = {bytes.begin(), bytes.end()}, .all = bytes.size()};
    }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put(const std::string& name, const std::vector<T>& values) { put(name, std::span<const T>(values)); }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put_value(const std::string& name, const T& value) { put(name, std::span<const T>(&value, 1)); }

    /// In parallel: stores this rank's entries, from number `begin` on, of a block of `all` entries. Every rank stores its part; the file
    /// holds the whole block.
    template <class T>
    void put_part(const std::string& name, std::span<const T> own, std::size_t begin, std::size_t all) {
        put(name, own);
        Block& block = blocks_[name];
        block.part = true, block.begin = begin * sizeof(T), block.all = all * sizeof(T);
    }
    /// Reads the same entries from a whole block, or from the part that was stored.
    template <class T>
    void get_part(const std::string& name, std::span<T> own, std::size_t begin, std::size_t all) const {
        if (find(name).all != all * sizeof(T)) refuse_size(name);
        copy(name, begin * sizeof(T), own.data(), own.size_bytes());
    }

    /// The entries of a block that are available, in memory or in the file: all, or the part that was stored.
    struct Held {
        std::size_t begin, end, all;
        bool part;
        /// An equal share of all entries for each rank.
        Held share(int rank, int ranks) const {
            const auto r = static_cast<std::size_t>(rank), n = static_cast<std::size_t>(ranks);
            return {all * r / n, all * (r + 1) / n, all, true};
        }
    };
    template <class T>
    Held held(const std::string& name) const {
        const Block& block = find(name);
        return {block.begin / sizeof(T), (block.begin + block.size()) / sizeof(T), block.all / sizeof(T), block.part};
    }

    /// Checks values of a file before they are used as a position or a time. Throws std::runtime_error naming the block.
    static void require_finite(const std::string& name, std::span<const double> values);
    /// The same check for a count or an index.
    static void require_within(const std::string& name, std::int64_t value, std::int64_t least, std::int64_t most);

    bool has(const std::string& name) const { return blocks_.count(name) != 0; }
    /// Copies the block into `to`, which must have its exact size; throws std::runtime_error naming the block otherwise.
    template <class T>
    void get(const std::string& name, std::span<T> to) const {
        const Block& block = find(name);
        if (block.size() != to.size_bytes()) refuse_size(name);
        copy(name, block.begin, to.data(), to.size_bytes());
    }
    /// Resizes `to` to the block.
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void get(const std::string& name, std::vector<T>& to) const {
        to.resize(find(name).size() / sizeof(T));
        get(name, std::span<T>(to));
    }
    template <class T>
    requires std::is_trivially_copyable_v<T> T get_value(const std::string& name)
    const {
        T value{};
        get(name, std::span<T>(&value, 1));
        return value;
    }

    /// Writes beside `path` and renames; throws OutputError. In parallel the call is collective and rank 0 writes.
    void write(const std::filesystem::path& path) const;
    /// Throws BadInput when the file is missing, truncated, altered or of another version. In parallel the call is collective: each rank
    /// sums a part of the file for the checksum, and all ranks return or throw alike.
    static Checkpoint read(const std::filesystem::path& path);
    /// Bytes of the file that this process has read so far.
    std::size_t bytes_read() const;

private:
    class File;
    /// Bytes [begin, begin + size()) of a block of `all` bytes: stored in memory, or, as a whole, in the file from `at` on.
    struct Block {
        std::vector<std::byte> bytes{};
        bool part = false;
        std::size_t begin = 0, all = 0;
        std::uint64_t at = 0;
        bool in_file() const { return at > 0; }
        std::size_t size() const { return in_file() ? all : bytes.size(); }
    };
    const Block& find(const std::string& name) const;
    /// Copies bytes of a block from `begin` on.
    void copy(const std::string& name, std::size_t begin, void* to, std::size_t count) const;
    [[noreturn]] static void refuse_size(const std::string& name);
    void list_blocks();

    std::map<std::string, Block> blocks_;
    std::shared_ptr<File> file_;  // the file being read
};

}  // namespace weir
