#include "smoke/helmholtz.hpp"

#include "linear/conjugate_gradients.hpp"

namespace weir::smoke {

namespace {

/// The correction is of the order of dt, so a relative error of 1e-6 is far below that of the time scheme.
constexpr real tolerance = 1e-6;
/// CG's error falls by (√κ − 1)/(√κ + 1) per iteration, κ = 1 + 4 D a/h²: 2000 reach the tolerance up to a/h² of about 1e4.
constexpr int max_iterations = 2000;

template <int D, class Row>
void each_row(const Nodes<D>& nodes, Row&& row) {
    for_each_row(nodes.lo, nodes.hi, row);
}

}  // namespace

template <int D>
void laplacian(const Padded<D>& q, const Vec<D>& h, const Nodes<D>& nodes, const Mask<D>& mask, std::type_identity_t<OpenFaces<D>> open,
               Grid<real, D>& out) {
    each_row(nodes, [&](const Index<D>& first, int count) {
        const real *c = q.at(first), *m = mask.empty() ? nullptr : mask.at(first);
        real* sum = &out(first);
        std::fill_n(sum, count, 0.0);
        for (int b = 0; b < D; ++b) {
            const std::ptrdiff_t s = q.stride(b);
            const real factor = 1 / (h[b] * h[b]);
            if (open) {
                const auto& faces = (*open)[static_cast<std::size_t>(b)];
                const real *below = &faces(first), *above = below + faces.stride(b);
#pragma omp simd
                for (int i = 0; i < count; ++i) sum[i] += factor * (above[i] * (c[i + s] - c[i]) + below[i] * (c[i - s] - c[i]));
            } else {
#pragma omp simd
                for (int i = 0; i < count; ++i) sum[i] += factor * ((c[i + s] - c[i]) + (c[i - s] - c[i]));
            }
        }
        if (!m) return;
        for (int i = 0; i < count; ++i) sum[i] *= m[i];
    });
}

template <int D>
Helmholtz<D>::Helmholtz(const Nodes<D>& nodes, const Vec<D>& h, const Boundary<D>& boundary, OpenFaces<D> open, const Extent<D>& extent)
    : nodes_(nodes), h_(h), boundary_(boundary.homogeneous()), open_(open), direction_(extent), image_(extent), solution_(extent) {}

/// The first direction is the residual, scaled: it is for δ, r for δ/scale.
template <int D>
void Helmholtz<D>::set_first_direction(const Grid<real, D>& r, const WallRows<D>& walls) {
    fill_planes(direction_, r, boundary_);
    if (!walls.empty()) {
        walls.each([&](const Index<D>& I, real, real scale) { direction_(I) *= scale; });
        for_each_plane(direction_.extent(), [&](int plane) { fill_plane_ghosts(direction_, boundary_, plane); });
    }
    fill_end_planes(direction_, boundary_, 1);  // on all ranks, including those without walls
}

/// The solve is for δ/scale, with M = 1.
template <int D>
struct Helmholtz<D>::System {
    static constexpr linear::Norm norm = linear::Norm::natural;
    Helmholtz& of;
    Grid<real, D>& r;
    real a;
    const Mask<D>& mask;
    std::span<const Held> held;
    const WallRows<D>& walls;

    real precondition() {
        return sum_over(r.extent(), [&](const Index<D>& I) { return r(I) * r(I); });
    }
    void update_direction(real beta) {
        if (beta == 0) return of.set_first_direction(r, walls);
        auto& p = of.direction_;
        for_each_in(of.nodes_.lo, of.nodes_.hi, [&](const Index<D>& I) { p(I) = r(I) + beta * p(I); });
        walls.each([&](const Index<D>& I, real, real scale) { p(I) += (scale - 1) * r(I); });
        fill_ghosts(p, of.boundary_, 1);
    }
    real multiply() {
        const auto& p = of.direction_;
        auto& Ap = of.image_;
        laplacian(p, of.h_, of.nodes_, mask, of.open_, Ap);  // Ap stays 0 outside the nodes
        for_each_in(of.nodes_.lo, of.nodes_.hi, [&](const Index<D>& I) { Ap(I) = p(I) - a * Ap(I); });
        for (const Held& h : held) Ap[h.cell] = 0;
        walls.each([&](const Index<D>& I, real extra, real) { Ap(I) -= a * extra * p(I); });
        return sum_over(Ap.extent(), [&](const Index<D>& I) { return Ap(I) * p(I); });
    }
    void advance(real alpha) {
        auto& Ap = of.image_;
        walls.each([&](const Index<D>& I, real, real scale) { Ap(I) *= scale; });
        for_each_in(of.nodes_.lo, of.nodes_.hi, [&](const Index<D>& I) {
            of.solution_(I) += alpha * of.direction_(I);
            r(I) -= alpha * Ap(I);
        });
    }
};

template <int D>
int Helmholtz<D>::solve(Grid<real, D>& r, real a, const Mask<D>& mask, std::span<const Held> held, const char* what,
                        const WallRows<D>& walls) {
    solution_.fill(0);
    for (const Held& h : held) r[h.cell] = 0;
    walls.each([&](const Index<D>& I, real, real scale) { r(I) *= scale; });
    System system{*this, r, a, mask, held, walls};
    int iterations = 0;
    linear::StopTest stop(tolerance, max_iterations, iterations);
    linear::require_converged(what, "diffusion solve", linear::conjugate_gradients(system, stop), stop);
    r.swap(solution_);
    return iterations;
}

template void laplacian(const Padded<2>&, const Vec<2>&, const Nodes<2>&, const Mask<2>&, OpenFaces<2>, Grid<real, 2>&);
template void laplacian(const Padded<3>&, const Vec<3>&, const Nodes<3>&, const Mask<3>&, OpenFaces<3>, Grid<real, 3>&);
template class Helmholtz<2>;
template class Helmholtz<3>;

}  // namespace weir::smoke
