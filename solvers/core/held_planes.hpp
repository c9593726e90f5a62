// How a solver holds its fields over ranks: each rank its own planes and some beyond its cuts, or, where somebody looks at whole fields on
// all ranks, everything.
#pragma once
#include "core/grid.hpp"

#include <memory>
#include <utility>

namespace weir {

/// The first member of a solver that holds fields: what is made after it, until made(), is held so.
class HeldPlanes {
public:
    /// `alone`: own planes and `deep` beyond the cuts (more than 0), around a periodic axis too; `reach` as of OwnPlanes. An empty cut:
    /// all, in one process or not.
    HeldPlanes(Cut cut, bool alone, int deep, bool ring, int reach = 1)
        : cut_(std::move(cut)),
          kept_(alone ? deep : 0),
          reach_(reach),
          ring_(ring),
          making_(alone ? std::make_unique<OwnPlanes>(cut_, reach_, kept_, ring_) : nullptr) {}
    HeldPlanes(const HeldPlanes&) = delete;
    HeldPlanes& operator=(const HeldPlanes&) = delete;

    void made() { making_.reset(); }
    const Cut& cut() const { return cut_; }
    bool alone() const { return kept_ > 0; }
    bool ring() const { return ring_; }
    /// For a step.
    OwnPlanes own() const { return OwnPlanes(cut_, reach_, kept_, ring_); }
    /// For whoever looks: this rank's planes where it holds no more, else all.
    OwnPlanes looking() const { return OwnPlanes(alone() ? cut_ : nowhere(), reach_, kept_, ring_); }

private:
    static const Cut& nowhere() {
        static const Cut none;
        return none;
    }
    Cut cut_;
    int kept_, reach_;
    bool ring_;
    std::unique_ptr<OwnPlanes> making_;
};

}  // namespace weir
