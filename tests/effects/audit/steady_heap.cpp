// A heap in place of the system's whose calls take the same instructions whatever was allocated before, and whose blocks begin on cache
// lines: otherwise a step's count varies by a hundredth with the history of the heap (OpenMP's runtime allocates for every parallel loop,
// vector loops begin by alignment). One thread only, as everything that callgrind runs.
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

constexpr std::size_t line = 64, classes = 48;

struct Header {
    void* base;         // of the block
    std::size_t order;  // its class: 64 * 2^order bytes
};
static_assert(sizeof(Header) <= line);

void* unused[classes];
std::byte* fresh = nullptr;
std::size_t left = 0;

void* take(std::size_t order) {
    if (void* block = unused[order]) {
        std::memcpy(&unused[order], block, sizeof(void*));
        return block;
    }
    const std::size_t size = line << order;
    if (left < size) {
        left = size > (std::size_t{1} << 26) ? size : std::size_t{1} << 26;
        void* map = mmap(nullptr, left, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
        if (map == MAP_FAILED) return left = 0, nullptr;
        fresh = static_cast<std::byte*>(map);
    }
    void* block = fresh;
    fresh += size;
    left -= size;
    return block;
}

Header& header_of(void* p) { return *reinterpret_cast<Header*>(static_cast<std::byte*>(p) - line); }

void* take_aligned(std::size_t alignment, std::size_t size) {
    const std::size_t extra = alignment > line ? alignment : line, bytes = size + extra;
    const auto order = static_cast<std::size_t>(64 - __builtin_clzll((bytes - 1) / line));  // smallest with 64 * 2^order >= bytes
    void* base = take(order);
    if (!base) return errno = ENOMEM, nullptr;
    const auto at = (reinterpret_cast<std::uintptr_t>(base) + extra) / extra * extra;
    void* p = reinterpret_cast<void*>(at);
    header_of(p) = {base, order};
    return p;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) { return take_aligned(line, size); }
void* memalign(std::size_t alignment, std::size_t size) { return take_aligned(alignment, size); }
void* aligned_alloc(std::size_t alignment, std::size_t size) { return take_aligned(alignment, size); }
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
    *p = take_aligned(alignment, size);
    return *p ? 0 : ENOMEM;
}
void* calloc(std::size_t n, std::size_t size) {
    void* p = malloc(n * size);
    return p ? std::memset(p, 0, n * size) : p;
}
void free(void* p) {
    if (!p) return;
    const Header header = header_of(p);
    std::memcpy(header.base, &unused[header.order], sizeof(void*));
    unused[header.order] = header.base;
}
std::size_t malloc_usable_size(void* p) {
    if (!p) return 0;
    const Header& header = header_of(p);
    return (line << header.order) - static_cast<std::size_t>(static_cast<std::byte*>(p) - static_cast<std::byte*>(header.base));
}
void* realloc(void* p, std::size_t size) {
    void* larger = malloc(size);
    if (p && larger) {
        const std::size_t old = malloc_usable_size(p);
        std::memcpy(larger, p, old < size ? old : size);
        free(p);
    }
    return larger;
}

}  // extern "C"
