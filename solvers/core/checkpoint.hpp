// A checkpoint is a list of named byte blocks. It is written to a temporary name and renamed, carries a checksum, and is refused
// as a whole when truncated or altered.
#pragma once
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <span>
#include <stdexcept>
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
        blocks_[name].assign(bytes.begin(), bytes.end());
        parts_.erase(name);
    }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put(const std::string& name, const std::vector<T>& values) { put(name, std::span<const T>(values)); }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put_value(const std::string& name, const T& value) { put(name, std::span<const T>(&value, 1)); }

    /// Over ranks: this one's entries of a block of `all`, the first of which is number `begin`. All ranks put theirs; the file holds all.
    template <class T>
    void put_part(const std::string& name, std::span<const T> own, std::size_t begin, std::size_t all) {
        put(name, own);
        parts_[name] = {begin * sizeof(T), all * sizeof(T)};
    }
    /// The same entries of a block that is whole, or of the part that was put.
    template <class T>
    void get_part(const std::string& name, std::span<T> own, std::size_t begin, std::size_t all) const {
        const auto& block = find(name);
        const auto part = parts_.find(name);
        const std::size_t before = part == parts_.end() ? 0 : part->second.begin,
                          whole = part == parts_.end() ? block.size() : part->second.all;
        if (whole != all * sizeof(T) || begin * sizeof(T) < before || begin * sizeof(T) - before + own.size_bytes() > block.size())
            throw std::runtime_error("checkpoint block \"" + name + "\" has another size");
        if (!own.empty()) std::memcpy(own.data(), block.data() + (begin * sizeof(T) - before), own.size_bytes());
    }

    /// The entries of a block that are here: all, or the part that was put.
    struct Held {
        std::size_t begin, end, all;
        bool part;
    };
    template <class T>
    Held held(const std::string& name) const {
        const std::size_t here = find(name).size() / sizeof(T);
        const auto part = parts_.find(name);
        if (part == parts_.end()) return {0, here, here, false};
        return {part->second.begin / sizeof(T), part->second.begin / sizeof(T) + here, part->second.all / sizeof(T), true};
    }

    bool has(const std::string& name) const { return blocks_.count(name) != 0; }
    /// Copies the block into `to`, which must have its exact size; throws std::runtime_error naming the block otherwise.
    template <class T>
    void get(const std::string& name, std::span<T> to) const {
        const auto& block = find(name);
        if (block.size() != to.size_bytes()) throw std::runtime_error("checkpoint block \"" + name + "\" has another size");
        if (!block.empty()) std::memcpy(to.data(), block.data(), block.size());
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

    /// Writes beside `path` and renames; throws OutputError. Over ranks by the first, and all call it together.
    void write(const std::filesystem::path& path) const;
    /// Throws BadInput when the file is missing, truncated, altered or of another version.
    static Checkpoint read(const std::filesystem::path& path);

private:
    const std::vector<std::byte>& find(const std::string& name) const {
        const auto at = blocks_.find(name);
        if (at == blocks_.end()) throw std::runtime_error("checkpoint has no block \"" + name + "\"");
        return at->second;
    }
    struct Part {
        std::size_t begin, all;  // [bytes]
    };
    std::map<std::string, std::vector<std::byte>> blocks_;
    std::map<std::string, Part> parts_;  // of the blocks that are this rank's alone
};

}  // namespace weir
