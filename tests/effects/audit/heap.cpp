#include "effects/audit/heap.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<long> count{0}, held{0};

void* taken(void* p) {
    if (!p) throw std::bad_alloc();
    ++count;
    held += static_cast<long>(malloc_usable_size(p));
    return p;
}

void given(void* p) {
    if (p) held -= static_cast<long>(malloc_usable_size(p));
    std::free(p);
}

void* aligned(std::size_t size, std::align_val_t to) {
    const auto a = static_cast<std::size_t>(to);
    return taken(std::aligned_alloc(a, (size + a - 1) / a * a));
}

}  // namespace

#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // g++ 12 does not see that both halves are replaced together

void* operator new(std::size_t size) { return taken(std::malloc(size)); }
void* operator new(std::size_t size, std::align_val_t to) { return aligned(size, to); }
void operator delete(void* p) noexcept { given(p); }
void operator delete(void* p, std::size_t) noexcept { given(p); }
void operator delete(void* p, std::align_val_t) noexcept { given(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { given(p); }

namespace weir::test {

long allocations() { return count; }
long bytes_held() { return held; }

}  // namespace weir::test
