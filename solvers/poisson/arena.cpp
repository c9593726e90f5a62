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
    size_ = used_ = mapped_ = 0;
}

void Arena::reserve(std::size_t bytes) {
    release();
    if (bytes == 0) return;
    mapped_ = bytes + huge_page;  // room to begin on a huge page
    mapping_ = mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping_ == MAP_FAILED) {
        mapping_ = nullptr;
        throw std::bad_alloc();
    }
    const auto start = reinterpret_cast<std::uintptr_t>(mapping_);
    begin_ = reinterpret_cast<unsigned char*>((start + huge_page - 1) / huge_page * huge_page);
    madvise(begin_, bytes, MADV_HUGEPAGE);  // a wish: nothing depends on it
    size_ = bytes;
}

}  // namespace weir::poisson
