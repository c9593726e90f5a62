// Storage of a solver's fields in parallel: each rank stores its own planes and some ghost planes, or, where whole fields are needed on all
// ranks, everything.
#pragma once
#include "parallel/grid.hpp"

#include <memory>
#include <utility>

namespace weir {

/// The first member of a solver that stores fields: it sets the storage of all arrays constructed after it, until made().
class HeldPlanes {
public:
    /// `distributed`: distributed storage with own planes and `ghost_planes` planes (more than 0), also around a periodic axis; `reach` as
    /// in OwnPlanes. An empty partition: all planes, in one process or several.
    HeldPlanes(Cut cut, bool distributed, int ghost_planes, bool ring, int reach = 1)
        : cut_(std::move(cut)),
          kept_(distributed ? ghost_planes : 0),
          reach_(reach),
          ring_(ring),
          making_(distributed ? std::make_unique<OwnPlanes>(cut_, reach_, kept_, ring_) : nullptr) {}
    HeldPlanes(const HeldPlanes&) = delete;
    HeldPlanes& operator=(const HeldPlanes&) = delete;

    void made() { making_.reset(); }
    const Cut& cut() const { return cut_; }
    bool distributed() const { return kept_ > 0; }
    bool ring() const { return ring_; }
    /// The scope of a step.
    OwnPlanes own() const { return OwnPlanes(cut_, reach_, kept_, ring_); }
    /// The scope in which fields are read from outside: this rank's planes with distributed storage, otherwise all.
    OwnPlanes looking() const { return OwnPlanes(distributed() ? cut_ : nowhere(), reach_, kept_, ring_); }

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
