// Particles as the fast path sees them during one step: sorted by cell, as float4 around the centre of the domain, with images beyond
// periodic sides and a sliced neighbour list. The state in double precision stays where it is; position k here is state particle owner(k).
// Over ranks each sorts its own particles and those shown to it (migration.hpp), has the neighbours of its own (shares.hpp), and what
// others compute is brought.
#pragma once
#include "core/types.hpp"
#include "particles/frame.hpp"
#include "particles/isa.hpp"
#include "particles/migration.hpp"
#include "particles/shares.hpp"
#include "particles/sliced_list.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace weir::particles {

class Pairs {
public:
    Pairs(const PassTable& table, const Frame& frame) : table_(table), frame_(frame) {}

    /// Lines 5-7 of Macklin & Müller's algorithm 1: sorts, loads positions into the fourth-number-zero float4 array, finds neighbours.
    void find(const Coordinates& x, int count, real radius);
    /// The same over ranks, of those held here.
    void find(const Coordinates& x, int count, real radius, const Held& held);

    const PassTable& table() const { return table_; }
    /// Particles and images.
    int size() const { return cells_.count(); }
    int particles() const { return particles_; }
    /// Of all ranks.
    int total() const { return total_; }
    int owner(int k) const { return owner_[static_cast<std::size_t>(k)]; }
    bool is_image(int k) const { return images() > 0 && cells_.order()[static_cast<std::size_t>(k)] >= particles_; }
    int images() const { return size() - particles_; }
    /// Own state particles in sorted order.
    const std::vector<int>& particle_order();
    /// Two float4 arrays, and room for more; each has dummies behind the last particle.
    float* a() { return a_.data(); }
    float* b() { return b_.data(); }
    /// Grows an array of float4 (or of single floats) to this step's size, dummies included.
    void fit(std::vector<float>& numbers, int per_particle) const;
    /// Zeros for the dummies in an array of float4, where they may have been particles before: no number times a weight of 0 is wanted
    /// there.
    void clear_dummies(std::vector<float>& four) const { std::fill_n(four.begin() + 4 * size(), 4 * table_.lanes, 0.0f); }
    /// The fast path's coordinate of a state position along an axis.
    float local(real x, int axis) const { return static_cast<float>(x - frame_.centre[static_cast<std::size_t>(axis)]); }
    /// Where find() saw sorted particle k: the coordinate that the passes started from.
    float found_at(int k, int axis) const { return axis_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)]; }
    /// What was computed of own particles comes to where others read it, in an array of float4: over ranks to those beside them, and from
    /// owners to their images; `moves`: the first three numbers are positions.
    void refresh(float* four, bool moves);
    /// Over ranks, the same of arrays of the state, or of one number a sorted particle.
    using StateArrays = std::span<std::vector<real>* const>;
    void share(StateArrays state);
    void share(std::vector<float>& sorted);
    /// Of what each rank gives; NaN if any is.
    real largest(real own) const;
    const Shares& shares() const { return shares_; }
    const SlicedList& list() const { return list_; }
    SlicedList& list() { return list_; }
    const CellSort& cells() const { return cells_; }
    /// f(k) for all particles and images; over ranks own ones, those that this one's passes read, or all that are here.
    template <class F>
    void each(F&& f) const {
        each_of(shares_.own(), f);
    }
    template <class F>
    void each_read(F&& f) const {
        each_of(shares_.read(), f);
    }
    template <class F>
    void each_anywhere(F&& f) const {
        each_of({0, size()}, f);
    }
    /// Mean and largest number of neighbours of the particles; those of images are not counted.
    struct NeighbourCounts {
        real mean = 0, most = 0;
    };
    NeighbourCounts neighbour_counts() const;
    std::size_t bytes() const;

private:
    template <class F>
    static void each_of(const Entries& entries, F&& f) {
        for_chunks(entries.count(), [&](int, int begin, int end) {
            for (int k = entries.begin + begin; k < entries.begin + end; ++k) f(k);
        });
    }
    void place(const Coordinates& all);
    void link_images();
    void finish(const Coordinates& all, real radius);
    void list_near_sides(const Coordinates& x, int count, const Box& particles, real radius, const real* place);
    void make_images(const Coordinates& x, int count, const Box& particles, real radius, const real* place);
    void place_dummies(float* four) const;

    const PassTable& table_;
    Frame frame_;
    int particles_ = 0, total_ = 0;
    CellSort cells_;
    Shares shares_;
    SlicedList list_;
    std::vector<float> a_, b_;
    std::array<std::vector<float>, 3> axis_;  // positions as the list is built from them
    std::vector<int> owner_;
    // Only with periodic axes:
    std::array<std::vector<real>, 3> with_images_;   // coordinates of particles and images before sorting
    std::vector<int> image_owner_;                   // state particle of each image
    std::vector<std::array<float, 3>> image_shift_;  // and where it stands from there
    std::vector<Link> links_;
    std::vector<int> near_sides_;  // particles that have images
    std::vector<int> sorted_;      // scratch: where each particle went
};

}  // namespace weir::particles
