#include "particles/state/brush.hpp"

#include <algorithm>

namespace weir::particles {

namespace {

/// Minimum distance of a poured particle from others, in spacings: closer ones would be pushed apart.
constexpr real room = 0.95;

/// The index of the lattice of cell centres below x.
template <int D>
Index<D> cell_below(const Fluid<D>& fluid, const Vec<D>& x) {
    Index<D> I;
    for (int a = 0; a < D; ++a) I[a] = static_cast<int>(std::floor((x[a] - fluid.domain.lo[a]) / fluid.domain.spacing));
    return I;
}

/// f(I) over [lo, lo + extent), serially: additions have a fixed order.
template <int D, class F>
void for_each_serial(const Index<D>& lo, const Index<D>& extent, F&& f) {
    for (std::size_t n = 0, all = product(extent); n < all; ++n) {
        Index<D> I = lo;
        std::size_t rest = n;
        for (int a = 0; a < D; ++a) {
            I[a] += static_cast<int>(rest % static_cast<std::size_t>(extent[a]));
            rest /= static_cast<std::size_t>(extent[a]);
        }
        f(I, n);
    }
}

}  // namespace

template <int D>
void BrushOnParticles<D>::account(const Vec<D>& u, real mass) {
    for (int a = 0; a < D; ++a) brush_forcing_->impulse[a] += mass * u[a];
    brush_forcing_->mass += mass;
}

template <int D>
void BrushOnParticles<D>::apply(Flow<D>& f, real dt) {
    const auto brush = brush_forcing_->at<D>(f.fluid.time);
    if (!brush.moves()) return;
    const Vec<D> most = Vec<D>::constant(f.fluid.domain.spacing / dt);
    for (int a = 0; a < D; ++a) {
        auto& va = f.fluid.v[static_cast<std::size_t>(a)];
        brush_forcing_->impulse[a] += f.fluid.mass * block_sum(f.fluid.count(), [&](int i) -> real {
                                          const Vec<D> x = f.fluid.position(i);
                                          const real weight = brush.weight(x);
                                          if (weight == 0) return 0;
                                          real& u = va[static_cast<std::size_t>(i)];
                                          const real change = brush_forcing_->share(weight, dt) * (brush.target(x, most)[a] - u);
                                          u += change;
                                          return change;
                                      });
    }
}

template <int D>
void BrushOnParticles<D>::apply_sources_and_sinks(Fluid<D>& fluid) {
    brush_ = brush_forcing_->at<D>(fluid.time);
    if (brush_.kind == BrushKind::pour) pour(fluid, brush_);
    if (brush_.kind == BrushKind::drain) drain(fluid, brush_);
}

template <int D>
real BrushOnParticles<D>::warm(Fluid<D>& fluid, const Heat<D>& heat, real dt) {
    if (brush_.kind != BrushKind::heat) return 0;
    const real wanted = heat.enthalpy(brush_.temperature);
    const real given = fluid.mass * block_sum(fluid.count(), [&](int i) -> real {
                           const real weight = brush_.weight(fluid.position(i));
                           if (weight == 0) return 0;
                           real& h = fluid.enthalpy[static_cast<std::size_t>(i)];
                           const real change = brush_forcing_->share(weight, dt) * (wanted - h);
                           h += change;
                           return change;
                       });
    brush_forcing_->heat += given;
    return given;
}

template <int D>
void BrushOnParticles<D>::pour(Fluid<D>& fluid, const Brush<D>& brush) {
    const Vec<D> reach = Vec<D>::constant(brush.radius);
    Index<D> lo = cell_below(fluid, brush.centre - reach), hi = cell_below(fluid, brush.centre + reach);
    const Index<D> last = cell_below(fluid, fluid.domain.hi - Vec<D>::constant(0.5 * fluid.domain.spacing));
    Index<D> extent;
    for (int a = 0; a < D; ++a) {
        lo[a] = std::max(lo[a], 0), hi[a] = std::min(hi[a], last[a]);
        if (hi[a] < lo[a]) return;
        extent[a] = hi[a] - lo[a] + 1;
    }
    mark_taken(fluid, lo, extent);
    for_each_serial(lo, extent, [&](const Index<D>& I, std::size_t n) {
        const Vec<D> x = fluid.domain.lo + fluid.domain.spacing * (to_vec(I) + Vec<D>::constant(0.5));
        if (taken_[n] || !brush.covers(x)) return;
        if (!fluid.domain.solids.empty() && fluid.domain.solids.distance(x) <= 0.25 * fluid.domain.spacing) return;
        fluid.add(x, brush.velocity);
        account(brush.velocity, fluid.mass);
    });
}

template <int D>
void BrushOnParticles<D>::mark_taken(const Fluid<D>& fluid, const Index<D>& lo, const Index<D>& extent) {
    taken_.assign(product(extent), 0);
    const real d = fluid.domain.spacing;
    for (int i = 0; i < fluid.count(); ++i) {
        const Vec<D> x = fluid.position(i);
        const Index<D> I = cell_below(fluid, x);
        bool near = true;
        for (int a = 0; a < D; ++a) near = near && I[a] >= lo[a] - 1 && I[a] <= lo[a] + extent[a];
        if (!near) continue;
        for_each_serial(I - Index<D>::constant(1), Index<D>::constant(3), [&](const Index<D>& J, std::size_t) {
            std::size_t at = 0, stride = 1;
            for (int a = 0; a < D; ++a) {
                if (J[a] < lo[a] || J[a] >= lo[a] + extent[a]) return;
                at += stride * static_cast<std::size_t>(J[a] - lo[a]);
                stride *= static_cast<std::size_t>(extent[a]);
            }
            const Vec<D> apart = fluid.domain.lo + d * (to_vec(J) + Vec<D>::constant(0.5)) - x;
            if (dot(apart, apart) < room * room * d * d) taken_[at] = 1;
        });
    }
}

template <int D>
void BrushOnParticles<D>::drain(Fluid<D>& fluid, const Brush<D>& brush) {
    fluid.remove_if([&](int i) {
        if (!brush.covers(fluid.position(i))) return false;
        account(fluid.velocity(i), -fluid.mass);
        return true;
    });
}

template class BrushOnParticles<2>;
template class BrushOnParticles<3>;

}  // namespace weir::particles
