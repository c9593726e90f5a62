// The particles of one step in the layout of the fast path: sorted by cell, as float4 relative to the centre of the domain, with periodic
// images and a sliced neighbour list. The double-precision state is unchanged; position k here is state particle owner(k). In parallel each
// rank sorts its own and its ghost particles (migration.hpp), finds the neighbours of its own (shares.hpp), and receives values of the
// others.
#pragma once
#include "core/types.hpp"
#include "particles/ranks/migration.hpp"
#include "particles/ranks/shares.hpp"
#include "particles/state/frame.hpp"
#include "particles/threads/isa.hpp"
#include "particles/threads/sliced_list.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace weir::particles {

class Pairs {
public:
    Pairs(const PassTable& table, const Frame& frame) : table_(table), frame_(frame) {}

    /// Lines 5-7 of Macklin & Müller's algorithm 1: sorts, loads positions into a float4 array with fourth number zero, finds neighbours.
    void find(const Coordinates& x, int count, real radius);
    /// The same in parallel, for the particles stored here.
    void find(const Coordinates& x, int count, real radius, const Held& held);

    const PassTable& table() const { return table_; }
    /// Number of particles and images.
    int size() const { return cells_.count(); }
    int particles() const { return particles_; }
    /// Total over the ranks.
    int total() const { return total_; }
    int owner(int k) const { return owner_[static_cast<std::size_t>(k)]; }
    bool is_image(int k) const { return images() > 0 && cells_.order()[static_cast<std::size_t>(k)] >= particles_; }
    int images() const { return size() - particles_; }
    /// Own state particles in sorted order.
    const std::vector<int>& particle_order();
    /// Two float4 arrays with spare capacity; each has dummies behind the last particle.
    float* a() { return a_.data(); }
    float* b() { return b_.data(); }
    /// Grows an array of float4 (or of single floats) to this step's size, including dummies.
    void fit(std::vector<float>& numbers, int per_particle) const;
    /// Clears the dummies in an array of float4, where particles may have been before: weight 0 times NaN would not be 0.
    void clear_dummies(std::vector<float>& four) const { std::fill_n(four.begin() + 4 * size(), 4 * table_.lanes, 0.0f); }
    /// The fast path's coordinate of a state position along an axis.
    float local(real x, int axis) const { return static_cast<float>(x - frame_.centre[static_cast<std::size_t>(axis)]); }
    /// Coordinate of sorted particle k as of find(), where the passes started.
    float found_at(int k, int axis) const { return axis_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)]; }
    /// Halo exchange of values of own particles, in an array of float4: in parallel to ghost particles, and from owners to their images;
    /// `moves`: the first three numbers are positions.
    void refresh(float* four, bool moves);
    /// In parallel, the same for arrays of the state, or of one number per sorted particle.
    using StateArrays = std::span<std::vector<real>* const>;
    void share(StateArrays state);
    void share(std::vector<float>& sorted);
    /// Maximum over the ranks; NaN if any is NaN.
    real largest(real own) const;
    const Shares& shares() const { return shares_; }
    const SlicedList& list() const { return list_; }
    SlicedList& list() { return list_; }
    const CellSort& cells() const { return cells_; }
    /// f(k) for all particles and images; in parallel for own ones, for those read by this rank's passes, or for all stored here.
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
    /// Mean and maximum number of neighbours of the particles; images are not counted.
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
    std::array<std::vector<float>, 3> axis_;  // positions from which the list was built
    std::vector<int> owner_;
    // only with periodic axes
    std::array<std::vector<real>, 3> with_images_;   // coordinates of particles and images before sorting
    std::vector<int> image_owner_;                   // state particle of each image
    std::vector<std::array<float, 3>> image_shift_;  // and its displacement
    std::vector<Link> links_;
    std::vector<int> near_sides_;  // particles with images
    std::vector<int> sorted_;      // scratch: destination of each particle
};

}  // namespace weir::particles
