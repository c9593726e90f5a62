// The operations of the conjugate gradients on one plane of the finest level.
#include "poisson/geometric/geometric_cg.hpp"
#include "poisson/geometric/packing.hpp"
#include "poisson/geometric/products.hpp"

namespace weir::poisson {

namespace {

/// sum += r·r, largest = max |r|; in the order of the compiler's vectors, for any number of threads.
void add_norms(const real* r, int n, real& sum, real& largest) {
    real rr = 0, most = largest;
#pragma omp simd reduction(+ : rr) reduction(max : most)
    for (int i = 0; i < n; ++i) {
        rr += r[i] * r[i];
        most = std::abs(r[i]) > most ? std::abs(r[i]) : most;
    }
    sum += rr;
    largest = most;
}

/// x += α p for sixteen entries; where x is zero, α p.
WEIR_INLINE void move(double* x, const d16& direction, real alpha, bool from_zero) {
    store8(x, (from_zero ? d8{} : load8(x)) + alpha * direction.lo);
    store8(x + 8, (from_zero ? d8{} : load8(x + 8)) + alpha * direction.hi);
}

}  // namespace

/// p = x in fluid, zero elsewhere; dry rows are zero already.
template <int D>
void GeometricCg<D>::scatter_plane(const Natural<D>& problem, Grid<real, D>& p, int q) {
    const Layout<D>& at = hierarchy_.finest().at;
    for (int j = 0; j < at.rows_in_plane(); ++j) {
        const int row = problem.row(q, j);
        if (problem.is_dry(row)) continue;
        const auto s = static_cast<std::size_t>(at.parity(q, j));
        real* to = p.data() + static_cast<std::ptrdiff_t>(row) * at.n[0];
        merge(x_[s] + at.offset(row), x_[1 - s] + at.offset(row), at.n[0], to);
        problem.clear_outside(row, to);
        problem.sum_row(row, to);
    }
}

/// r = b − A p, packed, with its norms; p may be nullptr for zero. The means of the problem must be those of b.
template <int D>
void GeometricCg<D>::residual_plane(const Natural<D>& problem, const real* p, const Grid<real, D>& b, int q) {
    Level<D>& finest = hierarchy_.finest();
    const Layout<D>& at = finest.at;
    thread_local Vector natural;
    natural.resize(static_cast<std::size_t>(at.n[0]) + 1);
    PlaneSums sums;
    for (int j = 0; j < at.rows_in_plane(); ++j) {
        const int row = problem.row(q, j);
        if (problem.is_dry(row)) continue;
        const auto s = static_cast<std::size_t>(at.parity(q, j));
        if (p != nullptr)
            problem.residual_row(q, j, p, b.data(), natural.data());
        else
            problem.rhs_row(row, b.data(), natural.data());
        add_norms(natural.data(), at.n[0], sums.rr, sums.largest);
        split(natural.data(), at.n[0], at.width, finest.r[s] + at.offset(row), finest.r[1 - s] + at.offset(row));
    }
    sums_[static_cast<std::size_t>(q)] = sums;
}

/// The last half sweep over the red cells of a plane. Their residual is then zero, so their u·A u is u·r.
template <int D>
void GeometricCg<D>::last_half_sweep(int q) {
    Level<D>& finest = hierarchy_.finest();
    d8 ru{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        float* u = finest.u[0] + finest.at.offset(row);
        const float* r = finest.r[0] + finest.at.offset(row);
        with_row(finest, q, j, 0, [&](const auto neighbours, const auto diagonal) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) {
                    const f16 next = (load16(r + m) + neighbours(m)) * diagonal.inverse(m);
                    store(u + m, next);
                    ru += low(next) * load8(r + m) + high(next) * load8(r + m + 8);
                }
        });
        finest.at.wrap(u);
    }
    auto& sums = sums_[static_cast<std::size_t>(q)];
    sums.ru = sums.uAu = sum(ru);
}

template <int D>
void GeometricCg<D>::black_products(int q) {
    const Level<D>& finest = hierarchy_.finest();
    d8 ru{}, uAu{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        const float *u = finest.u[1] + finest.at.offset(row), *r = finest.r[1] + finest.at.offset(row);
        const auto diagonal_at = [&, own = finest.at.offset(row)](int m) {
            return finest.by_count ? to_float(finest.count[1] + own + m) : load16(finest.dinv[1] + own + m);
        };
        with_product(finest, finest.u, q, j, 1, [&](const auto product) WEIR_INLINED {
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) {
                    // a periodic row repeats its first entry past its end: it must not be counted twice
                    const f16 value = load16(u + m), inside = diagonal_at(m) != f16{} ? value : f16{};
                    const d16 Au = product(m), v = {low(inside), high(inside)}, f = load_wide(r + m);
                    ru += v.lo * f.lo + v.hi * f.hi;
                    uAu += v.lo * Au.lo + v.hi * Au.hi;
                }
        });
    }
    auto& sums = sums_[static_cast<std::size_t>(q)];
    sums.ru += sum(ru);
    sums.uAu += sum(uAu);
}

/// p = u + β p.
template <int D>
void GeometricCg<D>::turn_plane(int q, real beta) {
    const Level<D>& finest = hierarchy_.finest();
    const f16 b = splat(static_cast<float>(beta));
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        for (std::size_t c = 0; c < 2; ++c) {
            const float* u = finest.u[c] + finest.at.offset(row);
            float* p = p_[c] + finest.at.offset(row);
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) store(p + m, load16(u + m) + b * load16(p + m));
            finest.at.wrap(p);
        }
    }
}

/// x += α p,  r −= α A p,  r·r, and the red initialization of the next cycle.
template <int D>
void GeometricCg<D>::advance_plane(int q, real alpha) {
    Level<D>& finest = hierarchy_.finest();
    const bool from_zero = at_zero_;
    d8 rr{};
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        const std::ptrdiff_t own = finest.at.offset(row);
        for (int colour = 0; colour < 2; ++colour) {
            const auto c = static_cast<std::size_t>(colour);
            double* x = x_[c] + own;
            float* r = finest.r[c] + own;
            const float* p = p_[c] + own;
            with_product(finest, p_, q, j, colour, [&](const auto product) WEIR_INLINED {
                with_row(finest, q, j, colour, [&](const auto&, const auto diagonal) WEIR_INLINED {
                    for (const Span& span : RowSpans<D>(finest, row))
                        for (int m = span.begin; m < span.end; m += lanes) {
                            const d16 Ap = product(m), direction = load_wide(p + m), old = load_wide(r + m);
                            move(x + m, direction, alpha, from_zero);
                            const d8 lo = old.lo - alpha * Ap.lo, hi = old.hi - alpha * Ap.hi;
                            const f16 inside = diagonal.inverse(m) != f16{} ? join(lo, hi) : f16{};
                            store(r + m, inside);
                            const d8 a = low(inside), b = high(inside);
                            rr += a * a + b * b;
                            if (colour == 0) store(finest.u[0] + own + m, inside * diagonal.inverse(m));
                        }
                });
            });
        }
        finest.at.wrap(finest.u[0] + own);
    }
    sums_[static_cast<std::size_t>(q)].rr = sum(rr);
}

/// Only x += α p.
template <int D>
void GeometricCg<D>::move_plane(int q, real alpha) {
    const Level<D>& finest = hierarchy_.finest();
    const bool from_zero = at_zero_;
    for (int j = 0; j < finest.at.rows_in_plane(); ++j) {
        const int row = finest.at.row(q, j);
        for (std::size_t c = 0; c < 2; ++c) {
            double* x = x_[c] + finest.at.offset(row);
            const float* p = p_[c] + finest.at.offset(row);
            for (const Span& span : RowSpans<D>(finest, row))
                for (int m = span.begin; m < span.end; m += lanes) move(x + m, load_wide(p + m), alpha, from_zero);
        }
    }
}

template void GeometricCg<2>::scatter_plane(const Natural<2>&, Grid<real, 2>&, int);
template void GeometricCg<2>::residual_plane(const Natural<2>&, const real*, const Grid<real, 2>&, int);
template void GeometricCg<2>::last_half_sweep(int);
template void GeometricCg<2>::black_products(int);
template void GeometricCg<2>::turn_plane(int, real);
template void GeometricCg<2>::advance_plane(int, real);
template void GeometricCg<2>::move_plane(int, real);
template void GeometricCg<3>::scatter_plane(const Natural<3>&, Grid<real, 3>&, int);
template void GeometricCg<3>::residual_plane(const Natural<3>&, const real*, const Grid<real, 3>&, int);
template void GeometricCg<3>::last_half_sweep(int);
template void GeometricCg<3>::black_products(int);
template void GeometricCg<3>::turn_plane(int, real);
template void GeometricCg<3>::advance_plane(int, real);
template void GeometricCg<3>::move_plane(int, real);

}  // namespace weir::poisson
