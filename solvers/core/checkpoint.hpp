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
    }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put(const std::string& name, const std::vector<T>& values) { put(name, std::span<const T>(values)); }
    template <class T>
    requires std::is_trivially_copyable_v<T>
    void put_value(const std::string& name, const T& value) { put(name, std::span<const T>(&value, 1)); }

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

    /// Writes beside `path` and renames; throws OutputError.
    void write(const std::filesystem::path& path) const;
    /// Throws BadInput when the file is missing, truncated, altered or of another version.
    static Checkpoint read(const std::filesystem::path& path);

private:
    const std::vector<std::byte>& find(const std::string& name) const {
        const auto at = blocks_.find(name);
        if (at == blocks_.end()) throw std::runtime_error("checkpoint has no block \"" + name + "\"");
        return at->second;
    }
    std::map<std::string, std::vector<std::byte>> blocks_;
};

}  // namespace weir
