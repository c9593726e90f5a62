// The frame of a tank that rolls, on the staggered grid: forces at face centres, the Coriolis force by turning the velocity between halves
// of the others (Boris 1970); gravity, which acts before, is taken half back for that. The turn is a half of one component, the other, and
// the half again: each with the newest values of the other, so that it neither damps nor amplifies.
#include "geometry/rotating_frame.hpp"

#include "mac/grid/effects.hpp"

namespace weir::mac {

namespace {

template <int D>
class RotatingFrame final : public MacEffect<D> {
public:
    RotatingFrame(const scene::Table& table, const scene::Scene& scene) : frame_(table, scene), cfl_(scene.number("time.cfl")) {}
    Stage stage() const override { return Stage::force; }
    void apply(MacState<D>& s, real dt) override {
        const auto roll = frame_.at(s.time + dt);  // forces act where the liquid has moved to (free_surface/leapfrog.hpp)
        push(s, roll, dt / 2, -frame_.gravity());
        turn(s, frame_.p(), frame_.q(), dt * roll.rate);
        turn(s, frame_.q(), frame_.p(), -2 * dt * roll.rate);
        turn(s, frame_.p(), frame_.q(), dt * roll.rate);
        push(s, roll, dt / 2, frame_.gravity());
    }
    real max_dt(const MacState<D>& s) const override {
        Vec<D> hi = s.u.origin;
        for (int d = 0; d < D; ++d) hi[d] += s.u.h[d] * s.u.cells[d];
        real h = s.u.h[0];
        for (int d = 1; d < D; ++d) h = std::min(h, s.u.h[d]);
        return acceleration_limit(frame_.most(s.u.origin, hi), h, cfl_);
    }

private:
    void push(MacState<D>& s, const geometry::Roll& roll, real dt, const Vec<D>& more) const {
        for (const int a : {frame_.p(), frame_.q()})
            for_each_free_face(s.u, s.sides, a, [&](const Index<D>& I) {
                s.u[a](I) += dt * (frame_.acceleration(roll, s.u.face_centre(a, I))[a] + more[a]);
            });
    }
    /// u_a += by u_b, the mean of the four nearest faces. Sides around the axis are walls: free faces have cells on both sides.
    static void turn(MacState<D>& s, int a, int b, real by) {
        if (by == 0) return;
        refresh(s.u[b], s.sides.periodic(D - 1));
        const Index<D> across = e<D>(b);
        for_each_free_face(s.u, s.sides, a, [&](const Index<D>& I) {
            const Index<D> lower = I - e<D>(a);
            s.u[a](I) += 0.25 * by * (s.u[b](lower) + s.u[b](lower + across) + s.u[b](I) + s.u[b](I + across));
        });
    }

    geometry::RotatingFrame<D> frame_;
    real cfl_;
};

}  // namespace

EffectKind rotating_frame() { return effect_kind<RotatingFrame>(geometry::rotating_frame_schema()); }

}  // namespace weir::mac
