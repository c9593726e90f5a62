// Signed depth of lattice samples inside the liquid represented by particles: the fields of reference.hpp in single precision, on threads,
// in blocks of samples. Blocks far from any particle, and blocks deep inside, are not computed.
#pragma once
#include "particles/threads/cell_sort.hpp"
#include "surfaces/cloud.hpp"
#include "surfaces/kernel.hpp"
#include "surfaces/options.hpp"
#include "surfaces/samples.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace weir::surfaces {

class ParticleField {
public:
    /// `flat`: the lattice is one plane, and the cloud has layers on both sides of it.
    explicit ParticleField(Method method, bool flat = false) : method_(method), flat_(flat) {}
    /// Sets the cells for particles with this box and number, on an existing lattice.
    void lay(const particles::Box& box, std::int64_t count, real spacing, const Samples& samples);
    /// In parallel: the planes of cells whose particles are read for these planes of samples and for means between them and the next plane;
    /// and the plane of cells of a point.
    PlaneRange cells_read(const Samples& samples, PlaneRange planes) const;
    int cell_plane(real x) const;
    /// Computes the own planes of samples from the particles read for them. The cloud must outlive all calls for means.
    void compute(const Cloud& cloud, Samples& samples);
    /// The kernel-weighted mean of the velocity of the particles within reach of a point [m/s]; 0 without particles.
    Vec<3> velocity_at(const Vec<3>& x, const std::array<std::span<const real>, 3>& velocity) const;
    /// The same mean of their crowding: a sum over neighbours, each weighted by 1 - (d/reach)^2; a lattice has 12.5. Only for `density`.
    real crowding_at(const Vec<3>& x) const;
    std::size_t bytes() const;
    /// Number of samples computed by the last call.
    long computed() const;

private:
    struct Block {
        /// Samples along each axis: its sums fit in the first-level cache; the same number along z, and for a 2D liquid along y.
        static constexpr std::array<int, 3> length{16, 8, 8};
        std::array<int, 3> begin, end;  // this rank's samples
        float value;                    // default value
        bool computed;
    };
    struct FloatBlob {
        std::array<float, 3> centre, half;
        std::array<float, 6> stretch;
        float peak;
    };
    void sort(const Cloud& cloud);
    void find_deep_cells();
    void find_blocks(const Samples& samples);
    bool is_deep(const Block& whole) const;
    void mark_needed(const Block& block);
    void measure_particles();
    void measure(int i);
    void fill(const Block& block, Samples& samples) const;
    template <class Rows>
    void scatter_means(const Block& block, Rows& rows) const;
    template <class Rows>
    void scatter_kernels(const Block& block, Rows& rows) const;
    /// Cells that intersect a box [spacings]; the first and last along each axis, and whether a part of the box lies outside all cells.
    struct CellBox {
        std::array<int, 3> begin, end;
        bool beyond;
    };
    /// The cells between two coordinates [spacings] along an axis.
    PlaneRange cells_between(std::size_t axis, float lo, float hi) const;
    std::size_t slowest() const { return flat_ ? 1 : 2; }
    /// Index of the first cell of a row, among the sorted cells.
    std::size_t row_of(int j, int k) const {
        const auto& n = grid_.cells;
        return (static_cast<std::size_t>(k) * static_cast<std::size_t>(n[1]) + static_cast<std::size_t>(j)) *
                   static_cast<std::size_t>(n[0]) -
               static_cast<std::size_t>(cells_.first_cell());
    }
    CellBox cells_in(const std::array<float, 3>& lo, const std::array<float, 3>& hi) const;
    /// f(first, end) for sorted particles in the cells of a box, one run of cells at a time, in sorted order.
    template <class F>
    void for_runs(const CellBox& box, const F& f) const;
    template <class Value>
    void weigh(const Vec<3>& x, const Value& value) const;
    /// Maximum range of a particle's kernel [spacings].
    float outermost() const;
    std::array<float, 3> low(const Block& block) const;
    std::array<float, 3> high(const Block& block) const;

    Method method_;
    bool flat_;
    const Cloud* cloud_ = nullptr;
    particles::CellGrid grid_;
    PlaneRange read_{0, 0};  // planes of cells
    particles::CellSort cells_;
    Vec<3> origin_{};                         // the first sample [m]
    float step_ = 1;                          // between samples [spacings]
    std::array<float, 3> cell_origin_{};      // [spacings]
    float cell_width_ = 1;                    // [spacings]
    std::array<std::vector<float>, 3> x_;     // sorted, in spacings relative to the first sample
    std::vector<char> full_, deep_, needed_;  // per cell
    std::vector<Block> blocks_;
    std::vector<float> peak_, crowding_;  // of each sorted particle, in cells that are needed
    std::vector<FloatBlob> blobs_;
};

template <class F>
void ParticleField::for_runs(const CellBox& box, const F& f) const {
    if (box.begin[0] >= box.end[0]) return;
    for (int k = box.begin[2]; k < box.end[2]; ++k)
        for (int j = box.begin[1]; j < box.end[1]; ++j) {
            const std::size_t row = row_of(j, k);
            const int first = cells_.start()[row + static_cast<std::size_t>(box.begin[0])];
            const int behind = cells_.start()[row + static_cast<std::size_t>(box.end[0])];
            if (first < behind) f(first, behind);
        }
}

}  // namespace weir::surfaces
