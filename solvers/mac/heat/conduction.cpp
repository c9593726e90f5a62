#include "mac/heat/conduction.hpp"

#include "core/error.hpp"
#include "mac/grid/rows.hpp"

#include <algorithm>
#include <numeric>

namespace weir::mac {

namespace {

using poisson::Cell;

constexpr real most_stages = 1e5;  // of a step

/// Conductivity of the face between two cells; negative values are those of cells on the plateau (two-phase cells). Heat from a
/// single-phase cell reaches the front inside a two-phase cell only through its own phase. With the mean of both, ice that is not in the
/// path would insulate well-conducting melt from its front.
inline real face_conductivity(real a, real b) {
    const real p = std::abs(a), q = std::abs(b), sum = p + q;
    const real mean = sum > 0 ? 2 * p * q / sum : 0;
    return a < 0 && b > 0 ? q : b < 0 && a > 0 ? p : mean;
}

/// Boundary conditions of a correction or of a conductivity: zero flux, or periodic.
template <int D>
Boundary<D> without_values(Boundary<D> boundary) {
    for (auto& axis : boundary.end)
        for (auto& rule : axis)
            if (rule.kind != EndRule::Kind::periodic) rule = {EndRule::Kind::neumann, 0, {}};
    return boundary;
}

/// max_over, row by row.
template <int D, class F>
real max_of_rows(const Index<D>& extent, F&& f) {
    return parallel_max(extent[D - 1], [&](int outer) {
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
Conduction<D>::Conduction(const thermo::Melting& melting, const Extent<D>& cells, const Vec<D>& h, real rho, const Boundary<D>& temperature)
    : melting_(melting),
      h_(h),
      rho_(rho),
      cell_volume_(1),
      boundary_(temperature),
      no_flux_(without_values(temperature)),
      even_cells_(rows_of(cells)),
      change_{Grid<real, D>(cells), Grid<real, D>(cells)},
      T_{Padded<D>(cells), Padded<D>(cells)},
      alike_(rows_of(cells)),
      arrivals_(static_cast<std::size_t>(most_in_a_pass * cells[D - 1])),
      work_(static_cast<std::size_t>(cells[D - 1]) + 1) {
    std::iota(work_.begin(), work_.end(), 0);
    for (int a = 0; a < D; ++a) {
        cell_volume_ *= h[a];
        Extent<D> faces = cells;
        ++faces[a];
        conductance_[static_cast<std::size_t>(a)] = Grid<real, D>(faces);
        even_faces_[static_cast<std::size_t>(a)] = Grid<real, D>(rows_of(faces), -1);
    }
}

/// Conductances are constant while everything is liquid and the cell flags do not change.
template <int D>
void Conduction<D>::prepare(const Grid<real, D>& H, const Given& given) {
    const bool liquid = is_liquid(H, given);
    if (known_ && !given.cells_changed && liquid && all_liquid_) return;
    set_conductivities(H, given);
    for (int a = 0; a < D; ++a) set_conductances(a);
    weaken_exchanges();
    find_rows_alike();
    const Extent<D>& rows = alike_.extent();
    most_conductance_ = max_over(rows, [&](const Index<D>& row) { return conducts_most(row); });
    const auto& cells = given.cells.values();
    const auto exchanges = [](real alpha) { return alpha > 0; };
    uniform_ = liquid && std::none_of(exchange_.begin(), exchange_.end(), exchanges) &&
               std::all_of(cells.begin(), cells.end(), [](Cell cell) { return cell == Cell::fluid; });
    all_liquid_ = liquid, known_ = true;
}

template <int D>
bool Conduction<D>::is_liquid(const Grid<real, D>& H, const Given& given) const {
    const int n = H.extent()[0];
    const real lacks = max_of_rows(H.extent(), [&](const Index<D>& I) {
        const real *at = &H(I), *before = given.before ? given.before->at(I) : at;
        const Cell* cell = &given.cells(I);
        real most = -infinity;
#pragma omp simd reduction(max : most)
        for (int i = 0; i < n; ++i)
            most = std::max(most, cell[i] == Cell::fluid ? melting_.h_liquid - std::min(at[i], before[i]) : -infinity);
        return most;
    });
    return lacks <= 0;
}

/// Conductivity of cells, stored in T_[1], which is unused before the first stage; negative on the plateau.
template <int D>
void Conduction<D>::set_conductivities(const Grid<real, D>& H, const Given& given) {
    const thermo::Melting m = melting_;
    const real per_heat = 1 / std::max(m.h_liquid - m.h_solid, std::numeric_limits<real>::min());
    fill_rows(T_[1], no_flux_, [&](const Index<D>& first, int count, real* k) {
        const real* at = &H(first);
        const Cell* cell = &given.cells(first);
        real least = infinity, most = -infinity;
#pragma omp simd reduction(min : least) reduction(max : most)
        for (int i = 0; i < count; ++i) {
            const real mixed = m.k_solid + (at[i] - m.h_solid) * per_heat * (m.k_liquid - m.k_solid);
            const real whole = at[i] >= m.h_liquid ? m.k_liquid : m.k_solid;
            const bool on_plateau = at[i] > m.h_solid && at[i] < m.h_liquid;
            k[i] = cell[i] != Cell::fluid ? 0 : on_plateau ? -mixed : whole;
            least = std::min(least, k[i]), most = std::max(most, k[i]);
        }
        even_cells_(first) = least == most ? least : -1;
    });
}

/// Away from fronts and solids all faces of a row have one conductance, usually unchanged: then nothing is written.
template <int D>
void Conduction<D>::set_conductances(int a) {
    const Padded<D>& conductivity = T_[1];
    auto &g = conductance_[static_cast<std::size_t>(a)], &even = even_faces_[static_cast<std::size_t>(a)];
    const int n = conductivity.extent()[a], count = g.extent()[0];
    const bool joins = boundary_.end[static_cast<std::size_t>(a)][0].kind == EndRule::Kind::periodic;
    const real factor = 1 / (h_[a] * h_[a]);
    for_each_cell(even.extent(), [&](const Index<D>& first) {
        Index<D> lower = first, upper = first;
        if (a > 0) {
            if (--lower[a] < 0) lower[a] = joins ? n - 1 : 0;
            if (upper[a] == n) upper[a] = joins ? 0 : n - 1;
        }
        const real k = even_cells_(lower), all = factor * face_conductivity(k, k);
        real* to = &g(first);
        if (k >= 0 && k == even_cells_(upper)) {
            if (even(first) != all) std::fill_n(to, count, all);
            even(first) = all;
            return;
        }
        even(first) = -1;
        const real *above = conductivity.at(first), *below = above - conductivity.stride(a);
#pragma omp simd
        for (int i = 0; i < count; ++i) to[i] = factor * face_conductivity(below[i], above[i]);
    });
}

/// Where all faces of a row's cells have equal conductance, a stage reads D numbers for them.
template <int D>
void Conduction<D>::find_rows_alike() {
    for_each_cell(alike_.extent(), [&](const Index<D>& row) {
        Vec<D> all;
        bool differ = false;
        for (int a = 0; a < D; ++a) {
            const auto& even = even_faces_[static_cast<std::size_t>(a)];
            all[a] = even(row);
            differ = differ || all[a] < 0 || even(a == 0 ? row : row + e<D>(a)) != all[a];
        }
        if (differ) all[0] = -1;
        alike_(row) = all;
    });
}

/// The sum over all faces of a cell of that row [W/(m³ K)].
template <int D>
real Conduction<D>::conducts_most(const Index<D>& row) const {
    real most = 0;
    if (const Vec<D>& all = alike_(row); all[0] >= 0) {
        for (int a = 0; a < D; ++a) most += 2 * all[a];
        return most;
    }
    std::array<const real*, D> g;
    std::array<std::ptrdiff_t, D> up;
    for (std::size_t b = 0; b < D; ++b) g[b] = &conductance_[b](row), up[b] = conductance_[b].stride(static_cast<int>(b));
#pragma omp simd reduction(max : most)
    for (int i = 0; i < T_[0].extent()[0]; ++i) {
        real sum = 0;
        for (std::size_t b = 0; b < D; ++b) sum += g[b][i] + g[b][i + up[b]];
        most = std::max(most, sum);
    }
    return most;
}

template <int D>
void Conduction<D>::exchange_through(int axis, int end, real coefficient) {
    exchange_[static_cast<std::size_t>(2 * axis + end)] = coefficient;
    rule(axis, end).kind = EndRule::Kind::dirichlet;
}

/// A half cell and a heat-transfer coefficient α in series conduct 1/(h/(2k) + 1/α): the half cell's 2k/h divided by 1 + 2k/(α h).
template <int D>
void Conduction<D>::weaken_exchanges() {
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const real alpha = exchange_[static_cast<std::size_t>(2 * a + end)];
            if (alpha == 0) continue;
            auto& g = conductance_[static_cast<std::size_t>(a)];
            Extent<D> side = g.extent();
            side[a] = 1;
            for_each_cell(side, [&](Index<D> I) {
                if (end == 1) I[a] = g.extent()[a] - 1;
                g(I) /= 1 + 2 * g(I) * h_[a] / alpha;
                if (a == 0 || I[0] == 0) even_faces_[static_cast<std::size_t>(a)](row_of(I)) = -1;
            });
        }
}

/// By the maximum principle nothing freezes where everything is liquid, no side is colder than the melting point and no source removes
/// heat.
template <int D>
bool Conduction<D>::may_freeze(const Grid<real, D>& source) const {
    bool freezes = !all_liquid_ || !source.empty();
    for (const auto& axis : boundary_.end)
        for (const auto& rule : axis) freezes |= rule.kind == EndRule::Kind::dirichlet && rule.value < melting_.T;
    return freezes;
}

/// The scheme is stable while dt times the largest eigenvalue of the conduction operator is within s (s + 5)/3. The eigenvalue is at most
/// twice a cell's sum of conductances. A cell near the transition uses the smaller of its heat capacities.
template <int D>
int Conduction<D>::stages_for(real dt, const Grid<real, D>& source) const {
    const real c = may_freeze(source) ? std::min(melting_.c_solid, melting_.c_liquid) : melting_.c_liquid;
    const real euler_steps = dt * most_conductance_ / (rho_ * c);
    const real count = std::ceil((std::sqrt(25 + 24 * euler_steps) - 5) / 2);
    if (!(count <= most_stages)) throw NumericalFailure("temperature", "the step is too long for the conduction of heat");
    return std::max(1, static_cast<int>(count));
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

/// At most six half distances to walls, and faces that conduct up to twice as well as the worse of their cells.
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
    std::size_t count = alike_.size() * sizeof(Vec<D>) + arrivals_.size() * sizeof(real) + work_.size() * sizeof(std::int64_t);
    for (const auto& grid : change_) count += grid.size() * sizeof(real);
    for (const auto& padded : T_) count += padded.bytes();
    for (const auto& g : conductance_) count += g.size() * sizeof(real);
    for (const auto& even : even_faces_) count += even.size() * sizeof(real);
    count += even_cells_.size() * sizeof(real);
    return count;
}

template class Conduction<2>;
template class Conduction<3>;

}  // namespace weir::mac
