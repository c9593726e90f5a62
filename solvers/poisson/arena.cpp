#include "poisson/arena.hpp"

#include <new>

#include <sys/mman.h>

namespace weir::poisson {

namespace {
constexpr std::size_t huge_page = std::size_t{1} << 21;
}

Arena::~Arena() { release(); }

void Arena::release() {
    if (mapping_ != nullptr) munmap(mapping_, mapped_);
    mapping_ = nullptr;
    begin_ = nullptr;
    size_ = used_ = mapped_ = opened_ = 0;
}

void Arena::reserve(std::size_t bytes, bool closed) {
    release();
    closed_ = closed;
    if (bytes == 0) return;
    mapped_ = bytes + huge_page;  // room to begin on a huge page
    mapping_ = mmap(nullptr, mapped_, closed ? PROT_NONE : PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | (closed ? MAP_NORESERVE : 0), -1, 0);
    if (mapping_ == MAP_FAILED) {
        mapping_ = nullptr;
        throw std::bad_alloc();
    }
    const auto start = reinterpret_cast<std::uintptr_t>(mapping_);
    begin_ = reinterpret_cast<unsigned char*>((start + huge_page - 1) / huge_page * huge_page);
    if (!closed) madvise(begin_, bytes, MADV_HUGEPAGE);  // a wish: nothing depends on it
    size_ = bytes;
}

void Arena::open_bytes(std::uintptr_t from, std::uintptr_t to) {
    if (!closed_ || from >= to) return;
    constexpr std::uintptr_t page = 4096;  // at least: what is not a whole page of the system's is refused
    opened_ += to - from;
    const std::uintptr_t begin = from / page * page, end = (to + page - 1) / page * page;
    if (mprotect(reinterpret_cast<void*>(begin), end - begin, PROT_READ | PROT_WRITE) != 0) throw std::bad_alloc();
}

}  // namespace weir::poisson
