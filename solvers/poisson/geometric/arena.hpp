// One block of zeroed memory on huge pages, allocated in aligned pieces: a cycle streams through all of it, so page walks matter.
#pragma once
#include "parallel/plane_store.hpp"

#include <cstddef>
#include <memory>

namespace weir::poisson {

class Arena {
public:
    Arena() = default;
    ~Arena();
    Arena(const Arena&) = delete;
    Arena& operator=(const Arena&) = delete;

    /// Reserves `bytes`, all zero, and releases all pieces. `closed`: address space that must not be accessed until it is opened.
    void reserve(std::size_t bytes, bool closed = false);
    /// Opens the entries [from, to) of a piece of a closed arena.
    template <class T>
    void open(const T* from, const T* to) {
        open_bytes(from, to);
    }
    /// Bytes of committed memory.
    std::size_t bytes() const { return closed_ ? opened_ : size_; }
    /// Allocates `count` elements on separate cache lines.
    template <class T>
    T* take(std::size_t count) {
        T* piece = reinterpret_cast<T*>(begin_ + used_);
        used_ += need<T>(count);
        return piece;
    }
    /// Bytes that take(count) uses: whole cache lines plus one, so that arrays of a power of two do not share cache sets.
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
