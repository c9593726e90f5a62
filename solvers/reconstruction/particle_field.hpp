// How far each sample of a lattice lies inside the liquid that particles stand for: the fields of reference.hpp in single precision, on
// threads, in blocks of samples. Blocks far from any particle, and blocks among so many that they are inside, are not computed.
#pragma once
#include "particles/cell_sort.hpp"
#include "reconstruction/kernel.hpp"
#include "reconstruction/options.hpp"
#include "reconstruction/samples.hpp"

#include <array>
#include <span>
#include <vector>

namespace weir::reconstruction {

/// The particles of one instant, and behind them their images beyond walls and sides that repeat.
struct Cloud {
    std::array<std::vector<real>, 3> x;  // [m]
    std::vector<int> source;             // of each image: the particle that it is one of
    int own = 0;                         // particles that are no images
    real spacing = 0;                    // at rest [m]

    int count() const { return static_cast<int>(x[0].size()); }
    particles::Coordinates coordinates() const { return {x[0].data(), x[1].data(), x[2].data()}; }
    int particle(int i) const { return i < own ? i : source[static_cast<std::size_t>(i - own)]; }
};

class ParticleField {
public:
    /// `flat`: the lattice is one plane, and the cloud has layers on both sides of it.
    explicit ParticleField(Method method, bool flat = false) : method_(method), flat_(flat) {}
    /// Fills samples.depth of a lattice that is laid already. The cloud must live as long as means are asked for.
    void compute(const Cloud& cloud, Samples& samples);
    /// The mean over the particles in reach of a point, weighted by their kernels, of their velocity [m/s]; 0 where there is none.
    Vec<3> velocity_at(const Vec<3>& x, const std::array<std::span<const real>, 3>& velocity) const;
    /// The same of how crowded they are: a sum over others near, each counted by 1 - (d/reach)^2; a lattice has 12.5. Of `density` only.
    real crowding_at(const Vec<3>& x) const;
    std::size_t bytes() const;
    /// Samples that were computed by the last call.
    long computed() const;

private:
    struct Block {
        std::array<int, 3> begin, end;  // samples
        float value;                    // where it is not computed
        bool computed;
    };
    struct FloatBlob {
        std::array<float, 3> centre, half;
        std::array<float, 6> stretch;
        float peak;
    };
    void sort(const Cloud& cloud, const Samples& samples);
    void find_deep_cells();
    void find_blocks(const Samples& samples);
    void mark_needed(const Block& block);
    void measure_particles();
    void measure(int i);
    void fill(const Block& block, Samples& samples) const;
    template <class Rows>
    void scatter_means(const Block& block, Rows& rows) const;
    template <class Rows>
    void scatter_kernels(const Block& block, Rows& rows) const;
    /// Cells that meet a box [spacings]; the first and last along each axis, and whether some of the box lies outside all cells.
    struct CellBox {
        std::array<int, 3> begin, end;
        bool beyond;
    };
    CellBox cells_in(const std::array<float, 3>& lo, const std::array<float, 3>& hi) const;
    /// f(first, behind last) for sorted particles in the cells of a box, a run of cells at a time, in the order of the sort.
    template <class F>
    void for_runs(const CellBox& box, const F& f) const;
    template <class Value>
    void weigh(const Vec<3>& x, const Value& value) const;
    /// How far a particle's kernel may reach from it [spacings].
    float outermost() const;
    std::array<float, 3> low(const Block& block) const;
    std::array<float, 3> high(const Block& block) const;

    Method method_;
    bool flat_;
    const Cloud* cloud_ = nullptr;
    particles::CellSort cells_;
    Vec<3> origin_{};                         // the first sample [m]
    float step_ = 1;                          // between samples [spacings]
    std::array<float, 3> cell_origin_{};      // [spacings]
    float cell_width_ = 1;                    // [spacings]
    std::array<std::vector<float>, 3> x_;     // sorted, in spacings from the first sample
    std::vector<char> full_, deep_, needed_;  // cells
    std::vector<Block> blocks_;
    std::vector<float> peak_, crowding_;  // of each sorted particle, in cells that are needed
    std::vector<FloatBlob> blobs_;
};

}  // namespace weir::reconstruction
