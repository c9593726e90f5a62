#include "effects/audit/heap.hpp"

#include <malloc.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

constexpr long huge_page = 1L << 21;
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

/// Anonymous memory that is mapped beside the heap: the multigrid's arena, which asks for a huge page more than it uses so that it begins
/// on one. The C library's own mappings do not come by here.
extern "C" void* mmap(void* at, std::size_t size, int protection, int flags, int file, off_t offset) noexcept {
    if (file == -1) held += static_cast<long>(size) - huge_page;
    return reinterpret_cast<void*>(syscall(SYS_mmap, at, size, protection, flags, file, offset));
}
extern "C" int munmap(void* at, std::size_t size) noexcept {
    held -= static_cast<long>(size) - huge_page;
    return static_cast<int>(syscall(SYS_munmap, at, size));
}

namespace weir::test {

long allocations() { return count; }
long bytes_held() { return held; }

}  // namespace weir::test
