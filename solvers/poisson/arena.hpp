// One block of zeroed memory on huge pages, handed out in aligned pieces: a cycle streams through all of it, so page walks matter.
#pragma once
#include <cstddef>
#include <cstdint>

namespace weir::poisson {

class Arena {
public:
    Arena() = default;
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    /// Makes room for `bytes`, all zero; forgets what was handed out. Keeps the block if it is the same size and `keep_contents`.
    void reserve(std::size_t bytes);
    /// A piece for `count` elements on its own cache lines.
    template <class T>
    T* take(std::size_t count) {
        T* piece = reinterpret_cast<T*>(begin_ + used_);
        used_ += need<T>(count);
        return piece;
    }
    /// Bytes that take(count) uses: whole cache lines and one more, so that arrays of a power of two do not share cache sets.
    template <class T>
    static constexpr std::size_t need(std::size_t count) {
        return (count * sizeof(T) + line - 1) / line * line + line;
    }
    std::size_t size() const { return size_; }

private:
    static constexpr std::size_t line = 64;
    unsigned char* begin_ = nullptr;
    void* mapping_ = nullptr;
    std::size_t size_ = 0, used_ = 0, mapped_ = 0;
    void release();
};

}  // namespace weir::poisson
