#include "staggered/conduction.hpp"

#include "core/error.hpp"
#include "staggered/rows.hpp"

#include <algorithm>

namespace weir::staggered {

namespace {

using poisson::Cell;

constexpr real most_stages = 1e5;  // of a step

/// Of the face between two cells; negative are those of cells on the plateau. From a whole cell heat comes to the front inside such a cell
/// through its own state alone: with the mean of both, a melt that conducts well is kept from its ice by ice that is not in the way.
inline real face_conductivity(real a, real b) {
    const real p = std::abs(a), q = std::abs(b), sum = p + q;
    const real mean = sum > 0 ? 2 * p * q / sum : 0;
    return a < 0 && b > 0 ? q : b < 0 && a > 0 ? p : mean;
}

/// Conditions of a correction, or of a conductivity: nothing passes but around a periodic axis.
template <int D>
Boundary<D> without_values(Boundary<D> boundary) {
    for (auto& axis : boundary.end)
        for (auto& rule : axis)
            if (rule.kind != EndRule::Kind::periodic) rule = {EndRule::Kind::neumann, 0, {}};
    return boundary;
}

/// sum_over's order, a row at a time.
template <int D, class F>
real sum_of_rows(const Index<D>& extent, F&& f) {
    return ordered_sum(extent[D - 1], [&](int outer) {
        Index<D> I{};
        I[D - 1] = outer;
        real sum = 0;
        for (int j = 0; j < (D == 2 ? 1 : extent[1]); ++j) {
            if constexpr (D == 3) I[1] = j;
            sum += f(I);
        }
        return sum;
    });
}

/// max_over, a row at a time.
template <int D, class F>
real max_of_rows(const Index<D>& extent, F&& f) {
    return ordered_max(extent[D - 1], [&](int outer) {
        Index<D> I{};
        I[D - 1] = outer;
        real most = -infinity;
        for (int j = 0; j < (D == 2 ? 1 : extent[1]); ++j) {
            if constexpr (D == 3) I[1] = j;
            most = larger_or_nan(most, f(I));
        }
        return most;
    });
}

}  // namespace

template <int D>
Conduction<D>::Conduction(const matter::Melting& melting, const Index<D>& cells, const Vec<D>& h, real rho, const Boundary<D>& temperature)
    : melting_(melting),
      h_(h),
      rho_(rho),
      cell_volume_(1),
      boundary_(temperature),
      no_flux_(without_values(temperature)),
      change_(cells),
      older_(cells),
      k_(cells),
      T_(cells) {
    for (int a = 0; a < D; ++a) {
        cell_volume_ *= h[a];
        Index<D> faces = cells;
        ++faces[a];
        conductance_[static_cast<std::size_t>(a)] = Grid<real, D>(faces);
    }
}

/// Conductances stay what they are while all is liquid and the cells stay what they are.
template <int D>
void Conduction<D>::prepare(const Grid<real, D>& H, const Given& given) {
    const int n = H.extent()[0];
    const real colder = max_of_rows(H.extent(), [&](const Index<D>& I) {  // H below the liquid's
        const real *at = &H(I), *before = given.before ? given.before->at(I) : at;
        const Cell* cell = &given.cells(I);
        real most = -infinity;
#pragma omp simd reduction(max : most)
        for (int i = 0; i < n; ++i)
            most = std::max(most, cell[i] == Cell::fluid ? melting_.h_liquid - std::min(at[i], before[i]) : -infinity);
        return most;
    });
    const bool liquid = colder <= 0;
    if (known_ && !given.cells_changed && liquid && all_liquid_) return;
    set_conductances(H, given.cells);
    all_liquid_ = liquid, known_ = true;
}

template <int D>
void Conduction<D>::set_conductances(const Grid<real, D>& H, const Grid<Cell, D>& cells) {
    const Index<D> n = H.extent();
    const real per_heat = 1 / std::max(melting_.h_liquid - melting_.h_solid, std::numeric_limits<real>::min());
    fill_rows(k_, no_flux_, [&](const Index<D>& first, int count, real* k) {
        const real* at = &H(first);
        const Cell* cell = &cells(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real f = std::clamp((at[i] - melting_.h_solid) * per_heat, real(0), real(1));
            const real mixed = melting_.k_solid + f * (melting_.k_liquid - melting_.k_solid);
            k[i] = cell[i] != Cell::fluid ? 0 : f > 0 && f < 1 ? -mixed : mixed;
        }
    });
    for (int a = 0; a < D; ++a) {
        auto& g = conductance_[static_cast<std::size_t>(a)];
        const real factor = 1 / (h_[a] * h_[a]);
        for_each_row(Index<D>{}, g.extent(), [&](const Index<D>& first, int count) {
            real* to = &g(first);
            const real *above = k_.at(first), *below = above - k_.stride(a);
#pragma omp simd
            for (int i = 0; i < count; ++i) to[i] = factor * face_conductivity(below[i], above[i]);
        });
    }
    weaken_exchanges();
    most_conductance_ = max_of_rows(n, [&](const Index<D>& I) {
        std::array<const real*, D> g;
        std::array<std::ptrdiff_t, D> up;
        for (std::size_t b = 0; b < D; ++b) g[b] = &conductance_[b](I), up[b] = conductance_[b].stride(static_cast<int>(b));
        real most = 0;
        for (int i = 0; i < n[0]; ++i) {
            real sum = 0;
            for (std::size_t b = 0; b < D; ++b) sum += g[b][i] + g[b][i + up[b]];
            most = std::max(most, sum);
        }
        return most;
    });
}

template <int D>
void Conduction<D>::exchange_through(int axis, int end, real coefficient) {
    exchange_[static_cast<std::size_t>(2 * axis + end)] = coefficient;
    rule(axis, end).kind = EndRule::Kind::dirichlet;
}

/// A half cell and an exchange one after the other let pass 1/(h/(2k) + 1/α) for a kelvin: the half cell's own 2k/h over 1 + 2k/(α h).
template <int D>
void Conduction<D>::weaken_exchanges() {
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const real alpha = exchange_[static_cast<std::size_t>(2 * a + end)];
            if (alpha == 0) continue;
            auto& g = conductance_[static_cast<std::size_t>(a)];
            Index<D> side = g.extent();
            side[a] = 1;
            for_each_cell(side, [&](Index<D> I) {
                if (end == 1) I[a] = g.extent()[a] - 1;
                g(I) /= 1 + 2 * g(I) * h_[a] / alpha;
            });
        }
}

/// T_ = T(H + D_j), or T of that from `before`, with its ghosts.
template <int D>
void Conduction<D>::take_temperature(const Grid<real, D>& H, const Padded<D>* before) {
    const matter::Melting m = melting_;
    const real per_solid = 1 / m.c_solid, per_liquid = 1 / m.c_liquid;
    fill_rows(T_, boundary_, [&](const Index<D>& first, int count, real* T) {
        const real *h = before ? before->at(first) : &H(first), *d = &change_(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real at = h[i] + d[i];
            T[i] = m.T + ((std::min(at, m.h_solid) - m.h_solid) * per_solid + (std::max(at, m.h_liquid) - m.h_liquid) * per_liquid);
        }
    });
}

/// out = ∇·(k ∇T) [W/m³] of a row of cells.
template <int D>
void Conduction<D>::flow(const Index<D>& first, int count, real* out) const {
    const real* t = T_.at(first);
    for (int b = 0; b < D; ++b) {
        const auto& faces = conductance_[static_cast<std::size_t>(b)];
        const real* g = &faces(first);
        const std::ptrdiff_t up = faces.stride(b), next = T_.stride(b);
        if (b == 0) {
#pragma omp simd
            for (int i = 0; i < count; ++i) out[i] = g[i + up] * (t[i + next] - t[i]) - g[i] * (t[i] - t[i - next]);
        } else {
#pragma omp simd
            for (int i = 0; i < count; ++i) out[i] += g[i + up] * (t[i + next] - t[i]) - g[i] * (t[i] - t[i - next]);
        }
    }
}

/// What of it comes through the sides of the domain, over all cells.
template <int D>
real Conduction<D>::through_sides() const {
    const Index<D> n = T_.extent();
    real all = 0;
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            if (boundary_.end[static_cast<std::size_t>(a)][static_cast<std::size_t>(end)].kind != EndRule::Kind::dirichlet) continue;
            const auto& g = conductance_[static_cast<std::size_t>(a)];
            Index<D> side = n;
            side[a] = 1;
            all += sum_over(side, [&](Index<D> I) {
                if (end == 1) I[a] = n[a] - 1;
                const Index<D> beyond = end == 0 ? I - e<D>(a) : I + e<D>(a);
                return g(end == 0 ? I : beyond) * (T_(beyond) - T_(I));
            });
        }
    return all;
}

/// The scheme is stable while dt times the largest eigenvalue of the conduction, at most twice what leaves a cell for a kelvin, is within
/// s (s + 5)/3. A cell's heat capacity is the lesser one where it may have that in the course of the step: by the principle of the maximum,
/// nothing freezes where all is liquid, no side is colder than the melting point and no source takes heat away.
template <int D>
int Conduction<D>::stages_for(real dt, const Grid<real, D>& source) const {
    bool freezes = !all_liquid_ || !source.empty();
    for (const auto& axis : boundary_.end)
        for (const auto& rule : axis) freezes |= rule.kind == EndRule::Kind::dirichlet && rule.value < melting_.T;
    const real c = freezes ? std::min(melting_.c_solid, melting_.c_liquid) : melting_.c_liquid;
    const real euler_steps = dt * most_conductance_ / (rho_ * c);
    const real count = std::ceil((std::sqrt(25 + 24 * euler_steps) - 5) / 2);
    if (!(count <= most_stages)) throw NumericalFailure("temperature", "the step is too long for the conduction of heat");
    return std::max(1, static_cast<int>(count));
}

template <int D>
real Conduction<D>::stages(Grid<real, D>& H, const Given& given, real dt, int count) {
    const Index<D> n = H.extent();
    const real w = 6 / (static_cast<real>(count) * (count + 5)) * dt / rho_, elsewhere = rho_ / dt;
    real arrived = 0, arrived_before = 0;  // D_j, D_{j−1} of what comes from outside [J kg/m^D]
    change_.fill(0), older_.fill(0);
    const real sources = given.source.empty() ? 0 : sum_over(n, [&](const Index<D>& I) { return given.source(I); });
    for (int j = 1; j <= count; ++j) {
        const real mu = (2.0 * j + 3) / (j + 4), nu = (1.0 - j) / (j + 4), push = mu * w;
        take_temperature(H, given.before);
        arrived_before = std::exchange(arrived, mu * arrived + nu * arrived_before + push * (through_sides() + sources));
        for_each_row(Index<D>{}, n, [&](const Index<D>& first, int width) {
            alignas(64) real rate[row_block];
            flow(first, width, rate);
            if (!given.source.empty())
                for (int i = 0; i < width; ++i) rate[i] += (&given.source(first))[i];
            if (given.before) {
                const real *now = &H(first), *was = given.before->at(first);
#pragma omp simd
                for (int i = 0; i < width; ++i) rate[i] += elsewhere * (now[i] - was[i]);
            }
            const real* now = &change_(first);
            real* to = &older_(first);
#pragma omp simd
            for (int i = 0; i < width; ++i) to[i] = mu * now[i] + nu * to[i] + push * rate[i];
        });
        change_.swap(older_);
    }
    for_each_row(Index<D>{}, n, [&](const Index<D>& first, int width) {
        real* h = &H(first);
        const real *from = given.before ? given.before->at(first) : h, *d = &change_(first);
#pragma omp simd
        for (int i = 0; i < width; ++i) h[i] = from[i] + d[i];
    });
    return rho_ * cell_volume_ * arrived;
}

template <int D>
real Conduction<D>::step(Grid<real, D>& H, const Given& given, real dt) {
    if (dt == 0) return 0;
    prepare(H, given);
    return stages(H, given, dt, stages_for(dt, given.source));
}

template <int D>
real Conduction<D>::euler_step(Grid<real, D>& H, const Given& given, real dt) {
    if (dt == 0) return 0;
    prepare(H, given);
    return stages(H, given, dt, 1);
}

/// Six half-distances of walls at the most, and faces that conduct up to twice as well as the worse of their cells.
template <int D>
real Conduction<D>::longest_euler_step() const {
    const real best = std::max(melting_.k_solid, melting_.k_liquid);
    const real fastest =
        std::max(std::min(2 * melting_.k_solid, best) / melting_.c_solid, std::min(2 * melting_.k_liquid, best) / melting_.c_liquid);
    real sum = 0;
    for (int a = 0; a < D; ++a) sum += 3 / (h_[a] * h_[a]);
    return fastest > 0 ? rho_ / (fastest * sum) : infinity;
}

template <int D>
std::size_t Conduction<D>::bytes() const {
    std::size_t count = 0;
    for (const auto* grid : {&change_, &older_}) count += grid->size() * sizeof(real);
    for (const auto* padded : {&k_, &T_}) count += padded->bytes();
    for (const auto& g : conductance_) count += g.size() * sizeof(real);
    return count;
}

template class Conduction<2>;
template class Conduction<3>;

}  // namespace weir::staggered
