// Replaces operator new of the whole program by one that counts: include it in one file of a test program.
#pragma once
#include <atomic>
#include <cstdlib>
#include <new>

namespace weir::test {
inline std::atomic<long> allocations{0};
}

#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // g++ 12 does not see that both halves are replaced together

void* operator new(std::size_t size) {
    ++weir::test::allocations;
    if (void* p = std::malloc(size)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
