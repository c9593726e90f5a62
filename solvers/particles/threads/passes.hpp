// The pair passes, as plain functions on plain arrays, compiled once per instruction set. Positions are float4 (x, y, z and one more
// number). The neighbour list is sliced ELL: a slice is as many consecutive particles as there are lanes, entry k of all of them is one row
// of byte offsets, and short lists are padded with a distant dummy particle.
#pragma once
#include <cstddef>
#include <cstdint>

namespace weir::particles {

namespace single {
#define SCALAR float
#include "particles/kernels/params.h"
#undef SCALAR
}  // namespace single
namespace plain {
#define SCALAR double
#include "particles/kernels/params.h"
#undef SCALAR
}  // namespace plain

inline constexpr float dummy_position = 1e6f;  // [m] from the centre of the domain; its square times any factor used here is finite

/// One chunk of the list, during its construction and use.
struct ListChunk {
    std::uint32_t* entries = nullptr;  // capacity of `capacity` entries, `used` of them filled
    std::size_t capacity = 0, used = 0;
    int begin = 0, end = 0, next = 0;                // slices of this chunk, and the first one not yet built
    float *x = nullptr, *y = nullptr, *z = nullptr;  // scratch for the candidates of one cell
    std::uint32_t *offset = nullptr, *hits = nullptr;
    int candidates = 0;  // capacity of that scratch; hits has `lanes` times as much
    int packed_cell = -1, packed = 0;
    std::size_t needed = 0;  // if too small: the sufficient capacity
};

enum class Built { done, needs_candidates, needs_entries };

struct ListJob {
    const float* axis[3] = {};   // sorted coordinates, with space for one register behind them
    int count = 0;               // particles; the dummy is particle `count`
    const int* start = nullptr;  // of cells from first_cell on
    int first_cell = 0;
    int own_begin = 0, own_end = 0;  // particles with neighbours; others have none
    const int* cell_of = nullptr;    // of sorted particles
    int cells[3] = {1, 1, 1};
    float radius2 = 0;
    std::size_t* first = nullptr;  // per slice: first row in its chunk
    int* rows = nullptr;           // per slice
    int* neighbours = nullptr;     // per particle
};

/// Number of boundary corrections, and the square of the largest distance; squares below least2 are rounding.
struct CorrectionTally {
    long long count = 0;
    float farthest2 = 0, least2 = 0;
};

/// Arguments of the PBF passes. nullptr: not required.
struct PbfPass {
    const single::PbfParams* p = nullptr;
    const single::WallParams* walls = nullptr;
    int count = 0;
    const float* from = nullptr;  // x, y, z, lambda
    float* to = nullptr;
    const float* solid = nullptr;  // per particle: part of the kernel inside solids, and its gradient
    const float* rest = nullptr;   // rest densities over rho0; nullptr: 1
    float* density = nullptr;      // rho / rho0
    float* multiplier = nullptr;   // sum of lambda over the iterations; nullptr: not stored
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
    CorrectionTally* corrections = nullptr;  // of the corrections
    const int* order = nullptr;              // sorted particles from `particles` on are images, which are not counted
    int particles = 0;
    int own_begin = 0, own_end = 0;  // only these particles are counted
};

/// Arguments of the velocity passes: float4 arrays.
struct FinishPass {
    const single::PbfParams* p = nullptr;
    int count = 0;
    const float* positions = nullptr;
    const float* values = nullptr;  // velocities, or vorticity and its magnitude
    float* to = nullptr;
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
};

/// Arguments of the SPH passes: float4 arrays (x, y, z, 1 / rho) and (velocity, pressure).
struct SphPass {
    const single::SphParams* p = nullptr;
    const single::WallParams* walls = nullptr;
    int count = 0;
    const float* positions = nullptr;
    const float* velocities = nullptr;
    const float* solid = nullptr;
    float* density = nullptr;       // rho, or its rate
    float* acceleration = nullptr;  // float4
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
    bool wall_forces = false;     // gravity behind walls, or no-slip walls
    const float* rest = nullptr;  // density behind walls, over p->wall_rho; nullptr: 1
};

/// Terms of SPH's force pass besides the pressure gradient, and the form of that gradient.
enum SphTerm : unsigned { sph_summed = 1, sph_artificial = 2, sph_viscous = 4 };

/// Arguments of the heat pass: float4 arrays (x, y, z, theta), and rates of specific enthalpy [J/(kg s)].
struct HeatPass {
    const single::HeatParams* p = nullptr;
    const single::HeatWalls* walls = nullptr;
    int count = 0;
    const float* positions = nullptr;
    double* to = nullptr;
    double* by_walls = nullptr;  // the part due to walls; nullptr: no wall has a fixed temperature
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
};

/// The passes of one instruction set; each works on the slices of one chunk.
struct PassTable {
    const char* name;
    int lanes;
    Built (*build)(const ListJob&, ListChunk&);
    struct Pbf {
        void (*lambda)(const PbfPass&, const ListChunk&);
        void (*correct)(const PbfPass&, const ListChunk&);
        void (*correct_with_pressure)(const PbfPass&, const ListChunk&);
        void (*density)(const PbfPass&, const ListChunk&);
    } pbf[3];  // by kernel: Müller's, cubic, Wendland
    struct Finish {
        void (*smooth)(const FinishPass&, const ListChunk&);
        void (*curl)(const FinishPass&, const ListChunk&);
        void (*confine)(const FinishPass&, const ListChunk&);
    } finish[3];
    struct Sph {
        void (*density)(const SphPass&, const ListChunk&);
        void (*rate[2])(const SphPass&, const ListChunk&);   // without and with density diffusion
        void (*force[8])(const SphPass&, const ListChunk&);  // by the terms of the scene: a sum of SphTerm
        void (*normal)(const SphPass&, const ListChunk&);
        void (*tension)(const SphPass&, const ListChunk&);
    } sph[3];
    void (*heat[3])(const HeatPass&, const ListChunk&);
    void (*heat_and_density[3])(const HeatPass&, const PbfPass&, const ListChunk&);
};

extern const PassTable passes_sse2, passes_avx2, passes_avx512;

}  // namespace weir::particles
