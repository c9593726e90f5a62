#include "flow/helmholtz.hpp"

#include "core/error.hpp"

namespace weir::flow {

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
Helmholtz<D>::Helmholtz(const Nodes<D>& nodes, const Vec<D>& h, const Boundary<D>& boundary, OpenFaces<D> open, const Index<D>& extent)
    : nodes_(nodes), h_(h), boundary_(boundary.homogeneous()), open_(open), direction_(extent), image_(extent), solution_(extent) {}

template <int D>
real Helmholtz<D>::dot(const Grid<real, D>& x, const Grid<real, D>& y) const {
    return sum_over(x.extent(), [&](const Index<D>& I) { return x(I) * y(I); });
}

/// The first direction is the residual, scaled: it is for δ, r for δ/scale.
template <int D>
void Helmholtz<D>::begin(const Grid<real, D>& r, const WallRows<D>& walls) {
    fill_planes(direction_, r, boundary_);
    if (!walls.empty()) {
        walls.each([&](const Index<D>& I, real, real scale) { direction_(I) *= scale; });
        for_each_plane(0, direction_.extent()[D - 1], [&](int plane) { fill_plane_ghosts(direction_, boundary_, plane); });
    }
    fill_end_planes(direction_, boundary_);  // on all ranks, including those without walls
}

template <int D>
int Helmholtz<D>::solve(Grid<real, D>& r, real a, const Mask<D>& mask, std::span<const Held> held, const char* what,
                        const WallRows<D>& walls) {
    solution_.fill(0);
    for (const Held& h : held) r[h.cell] = 0;
    walls.each([&](const Index<D>& I, real, real scale) { r(I) *= scale; });
    real rr = dot(r, r);
    const real goal = tolerance * tolerance * rr;
    begin(r, walls);
    int iteration = 0;
    for (; rr > goal; ++iteration) {
        if (iteration == max_iterations || !std::isfinite(rr))
            throw NumericalFailure(what, "the implicit solve for " + std::string(what) + " did not converge");
        laplacian(direction_, h_, nodes_, mask, open_, image_);  // image_ stays 0 outside the nodes
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) { image_(I) = direction_(I) - a * image_(I); });
        for (const Held& h : held) image_[h.cell] = 0;
        walls.each([&](const Index<D>& I, real extra, real) { image_(I) -= a * extra * direction_(I); });
        const real pAp = sum_over(image_.extent(), [&](const Index<D>& I) { return image_(I) * direction_(I); });
        const real alpha = rr / pAp;
        walls.each([&](const Index<D>& I, real, real scale) { image_(I) *= scale; });
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) {
            solution_(I) += alpha * direction_(I);
            r(I) -= alpha * image_(I);
        });
        const real last = rr;
        rr = dot(r, r);
        const real beta = rr / last;
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) { direction_(I) = r(I) + beta * direction_(I); });
        walls.each([&](const Index<D>& I, real, real scale) { direction_(I) += (scale - 1) * r(I); });
        fill_ghosts(direction_, boundary_, 1);
    }
    r.swap(solution_);
    return iteration;
}

template void laplacian(const Padded<2>&, const Vec<2>&, const Nodes<2>&, const Mask<2>&, OpenFaces<2>, Grid<real, 2>&);
template void laplacian(const Padded<3>&, const Vec<3>&, const Nodes<3>&, const Mask<3>&, OpenFaces<3>, Grid<real, 3>&);
template class Helmholtz<2>;
template class Helmholtz<3>;

}  // namespace weir::flow
