// Replaces operator new of the whole program by one that counts, how often and how much: include it in one file of a test program.
#pragma once
#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace weir::test {
inline std::atomic<long> allocations{0};
inline std::atomic<long> held{0}, most_held{0};  // [bytes] now, and at most so far
}  // namespace weir::test

#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // g++ 12 does not see that both halves are replaced together

void* operator new(std::size_t size) {
    ++weir::test::allocations;
    void* const p = std::malloc(size);
    if (!p) throw std::bad_alloc();
    const long held = weir::test::held += static_cast<long>(malloc_usable_size(p));
    for (long most = weir::test::most_held; held > most && !weir::test::most_held.compare_exchange_weak(most, held);) {
    }
    return p;
}
/// Counted too: std::stable_sort pairs it with the operator delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    try {
        return operator new(size);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
void operator delete(void* p) noexcept {
    weir::test::held -= static_cast<long>(malloc_usable_size(p));  // of nullptr 0
    std::free(p);
}
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }
