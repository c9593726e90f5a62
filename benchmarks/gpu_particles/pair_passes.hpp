// PBF's passes over pairs, lambda and correct, over a neighbour list and over the particles of the 27 (2D: 9) cells around each one, on the
// same particles in the same run, with work groups of any size. The list is the solver's (kernels/list.cl, pbf.cl); the passes over cells
// stand here and sum the same pair text (pbf_pair.inl) in the list's order. Cells are those of the predicted positions for all iterations,
// as the list is; but what comes closer than the support only then is seen by the cells alone.
#pragma once
#include "backend/device.hpp"
#include "core/types.hpp"
#include "particles/opencl/device_memory.hpp"
#include "particles/opencl/kernel_text.hpp"
#include "particles/state/fluid.hpp"
#include "particles/state/frame.hpp"
#include "particles/threads/passes.hpp"
#include "pbf/options.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace weir::bench {

inline constexpr const char* cells_text = R"(
/* Particles j of one row of cells after the other, in the order of append_near (list.cl). */
#define FOR_NEAR(j) \
    for (int z = max(own.z - 1, 0); z <= min(own.z + 1, cells.z - 1); ++z) \
        for (int y = max(own.y - 1, 0); y <= min(own.y + 1, cells.y - 1); ++y) \
            for (int row = (z * cells.y + y) * cells.x, j = start[row + max(own.x - 1, 0)], \
                     end = start[row + min(own.x + 1, cells.x - 1) + 1]; j < end; ++j)

WEIR_FN int4 cell_at(int c, int4 cells) { return (int4)(c % cells.x, c / cells.x % cells.y, c / (cells.x * cells.y), 0); }

__kernel void lambda_cells(int count, int4 cells, __constant PbfParams* p, __constant WallParams* walls, __global const float4* terms,
                           __global const float4* from, __global const int* sorted_cell, __global const int* start,
                           __global float4* to, __global float* density, __global float* multiplier) {
    const int i = get_global_id(0);
    if (i >= count) return;
    float4 me = from[i];
    const int4 own = cell_at(sorted_cell[i], cells);
    float rho = p->self, neighbours2 = 0, gx = 0, gy = 0, gz = 0;
    FOR_NEAR(j) {
        const float4 d = me - from[j];
        if (j == i || !(SQUARE(d) < p->h2)) continue;
        const float r2 = DISTANCE2(d, p);
        const float slope = pbf_slope(r2, p);
        rho = pbf_add_density(rho, r2, p);
        neighbours2 = FMA(slope * slope, r2, neighbours2);
        gx = FMA(slope, d.x, gx);
        gy = FMA(slope, d.y, gy);
        gz = FMA(slope, d.z, gz);
    }
    const float4 w = walls_at(me, walls, terms, i);
    rho += w.w;
    gx += w.x;
    gy += w.y;
    gz += w.z;
    const float before = multiplier[i];
    const float sum = pbf_multiplier(before, rho, neighbours2, dot3(gx, gy, gz, gx, gy, gz), p);
    multiplier[i] = sum;
    me.w = sum - before;
    to[i] = me;
    density[i] = rho;
}

__kernel void correct_cells(int count, int4 cells, __constant PbfParams* p, __constant WallParams* walls, __global const float4* terms,
                            __global const float4* from, __global const int* sorted_cell, __global const int* start,
                            __global float4* to) {
    const int i = get_global_id(0);
    if (i >= count) return;
    const float4 me = from[i];
    const int4 own = cell_at(sorted_cell[i], cells);
    float cx = 0, cy = 0, cz = 0;
    FOR_NEAR(j) {
        const float4 other = from[j], d = me - other;
        if (j == i || !(SQUARE(d) < p->h2)) continue;
        const float factor = pbf_correction(DISTANCE2(d, p), me.w + other.w, p);
        cx = FMA(factor, d.x, cx);
        cy = FMA(factor, d.y, cy);
        cz = FMA(factor, d.z, cz);
    }
    const float4 w = walls_at(me, walls, terms, i);
    to[i] = (float4)(clamp(me.x + FMA(me.w, w.x, cx), walls->keep_lo[0], walls->keep_hi[0]),
                     clamp(me.y + FMA(me.w, w.y, cy), walls->keep_lo[1], walls->keep_hi[1]),
                     clamp(me.z + FMA(me.w, w.z, cz), walls->keep_lo[2], walls->keep_hi[2]), 0.0f);
}
)";

/// Milliseconds of one call of each pass by the device's clock: over the list, which is built first, and over cells.
struct PairTimes {
    double build = infinity, lambda = infinity, correct = infinity, lambda_cells = infinity, correct_cells = infinity;
    double by_list(int iterations) const { return build + iterations * (lambda + correct); }
    double by_cells(int iterations) const { return iterations * (lambda_cells + correct_cells); }
};

/// The largest distance between a particle of one way and the same of the other, and from where it was before, in supports.
struct Difference {
    double apart = 0, moved = 0;
};

/// The particles of `fluid` at their predicted positions, on a device of their own.
template <int D>
class PairPasses {
public:
    PairPasses(const pbf::Options& options, const particles::Fluid<D>& fluid, real dt);
    /// The least of three runs.
    PairTimes measure(int iterations, std::size_t group);
    /// After so many iterations.
    Difference difference(int iterations, std::size_t group);
    std::size_t group_limit() const { return device_->info().group_limit; }

private:
    using Memory = backend::Memory;
    using Places = std::vector<std::array<float, 4>>;
    template <class T>
    Memory copy_of(const T* data, std::size_t count) {
        Memory memory = device_->alloc(count * sizeof(T));
        device_->upload(memory, data, count * sizeof(T));
        return memory;
    }
    void sort(const particles::Fluid<D>& fluid, real dt);
    void build_list(int room, std::size_t group);
    Places after(int iterations, bool over_cells, std::size_t group);

    std::unique_ptr<backend::Device> device_;
    int count_ = 0, room_ = 0;
    float support_ = 0;
    particles::CellGrid grid_;
    std::array<int, 4> cells_{};
    Places begin_;  // sorted
    Memory params_, walls_, state_, terms_, rests_, sorted_cell_, start_, a_, b_, density_, multiplier_, neighbours_, list_, needed_,
        corrections_;
};

template <int D>
PairPasses<D>::PairPasses(const pbf::Options& options, const particles::Fluid<D>& fluid, real dt)
    : device_(backend::open_device(options.backend.device)), support_(static_cast<float>(options.support * fluid.domain.spacing)) {
    if (options.pressure_k > 0) throw std::logic_error("the passes over cells have no artificial pressure");
    device_->compile(particles::program_of({"prelude_opencl.h", "params.h", "state_params.h", "single.inl", "pair.inl", "pbf_pair.inl",
                                            "state.cl", "list.cl", "pbf.cl"}) +
                         cells_text,
                     "-cl-std=CL1.2 -DWEIR_KEEP -DWEIR_GROUP=64 -DWEIR_DIM=" + std::to_string(D) +
                         " -DWEIR_KERNEL=" + std::to_string(static_cast<int>(options.smoothing)));
    const real d = fluid.domain.spacing;
    const auto params = pbf::pbf_params<particles::single::PbfParams, D>(options, d);
    const auto walls = particles::wall_params<particles::single::WallParams>(options, fluid.domain);
    params_ = copy_of(&params, 1), walls_ = copy_of(&walls, 1);
    state_ = terms_ = rests_ = device_->alloc(1024);  // read where axes repeat, solids are, or something boils: nowhere here
    corrections_ = device_->alloc(8);
    sort(fluid, dt);
    const auto n = static_cast<std::size_t>(count_);
    a_ = device_->alloc(n * 16), b_ = device_->alloc(n * 16);
    density_ = device_->alloc(n * 4), multiplier_ = device_->alloc(n * 4), neighbours_ = device_->alloc(n * 4);
    needed_ = list_ = device_->alloc(4);
    device_->upload(a_, begin_.data(), n * 16);
    device_->fill_zero(needed_, 4);
    build_list(0, 64);  // counts
    device_->download(&room_, needed_, 4);
    list_ = device_->alloc(n * 4 * static_cast<std::size_t>(std::max(room_, 1)));
    device_->timings();
}

/// x* = x + dt (v + dt g), sorted by cells, around the centre of the domain in single precision (list.cl, load_sorted).
template <int D>
void PairPasses<D>::sort(const particles::Fluid<D>& fluid, real dt) {
    count_ = fluid.count();
    const auto& domain = fluid.domain;
    auto predicted = fluid.x;
    for (int i = 0; i < count_; ++i) {
        Vec<D> x = fluid.position(i), v = fluid.velocity(i);
        for (int a = 0; a < D; ++a) x[a] = std::clamp(x[a] + dt * (v[a] + dt * fluid.gravity[a]), domain.keep_lo[a], domain.keep_hi[a]);
        fluid.put(predicted, i, x);
    }
    particles::CellSort sorted;
    const auto at = fluid.coordinates(predicted);
    grid_ = domain.frame().cover(sorted.box(at, count_), count_, static_cast<real>(support_));
    sorted.sort(at, count_, grid_);
    cells_ = {grid_.cells[0], grid_.cells[1], grid_.cells[2], 1};
    begin_.resize(static_cast<std::size_t>(count_));
    for (std::size_t k = 0; k < begin_.size(); ++k)
        for (int a = 0; a < D; ++a)
            begin_[k][static_cast<std::size_t>(a)] = static_cast<float>(
                predicted[static_cast<std::size_t>(a)][static_cast<std::size_t>(sorted.order()[k])] - domain.centre()[a]);
    sorted_cell_ = copy_of(sorted.cell_of().data(), sorted.cell_of().size());
    start_ = copy_of(sorted.start().data(), sorted.start().size());
}

template <int D>
void PairPasses<D>::build_list(int room, std::size_t group) {
    const std::array<double, 4> corner{grid_.origin[0], grid_.origin[1], grid_.origin[2], grid_.per_cell};
    device_->launch(
        "find_neighbours", static_cast<std::size_t>(count_), group,
        {count_, count_, room, support_ * support_, state_, corner, cells_, a_, sorted_cell_, start_, neighbours_, list_, needed_});
}

template <int D>
typename PairPasses<D>::Places PairPasses<D>::after(int iterations, bool over_cells, std::size_t group) {
    const auto n = static_cast<std::size_t>(count_);
    device_->upload(a_, begin_.data(), n * 16);
    device_->fill_zero(multiplier_, n * 4);
    if (!over_cells) build_list(room_, group);
    for (int k = 0; k < iterations; ++k)
        if (over_cells) {
            device_->launch("lambda_cells", n, group,
                            {count_, cells_, params_, walls_, terms_, a_, sorted_cell_, start_, b_, density_, multiplier_});
            device_->launch("correct_cells", n, group, {count_, cells_, params_, walls_, terms_, b_, sorted_cell_, start_, a_});
        } else {
            device_->launch("lambda", n, group,
                            {count_, count_, params_, walls_, terms_, rests_, a_, neighbours_, list_, b_, density_, multiplier_});
            device_->launch("correct", n, group,
                            {count_, count_, state_, params_, walls_, terms_, rests_, corrections_, b_, neighbours_, list_, a_});
        }
    Places places(n);
    device_->download(places.data(), a_, n * 16);
    return places;
}

template <int D>
Difference PairPasses<D>::difference(int iterations, std::size_t group) {
    const Places list = after(iterations, false, group), cells = after(iterations, true, group);
    device_->timings();
    const auto largest = [&](const Places& from, const Places& to) {
        double square = 0;
        for (std::size_t k = 0; k < from.size(); ++k) {
            double here = 0;
            for (std::size_t a = 0; a < D; ++a) here += std::pow(static_cast<double>(from[k][a] - to[k][a]), 2);
            if (!(here <= square)) square = here;
        }
        return std::sqrt(square) / static_cast<double>(support_);
    };
    return {largest(cells, list), largest(begin_, list)};
}

template <int D>
PairTimes PairPasses<D>::measure(int iterations, std::size_t group) {
    PairTimes best;
    const std::map<std::string, double*> of{{"find_neighbours", &best.build},
                                            {"lambda", &best.lambda},
                                            {"correct", &best.correct},
                                            {"lambda_cells", &best.lambda_cells},
                                            {"correct_cells", &best.correct_cells}};
    for (int run = 0; run < 3; ++run) {
        for (const bool over_cells : {false, true}) after(iterations, over_cells, group);
        for (const auto& t : device_->timings())
            if (t.calls > 0) *of.at(t.kernel) = std::min(*of.at(t.kernel), 1e3 * t.seconds / t.calls);
    }
    return best;
}

}  // namespace weir::bench
