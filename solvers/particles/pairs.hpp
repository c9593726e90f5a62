// Particles as the fast path sees them during one step: sorted by cell, as float4 around the centre of the domain, with images beyond
// periodic sides and a sliced neighbour list. The state in double precision stays where it is; position k here is state particle owner(k).
#pragma once
#include "core/types.hpp"
#include "particles/frame.hpp"
#include "particles/isa.hpp"
#include "particles/sliced_list.hpp"

#include <array>
#include <vector>

namespace weir::particles {

class Pairs {
public:
    Pairs(const PassTable& table, const Frame& frame) : table_(table), frame_(frame) {}

    /// Lines 5-7 of Macklin & Müller's algorithm 1: sorts, loads positions into the fourth-number-zero float4 array, finds neighbours.
    void find(const Coordinates& x, int count, real radius);

    const PassTable& table() const { return table_; }
    /// Particles and images.
    int size() const { return cells_.count(); }
    int particles() const { return particles_; }
    int owner(int k) const { return owner_[static_cast<std::size_t>(k)]; }
    bool is_image(int k) const { return images() > 0 && cells_.order()[static_cast<std::size_t>(k)] >= particles_; }
    int images() const { return size() - particles_; }
    /// State particles in sorted order.
    const std::vector<int>& particle_order();
    /// Two float4 arrays, and room for more; each has dummies behind the last particle.
    float* a() { return a_.data(); }
    float* b() { return b_.data(); }
    /// Grows an array of float4 (or of single floats) to this step's size, dummies included.
    void fit(std::vector<float>& numbers, int per_particle) const;
    /// The fast path's coordinate of a state position along an axis.
    float local(real x, int axis) const { return static_cast<float>(x - frame_.centre[static_cast<std::size_t>(axis)]); }
    /// Where find() saw sorted particle k: the coordinate that the passes started from.
    float found_at(int k, int axis) const { return axis_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(k)]; }
    /// Copies owners to their images in an array of float4; `moves`: the first three numbers are positions.
    void refresh_images(float* four, bool moves) const;
    const SlicedList& list() const { return list_; }
    SlicedList& list() { return list_; }
    const CellSort& cells() const { return cells_; }
    /// f(k) for all particles and images.
    template <class F>
    void each(F&& f) const {
        for_chunks(size(), [&](int, int begin, int end) {
            for (int k = begin; k < end; ++k) f(k);
        });
    }
    /// Mean and largest number of neighbours of the particles; those of images are not counted.
    struct NeighbourCounts {
        real mean = 0, most = 0;
    };
    NeighbourCounts neighbour_counts() const;
    std::size_t bytes() const;

private:
    void make_images(const Coordinates& x, int count, const Box& particles, real radius);
    void place_dummies(float* four) const;

    const PassTable& table_;
    Frame frame_;
    int particles_ = 0;
    CellSort cells_;
    SlicedList list_;
    std::vector<float> a_, b_;
    std::array<std::vector<float>, 3> axis_;  // positions as the list is built from them
    std::vector<int> owner_;
    // Only with periodic axes:
    std::array<std::vector<real>, 3> with_images_;   // coordinates of particles and images before sorting
    std::vector<int> image_owner_;                   // state particle of each image
    std::vector<std::array<float, 3>> image_shift_;  // and where it stands from there
    std::vector<std::array<int, 3>> links_;          // (sorted image, sorted owner, image)
    std::vector<int> sorted_;                        // scratch: where each particle went
};

}  // namespace weir::particles
