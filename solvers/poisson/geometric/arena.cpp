#include "poisson/geometric/arena.hpp"

#include <cstdint>
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
    closed_.reset();
    begin_ = nullptr;
    size_ = used_ = mapped_ = opened_ = 0;
}

void Arena::reserve(std::size_t bytes, bool closed) {
    release();
    if (bytes == 0) return;
    size_ = bytes;
    if (closed) {
        closed_ = std::make_unique<Reserved>(bytes);
        begin_ = closed_->data();
        return;
    }
    mapped_ = bytes + huge_page;  // includes space to align to a huge page
    mapping_ = mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (mapping_ == MAP_FAILED) {
        mapping_ = nullptr;
        throw std::bad_alloc();
    }
    const auto start = reinterpret_cast<std::uintptr_t>(mapping_);
    begin_ = reinterpret_cast<unsigned char*>((start + huge_page - 1) / huge_page * huge_page);
    madvise(begin_, bytes, MADV_HUGEPAGE);  // a hint: correctness does not depend on it
}

void Arena::open_bytes(const void* from, const void* to) {
    if (!closed_) return;
    const auto begin = static_cast<std::size_t>(static_cast<const unsigned char*>(from) - begin_),
               end = static_cast<std::size_t>(static_cast<const unsigned char*>(to) - begin_);
    if (begin >= end) return;
    opened_ += end - begin;
    closed_->open(begin, end);
}

}  // namespace weir::poisson
