#include "heightfield/rows.hpp"

#include "core/parallel.hpp"
#include "parallel/communicator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

// iterations of the next loop are independent
#ifdef __clang__
#define WEIR_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#else
#define WEIR_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace weir::heightfield {

namespace {

constexpr int ghosts = 2;       // columns beyond each side: the reconstruction at a side's face reads them
constexpr int rows_apart = 32;  // rows of a part of the plane, processed by one thread at a time
constexpr int pad = 8;

/// Half of the limited slope from the differences to both neighbours.
template <Limiter limiter>
[[gnu::always_inline]] inline real half_slope(real a, real b) {
    if constexpr (limiter == Limiter::none) return 0;
    const real p = std::abs(a), q = std::abs(b);
    real m = 0.5 * (p < q ? p : q);  // minmod
    if constexpr (limiter == Limiter::mc) {
        const real middle = 0.25 * (p + q), twice = 2 * m;
        m = twice < middle ? twice : middle;
    }
    if constexpr (limiter == Limiter::van_leer) {
        const real sum = p + q;
        m = p * q / (sum > 1e-300 ? sum : 1e-300);
    }
    return a * b > 0 ? (a > 0 ? m : -m) : 0;
}

/// Depth, surface, velocity normal to the face and along it.
struct Values {
    real *h, *surface, *across, *along;
};
/// Fluxes through faces: water, normal momentum for each side, tangential momentum.
struct Fluxes {
    real *h, *before, *behind, *along;
};

/// HLLC with hydrostatic reconstruction over the higher bed of both sides (Audusse et al. 2004, eqs. 2.10 to 2.15).
[[gnu::always_inline]] inline void face(const Values& L, int i, const Values& R, int j, const Fluxes& to, int n, real g) {
    const real bed_l = L.surface[i] - L.h[i], bed_r = R.surface[j] - R.h[j], bed = bed_l > bed_r ? bed_l : bed_r;
    const real over_l = L.surface[i] - bed, over_r = R.surface[j] - bed;
    const real hl = over_l > 0 ? over_l : 0, hr = over_r > 0 ? over_r : 0;
    const real ul = L.across[i], ur = R.across[j];
    const real cl = std::sqrt(g * hl), cr = std::sqrt(g * hr), c_sum = cl + cr;
    const real middle = (ul * cl + ur * cr) / (c_sum > 1e-300 ? c_sum : 1e-300), c_middle = std::sqrt(0.5 * g * (hl + hr));
    const real left = ul - cl, right = ur + cr, mid_l = middle - c_middle, mid_r = middle + c_middle;
    real s_l = left < mid_l ? left : mid_l, s_r = right > mid_r ? right : mid_r;
    s_l = hl > 0 ? (hr > 0 ? s_l : left) : ur - 2 * cr;
    s_r = hr > 0 ? (hl > 0 ? s_r : right) : ul + 2 * cl;
    s_l = s_l < 0 ? s_l : 0, s_r = s_r > 0 ? s_r : 0;
    const real width = s_r - s_l, over = 1 / (width > 1e-300 ? width : 1e-300);
    const real ql = hl * ul, qr = hr * ur, pl = 0.5 * g * hl * hl, pr = 0.5 * g * hr * hr;
    const real flux = (s_r * ql - s_l * qr + s_l * s_r * (hr - hl)) * over;
    const real momentum = (s_r * (ql * ul + pl) - s_l * (qr * ur + pr) + s_l * s_r * (qr - ql)) * over;
    to.h[n] = flux;
    to.before[n] = momentum + (0.5 * g * L.h[i] * L.h[i] - pl);
    to.behind[n] = momentum + (0.5 * g * R.h[j] * R.h[j] - pr);
    if (to.along) to.along[n] = flux * (flux > 0 ? L.along[i] : R.along[j]);
}

/// Allocates rows from one block of memory.
class Carver {
public:
    Carver(real* at, int n)
        : at_(reinterpret_cast<real*>((reinterpret_cast<std::uintptr_t>(at) + 63) / 64 * 64)), room_((n + 2 * pad + 7) / 8 * 8) {}
    real* row() {
        real* r = at_ + pad;
        at_ += room_;
        return r;
    }
    Values values() {
        Values v{};
        v.h = row(), v.surface = row(), v.across = row(), v.along = row();
        return v;
    }
    Fluxes fluxes() {
        Fluxes f{};
        f.h = row(), f.before = row(), f.behind = row(), f.along = row();
        return f;
    }
    static std::size_t size(int n, int rows) {
        return 8 + static_cast<std::size_t>(rows) * static_cast<std::size_t>((n + 2 * pad + 7) / 8 * 8);
    }

private:
    real* at_;
    int room_;
};
constexpr int rows_of_scratch = 3 * 4 + 2 * 4 + 2 * 2 * 4 + 3 * 4 + 1;

template <Limiter limiter, bool flat>  // flat: a plane of columns; otherwise one row
class Part {
public:
    Part(const StageOf& stage, real* scratch, RowReport* reports)
        : s_(stage.state), from_(stage.from), to_(stage.to), dt_(stage.dt), second_(stage.second), reports_(reports), n_(s_.plane.nx) {
        Carver carve(scratch, n_);
        for (Values& v : rows_) v = carve.values();
        left_ = carve.values(), right_ = carve.values();
        for (auto& pair : edges_)
            for (Values& v : pair) v = carve.values();
        across_x_ = carve.fluxes();
        for (Fluxes& f : across_z_) f = carve.fluxes();
        rate_ = carve.row();
        if (!flat) across_x_.along = nullptr;
    }

    void run(int begin, int end) {
        if constexpr (!flat) {
            load(0);
            finish(0);
            return;
        }
        load(begin - 2), load(begin - 1), load(begin);
        split_z(begin - 1);
        for (int k = begin; k <= end; ++k) {
            load(k + 1);
            split_z(k);
            faces_z(k);
            if (k > begin) finish(k - 1);
        }
    }

private:
    Values& row(int k) { return rows_[(k + 3) % 3]; }
    std::array<Values, 2>& edges(int k) { return edges_[(k + 2) % 2]; }
    Fluxes& below(int k) { return across_z_[(k + 2) % 2]; }  // the faces on the lower side of row k

    /// Loads depth, surface and velocities of row k, which may lie beyond the sides.
    void load(int k) {
        const int nz = s_.plane.nz;
        if (k >= 0 && k < nz) return read(k, row(k));
        const int end = k < 0 ? 0 : 1;
        const Side& side = s_.sides(1, end);
        if (side.kind == SideKind::periodic) return read((k % nz + nz) % nz, row(k));
        if (side.kind == SideKind::wall) {
            read(std::clamp(k < 0 ? -1 - k : 2 * nz - 1 - k, 0, nz - 1), row(k));
            for (int i = -ghosts; i < n_ + ghosts; ++i) row(k).along[i] = -row(k).along[i];
            return;
        }
        read(end == 0 ? 0 : nz - 1, row(k));
        const real out = end == 0 ? -1 : 1;
        Values& r = row(k);
        for (int i = -ghosts; i < n_ + ghosts; ++i) {
            const real bed = r.surface[i] - r.h[i];
            const Beside b = beside(side, {r.h[i], out * r.along[i], r.across[i]}, bed, s_.g);
            r.h[i] = b.h, r.surface[i] = b.h + bed, r.along[i] = out * b.out, r.across[i] = b.along;
        }
    }
    void read(int k, Values& to) {
        const std::size_t first = s_.plane.at(0, k);
        const real *h = from_.h + first, *qx = from_.qx + first, *qz = flat ? from_.qz + first : nullptr, *bed = s_.bed.data() + first;
        real* __restrict depth = to.h, * __restrict surface = to.surface, * __restrict u = to.across, * __restrict w = to.along;
        const real dry = s_.dry;
        const int n = n_;
        WEIR_INDEPENDENT
        for (int i = 0; i < n; ++i) {
            const real d = h[i], held = d > dry ? d : dry, wet = d > dry ? 1.0 : 0.0, over = wet / held;
            depth[i] = d;
            surface[i] = d + bed[i];
            u[i] = qx[i] * over;
            if constexpr (flat) w[i] = qz[i] * over;
        }
        if constexpr (!flat) std::fill(w, w + n, 0.0);
        for (int end = 0; end < 2; ++end) ghosts_x(end, to);
    }
    void ghosts_x(int end, Values& r) {
        const Side& side = s_.sides(0, end);
        const real out = end == 0 ? -1 : 1;
        const int last = end == 0 ? 0 : n_ - 1;
        for (int d = 1; d <= ghosts; ++d) {
            const int to = end == 0 ? -d : n_ - 1 + d;
            const int mirror = std::clamp(end == 0 ? d - 1 : n_ - d, 0, n_ - 1);
            if (side.kind == SideKind::periodic) {
                copy(r, to, ((to % n_) + n_) % n_);
            } else if (side.kind == SideKind::wall) {
                copy(r, to, mirror);
                r.across[to] = -r.across[to];
            } else {
                const real bed = r.surface[last] - r.h[last];
                const Beside b = beside(side, {r.h[last], out * r.across[last], r.along[last]}, bed, s_.g);
                r.h[to] = b.h, r.surface[to] = b.h + bed, r.across[to] = out * b.out, r.along[to] = b.along;
            }
        }
    }
    static void copy(Values& r, int to, int from) {
        r.h[to] = r.h[from], r.surface[to] = r.surface[from], r.across[to] = r.across[from], r.along[to] = r.along[from];
    }

    /// Reconstructs both edges of each column of row k along z; the normal direction is z there.
    void split_z(int k) {
        const Values &a = row(k - 1), &b = row(k), &c = row(k + 1);
        auto& [low, high] = edges(k);
        split(a.h, b.h, c.h, low.h, high.h, 0, n_);
        split(a.surface, b.surface, c.surface, low.surface, high.surface, 0, n_);
        split(a.along, b.along, c.along, low.across, high.across, 0, n_);
        split(a.across, b.across, c.across, low.along, high.along, 0, n_);
    }
    void split_x(const Values& r) {
        split(r.h - 1, r.h, r.h + 1, left_.h, right_.h, -1, n_ + 1);
        split(r.surface - 1, r.surface, r.surface + 1, left_.surface, right_.surface, -1, n_ + 1);
        split(r.across - 1, r.across, r.across + 1, left_.across, right_.across, -1, n_ + 1);
        if (flat) split(r.along - 1, r.along, r.along + 1, left_.along, right_.along, -1, n_ + 1);
    }
    static void split(const real* before, const real* here, const real* behind, real* __restrict low, real* __restrict high, int begin,
                      int end) {
        for (int i = begin; i < end; ++i) {
            const real s = half_slope<limiter>(here[i] - before[i], behind[i] - here[i]);
            low[i] = here[i] - s;
            high[i] = here[i] + s;
        }
    }
    void faces_z(int k) {
        const Values low = edges(k - 1)[1], high = edges(k)[0];
        const Fluxes to = below(k);
        const real g = s_.g;
        WEIR_INDEPENDENT
        for (int i = 0; i < n_; ++i) face(low, i, high, i, to, i, g);
    }

    /// New depth and discharge of row k, from the faces below and above it.
    void finish(int k) {
        split_x(row(k));
        const Values l = left_, r = right_;
        const Fluxes fx = across_x_;
        const real g = s_.g;
        WEIR_INDEPENDENT
        for (int i = 0; i <= n_; ++i) face(r, i - 1, l, i, fx, i, g);
        if (second_)
            update<true>(k);
        else
            update<false>(k);
        report(k);
    }
    template <bool second>
    void update(int k) {
        const std::size_t first = s_.plane.at(0, k);
        const real *h0 = from_.h + first, *x0 = from_.qx + first, *z0 = flat ? from_.qz + first : nullptr;
        real *h1 = to_.h + first, *x1 = to_.qx + first, *z1 = flat ? to_.qz + first : nullptr, *rate = rate_;
        const Values l = left_, r = right_, low = edges(k)[0], high = edges(k)[1];
        const Fluxes fx = across_x_, f0 = below(k), f1 = below(k + 1);
        const real ax = dt_ / s_.plane.dx, az = dt_ / s_.plane.dz, half_g = 0.5 * s_.g, dry = s_.dry, g = s_.g;
        const real rx = 1 / s_.plane.dx, rz = 1 / s_.plane.dz;
        WEIR_INDEPENDENT
        for (int i = 0; i < n_; ++i) {
            real dh = ax * (fx.h[i + 1] - fx.h[i]);
            const real bed_x = (r.surface[i] - r.h[i]) - (l.surface[i] - l.h[i]);
            real dx = ax * (fx.before[i + 1] - fx.behind[i] + half_g * (l.h[i] + r.h[i]) * bed_x), dz = 0;
            if constexpr (flat) {
                const real bed_z = (high.surface[i] - high.h[i]) - (low.surface[i] - low.h[i]);
                dh += az * (f1.h[i] - f0.h[i]);
                dx += az * (f1.along[i] - f0.along[i]);
                dz = ax * (fx.along[i + 1] - fx.along[i]) + az * (f1.before[i] - f0.behind[i] + half_g * (low.h[i] + high.h[i]) * bed_z);
            }
            const real h = second ? 0.5 * (h1[i] + (h0[i] - dh)) : h0[i] - dh;
            const real x = second ? 0.5 * (x1[i] + (x0[i] - dx)) : x0[i] - dx;
            const bool wet = h > dry;
            h1[i] = h;
            x1[i] = wet ? x : 0;
            if constexpr (flat) {
                const real z = second ? 0.5 * (z1[i] + (z0[i] - dz)) : z0[i] - dz;
                z1[i] = wet ? z : 0;
                if constexpr (second) {
                    const real d = h > dry ? h : dry, over = wet ? 1 / d : 0, c = std::sqrt(g * d);
                    rate[i] = (std::abs(x * over) + c) * rx + (std::abs(z * over) + c) * rz;
                }
            } else if constexpr (second) {
                const real d = h > dry ? h : dry, over = wet ? 1 / d : 0;
                rate[i] = (std::abs(x * over) + std::sqrt(g * d)) * rx;
            }
        }
    }
    /// Sums and extrema of row k in eight lanes; depths made negative by round-off are set to 0.
    void report(int k) {
        RowReport& told = reports_[k];
        real* h = to_.h + s_.plane.at(0, k);
        constexpr int lanes = 8;
        real sum[lanes] = {}, low[lanes] = {}, fast[lanes] = {};
        const int whole = n_ / lanes * lanes;
        for (int i = 0; i < whole; i += lanes)
            for (int l = 0; l < lanes; ++l) sum[l] += h[i + l], low[l] = h[i + l] < low[l] ? h[i + l] : low[l];
        for (int i = whole; i < n_; ++i) sum[0] += h[i], low[0] = h[i] < low[0] ? h[i] : low[0];
        if (second_) {
            for (int i = 0; i < whole; i += lanes)
                for (int l = 0; l < lanes; ++l) fast[l] = rate_[i + l] > fast[l] ? rate_[i + l] : fast[l];
            for (int i = whole; i < n_; ++i) fast[0] = rate_[i] > fast[0] ? rate_[i] : fast[0];
        }
        real volume = 0, lowest = 0, fastest = 0;
        for (int l = 0; l < lanes; ++l) volume += sum[l], lowest = std::min(lowest, low[l]), fastest = std::max(fastest, fast[l]);
        if (lowest < 0)
            for (int i = 0; i < n_; ++i) h[i] = h[i] < 0 ? 0 : h[i];
        const real dz = s_.plane.dz;
        real in = across_x_.h[0] - across_x_.h[n_], sides = 0;
        if (flat && k == 0 && s_.sides.open(1, 0)) sides += total(below(0).h);
        if (flat && k == s_.plane.nz - 1 && s_.sides.open(1, 1)) sides -= total(below(k + 1).h);
        if (!s_.sides.open(0, 0) && !s_.sides.open(0, 1)) in = 0;
        told = {volume * s_.plane.dx, fastest, lowest, dt_ * (in * dz + sides * s_.plane.dx)};
    }
    real total(const real* row) const {
        real sum = 0;
        for (int i = 0; i < n_; ++i) sum += row[i];
        return sum;
    }

    const State& s_;
    Water from_, to_;
    real dt_;
    bool second_;
    RowReport* reports_;
    int n_;
    std::array<Values, 3> rows_;
    Values left_, right_;
    std::array<std::array<Values, 2>, 2> edges_;
    Fluxes across_x_;
    std::array<Fluxes, 2> across_z_;
    real* rate_;
};

template <Limiter limiter>
void run_parts(const StageOf& stage, std::vector<std::vector<real>>& scratch, RowReport* reports) {
    const Plane& plane = stage.state.plane;
    const int begin = plane.own.lower(0), end = plane.own.upper(plane.nz);
    const auto own = [&] { return scratch[static_cast<std::size_t>(omp_get_thread_num())].data(); };
    if (plane.dim == 2) {
        Part<limiter, false>(stage, scratch[0].data(), reports).run(0, 1);
        return;
    }
    parallel_for(0, (end - begin + rows_apart - 1) / rows_apart, [&](int p) {
        const int first = begin + p * rows_apart;
        Part<limiter, true>(stage, own(), reports).run(first, std::min(end, first + rows_apart));
    });
}

}  // namespace

Limiter limiter_named(const std::string& name) {
    if (name == "none") return Limiter::none;
    if (name == "minmod") return Limiter::minmod;
    if (name == "van_leer") return Limiter::van_leer;
    if (name == "mc") return Limiter::mc;
    throw std::logic_error("limiter \"" + name + "\" is in the schema but has no meaning");
}

Rows::Rows(const Plane& plane, Limiter limiter) : plane_(plane), limiter_(limiter) {}

void Rows::stage(const StageOf& stage, std::vector<RowReport>& reports) {
    const auto wanted = static_cast<std::size_t>(plane_.dim == 2 ? 1 : threads());
    if (scratch_.size() < wanted) scratch_.resize(wanted, std::vector<real>(Carver::size(plane_.nx, rows_of_scratch)));
    switch (limiter_) {
        case Limiter::none:
            return run_parts<Limiter::none>(stage, scratch_, reports.data());
        case Limiter::minmod:
            return run_parts<Limiter::minmod>(stage, scratch_, reports.data());
        case Limiter::van_leer:
            return run_parts<Limiter::van_leer>(stage, scratch_, reports.data());
        case Limiter::mc:
            return run_parts<Limiter::mc>(stage, scratch_, reports.data());
    }
}

std::size_t Rows::bytes() const {
    std::size_t total = 0;
    for (const auto& s : scratch_) total += s.capacity() * sizeof(real);
    return total;
}

}  // namespace weir::heightfield
