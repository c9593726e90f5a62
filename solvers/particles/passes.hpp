// The passes over pairs of particles, as plain functions on plain arrays: what is compiled once for each instruction set. Positions are
// float4 (x, y, z and one more number), the neighbour list is sliced ELL: as many consecutive particles as there are lanes form a slice,
// entry k of all of them is one row of byte offsets, short lists are padded with a dummy particle far away.
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

/// One chunk of the list, while it is built and when it is read.
struct ListChunk {
    std::uint32_t* entries = nullptr;  // room for `capacity` entries, `used` of them filled
    std::size_t capacity = 0, used = 0;
    int begin = 0, end = 0, next = 0;                // slices of this chunk, and the first one that is not built yet
    float *x = nullptr, *y = nullptr, *z = nullptr;  // scratch for the candidates of one cell
    std::uint32_t *offset = nullptr, *hits = nullptr;
    int candidates = 0;  // room in that scratch; hits has `lanes` times as much
    int packed_cell = -1, packed = 0;
    std::size_t needed = 0;  // after a refusal: how much would have been enough
};

enum class Built { done, needs_candidates, needs_entries };

struct ListJob {
    const float* axis[3] = {};     // sorted coordinates, and room for a register behind them
    int count = 0;                 // particles; the dummy is particle `count`
    const int* start = nullptr;    // of cells
    const int* cell_of = nullptr;  // of sorted particles
    int cells[3] = {1, 1, 1};
    float radius2 = 0;
    std::size_t* first = nullptr;  // of each slice: where its rows begin in its chunk
    int* rows = nullptr;           // of each slice
    int* neighbours = nullptr;     // of each particle
};

/// How often walls put a particle back, and the square of the largest distance; a square of less than least2 is rounding.
struct ClampTally {
    long long count = 0;
    float farthest2 = 0, least2 = 0;
};

/// What the passes of PBF read and write. Null pointers: not wanted.
struct PbfPass {
    const single::PbfParams* p = nullptr;
    const single::WallParams* walls = nullptr;
    int count = 0;
    const float* from = nullptr;  // x, y, z, lambda
    float* to = nullptr;
    const float* solid = nullptr;  // of each particle: part of the kernel inside solids, and its gradient
    const float* rest = nullptr;   // density that each is to have, over rho0; null: 1
    float* density = nullptr;      // rho / rho0
    float* multiplier = nullptr;   // sum of lambda over the iterations; null: not kept
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
    ClampTally* clamps = nullptr;  // of the corrections
    const int* order = nullptr;    // sorted particles from `particles` on are images, which are not counted
    int particles = 0;
    int own_begin = 0, own_end = 0;  // nor are particles but these
};

/// What the passes over velocities read and write: float4 arrays.
struct FinishPass {
    const single::PbfParams* p = nullptr;
    int count = 0;
    const float* positions = nullptr;
    const float* values = nullptr;  // velocities, or vorticity and its length
    float* to = nullptr;
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
};

/// What the passes of SPH read and write: float4 arrays (x, y, z, 1 / rho) and (velocity, pressure).
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
    bool wall_forces = false;     // gravity behind walls, or walls that are stuck to
    const float* rest = nullptr;  // density of what stands behind walls, over p->wall_rho; null: 1
};

/// What SPH's force pass computes beside the gradient of pressure, and which form that has.
enum SphTerm : unsigned { sph_summed = 1, sph_artificial = 2, sph_viscous = 4 };

/// What the pass of heat reads and writes: float4 arrays (x, y, z, theta), and rates of specific enthalpy [J/(kg s)].
struct HeatPass {
    const single::HeatParams* p = nullptr;
    const single::HeatWalls* walls = nullptr;
    int count = 0;
    const float* positions = nullptr;
    double* to = nullptr;
    double* by_walls = nullptr;  // the part of it that comes from walls; null: none is held at a temperature
    const std::size_t* first = nullptr;
    const int* rows = nullptr;
};

/// One instruction set's passes; each works on the slices of one chunk.
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
        void (*rate[2])(const SphPass&, const ListChunk&);   // without diffusion of density, and with it
        void (*force[8])(const SphPass&, const ListChunk&);  // by the terms that the scene names: a sum of SphTerm
        void (*normal)(const SphPass&, const ListChunk&);
        void (*tension)(const SphPass&, const ListChunk&);
    } sph[3];
    void (*heat[3])(const HeatPass&, const ListChunk&);
    void (*heat_and_density[3])(const HeatPass&, const PbfPass&, const ListChunk&);
};

extern const PassTable passes_sse2, passes_avx2, passes_avx512;

}  // namespace weir::particles
