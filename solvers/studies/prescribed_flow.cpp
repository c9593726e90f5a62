#include "studies/prescribed_flow.hpp"

#include <stdexcept>

namespace weir::studies {

template <int D>
scene::Key PrescribedFlow<D>::key() {
    using scene::Type;
    const scene::Key period{.name = "period",
                            .type = Type::number,
                            .doc = "Period after which every point returns.",
                            .unit = "s",
                            .required = true,
                            .min = 0,
                            .min_open = true};
    scene::Key key{.name = "flow",
                   .type = Type::table,
                   .doc = "The velocity that carries the fields.",
                   .required = true,
                   .selector = "name",
                   .example = "flow = { name = \"rotation\" }"};
    key.variants = {
        {"constant",
         "The same velocity everywhere.",
         {{.name = "value", .type = Type::numbers, .doc = "The velocity.", .unit = "m/s", .required = true, .length = -1}}},
        {"rotation",
         "Rigid rotation about `centre` (and the z axis).",
         {{.name = "centre", .type = Type::numbers, .doc = "Centre.", .unit = "m", .fallback = std::vector<double>{0.5}, .length = -1},
          {.name = "rate", .type = Type::number, .doc = "Anticlockwise.", .unit = "rad/s", .fallback = 2 * pi}}},
        {"single_vortex", "psi = sin^2(pi x) sin^2(pi y) cos(pi t / period) / pi: LeVeque 1996, Rider & Kothe 1998.", {period}},
        {"enright", "The 3D deformation of LeVeque 1996, used by Enright et al. 2002.", {period}}};
    return key;
}

template <int D>
PrescribedFlow<D>::PrescribedFlow(const scene::Table& table) {
    const std::string& name = table.text("name");
    if (name == "constant") {
        kind_ = Kind::constant;
        constant_ = table.vec<D>("value");
    } else if (name == "rotation") {
        kind_ = Kind::rotation;
        centre_ = table.vec<D>("centre");
        rate_ = table.number("rate");
    } else {
        kind_ = name == "enright" ? Kind::enright : Kind::single_vortex;
        period_ = table.number("period");
    }
}

template <int D>
Vec<D> PrescribedFlow<D>::operator()(const Vec<D>& x, real t) const {
    Vec<D> u{};
    if (kind_ == Kind::constant) return constant_;
    if (kind_ == Kind::rotation) {
        u[0] = -rate_ * (x[1] - centre_[1]);
        u[1] = rate_ * (x[0] - centre_[0]);
        return u;
    }
    const real turn = std::cos(pi * t / period_), sx = std::sin(pi * x[0]), sy = std::sin(pi * x[1]);
    if (kind_ == Kind::single_vortex || D == 2) {
        u[0] = -2 * turn * sx * sx * sy * std::cos(pi * x[1]);
        u[1] = 2 * turn * sy * sy * sx * std::cos(pi * x[0]);
        return u;
    }
    const real sz = std::sin(pi * x[D - 1]), s2x = std::sin(2 * pi * x[0]), s2y = std::sin(2 * pi * x[1]),
               s2z = std::sin(2 * pi * x[D - 1]);
    u[0] = 2 * turn * sx * sx * s2y * s2z;
    u[1] = -turn * s2x * sy * sy * s2z;
    u[D - 1] = -turn * s2x * s2y * sz * sz;
    return u;
}

template <int D>
PrescribedBacktrace<D>::PrescribedBacktrace(const PrescribedFlow<D>& flow, const MacVelocity<D>& grid, const geometry::Sides<D>& sides,
                                            const std::string& scheme)
    : flow_(flow), h_(grid.h), origin_(grid.origin), domain_(grid.cells, sides), rk_(tableau(scheme)) {}

template <int D>
void PrescribedBacktrace<D>::row(int home_axis, const Index<D>& first, int count, real dt, Displacement<D>& to) const {
    to.near = false;
    const real from = dt > 0 ? start_ + length_ : start_;
    for (int i = 0; i < count; ++i) {
        Vec<D> home;
        for (int d = 0; d < D; ++d) home[d] = origin_[d] + h_[d] * (first[d] + (d == 0 ? i : 0) + (d == home_axis ? 0 : 0.5));
        Vec<D> k = flow_(home, from), sum = rk_.b[0] * k;
        for (int s = 1; s < rk_.stages; ++s) {
            const auto stage = static_cast<std::size_t>(s);
            k = flow_(home - rk_.c[stage] * dt * k, from - rk_.c[stage] * dt);
            sum += rk_.b[stage] * k;
        }
        for (int d = 0; d < D; ++d) to.d[d][i] = -dt * sum[d] / h_[d];
    }
    domain_.keep_inside(home_axis, first, count, to);
}

template class PrescribedFlow<2>;
template class PrescribedFlow<3>;
template class PrescribedBacktrace<2>;
template class PrescribedBacktrace<3>;

}  // namespace weir::studies
