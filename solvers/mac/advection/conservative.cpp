#include "mac/advection/conservative.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

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

/// The open fraction of a face; 1 beyond the sides.
template <int D>
real open_at(const MacState<D>& s, int b, Index<D> F) {
    for (int d = 0; d < D; ++d)
        if (s.sides.periodic(d)) F[d] = (F[d] + s.u.cells[d]) % s.u.cells[d];
    const auto& open = s.solid.open[static_cast<std::size_t>(b)];
    return open.contains(F) ? open(F) : 1;
}

/// The two faces along b whose fluxes cross one end of the control volume of face I along a.
template <int D>
std::array<Index<D>, 2> crossed(int a, int b, const Index<D>& I, int end) {
    const Index<D> F = end == 0 ? I : I + e<D>(b);
    return {F, F - e<D>(a)};
}

template <int D>
bool is_cut(const MacState<D>& s, int a, const Index<D>& I) {
    if (open_at(s, a, I) == 0) return false;
    for (int b = 0; b < D; ++b)
        for (int end = 0; end < 2; ++end) {
            for (const Index<D>& F : crossed(a, b, I, end))
                if (open_at(s, b, F) < 1) return true;
            if (open_at(s, a, end == 0 ? I - e<D>(b) : I + e<D>(b)) == 0) return true;
        }
    return false;
}

}  // namespace

template <int D>
void CutFaces<D>::find(const MacState<D>& s) {
    for (int a = 0; a < D; ++a) {
        auto& list = faces_[static_cast<std::size_t>(a)];
        list.clear();
        const Nodes<D> nodes = free_faces(s.u, s.sides, a);
        Index<D> I = nodes.lo;
        const int lo = s.own().lower(nodes.lo[D - 1]), hi = s.own().upper(nodes.hi[D - 1]);
        for (I[D - 1] = lo; I[D - 1] < hi;) {
            if (is_cut(s, a, I)) list.push_back(I);
            for (int d = 0; d < D; ++d) {
                if (++I[d] < nodes.hi[d] || d == D - 1) break;
                I[d] = nodes.lo[d];
            }
        }
    }
    found_ = true;
}

template <int D>
real CutFaces<D>::rate(const MacState<D>& s, int a, const Index<D>& I) const {
    const real here = s.before[a](I);
    real carried = 0, widest = 0, volume = open_at(s, a, I);
    for (int b = 0; b < D; ++b) {
        real pair = 0;  // added first: mirror symmetry is bitwise
        for (int end = 0; end < 2; ++end) {
            const auto [F, G] = crossed(a, b, I, end);
            const real open[2] = {open_at(s, b, F), open_at(s, b, G)}, area = 0.5 * (open[0] + open[1]);
            const real out = (end == 0 ? -0.5 : 0.5) * (open[0] * s.before[b](F) + open[1] * s.before[b](G));
            pair += std::min(out, 0.0) * (s.before[a](end == 0 ? I - e<D>(b) : I + e<D>(b)) - here);
            volume = std::max(volume, std::min(widest, area));
            widest = std::max(widest, area);
        }
        carried += pair / s.u.h[b];
    }
    return -carried / volume;
}

template <int D>
void CutFaces<D>::add_momentum_flux(const MacState<D>& s, int a, real dt, Grid<real, D>& u_a) {
    const auto& list = faces_[static_cast<std::size_t>(a)];
    const int count = static_cast<int>(list.size());
    values_.resize(std::max(values_.size(), list.size()));
    parallel_for(0, count, [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        values_[at] = u_a(list[at]) + dt * rate(s, a, list[at]);
    });
    mac::add_momentum_flux(s.before, s.u.h, free_faces(s.u, s.sides, a), dt, u_a);
    for (int i = 0; i < count; ++i) u_a(list[static_cast<std::size_t>(i)]) = values_[static_cast<std::size_t>(i)];
}

template <int D>
std::size_t CutFaces<D>::bytes() const {
    std::size_t total = values_.capacity() * sizeof(real);
    for (const auto& list : faces_) total += list.capacity() * sizeof(Index<D>);
    return total;
}

namespace {

/// The value of q at the face between q0 and q1 (qm, q2 beyond them), advected with velocity u.
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
            const real last = stage.zeta == 0 ? 0 : increment[i];  // the first stage must not use the rate of the last step
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
template class CutFaces<2>;
template class CutFaces<3>;
template class StageBlend<2>;
template class StageBlend<3>;

}  // namespace weir::mac
