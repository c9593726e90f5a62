// The pair passes for one instruction set. CMake compiles this file three times, with WEIR_ISA = 128, 256 and 512 and the flags of that
// processor; one is selected at run time (isa.cpp). It must not use inline functions that other files also use.
#include "particles/threads/list_build.hpp"
#include "particles/threads/passes.hpp"
#include "particles/threads/simd.hpp"

namespace weir::particles {
namespace {
namespace single = weir::particles::single;

#define WEIR_FN static inline
#define REAL vf
#define SCALAR float
#define WEIR_PARAM const
#define MAX0(x) max0(x)
#define FMA(a, b, c) fma(lanes_of(a), lanes_of(b), lanes_of(c))
#define FNMA(a, b, c) fnma(lanes_of(a), lanes_of(b), lanes_of(c))
#define BITS(x) ((whole)(x))
#define FROM_BITS(i) ((vf)(i))
#define RSQRT(x) inverse_root(x)
using single::HeatParams;
using single::HeatWalls;
using single::PbfParams;
using single::SphParams;
using single::WallParams;
// clang-format off
#include "particles/kernels/single.inl"
#include "particles/kernels/pair.inl"
#include "particles/kernels/heat_walls.inl"
// clang-format on

inline void prefetch(const std::uint32_t* row) { _mm_prefetch(reinterpret_cast<const char*>(row + 16 * lanes), _MM_HINT_T0); }
inline int live(int first, int count) { return first + lanes <= count ? lanes : count - first; }
inline void store_numbers(float* to, int first, int count, vf value) {
    for (int l = 0; l < count; ++l) to[first + l] = value[l];
}
inline vf kept(vf x, const WallParams* w, int axis) { return lower(higher(x, broadcast(w->keep_lo[axis])), broadcast(w->keep_hi[axis])); }

/// Counts the lanes corrected by walls. Squares of nonnegative floats are ordered like their bits.
inline void tally_corrections(CorrectionTally& tally, vf distance2, int begin, int end, const int* order, int particles) {
    if (!any_below(-distance2, -tally.least2)) return;
    long long times = 0;
    float farthest2 = 0;
    for (int l = begin; l < end; ++l) {
        if (!(distance2[l] > tally.least2) || order[l] >= particles) continue;
        ++times;
        farthest2 = distance2[l] > farthest2 ? distance2[l] : farthest2;
    }
    if (times == 0) return;
    __atomic_fetch_add(&tally.count, times, __ATOMIC_RELAXED);
    float before;
    __atomic_load(&tally.farthest2, &before, __ATOMIC_RELAXED);
    while (farthest2 > before &&
           !__atomic_compare_exchange(&tally.farthest2, &before, &farthest2, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
}

/// Walls and solids at the particles of one slice (walls_combined). Most slices have none nearby; a slice near a wall is near one or two.
inline Four walls_at(const Four& i, const WallParams* w, const float* solid, int first) {
    const vf zero = broadcast(0);
    const vf x[3] = {i.x, i.y, i.z};
    vf part[3] = {zero, zero, zero}, lean[3] = {zero, zero, zero}, pull[3] = {zero, zero, zero}, steep[3] = {zero, zero, zero};
    bool any = solid != nullptr;
    for (int a = 0; a < 3; ++a) {
        const vf above = x[a] - w->lo[a], below = w->hi[a] - x[a];
        if (any_below(-wall_depth(above, w->inv_h), 0)) {
            const vf covers = wall_series(above, w->fraction, w->inv_h), slope = wall_series(above, w->slope, w->inv_h);
            part[a] += covers, lean[a] -= covers * w->facing, pull[a] -= slope, steep[a] += slope * w->facing;
            any = true;
        }
        if (any_below(-wall_depth(below, w->inv_h), 0)) {
            const vf covers = wall_series(below, w->fraction, w->inv_h), slope = wall_series(below, w->slope, w->inv_h);
            part[a] += covers, lean[a] += covers * w->facing, pull[a] += slope, steep[a] += slope * w->facing;
            any = true;
        }
    }
    if (!any) return {zero, zero, zero, zero};
    vf body[4] = {zero, zero, zero, zero}, out[4];
    if (solid) {
        const Four s = load(solid, first);
        body[0] = s.x, body[1] = s.y, body[2] = s.z, body[3] = s.w;
    }
    walls_combined(part, lean, pull, steep, body, out);
    return {out[0], out[1], out[2], out[3]};
}

/// sum += a, converted without loss.
WEIR_ALWAYS void add(vd& sum, vf a) { sum += __builtin_convertvector(a, vd); }

/// The walls within reach of the particles of one slice, single and combined: one plane per axis in each image.
struct HeatImages {
    struct Image {
        int planes, plane[3];  // 2 axis, plus one for the upper wall
        bool held;             // the image's theta is mirrored
        float theta;
        vf height[3];  // of the slice's particles above the planes
    };
    Image of[26];
    int count;
};
WEIR_ALWAYS vf heat_height(const vf* x, int plane, const single::HeatWalls* w) {
    const int axis = plane / 2;
    return heat_above(plane % 2 ? broadcast(w->hi[axis]) - x[axis] : x[axis] - broadcast(w->lo[axis]), w);
}
inline void heat_images(const Four& i, const single::HeatWalls* w, float h, HeatImages& images) {
    const vf x[3] = {i.x, i.y, i.z};
    images.count = 0;
    for (int plane = 0; plane < 6; ++plane) {
        const int axis = plane / 2, before = images.count;
        const vf height = heat_height(x, plane, w);
        if (!any_below(height, h)) continue;
        const bool held = plane % 2 ? w->hi_held[axis] : w->lo_held[axis];
        const float theta = plane % 2 ? w->hi_theta[axis] : w->lo_theta[axis];
        for (int m = -1; m < before; ++m) {  // the plane alone, and behind each previous image along other axes
            HeatImages::Image& image = images.of[images.count];
            if (m < 0) {
                image.planes = 0, image.held = false, image.theta = 0;
            } else {
                if (images.of[m].plane[images.of[m].planes - 1] / 2 == axis) continue;
                image = images.of[m];
            }
            image.plane[image.planes] = plane;
            image.height[image.planes++] = height;
            if (held && !image.held) image.theta = theta;
            image.held = image.held != held;
            ++images.count;
        }
    }
}

namespace muller {
#define WEIR_DENSITY(r2, p) poly6(r2, (p)->h2)
#define WEIR_SLOPE(r2, p) spiky_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) linear_laplacian(r2, (p)->h)
#include "particles/kernels/pbf_passes.inl"

#include "particles/kernels/sph_passes.inl"

#include "particles/kernels/heat_passes.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace muller
namespace spline {
#define WEIR_DENSITY(r2, p) cubic(r2, (p)->h)
#define WEIR_SLOPE(r2, p) cubic_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) cubic_slope(r2, (p)->h)
#include "particles/kernels/pbf_passes.inl"

#include "particles/kernels/sph_passes.inl"

#include "particles/kernels/heat_passes.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace spline
namespace c2 {
#define WEIR_DENSITY(r2, p) wendland(r2, (p)->h)
#define WEIR_SLOPE(r2, p) wendland_slope(r2, (p)->h)
#define WEIR_LAPLACIAN(r2, p) wendland_slope(r2, (p)->h)
#include "particles/kernels/pbf_passes.inl"

#include "particles/kernels/sph_passes.inl"

#include "particles/kernels/heat_passes.inl"
#undef WEIR_DENSITY
#undef WEIR_SLOPE
#undef WEIR_LAPLACIAN
}  // namespace c2

Built build(const ListJob& job, ListChunk& chunk) { return build_list(job, chunk); }

}  // namespace

#if WEIR_ISA == 512
const PassTable passes_avx512{"avx512",
                              lanes,
                              build,
                              {muller::table, spline::table, c2::table},
                              {muller::finish_table, spline::finish_table, c2::finish_table},
                              {muller::sph_table, spline::sph_table, c2::sph_table},
                              {muller::heat, spline::heat, c2::heat},
                              {muller::heat_and_density, spline::heat_and_density, c2::heat_and_density}};
#elif WEIR_ISA == 256
const PassTable passes_avx2{"avx2",
                            lanes,
                            build,
                            {muller::table, spline::table, c2::table},
                            {muller::finish_table, spline::finish_table, c2::finish_table},
                            {muller::sph_table, spline::sph_table, c2::sph_table},
                            {muller::heat, spline::heat, c2::heat},
                            {muller::heat_and_density, spline::heat_and_density, c2::heat_and_density}};
#else
const PassTable passes_sse2{"sse2",
                            lanes,
                            build,
                            {muller::table, spline::table, c2::table},
                            {muller::finish_table, spline::finish_table, c2::finish_table},
                            {muller::sph_table, spline::sph_table, c2::sph_table},
                            {muller::heat, spline::heat, c2::heat},
                            {muller::heat_and_density, spline::heat_and_density, c2::heat_and_density}};
#endif

}  // namespace weir::particles
