#include "staggered/conservative.hpp"

namespace weir::staggered {

std::span<const Substep> substeps(Scheme scheme) {
    static constexpr std::array<Substep, 1> one{{{1, 0}}};
    static constexpr std::array<Substep, 3> wray{{{8.0 / 15, 0}, {5.0 / 12, -17.0 / 60}, {3.0 / 4, -5.0 / 12}}};
    if (scheme == Scheme::conservative) return wray;
    return one;
}

template <int D>
void add_momentum_flux(const PaddedVelocity<D>& before, const Vec<D>& h, const Nodes<D>& faces, real dt, Grid<real, D>& u_a) {
    const int a = faces.axis;
    for_each_row(faces.lo, faces.hi, [&](const Index<D>& first, int count) {
        const auto& field = before[a];
        const real* q = field.at(first);
        const std::ptrdiff_t sa = field.stride(a);
        real* out = &u_a(first);
        for (int b = 0; b < D; ++b) {
            const real factor = 0.25 * dt / h[b];
            const std::ptrdiff_t s = field.stride(b);
            const auto& carrier = before[b];
            const real* v = carrier.at(first);
            // faces of the control volume of face I across b: the carrying velocity is averaged along a from the cells on both sides
            const std::ptrdiff_t up = a == b ? sa : carrier.stride(b), back = a == b ? 0 : -carrier.stride(a);
            const std::ptrdiff_t here = a == b ? 0 : up, below = a == b ? -sa : 0, low_back = a == b ? 0 : back;
            const std::ptrdiff_t high_back = a == b ? up : up + back;
#pragma omp simd
            for (int i = 0; i < count; ++i) {
                const real above_flux = (v[i + here] + v[i + high_back]) * (q[i] + q[i + s]);
                const real below_flux = (v[i + below] + v[i + low_back]) * (q[i - s] + q[i]);
                out[i] -= factor * (above_flux - below_flux);
            }
        }
    });
}

namespace {

/// The value that a flux carries across the face between q0 and q1 (qm, q2 beyond them), moving with u.
inline real central(real, real, real q0, real q1, real) { return 0.5 * (q0 + q1); }
inline real van_leer(real u, real qm, real q0, real q1, real q2) {
    const real up = u > 0 ? q0 : q1, ahead = q1 - q0;
    const real to_next = u > 0 ? ahead : -ahead, from_last = u > 0 ? q0 - qm : q1 - q2;
    const real both = to_next * from_last;
    return up + (both > 0 ? both / (to_next + from_last) : 0.0);
}

template <int D, class FaceValue>
void add_flux_along(const Padded<D>& before, const Padded<D>& velocity, const Grid<real, D>* open, int b, real factor, FaceValue face_value,
                    Grid<real, D>& q) {
    for_each_row(Index<D>{}, q.extent(), [&](const Index<D>& first, int count) {
        const real *p = before.at(first), *u = velocity.at(first), *w = open ? &(*open)(first) : nullptr;
        const std::ptrdiff_t s = before.stride(b), su = velocity.stride(b), sw = open ? open->stride(b) : 0;
        real* out = &q(first);
        const auto row = [&](auto weight) {
#pragma omp simd
            for (int i = 0; i < count; ++i) {
                const real *c = p + i, above_u = u[i + su], below_u = u[i];
                const real above = weight(i + sw) * above_u * face_value(above_u, c[-s], c[0], c[s], c[2 * s]);
                const real below = weight(i) * below_u * face_value(below_u, c[-2 * s], c[-s], c[0], c[s]);
                out[i] -= factor * (above - below);
            }
        };
        if (w)
            row([w](std::ptrdiff_t i) { return w[i]; });
        else
            row([](std::ptrdiff_t) { return 1.0; });
    });
}

}  // namespace

template <int D>
void add_field_flux(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h, Flux flux,
                    real dt, Grid<real, D>& q) {
    for (int b = 0; b < D; ++b) {
        const auto axis = static_cast<std::size_t>(b);
        const Grid<real, D>* open = solid.any() ? &solid.open[axis] : nullptr;
        if (flux == Flux::central)
            add_flux_along(before, velocity[b], open, b, dt / h[b], central, q);
        else
            add_flux_along(before, velocity[b], open, b, dt / h[b], van_leer, q);
    }
}

template <int D>
void keep_uniform_at_solids(const Padded<D>& before, const PaddedVelocity<D>& velocity, const SolidFaces<D>& solid, const Vec<D>& h,
                            real dt, Grid<real, D>& q) {
    for_each_cell(q.extent(), [&](const Index<D>& I) {
        real out = 0;
        bool cut = false;
        for (int b = 0; b < D; ++b) {
            const auto& w = solid.open[static_cast<std::size_t>(b)];
            const Index<D> up = I + e<D>(b);
            cut = cut || w(I) < 1 || w(up) < 1;
            out += (w(up) * *velocity[b].at(up) - w(I) * *velocity[b].at(I)) / h[b];
        }
        if (cut) q(I) += dt * *before.at(I) * out;
    });
}

template <int D>
void StageBlend<D>::blend(const Substep& stage, const Padded<D>& before, Grid<real, D>& value) {
    if (increment_.empty()) increment_ = Grid<real, D>(value.extent());
    for_each_row(Index<D>{}, value.extent(), [&](const Index<D>& first, int count) {
        const real* old = before.at(first);
        real *now = &value(first), *increment = &increment_(first);
#pragma omp simd
        for (int i = 0; i < count; ++i) {
            const real rate = now[i] - old[i];
            const real last = stage.zeta == 0 ? 0 : increment[i];  // the first stage must not see what the last step left
            now[i] = old[i] + (stage.gamma * rate + stage.zeta * last);
            increment[i] = rate;
        }
    });
}

template void add_momentum_flux(const PaddedVelocity<2>&, const Vec<2>&, const Nodes<2>&, real, Grid<real, 2>&);
template void add_momentum_flux(const PaddedVelocity<3>&, const Vec<3>&, const Nodes<3>&, real, Grid<real, 3>&);
template void add_field_flux(const Padded<2>&, const PaddedVelocity<2>&, const SolidFaces<2>&, const Vec<2>&, Flux, real, Grid<real, 2>&);
template void add_field_flux(const Padded<3>&, const PaddedVelocity<3>&, const SolidFaces<3>&, const Vec<3>&, Flux, real, Grid<real, 3>&);
template void keep_uniform_at_solids(const Padded<2>&, const PaddedVelocity<2>&, const SolidFaces<2>&, const Vec<2>&, real, Grid<real, 2>&);
template void keep_uniform_at_solids(const Padded<3>&, const PaddedVelocity<3>&, const SolidFaces<3>&, const Vec<3>&, real, Grid<real, 3>&);
template class StageBlend<2>;
template class StageBlend<3>;

}  // namespace weir::staggered
