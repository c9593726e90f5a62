#include "waves/model.hpp"

namespace weir::waves {

void Model::fill(const Box& box, Sheet& sheet) {
    const auto nx = static_cast<std::size_t>(box.nx());
    for_own_rows(box, [&](int k) {
        for (int i = 0; i < box.nx(); ++i) {
            const std::size_t at = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(k);
            const Motion m = motion(box.x(i), box.z(k));
            sheet.height[at] = m.moved[1];
            if (!sheet.moved_x.empty()) sheet.moved_x[at] = m.moved[0], sheet.jacobian[at] = m.jacobian();
            if (!sheet.moved_z.empty()) sheet.moved_z[at] = m.moved[2];
            for (std::size_t a = 0; a < 3; ++a)
                if (!sheet.velocity[a].empty()) sheet.velocity[a][at] = m.velocity[a];
        }
    });
}

void Model::fill_water(const Box& box, real level, std::array<Values, 3>& out) {
    const auto nx = static_cast<std::size_t>(box.nx()), row = nx * static_cast<std::size_t>(box.ny());
    const PlaneRange rows{box.rows().lower(0), box.rows().upper(box.nz())}, layers = box.layers();
    const int deep = layers.end - layers.begin;
    parallel_for(0, deep * (rows.end - rows.begin), [&](int line) {
        const int j = layers.begin + line % deep, k = rows.begin + line / deep;
        for (int i = 0; i < box.nx(); ++i) {
            const Vec<3> u = velocity({{box.x(i), box.y(j) - level, box.z(k)}});
            const std::size_t at = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(j) + row * static_cast<std::size_t>(k);
            for (std::size_t a = 0; a < 3; ++a)
                if (!out[a].empty()) out[a][at] = u[a];
        }
    });
}

/// Newton's step where a patch keeps at least a twentieth of its area, otherwise the plain iteration x <- X - D(x). It converges to a rest
/// point for any surface whose displacement is shorter than its waves. Fifty steps suffice for steepness 0.9; the residual is not checked,
/// because the surface may be folded.
Vec<2> rest_of(const Model& model, real x, real z) {
    Vec<2> rest{{x, z}};
    if (!model.sideways()) return rest;
    constexpr real worth_newton = 0.05, enough = 1e-14;
    for (int i = 0; i < 50; ++i) {
        const Motion m = model.motion(rest[0], rest[1]);
        const real off_x = x - rest[0] - m.moved[0], off_z = z - rest[1] - m.moved[2], J = m.jacobian();
        if (J > worth_newton) {
            rest[0] += ((1 + m.zz) * off_x - m.xz * off_z) / J;
            rest[1] += ((1 + m.xx) * off_z - m.xz * off_x) / J;
        } else {
            rest[0] += off_x;
            rest[1] += off_z;
        }
        if (std::abs(off_x) + std::abs(off_z) <= enough * (std::abs(x) + std::abs(z) + std::abs(m.moved[0]) + std::abs(m.moved[2]))) break;
    }
    return rest;
}

}  // namespace weir::waves
