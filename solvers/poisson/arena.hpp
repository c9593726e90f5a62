// One block of zeroed memory on huge pages, handed out in aligned pieces: a cycle streams through all of it, so page walks matter.
#pragma once
#include "core/plane_store.hpp"

#include <cstddef>
#include <memory>

namespace weir::poisson {

class Arena {
public:
    Arena() = default;
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    /// Makes room for `bytes`, all zero; forgets what was handed out. `closed`: room that nobody may touch until it is opened.
    void reserve(std::size_t bytes, bool closed = false);
    /// Of a closed one, the entries [from, to) of a piece.
    template <class T>
    void open(const T* from, const T* to) {
        open_bytes(from, to);
    }
    /// What has memory behind it.
    std::size_t bytes() const { return closed_ ? opened_ : size_; }
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
    std::unique_ptr<Reserved> closed_;
    std::size_t size_ = 0, used_ = 0, mapped_ = 0, opened_ = 0;
    void open_bytes(const void* from, const void* to);
    void release();
};

}  // namespace weir::poisson
