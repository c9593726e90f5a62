#include "heightfield/sweep.hpp"

#include "core/parallel.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>

#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace weir::heightfield {

namespace {

constexpr int rows_of_part = 32;

/// Scope in which numbers below 1e-308 are flushed to zero on this thread. Ahead of a wave there are only such numbers: each step passes a
/// smaller part to the next column, and denormal arithmetic is a hundred times slower.
class TinyIsZero {
public:
#ifdef __SSE__
    TinyIsZero() { _mm_setcsr(before_ | flush_to_zero | denormals_are_zero); }
    ~TinyIsZero() { _mm_setcsr(before_); }

private:
    static constexpr unsigned flush_to_zero = 0x8000, denormals_are_zero = 0x0040;
    unsigned before_ = _mm_getcsr();

public:
#else
    TinyIsZero() = default;
#endif
    TinyIsZero(const TinyIsZero&) = delete;
    TinyIsZero& operator=(const TinyIsZero&) = delete;
};

/// One row: `below` and `above` are its neighbours' old heights, `old` its own, with one more entry at either end.
[[gnu::always_inline]] inline void uniform_row(const real* __restrict old, const real* __restrict below, const real* __restrict above,
                                               real* __restrict surface, real* __restrict rate, int n, real ax, real az, real dt) {
    for (int i = 0; i < n; ++i) {
        const real pull = ax * ((old[i - 1] - old[i]) + (old[i + 1] - old[i])) + az * ((below[i] - old[i]) + (above[i] - old[i]));
        const real w = rate[i] + dt * pull;
        rate[i] = w;
        surface[i] = old[i] + dt * w;
    }
}
[[gnu::always_inline]] inline void varied_row(const real* __restrict old, const real* __restrict below, const real* __restrict above,
                                              real* __restrict surface, real* __restrict rate, int n, const real* __restrict kx,
                                              const real* __restrict kz, const real* __restrict kz_above, real dt) {
    for (int i = 0; i < n; ++i) {
        const real pull = (kx[i] * (old[i - 1] - old[i]) + kx[i + 1] * (old[i + 1] - old[i])) +
                          (kz[i] * (below[i] - old[i]) + kz_above[i] * (above[i] - old[i]));
        const real w = rate[i] + dt * pull;
        rate[i] = w;
        surface[i] = old[i] + dt * w;
    }
}

}  // namespace

Sweep::Sweep(const Plane& plane, bool periodic_x, bool periodic_z)
    : plane_(plane),
      periodic_x_(periodic_x),
      periodic_z_(periodic_z),
      edges_(2 * static_cast<std::size_t>(OwnRows(plane).parts()) * static_cast<std::size_t>(plane.nx)) {}

int Sweep::OwnRows::parts() const { return (end - begin + rows_of_part - 1) / rows_of_part; }
int Sweep::OwnRows::part_begin(int p) const { return begin + p * rows_of_part; }
int Sweep::OwnRows::part_end(int p) const { return std::min(end, part_begin(p + 1)); }

void Sweep::part(const OwnRows& own, int p, Field& surface, Field& rate, const Stiffness& k, real dt, real* scratch) {
    const TinyIsZero here;
    const int n = plane_.nx, begin = own.part_begin(p), end = own.part_end(p);
    const auto row_size = static_cast<std::size_t>(n);
    const std::size_t padded = row_size + 16;
    real *old = scratch + 8, *before = scratch + padded + 8;
    const auto edge = [&](int of, int last) {
        return edges_.data() + (2 * static_cast<std::size_t>(of) + static_cast<std::size_t>(last)) * row_size;
    };
    // the old rows before and after this part: rows that other threads overwrite were copied, ghost rows are unchanged; beyond the ends of
    // the plane a row is its own neighbour: zero difference
    const auto before_row = [&](int row) {
        return own.has(row) ? edge(row < begin ? p - 1 : own.parts() - 1, 1) : surface.data() + plane_.at(0, row);
    };
    const auto after_row = [&](int row) { return own.has(row) ? edge(row < end ? 0 : p + 1, 0) : surface.data() + plane_.at(0, row); };
    const real* below = begin > 0 ? before_row(begin - 1) : periodic_z_ ? before_row(plane_.nz - 1) : edge(p, 0);
    for (int r = begin; r < end; ++r) {
        real *s = surface.data() + plane_.at(0, r), *w = rate.data() + plane_.at(0, r);
        std::copy(s, s + n, old);
        old[-1] = periodic_x_ ? old[n - 1] : old[0];
        old[n] = periodic_x_ ? old[0] : old[n - 1];
        const real* above = r + 1 < end ? s + n : r + 1 < plane_.nz ? after_row(r + 1) : periodic_z_ ? after_row(0) : old;
        if (k.uniform)
            uniform_row(old, below, above, s, w, n, k.along_x, k.along_z, dt);
        else
            varied_row(old, below, above, s, w, n, k.x.data() + static_cast<std::size_t>(r) * (row_size + 1), k.z.data() + plane_.at(0, r),
                       k.z.data() + plane_.at(0, r + 1), dt);
        std::swap(old, before);
        below = before;
    }
}

void Sweep::step(Field& surface, Field& rate, const Stiffness& k, real dt) {
    const auto row = static_cast<std::size_t>(plane_.nx);
    const auto wanted = static_cast<std::size_t>(plane_.dim == 2 ? 1 : threads());
    if (scratch_.size() < wanted) scratch_.resize(wanted, std::vector<real>(2 * (row + 16)));
    const OwnRows own(plane_);
    parallel_for(0, own.parts(), [&](int p) {
        const int begin = own.part_begin(p), last = own.part_end(p) - 1;
        std::copy_n(surface.data() + plane_.at(0, begin), row, edges_.data() + 2 * static_cast<std::size_t>(p) * row);
        std::copy_n(surface.data() + plane_.at(0, last), row, edges_.data() + (2 * static_cast<std::size_t>(p) + 1) * row);
    });
    if (own.parts() == 1) return part(own, 0, surface, rate, k, dt, scratch_[0].data());
    parallel_for(0, own.parts(),
                 [&](int p) { part(own, p, surface, rate, k, dt, scratch_[static_cast<std::size_t>(omp_get_thread_num())].data()); });
}

std::size_t Sweep::bytes() const {
    std::size_t total = edges_.capacity() * sizeof(real);
    for (const std::vector<real>& s : scratch_) total += s.capacity() * sizeof(real);
    return total;
}

void reference_sweep(const Plane& plane, bool periodic_x, bool periodic_z, Field& surface, Field& rate, const Stiffness& k, real dt) {
    const Field old = surface;
    const auto along = [](int n, int count, bool periodic) { return periodic ? (n + count) % count : std::clamp(n, 0, count - 1); };
    for (int r = 0; r < plane.nz; ++r)
        for (int i = 0; i < plane.nx; ++i) {
            const std::size_t c = plane.at(i, r),
                              fx = static_cast<std::size_t>(r) * static_cast<std::size_t>(plane.nx + 1) + static_cast<std::size_t>(i);
            const real here = old[c];
            const real left = old[plane.at(along(i - 1, plane.nx, periodic_x), r)],
                       right = old[plane.at(along(i + 1, plane.nx, periodic_x), r)];
            const real below = old[plane.at(i, along(r - 1, plane.nz, periodic_z))],
                       above = old[plane.at(i, along(r + 1, plane.nz, periodic_z))];
            const real kl = k.uniform ? k.along_x : k.x[fx], kr = k.uniform ? k.along_x : k.x[fx + 1];
            const real kb = k.uniform ? k.along_z : k.z[c], ka = k.uniform ? k.along_z : k.z[c + static_cast<std::size_t>(plane.nx)];
            rate[c] += dt * (kl * (left - here) + kr * (right - here) + kb * (below - here) + ka * (above - here));
            surface[c] = here + dt * rate[c];
        }
}

}  // namespace weir::heightfield
