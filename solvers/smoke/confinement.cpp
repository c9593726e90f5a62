// Vorticity confinement: compensates the numerical dissipation of vortices (Steinhoff & Underhill 1994; Fedkiw, Stam & Jensen 2001).
#include "mac/grid/rows.hpp"
#include "smoke/effects.hpp"

namespace weir::smoke {

namespace {

/// f = ε h (N × ω),  ω = ∇ × u,  N = ∇|ω| / |∇|ω||     Fedkiw, Stam & Jensen 2001, eq. 9-11. Here h is the smallest cell size.
template <int D>
struct Confinement final : MacEffect<D> {
    real epsilon;
    std::array<std::string, 3> force{"confinement_x", "confinement_y", "confinement_z"};
    Confinement(const scene::Table& table, const scene::Scene&) : epsilon(table.number("epsilon")) {}
    Stage stage() const override { return Stage::force; }
    void needs(FieldPlan& plan) const override {
        plan.scratch("vorticity_magnitude");
        for (int a = 0; a < D; ++a) plan.scratch(force[static_cast<std::size_t>(a)]);
    }
    /// The force of the velocity before the step, applied in halves at the departure and arrival points.
    void apply_before_advection(MacState<D>& s, real dt) override {
        find_force(s);
        push(s, dt);
        force_known_ = true;
    }
    void apply(MacState<D>& s, real dt) override {
        if (!force_known_) find_force(s);
        push(s, dt);
        force_known_ = false;
    }

private:
    struct alignas(64) Row : std::array<real, row_block> {};
    bool force_known_ = false;  // the scratch fields contain the force of this step

    std::array<Grid<real, D>*, D> force_fields(MacState<D>& s) const {
        std::array<Grid<real, D>*, D> f;
        for (std::size_t a = 0; a < D; ++a) f[a] = &s.scratch_field(force[a]);
        return f;
    }
    void find_force(MacState<D>& s) const {
        auto& magnitude = s.scratch_field("vorticity_magnitude");
        const auto f = force_fields(s);  // first ω, then the force
        for_each_row(Index<D>{}, s.extent(), [&](const Index<D>& first, int count) {
            vorticity(s, first, count, f);
            find_magnitude(f, first, count, &magnitude(first));
        });
        refresh(magnitude, false);
        const real strength = epsilon * *std::min_element(s.u.h.begin(), s.u.h.end());
        for_each_row(Index<D>{}, s.extent(), [&](const Index<D>& first, int count) {
            Row n[D];
            for (int a = 0; a < D; ++a) slope(magnitude, a, s.u.h[a], first, count, n[a]);
            normalise(n, count);
            cross(n, &s.cells(first), strength, first, count, f);
        });
        refresh(*f[D - 1], false);
    }
    void push(MacState<D>& s, real dt) const {
        const auto f = force_fields(s);
        for (int a = 0; a < D; ++a)
            for_each_row(e<D>(a), s.extent(), [&](const Index<D>& first, int count) {  // inner faces
                real* u = &s.u[a](first);
                const Grid<real, D>& force_a = *f[static_cast<std::size_t>(a)];
                const real *here = &force_a(first), *below = &force_a(first - e<D>(a));
#pragma omp simd
                for (int i = 0; i < count; ++i) u[i] += dt * (0.5 * (below[i] + here[i]));
            });
    }

    /// ω at the centres of a row of cells, by central differences of the cell-centred velocity; 2D has only the third component, stored in
    /// the first field.
    static void vorticity(const MacState<D>& s, const Index<D>& first, int count, const std::array<Grid<real, D>*, D>& omega) {
        for (int c = 0; c < (D == 2 ? 1 : 3); ++c) {
            const int a = D == 2 ? 0 : (c + 1) % 3, b = D == 2 ? 1 : (c + 2) % 3;
            Row along_a, along_b;
            slope_of_velocity(s, b, a, first, count, along_a);
            slope_of_velocity(s, a, b, first, count, along_b);
            real* out = &(*omega[static_cast<std::size_t>(c)])(first);
            for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) out[i] = along_a[i] - along_b[i];
        }
    }
    /// Slope of component a along b.
    static void slope_of_velocity(const MacState<D>& s, int a, int b, const Index<D>& first, int count, Row& slope) {
        const auto& u = s.before[a];
        const real *q = u.at(first), width = 2 * s.u.h[b];
        const std::ptrdiff_t sa = u.stride(a), sb = u.stride(b);
        real* out = slope.data();
#pragma omp simd
        for (int i = 0; i < count; ++i) out[i] = (0.5 * (q[i + sb] + q[i + sb + sa]) - 0.5 * (q[i - sb] + q[i - sb + sa])) / width;
    }
    static void find_magnitude(const std::array<Grid<real, D>*, D>& omega, const Index<D>& first, int count, real* out) {
        const real *x = &(*omega[0])(first), *y = &(*omega[1])(first), *z = &(*omega[D - 1])(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) out[i] = std::sqrt(D == 2 ? x[i] * x[i] : x[i] * x[i] + y[i] * y[i] + z[i] * z[i]);
    }
    /// Slope of a cell field along one axis, one-sided at the sides of the domain.
    static void slope(const Grid<real, D>& q, int a, real h, const Index<D>& first, int count, Row& slope) {
        const int last = q.extent()[a] - 1;
        real* out = slope.data();
        const auto differences = [&](int begin, int end, int index) {  // index of the first along a
            const int lo = std::max(index - 1, 0), hi = std::min(index + 1, last);
            const real *at = &q(first), width = (hi - lo) * h;
            const std::ptrdiff_t to_lo = (lo - index) * q.stride(a), to_hi = (hi - index) * q.stride(a);
#pragma omp simd
            for (int i = begin; i < end; ++i) out[i] = (at[i + to_hi] - at[i + to_lo]) / width;
        };
        if (last == 0) {
            std::fill_n(out, count, 0.0);
        } else if (a > 0) {
            differences(0, count, first[a]);
        } else {
            const int begin = first[0] == 0 ? 1 : 0, end = first[0] + count > last ? count - 1 : count;
            differences(0, begin, 0);
            if (end > begin) differences(begin, end, first[0] + begin);
            differences(end, count, last);
        }
    }
    /// N = n / |n|, 0 where n is.
    static void normalise(Row (&n)[D], int count) {
        real *x = n[0].data(), *y = n[1].data(), *z = n[D - 1].data();
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real squares = x[i] * x[i] + y[i] * y[i], length = std::sqrt(D == 2 ? squares : squares + z[i] * z[i]);
            const real most = length > 0 ? length : infinity;
            x[i] = x[i] / most;
            y[i] = y[i] / most;
            if constexpr (D == 3) z[i] = z[i] / most;
        }
    }
    /// ε h (N × ω) in fluid cells, replacing ω.
    static void cross(const Row (&n)[D], const poisson::Cell* cells, real strength, const Index<D>& first, int count,
                      const std::array<Grid<real, D>*, D>& f) {
        Row fluid;  // ε h, or 0
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) fluid[i] = cells[i] == poisson::Cell::fluid ? strength : 0;
        const real *weight = fluid.data(), *nx = n[0].data(), *ny = n[1].data(), *nz = n[D - 1].data();
        real *x = &(*f[0])(first), *y = &(*f[1])(first), *z = &(*f[D - 1])(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real wx = x[i], wy = y[i], wz = z[i];
            if constexpr (D == 2) {
                x[i] = weight[i] * (ny[i] * wx);
                y[i] = weight[i] * -(nx[i] * wx);
            } else {
                x[i] = weight[i] * (ny[i] * wz - nz[i] * wy);
                y[i] = weight[i] * (nz[i] * wx - nx[i] * wz);
                z[i] = weight[i] * (nx[i] * wy - ny[i] * wx);
            }
        }
    }
};

}  // namespace

EffectKind confinement() {
    return effect_kind<Confinement>({"confinement",
                                     "Vorticity confinement (Fedkiw et al. 2001). It adds energy; not for accuracy studies.",
                                     {{.name = "epsilon",
                                       .type = scene::Type::number,
                                       .doc = "Strength.",
                                       .unit = "1/s",
                                       .required = true,
                                       .min = 0,
                                       .steerable = true}},
                                     {"epsilon"}});
}

}  // namespace weir::smoke
