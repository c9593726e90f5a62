// The stages of a conduction step (conduction.hpp), several in one pass through memory. D_j of a plane needs D_{j−1} of it and of its two
// neighbours, and replaces D_{j−2}, which is no longer needed. Where everything is and stays liquid, temperature is linear in the change of
// the enthalpy and the conductivity is constant. A stage is then a stencil on D/c, with R(H) of the first stage.
#include "mac/grid/rows.hpp"
#include "mac/heat/conduction.hpp"
#include "poisson/geometric/wavefront.hpp"

#include <algorithm>

namespace weir::mac {

namespace {

constexpr std::size_t cache = 1536 * 1024;  // of one core [bytes]: a pass has as many stages as keep its planes in it

/// f(first) for the first cell of each row of a plane.
template <int D, class F>
void for_each_row_of(const Index<D>& extent, int plane, F&& f) {
    Index<D> first{};
    first[D - 1] = plane;
    for (int j = 0; j < (D == 2 ? 1 : extent[1]); ++j) {
        if constexpr (D == 3) first[1] = j;
        f(first);
    }
}

/// The single ghost layer beyond a side, mirrored at the side.
inline real beyond(const EndRule& rule, bool values, real inside) {
    return rule.kind == EndRule::Kind::dirichlet ? (values ? 2 * rule.value : 0) - inside : inside;
}
inline void mirror(const EndRule& rule, bool values, const real* inside, real* outside, int count) {
    for (int i = 0; i < count; ++i) outside[i] = beyond(rule, values, inside[i]);
}

/// ∇·(k ∇T) [W/m³] of cell i of a row.
template <int D>
struct Flow {
    const real* t;
    std::array<const real*, D> g;            // faces below
    std::array<std::ptrdiff_t, D> up, next;  // to the face above and to the cell above
    Flow(const std::array<Grid<real, D>, D>& conductance, const Padded<D>& T, const Index<D>& first) : t(T.at(first)) {
        for (int b = 0; b < D; ++b) {
            const auto at = static_cast<std::size_t>(b);
            g[at] = &conductance[at](first), up[at] = conductance[at].stride(b), next[at] = T.stride(b);
        }
    }
    real operator()(int i) const {
        real sum = 0;
        for (std::size_t b = 0; b < D; ++b) sum += g[b][i + up[b]] * (t[i + next[b]] - t[i]) - g[b][i] * (t[i] - t[i - next[b]]);
        return sum;
    }
};

/// The same where all faces along an axis conduct alike.
template <int D>
struct EvenFlow {
    const real* t;
    Vec<D> g;
    std::array<std::ptrdiff_t, D> next;
    EvenFlow(const Vec<D>& conductance, const Padded<D>& T, const Index<D>& first) : t(T.at(first)), g(conductance) {
        for (int b = 0; b < D; ++b) next[static_cast<std::size_t>(b)] = T.stride(b);
    }
    real operator()(int i) const {
        real sum = 0;
        for (int b = 0; b < D; ++b) {
            const std::ptrdiff_t by = next[static_cast<std::size_t>(b)];
            sum += g[b] * ((t[i + by] - t[i]) - (t[i] - t[i - by]));
        }
        return sum;
    }
};

/// Source and destination of one row of a stage.
struct StageRow {
    real mu, nu, push;
    const real* before;  // D_{j−1}
    real* d;             // D_{j−2}, and then D_j
};

/// D_j from the rates R(H + D_{j−1}); calls then(i, D_j) for each. For D_0 = 0 the destination is not read.
template <class Rate, class Then>
inline void recur(int number, const StageRow& at, int count, const Rate& rate, const Then& then) {
    if (number == 1) {
#pragma omp simd
        for (int i = 0; i < count; ++i) then(i, at.d[i] = at.push * rate(i));
    } else if (number == 2) {
#pragma omp simd
        for (int i = 0; i < count; ++i) then(i, at.d[i] = at.mu * at.before[i] + at.push * rate(i));
    } else {
#pragma omp simd
        for (int i = 0; i < count; ++i) then(i, at.d[i] = at.mu * at.before[i] + at.nu * at.d[i] + at.push * rate(i));
    }
}

}  // namespace

template <int D>
void Conduction<D>::continue_row(Padded<D>& T, const Index<D>& first, bool values) const {
    const int n = T.extent()[0];
    real* row = T.at(first);
    const auto& ends = boundary_.end[0];
    const bool joins = ends[0].kind == EndRule::Kind::periodic;
    row[-1] = joins ? row[n - 1] : beyond(ends[0], values, row[0]);
    row[n] = joins ? row[0] : beyond(ends[1], values, row[n - 1]);
}

/// Fills the ghosts of a plane that was just written; the ghost planes of a periodic last axis are filled later. `values`: of temperatures;
/// otherwise of their changes, which are zero on a side with a fixed temperature.
template <int D>
void Conduction<D>::continue_plane(Padded<D>& T, int plane, bool values) const {
    const Index<D> n = T.extent();
    Index<D> corner{};
    corner[D - 1] = plane;
    real* first = T.at(corner);
    if constexpr (D == 3) {
        const auto& ends = boundary_.end[1];
        const std::ptrdiff_t row = T.stride(1), last = (n[1] - 1) * row;
        if (ends[0].kind == EndRule::Kind::periodic) {
            std::copy_n(first + last, n[0], first - row);
            std::copy_n(first, n[0], first + last + row);
        } else {
            mirror(ends[0], values, first, first - row, n[0]);
            mirror(ends[1], values, first + last, first + last + row, n[0]);
        }
    }
    const auto& ends = boundary_.end[D - 1];
    if (ends[0].kind == EndRule::Kind::periodic) return;
    const std::ptrdiff_t layer = T.stride(D - 1);
    for_each_row_of(n, plane, [&](const Index<D>& I) {
        if (plane == 0) mirror(ends[0], values, T.at(I), T.at(I) - layer, n[0]);
        if (plane == n[D - 1] - 1) mirror(ends[1], values, T.at(I), T.at(I) + layer, n[0]);
    });
}

template <int D>
void Conduction<D>::continue_around(Padded<D>& T) const {
    if (boundary_.end[D - 1][0].kind != EndRule::Kind::periodic) return;
    const int planes = T.extent()[D - 1];
    const std::ptrdiff_t all = planes * T.stride(D - 1);
    for_each_row_of(T.extent(), 0, [&](const Index<D>& I) { std::copy_n(T.at(I), T.extent()[0], T.at(I) + all); });
    for_each_row_of(T.extent(), planes - 1, [&](const Index<D>& I) { std::copy_n(T.at(I), T.extent()[0], T.at(I) - all); });
}

/// Heat flux through the sides of the domain into the cells of a plane.
template <int D>
real Conduction<D>::through_sides(const Padded<D>& T, int plane) const {
    const Index<D> n = T.extent();
    real all = 0;
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            if (boundary_.end[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)].kind != EndRule::Kind::dirichlet) continue;
            if (a == D - 1 && plane != (end == 0 ? 0 : n[a] - 1)) continue;
            const auto& g = conductance_[static_cast<std::size_t>(a)];
            Index<D> lo{}, hi = n;
            lo[a] = end == 0 ? 0 : n[a] - 1, hi[a] = lo[a] + 1;
            lo[D - 1] = plane, hi[D - 1] = plane + 1;
            for (Index<D> I = lo; I[1] < hi[1]; ++I[1])  // in 2D the plane itself
                for (I[0] = lo[0]; I[0] < hi[0]; ++I[0]) {
                    const Index<D> beyond = end == 0 ? I - e<D>(a) : I + e<D>(a);
                    all += g(end == 0 ? I : beyond) * (T(beyond) - T(I));
                }
        }
    return all;
}

template <int D>
void Conduction<D>::take_temperature(const Stage& stage, int plane) {
    const thermo::Melting m = melting_;
    const real per_solid = 1 / m.c_solid, per_liquid = 1 / m.c_liquid;
    const int n = stage.H.extent()[0];
    for_each_row_of(stage.H.extent(), plane, [&](const Index<D>& first) {
        const real* h = stage.from(first);
        real* T = T_[0].at(first);
#pragma omp simd
        for (int i = 0; i < n; ++i)
            T[i] = m.T + ((std::min(h[i], m.h_solid) - m.h_solid) * per_solid + (std::max(h[i], m.h_liquid) - m.h_liquid) * per_liquid);
        continue_row(T_[0], first, true);
    });
    continue_plane(T_[0], plane, true);
}

/// Heat sources of a row of cells besides conduction [W/m³].
template <int D>
void Conduction<D>::other_rates(const Stage& stage, const Index<D>& first, int count, real* rate) {
    if (stage.given.source.empty())
        std::fill_n(rate, count, 0.0);
    else
        std::copy_n(&stage.given.source(first), count, rate);
    if (!stage.given.before) return;
    const real *H = &stage.H(first), *from = stage.from(first);
#pragma omp simd
    for (int i = 0; i < count; ++i) rate[i] += stage.elsewhere * (H[i] - from[i]);
}

/// D_j and T of H + D_j; the last stage writes H.
template <int D>
void Conduction<D>::add_stage(const Stage& stage, int plane) {
    const thermo::Melting m = melting_;
    const real per_solid = 1 / m.c_solid, per_liquid = 1 / m.c_liquid;
    const auto now = static_cast<std::size_t>(stage.number % 2);
    const Padded<D>& T = T_[1 - now];
    Padded<D>& to = T_[now];
    const bool alone = stage.given.source.empty() && !stage.given.before;  // conduction without other terms
    for_each_row_of(stage.H.extent(), plane, [&](const Index<D>& row) {
        const Vec<D>& alike = alike_(row);
        for_each_block(row, stage.H.extent()[0], [&](const Index<D>& first, int width) {
            const StageRow at{stage.mu, stage.nu, stage.push, &change_[1 - now](first), &change_[now](first)};
            const real* from = stage.from(first);
            real *H = &stage.H(first), *out = to.at(first);
            const auto advance = [&](const auto& rate) {
                if (stage.last) return recur(stage.number, at, width, rate, [&](int i, real d) { H[i] = from[i] + d; });
                recur(stage.number, at, width, rate, [&](int i, real d) {
                    const real h = from[i] + d;
                    out[i] = m.T + ((std::min(h, m.h_solid) - m.h_solid) * per_solid + (std::max(h, m.h_liquid) - m.h_liquid) * per_liquid);
                });
            };
            const Flow<D> flow(conductance_, T, first);
            const EvenFlow<D> even(alike, T, first);
            if (alone) return alike[0] >= 0 ? advance(even) : advance(flow);
            alignas(64) real rate[row_block];
            other_rates(stage, first, width, rate);
            alike[0] >= 0 ? advance([&](int i) { return even(i) + rate[i]; }) : advance([&](int i) { return flow(i) + rate[i]; });
        });
        if (!stage.last) continue_row(to, row, true);
    });
    if (!stage.last) continue_plane(to, plane, true);
}

/// Stores D_j/c in place of temperatures; R(H) of the first stage stays in the array of D_j.
template <int D>
void Conduction<D>::add_linear_stage(const Stage& stage, int plane) {
    const real c = melting_.c_liquid;
    const auto now = static_cast<std::size_t>(stage.number % 2);
    const Padded<D>& from = T_[1 - now];
    Padded<D>& to = T_[now];
    const Vec<D> alike = alike_[0];
    for_each_row_of(stage.H.extent(), plane, [&](const Index<D>& row) {
        for_each_block(row, stage.H.extent()[0], [&](const Index<D>& first, int width) {
            const StageRow at{stage.mu, stage.nu, stage.push / c, from.at(first), to.at(first)};
            const EvenFlow<D> flow(alike, from, first);
            real *start = &change_[0](first), *H = &stage.H(first);
            const auto advance = [&](const auto& rate) {
                if (stage.last) return recur(stage.number, at, width, rate, [&](int i, real d) { H[i] += c * d; });
                recur(stage.number, at, width, rate, [](int, real) {});
            };
            if (stage.number == 1)
                advance([&](int i) { return start[i] = flow(i); });
            else
                advance([&](int i) { return start[i] + flow(i); });
        });
        if (!stage.last) continue_row(to, row, false);
    });
    if (!stage.last) continue_plane(to, plane, false);
}

/// As many stages as keep their planes in cache, and a slab of planes per thread.
template <int D>
int Conduction<D>::most_stages_at_once() const {
    if (boundary_.end[D - 1][0].kind == EndRule::Kind::periodic) return 1;
    const int planes = T_[0].extent()[D - 1], team = std::min(threads(), planes);
    const std::size_t plane = change_[0].size() / static_cast<std::size_t>(planes) * sizeof(real) * (uniform_ ? 4 : 6 + D);
    const int fit = static_cast<int>(std::min<std::size_t>(cache / plane, most_in_a_pass + 2)) - 2;
    const int shared = team == 1 ? most_in_a_pass : planes / (2 * team) - 1;
    return std::clamp(std::min(fit, shared), 1, most_in_a_pass);
}

template <int D>
real Conduction<D>::stages(Grid<real, D>& H, const Given& given, real dt, int count) {
    const int planes = H.extent()[D - 1], at_once = most_stages_at_once();
    const real w = 6 / (static_cast<real>(count) * (count + 5)) * dt / rho_;
    const bool linear = uniform_ && !given.before && !may_freeze(given.source);
    const real sources = given.source.empty() ? 0 : sum_over(H.extent(), [&](const Index<D>& I) { return given.source(I); });
    const auto stage = [&](int j) {
        const real mu = (2.0 * j + 3) / (j + 4);
        return Stage{H, given, j, j == count, mu, (1.0 - j) / (j + 4), mu * w, rho_ / dt};
    };
    real arrived = 0, arrived_before = 0, at_start = 0;  // D_j and D_{j−1} of the heat from outside [J kg/m^D]; R(H) of it
    for (int done = 0; done <= count;) {
        const int pass = std::min(at_once, count + 1 - done);
        const auto work = [&](int s, int plane) {
            const int j = done + s;
            if (j == 0) return take_temperature(stage(0), plane);
            arrivals_[static_cast<std::size_t>(s * planes + plane)] = through_sides(T_[static_cast<std::size_t>((j - 1) % 2)], plane);
            linear ? add_linear_stage(stage(j), plane) : add_stage(stage(j), plane);
        };
        if (pass == 1) {
            parallel_for(0, planes, [&](int plane) { work(0, plane); });
            continue_around(T_[static_cast<std::size_t>(done % 2)]);
        } else {
            poisson::Wavefront{planes, pass, false, &work_}.run(threads(), work);
        }
        for (int s = 0; s < pass; ++s) {
            const Stage of = stage(done + s);
            if (of.number == 0) continue;
            real comes = 0;
            for (int plane = 0; plane < planes; ++plane) comes += arrivals_[static_cast<std::size_t>(s * planes + plane)];
            if (of.number == 1) at_start = comes;
            if (linear && of.number > 1) comes += at_start;
            arrived_before = std::exchange(arrived, of.mu * arrived + of.nu * arrived_before + of.push * (comes + sources));
        }
        done += pass;
    }
    return rho_ * cell_volume_ * arrived;
}

#define WEIR_INSTANTIATE(D)                                                              \
    template real Conduction<D>::stages(Grid<real, D>&, const Given&, real, int);        \
    template int Conduction<D>::most_stages_at_once() const;                             \
    template void Conduction<D>::take_temperature(const Stage&, int);                    \
    template void Conduction<D>::add_stage(const Stage&, int);                           \
    template void Conduction<D>::add_linear_stage(const Stage&, int);                    \
    template void Conduction<D>::continue_row(Padded<D>&, const Index<D>&, bool) const;  \
    template void Conduction<D>::continue_plane(Padded<D>&, int, bool) const;            \
    template void Conduction<D>::continue_around(Padded<D>&) const;                      \
    template void Conduction<D>::other_rates(const Stage&, const Index<D>&, int, real*); \
    template real Conduction<D>::through_sides(const Padded<D>&, int) const;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
