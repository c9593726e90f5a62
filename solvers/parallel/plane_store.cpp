#include "parallel/plane_store.hpp"

#include <new>

#include <sys/mman.h>
#include <unistd.h>

namespace weir {

namespace {

std::size_t page() {
    static const auto bytes = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    return bytes;
}

}  // namespace

/// A page of zeros before and after the array can be read. Stencils load eight entries at once and may read one entry beyond the ends of
/// rows; that unused entry may lie there.
Reserved::Reserved(std::size_t bytes) : mapped_((bytes + page() - 1) / page() * page()) {
    if (mapped_ == 0) return;
    void* const at = mmap(nullptr, mapped_ + 2 * page(), PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<unsigned char*>(at) + page();
    if (mprotect(at, page(), PROT_READ) != 0 || mprotect(data_ + mapped_, page(), PROT_READ) != 0) throw std::bad_alloc();
}

Reserved::~Reserved() {
    if (data_ != nullptr) munmap(data_ - page(), mapped_ + 2 * page());
}

void Reserved::open(std::size_t begin, std::size_t end) {
    if (begin >= end) return;
    begin = begin / page() * page();
    end = std::min((end + page() - 1) / page() * page(), mapped_);
    if (mprotect(data_ + begin, end - begin, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
}

void Reserved::close(std::size_t begin, std::size_t end) {
    begin = (begin + page() - 1) / page() * page();
    end = end / page() * page();
    if (begin >= end) return;
    madvise(data_ + begin, end - begin, MADV_DONTNEED);
    mprotect(data_ + begin, end - begin, PROT_NONE);
}

std::vector<char> planes_held(const Partition& cut, int rank, int count, int margin, int ghost_planes, bool ring) {
    const int n = cut.planes(), begin = cut.begin(rank) - std::min(ghost_planes, n), end = cut.end(rank, n) + std::min(ghost_planes, n);
    std::vector<char> held(static_cast<std::size_t>(count + 2 * margin), 0);
    const auto hold = [&](int plane) {
        if (plane >= -margin && plane < count + margin) held[static_cast<std::size_t>(plane + margin)] = 1;
    };
    for (int plane = begin <= 0 ? -margin : begin; plane <= (end >= n ? count + margin : end); ++plane) hold(plane);
    for (int plane = begin; ring && plane <= end; ++plane)
        if (plane < 0 || plane >= n) hold((plane % n + n) % n);
    for (int k = 0; ring && k <= count - n + margin; ++k) {  // a path around a periodic end reads the planes beyond the other end
        if (begin < 0) hold(n + k);
        if (end >= n) hold(-1 - k);
    }
    return held;
}

std::vector<char> planes_near(const Slab* slab, int count, int ghost_planes, bool ring) {
    if (slab == nullptr) return {};
    const Partition& cut = slab->partition();
    const int n = cut.planes(), rank = slab->rank();
    std::vector<char> near(static_cast<std::size_t>(count), 0);
    ghost_planes = std::min(ghost_planes, n);
    for (int plane = cut.begin(rank) - ghost_planes; plane < cut.end(rank, count) + ghost_planes; ++plane) {
        if (plane >= 0 && plane < count) near[static_cast<std::size_t>(plane)] = 1;
        if (ring && (plane < 0 || plane >= n)) near[static_cast<std::size_t>((plane % n + n) % n)] = 1;  // plane n of faces is plane 0
    }
    return near;
}

}  // namespace weir
