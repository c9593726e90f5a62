// Memory of an array of planes. With one rank it is a vector. With distributed storage (parallel/slab.hpp) it is address space for the
// whole array, with memory only for this rank's planes and its ghost planes. Every index then means the same on all ranks, and an access to
// any other plane faults (as in sparse grids: Setaluri, Aanjaneya, Bauer & Sifakis 2014).
#pragma once
#include "core/scratch.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace weir {

/// Reserved address space that must not be accessed until a part of it is opened. Memory is committed page by page, zero, on the first
/// write.
class Reserved {
public:
    explicit Reserved(std::size_t bytes);
    ~Reserved();
    Reserved(const Reserved&) = delete;
    Reserved& operator=(const Reserved&) = delete;
    unsigned char* data() const { return data_; }
    void open(std::size_t begin, std::size_t end);
    /// Returns the whole pages within the range to the system.
    void close(std::size_t begin, std::size_t end);

private:
    unsigned char* data_ = nullptr;
    std::size_t mapped_ = 0;
};

/// Which planes of an array a rank stores: its own, `ghost_planes` planes on both sides, also around a periodic axis, and the planes beyond
/// the ends of the axis that the ghosts reach. `margin`: planes before the first and after the last. Entry 0 is plane -margin.
std::vector<char> planes_held(const Partition& cut, int rank, int count, int margin, int ghost_planes, bool ring);

/// Marks, of `count` planes, this rank's and `ghost_planes` planes on both sides, also around the ends of a periodic axis. Empty without a
/// slab: all planes are near.
std::vector<char> planes_near(const Slab* slab, int count, int ghost_planes, bool ring);

template <class T>
class PlaneStore {
public:
    PlaneStore() = default;
    /// `head` entries stored on all ranks, `margin` planes, `count` planes, `margin` more. Stored whole without a slab, or where `count` is
    /// the number neither of its planes of cells nor of its planes of faces.
    PlaneStore(const Slab* slab, std::size_t head, std::size_t plane, int count, int margin, const T& value) {
        make(slab, head, plane, count, margin, value);
    }
    PlaneStore(const PlaneStore& other) { copy(other); }
    PlaneStore(PlaneStore&& other) noexcept { swap(other); }
    PlaneStore& operator=(const PlaneStore& other) {
        if (this != &other) copy(other);
        return *this;
    }
    PlaneStore& operator=(PlaneStore&& other) noexcept {
        PlaneStore moved(std::move(other));
        swap(moved);
        return *this;
    }
    ~PlaneStore() = default;

    T* data() { return data_; }
    const T* data() const { return data_; }
    T& operator[](std::size_t i) { return data_[i]; }
    const T& operator[](std::size_t i) const { return data_[i]; }
    std::size_t size() const { return size_; }
    /// Bytes of committed memory.
    std::size_t bytes() const {
        if (!window_) return whole_.capacity() * sizeof(T);
        const auto planes = static_cast<std::size_t>(std::count(window_->held.begin(), window_->held.end(), char{1}));
        return (window_->head + planes * window_->plane) * sizeof(T);
    }
    bool windowed() const { return window_ != nullptr; }
    bool holds(int plane) const { return !window_ || window_->held[static_cast<std::size_t>(plane + window_->margin)] != 0; }
    /// Returns whether `ghost_planes` planes are stored.
    bool reaches(int ghost_planes) const { return !window_ || ghost_planes <= window_->ghost_planes; }
    /// For Planes::held, at plane 0; nullptr where all planes are stored.
    const char* held() const { return window_ ? window_->held.data() + window_->margin : nullptr; }

    /// Commits memory for the ghost planes up to `ghost_planes` that are not stored yet.
    void open(int ghost_planes, bool ring) {
        if (!window_ || (ghost_planes <= window_->ghost_planes && (window_->ring || !ring))) return;
        window_->ghost_planes = std::max(ghost_planes, window_->ghost_planes), window_->ring = window_->ring || ring;
        open(planes_held(window_->slab->partition(), window_->slab->rank(), window_->count, window_->margin, window_->ghost_planes,
                         window_->ring));
    }
    void open_all() {
        if (window_) open(std::vector<char>(window_->held.size(), 1));
    }
    /// Undoes open_all(); the remaining planes keep their values.
    void close() {
        if (!window_) return;
        Window& w = *window_;
        const auto kept = planes_held(w.slab->partition(), w.slab->rank(), w.count, w.margin, w.ghost_planes, w.ring);
        for (std::size_t k = 0, end = 0; k < kept.size(); k = end) {
            for (end = k + 1; end < kept.size() && kept[end] == kept[k];) ++end;
            if (kept[k] == 0) w.memory.close(w.at(k), w.at(end));
        }
        w.held = kept;
    }
    void fill(const T& value) {
        if (!window_) return std::fill(whole_.begin(), whole_.end(), value);
        std::fill_n(data_, window_->head, value);
        each_run([&](T* from, std::size_t count) { std::fill_n(from, count, value); });
    }
    void swap(PlaneStore& other) noexcept {
        whole_.swap(other.whole_);
        window_.swap(other.window_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
    }
    /// As the constructor; memory that fits is reused with its contents.
    void resize(const Slab* slab, std::size_t head, std::size_t plane, int count, int margin) {
        const std::size_t size = head + plane * static_cast<std::size_t>(count + 2 * margin);
        if (makes_window(slab, count)) {
            const bool same = window_ && window_->slab == slab && size == size_ && window_->head == head && window_->plane == plane &&
                              window_->margin == margin;
            if (!same) make(slab, head, plane, count, margin, T{});
            return;
        }
        window_.reset();
        resize_scratch(whole_, size);
        data_ = whole_.data(), size_ = size;
    }

private:
    struct Window {
        Window(std::size_t bytes) : memory(bytes) {}
        Reserved memory;
        const Slab* slab = nullptr;
        std::size_t head = 0, plane = 0;
        int count = 0, margin = 0, ghost_planes = -1;
        bool ring = false;
        std::vector<char> held{};
        std::size_t at(std::size_t plane_from_margin) const { return (head + plane_from_margin * plane) * sizeof(T); }
    };

    static bool makes_window(const Slab* slab, int count) {
        return slab != nullptr && (count == slab->partition().planes() || count == slab->partition().planes() + 1);
    }
    void make(const Slab* slab, std::size_t head, std::size_t plane, int count, int margin, const T& value) {
        size_ = head + plane * static_cast<std::size_t>(count + 2 * margin);
        if (!makes_window(slab, count)) {
            window_.reset();
            whole_.assign(size_, value);
            data_ = whole_.data();
            return;
        }
        whole_ = {};
        reserve(slab, head, plane, count, margin);
        window_->memory.open(0, head * sizeof(T));
        open(slab->ghost_planes(), slab->ring());
        fill(value);
    }
    void reserve(const Slab* slab, std::size_t head, std::size_t plane, int count, int margin) {
        window_ = std::make_unique<Window>(size_ * sizeof(T));
        window_->slab = slab;
        window_->head = head, window_->plane = plane, window_->count = count, window_->margin = margin;
        window_->held.assign(static_cast<std::size_t>(count + 2 * margin), 0);
        data_ = reinterpret_cast<T*>(window_->memory.data());
    }
    void open(const std::vector<char>& wanted) {
        Window& w = *window_;
        for (std::size_t k = 0, end = 0; k < wanted.size(); k = end) {
            end = k + 1;
            if (wanted[k] == 0) continue;
            while (end < wanted.size() && wanted[end] != 0) ++end;
            w.memory.open(w.at(k), w.at(end));
        }
        for (std::size_t k = 0; k < wanted.size(); ++k) w.held[k] = static_cast<char>(w.held[k] | wanted[k]);
    }
    template <class F>
    void each_run(F&& f) const {
        const Window& w = *window_;
        for (std::size_t k = 0; k < w.held.size(); ++k)
            if (w.held[k] != 0) f(data_ + w.head + k * w.plane, w.plane);
    }
    void copy(const PlaneStore& other) {
        if (!other.window_) {
            window_.reset();
            whole_ = other.whole_;
            data_ = whole_.data(), size_ = whole_.size();
            return;
        }
        const Window& from = *other.window_;
        const bool fits = window_ && window_->slab == from.slab && size_ == other.size_ && window_->head == from.head &&
                          window_->plane == from.plane && window_->margin == from.margin;
        if (!fits) {
            whole_ = {};
            size_ = other.size_;
            reserve(from.slab, from.head, from.plane, from.count, from.margin);
            window_->memory.open(0, from.head * sizeof(T));
        }
        window_->ghost_planes = std::max(window_->ghost_planes, from.ghost_planes), window_->ring = window_->ring || from.ring;
        open(from.held);
        std::copy_n(other.data_, from.head, data_);
        other.each_run([&](const T* values, std::size_t count) { std::copy_n(values, count, data_ + (values - other.data_)); });
    }

    std::vector<T> whole_;
    std::unique_ptr<Window> window_;
    T* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace weir
