#include "heightfield/brush.hpp"

#include "core/parallel.hpp"

#include <algorithm>

namespace weir::heightfield {

namespace {

/// Integral of f(column) over all columns.
template <class F>
real sum_over_columns(const Plane& plane, F&& f) {
    return plane.area() * exact_sum(plane.nz, [&](int k) {
               real sum = 0;
               for (int i = 0; i < plane.nx; ++i) sum += f(plane.at(i, k), Vec<3>{{plane.x(i), 0, plane.z(k)}});
               return sum;
           });
}

class BrushOnWater final : public Effect<State> {
public:
    explicit BrushOnWater(std::shared_ptr<BrushForcing> forcing) : brush_forcing_(std::move(forcing)) {}
    Stage stage() const override { return Stage::force; }
    void apply(State& s, real dt) override {
        const auto brush = brush_from_above(*brush_forcing_, s);
        if (brush.kind == BrushKind::push || brush.kind == BrushKind::pull) push(s, brush, dt);
        if (brush.kind == BrushKind::pour) pour(s, brush, dt);
        if (brush.kind == BrushKind::drain) drain(s, brush, dt);
    }

private:
    void push(State& s, const Brush<3>& brush, real dt) {
        const Vec<3> most{{s.plane.dx / dt, 0, s.plane.dz / dt}};
        for (int a : {0, 2}) {
            Field& q = a == 0 ? s.qx : s.qz;
            if (q.empty()) continue;
            brush_forcing_->impulse[a] += s.rho * sum_over_columns(s.plane, [&](std::size_t c, const Vec<3>& x) -> real {
                                              const real weight = s.h[c] > s.dry ? brush.weight(x) : 0;
                                              if (weight == 0) return 0;
                                              const real change =
                                                  brush_forcing_->share(weight, dt) * (s.h[c] * brush.target(x, most)[a] - q[c]);
                                              q[c] += change;
                                              return change;
                                          });
        }
    }
    void pour(State& s, const Brush<3>& brush, real dt) {
        const real volume = sum_over_columns(s.plane, [&](std::size_t c, const Vec<3>& x) {
            const real rise = dt * brush.speed * brush.weight(x);
            s.h[c] += rise;
            s.qx[c] += rise * brush.velocity[0];
            if (!s.qz.empty()) s.qz[c] += rise * brush.velocity[2];
            return rise;
        });
        s.net_inflow += volume;
        brush_forcing_->mass += s.rho * volume;
        brush_forcing_->impulse[0] += s.rho * volume * brush.velocity[0];
        if (!s.qz.empty()) brush_forcing_->impulse[2] += s.rho * volume * brush.velocity[2];
    }
    /// Removed water takes its momentum with it.
    void drain(State& s, const Brush<3>& brush, real dt) {
        const auto left = [&](std::size_t c, const Vec<3>& x) {
            return s.h[c] > 0 ? std::max<real>(0, 1 - dt * brush.speed * brush.weight(x) / s.h[c]) : 1;
        };
        for (int a : {0, 2}) {
            Field& q = a == 0 ? s.qx : s.qz;
            if (q.empty()) continue;
            brush_forcing_->impulse[a] += s.rho * sum_over_columns(s.plane, [&](std::size_t c, const Vec<3>& x) {
                                              const real before = q[c];
                                              q[c] *= left(c, x);
                                              return q[c] - before;
                                          });
        }
        const real volume = sum_over_columns(s.plane, [&](std::size_t c, const Vec<3>& x) {
            const real before = s.h[c];
            s.h[c] *= left(c, x);
            return s.h[c] - before;
        });
        s.net_inflow += volume;
        brush_forcing_->mass += s.rho * volume;
    }

    std::shared_ptr<BrushForcing> brush_forcing_;
};

}  // namespace

Brush<3> brush_from_above(const BrushForcing& forcing, const State& s) {
    auto brush = forcing.at<3>(s.time);
    brush.centre[1] = 0;
    if (s.plane.dim == 2) brush.centre[2] = 0;
    return brush;
}

std::unique_ptr<Effect<State>> brush_effect(std::shared_ptr<BrushForcing> forcing) {
    return std::make_unique<BrushOnWater>(std::move(forcing));
}

void apply_sources_and_sinks(BrushForcing& forcing, State& s, Field& surface, real dt, const std::function<bool(std::size_t)>& covered) {
    const auto brush = brush_from_above(forcing, s);
    if (brush.kind != BrushKind::pour && brush.kind != BrushKind::drain) return;
    const real speed = brush.kind == BrushKind::pour ? brush.speed : -brush.speed;
    const real volume = sum_over_columns(s.plane, [&](std::size_t c, const Vec<3>& x) -> real {
        if (s.h[c] == 0 || covered(c)) return 0;
        const real before = surface[c];
        surface[c] = std::max(before + dt * speed * brush.weight(x), std::min(before, s.bed[c] + 0.5 * s.h[c]));
        return surface[c] - before;
    });
    s.net_inflow += volume;
    forcing.mass += s.rho * volume;
}

}  // namespace weir::heightfield
