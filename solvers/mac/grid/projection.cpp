#include "mac/grid/projection.hpp"

#include "mac/grid/rows.hpp"

namespace weir::mac {

using poisson::Cell;

PoissonChoice::PoissonChoice(const scene::Table& table) : method(table.text("method")) {
    options.tolerance = table.number("tolerance");
    options.max_iterations = static_cast<int>(table.integer("max_iterations"));
    options.fixed_iterations = table.flag("fixed");
}

scene::Key PoissonChoice::key() {
    std::vector<std::string> names;
    for (const auto& method : poisson::methods()) names.push_back(method.name);
    using scene::Type;
    return {
        .name = "poisson",
        .type = Type::table,
        .doc = "Solver of the pressure equation.",
        .keys = {
            {.name = "method", .type = Type::choice, .doc = "Solver.", .fallback = std::string("multigrid"), .choices = names},
            {.name = "tolerance",
             .type = Type::number,
             .doc = "Relative residual: residual over right-hand side.",
             .fallback = 1e-8,
             .min = 1e-15,
             .max = 1,
             .steerable = true},
            {.name = "max_iterations",
             .type = Type::integer,
             .doc = "Maximum number of iterations; a solve that needs more fails.",
             .fallback = std::int64_t{1000},
             .min = 1,
             .steerable = true},
            {.name = "fixed", .type = Type::flag, .doc = "Run exactly max_iterations, without a convergence test.", .fallback = false}}};
}

template <int D>
real flux_divergence(const MacState<D>& s, const Index<D>& I) {
    if (!s.solid.any()) return divergence(s.u, I);
    real sum = 0;
    for (int a = 0; a < D; ++a) {
        const auto &w = s.solid.open[static_cast<std::size_t>(a)], &v = s.solid.velocity[static_cast<std::size_t>(a)];
        const auto flux = [&](const Index<D>& F) { return w(F) * s.u[a](F) + (1 - w(F)) * v(F); };
        sum += (flux(I + e<D>(a)) - flux(I)) / s.u.h[a];
    }
    return sum;
}

template <int D>
void flux_divergence_row(const MacState<D>& s, const Index<D>& first, int count, real* out) {
    std::fill_n(out, count, 0.0);
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        const real *below = &s.u[a](first), h = s.u.h[a];
        const std::ptrdiff_t up = s.u[a].stride(a);
        if (!s.solid.any()) {
#pragma omp simd
            for (int i = 0; i < count; ++i) out[i] += (below[i + up] - below[i]) / h;
            continue;
        }
        const real *w = &s.solid.open[at](first), *v = &s.solid.velocity[at](first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real lower = w[i] * below[i] + (1 - w[i]) * v[i], upper = w[i + up] * below[i + up] + (1 - w[i + up]) * v[i + up];
            out[i] += (upper - lower) / h;
        }
    }
}

template <int D>
real max_divergence(const MacState<D>& s) {
    Extent<D> rows = s.extent();
    rows[0] = 1;
    return max_over(rows, [&](const Index<D>& I) {
        real largest = 0;
        for_each_block(I, s.extent()[0], [&](const Index<D>& first, int count) {
            alignas(64) real divergence[row_block];
            flux_divergence_row(s, first, count, divergence);
            const Cell* cell = &s.cells(first);
            for (int i = 0; i < count; ++i) divergence[i] = cell[i] == Cell::fluid ? divergence[i] : 0;
            largest = larger_or_nan(largest, largest_magnitude(divergence, static_cast<std::size_t>(count)));
        });
        return largest;
    });
}

template <int D>
void PressurePush<D>::add(int a, const Index<D>& first, int count, real* values) const {
    const int n = s_.u.cells[a];
    const real f = factor_ / s_.u.h[a];
    const Grid<real, D>* open = s_.solid.any() ? &s_.solid.open[static_cast<std::size_t>(a)] : nullptr;
    // above[i] and below[i]: pressures on both sides of the face first + i
    const auto inner = [&](int begin, int end, const real* above, const real* below) {
        const real* w = open ? &(*open)(first) : nullptr;
        if (w) {
            for (int i = begin; i < end; ++i) values[i] += w[i] > 0 ? f * (above[i] - below[i]) : 0;
        } else {
#pragma omp simd
            for (int i = begin; i < end; ++i) values[i] += f * (above[i] - below[i]);
        }
    };
    const auto outer = [&](int begin, int end, int side) {
        Index<D> cells = first;  // the row of cells inside
        cells[a] = side == 0 ? 0 : n - 1;
        const real *p = &s_.p(cells) - (a == 0 ? begin : 0), *w = open ? &(*open)(first) : nullptr;
        if (s_.sides.periodic(a)) {
            if (side == 1) return;  // a copy of the other end
            cells[a] = n - 1;
            return inner(begin, end, p, &s_.p(cells) - (a == 0 ? begin : 0));
        }
        if (!s_.sides.open(a, side)) return;
        const real twice = side == 0 ? 2 : -2;  // p = 0 at half a cell from the cell's centre
        for (int i = begin; i < end; ++i)
            if (!w || w[i] > 0) values[i] += f * (twice * p[i]);
    };
    if (a > 0) {
        if (first[a] == 0 || first[a] == n) return outer(0, count, first[a] == 0 ? 0 : 1);
        return inner(0, count, &s_.p(first), &s_.p(first - e<D>(a)));
    }
    const int begin = first[0] == 0 ? 1 : 0, end = std::min(count, n - first[0]);
    if (begin > 0) outer(0, 1, 0);
    if (end > begin) inner(begin, end, &s_.p(first), &s_.p(first) - 1);
    if (end < count) outer(end, count, 1);
}

template <int D>
void add_gradient(MacVelocity<D>& u, const MacState<D>& s, real factor) {
    const PressurePush<D> push(s, factor);
    for (int a = 0; a < D; ++a)
        for_each_row(Index<D>{}, u[a].extent(), [&](const Index<D>& first, int count) { push.add(a, first, count, &u[a](first)); });
    sync_periodic(u, s.sides);
}

template <int D>
Projection<D>::Projection(const PoissonChoice& choice, const MacState<D>& s)
    : solver_(poisson::make_solver<D>(choice.method, choice.options)), tolerance_(choice.options.tolerance), rhs_(s.extent()) {
    for (int a = 0; a < D; ++a) {
        const real ratio = s.u.h[0] / s.u.h[a];
        matrix_.axis_weight[a] = ratio * ratio;
        matrix_.periodic[static_cast<std::size_t>(a)] = s.sides.periodic(a);
    }
    set_matrix(s);
}

template <int D>
void Projection<D>::set_matrix(const MacState<D>& s, const Grid<real, D>* heavy) {
    matrix_.cells = s.cells;
    bool weighted = s.solid.any() || !s.mobility[0].empty();
    for (int a = 0; a < D; ++a) weighted = weighted || s.sides.open(a, 0) || s.sides.open(a, 1);
    for (int a = 0; a < D && weighted; ++a) {
        auto& weight = matrix_.weight[static_cast<std::size_t>(a)];
        if (weight.empty()) weight = Grid<real, D>(s.u[a].extent());
        const auto* open = s.solid.any() ? &s.solid.open[static_cast<std::size_t>(a)] : nullptr;
        const auto* moves = s.mobility[0].empty() ? nullptr : &s.mobility[static_cast<std::size_t>(a)];
        const int n = s.u.cells[a];
        const auto of_side = [&](int end) {  // 2: p = 0 half a cell away
            return s.sides.periodic(a) ? 1.0 : s.sides.open(a, end) ? 2.0 : 0.0;
        };
        const auto set_row = [&](const Index<D>& first, int count) {
            real* to = &weight(first);
            const real side = a == 0 ? 1 : first[a] == 0 ? of_side(0) : first[a] == n ? of_side(1) : 1;
            for (int i = 0; i < count; ++i) to[i] = side;
            if (a == 0 && first[0] == 0) to[0] = of_side(0);
            if (a == 0 && first[0] + count > n) to[count - 1] = of_side(1);
            for (int i = 0; open && i < count; ++i) to[i] *= (&(*open)(first))[i];
            for (int i = 0; moves && i < count; ++i) to[i] *= (&(*moves)(first))[i];
        };
        Index<D> rows = weight.extent();
        rows[0] = 1;
        for_each_held(weight, Index<D>{}, rows, [&](const Index<D>& I) { for_each_block(I, weight.extent()[0], set_row); });
    }
    if (!s.mobility[0].empty()) leave_out_ice();
    if (heavy != nullptr) {
        if (matrix_.light.empty()) matrix_.light = Grid<std::uint8_t, D>(heavy->extent());
        for_each_held(matrix_.light, Index<D>{}, heavy->extent(), [&](const Index<D>& I) { matrix_.light(I) = (*heavy)(I) < 0.5; });
    }
    solver_->setup(matrix_);
}

/// A cell without any open face has no pressure: the solver treats it as solid.
template <int D>
void Projection<D>::leave_out_ice() {
    for_each_row(Index<D>{}, matrix_.cells.extent(), [&](const Index<D>& first, int count) {
        alignas(64) real open[row_block];
        std::fill_n(open, count, 0.0);
        for (int a = 0; a < D; ++a) {
            const auto& weight = matrix_.weight[static_cast<std::size_t>(a)];
            const real* w = &weight(first);
            const std::ptrdiff_t up = weight.stride(a);
#pragma omp simd
            for (int i = 0; i < count; ++i) open[i] += w[i] + w[i + up];
        }
        Cell* cell = &matrix_.cells(first);
        for (int i = 0; i < count; ++i) cell[i] = open[i] > 0 ? cell[i] : Cell::solid;
    });
}

/// rhs = scale ∇·u in all cells: the solver reads only fluid cells.
template <int D>
static void set_rhs(const MacState<D>& s, real scale, Grid<real, D>& rhs) {
    for_each_row(Index<D>{}, s.extent(), [&](const Index<D>& first, int count) {
        real* out = &rhs(first);
        flux_divergence_row(s, first, count, out);
        for (int i = 0; i < count; ++i) out[i] *= scale;
    });
}

/// u −= β (dt/ρ) ∇p
template <int D>
static void push_by_pressure(MacState<D>& s, real dt) {
    if (s.mobility[0].empty()) return add_gradient(s.u, s, -dt / s.rho);
    const PressurePush<D> push(s, -dt / s.rho);
    for (int a = 0; a < D; ++a)
        for_each_row(Index<D>{}, s.u[a].extent(), [&](const Index<D>& first, int count) {
            alignas(64) real whole[row_block];
            std::fill_n(whole, count, 0.0);
            push.add(a, first, count, whole);
            const real* beta = &s.mobility[static_cast<std::size_t>(a)](first);
            real* u = &s.u[a](first);
#pragma omp simd
            for (int i = 0; i < count; ++i) u[i] += beta[i] * whole[i];
        });
    sync_periodic(s.u, s.sides);
}

/// In parallel: distributed where the method supports it, otherwise replicated on each rank.
template <int D>
const poisson::Report& Projection<D>::solve(MacState<D>& s) {
    if (!s.own().distributed()) return solver_->solve(s.p, rhs_);
    if (solver_->shares_planes()) {
        const poisson::Report& report = solver_->solve(s.p, rhs_);
        refresh(s.p, s.sides.periodic(D - 1));
        return report;
    }
    gather(rhs_);
    gather(s.p);
    return solver_->solve(s.p, rhs_);
}

template <int D>
const poisson::Report& Projection<D>::project(MacState<D>& s, real dt, BodiesInFlow<D>* bodies, SolidPlacement<D>* solids) {
    set_rhs(s, -s.u.h[0] * s.u.h[0] * s.rho / dt, rhs_);
    const poisson::Report& report = bodies ? bodies->solve(s, *solids, dt, solver_.get(), tolerance_, &rhs_) : solve(s);
    push_by_pressure(s, dt);
    return report;
}

template <int D>
std::size_t Projection<D>::bytes() const {
    std::size_t total = solver_->bytes() + rhs_.bytes() + matrix_.cells.bytes() + matrix_.light.bytes();
    for (const auto& weight : matrix_.weight) total += weight.bytes();
    return total;
}

template real flux_divergence(const MacState<2>&, const Index<2>&);
template real flux_divergence(const MacState<3>&, const Index<3>&);
template void flux_divergence_row(const MacState<2>&, const Index<2>&, int, real*);
template void flux_divergence_row(const MacState<3>&, const Index<3>&, int, real*);
template real max_divergence(const MacState<2>&);
template real max_divergence(const MacState<3>&);
template class PressurePush<2>;
template class PressurePush<3>;
template void add_gradient(MacVelocity<2>&, const MacState<2>&, real);
template void add_gradient(MacVelocity<3>&, const MacState<3>&, real);
template class Projection<2>;
template class Projection<3>;

}  // namespace weir::mac
