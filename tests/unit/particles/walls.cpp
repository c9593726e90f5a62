// Where walls and solids stand near one particle: what each hides of the other by how they face, and that the gradient is one.
#include "particles/state/kernels.hpp"
#include "particles/threads/passes.hpp"

#include "support/test.hpp"

#include <cmath>

using namespace weir;
using namespace weir::particles;

namespace {

#define SCALAR double
#include "particles/kernels/prelude_double.h"
using plain::WallParams;
#include "particles/kernels/pair.inl"

struct Seen {
    double part, x, y;
};

/// At distance s of a floor and t of a plane whose inside lies along (way_x, way_y).
Seen seen(const Kernel<2>& kernel, double s, double t, double way_x, double way_y) {
    const double part[3] = {0, kernel.behind(s), 0}, lean[3] = {0, -part[1], 0};
    const double pull[3] = {0, -kernel.plane(s), 0}, steep[3] = {0, kernel.plane(s), 0};
    const double plane = kernel.plane(t), solid[4] = {plane * way_x, plane * way_y, 0, kernel.behind(t)};
    double out[4];
    walls_combined(part, lean, pull, steep, solid, out);
    return {out[3], out[0], out[1]};
}

}  // namespace

TEST("a floor and a solid that faces it hide nothing of each other, at right angles the product, facing the same way twice that") {
    const Kernel<2> kernel(KernelKind::cubic, 1.0);
    for (const double s : {0.0, 0.1, 0.35})
        for (const double t : {0.0, 0.2, 0.5}) {
            const double a = kernel.behind(s), b = kernel.behind(t);
            EXPECT_NEAR(seen(kernel, s, t, 0, 1).part, a + b, 1e-14);
            EXPECT_NEAR(seen(kernel, s, t, 0, 1).y, kernel.plane(t) - kernel.plane(s), 1e-12) << "both whole";
            EXPECT_NEAR(seen(kernel, s, t, 1, 0).part, a + b - a * b, 1e-14);
            EXPECT_NEAR(seen(kernel, s, t, 0, -1).part, a + b - 2 * a * b, 1e-14);
        }
    EXPECT_NEAR(seen(kernel, 0, 0, 0, -1).part, 0.5, 1e-14) << "the same wall twice is one wall";
}

TEST("what walls and solids add is a gradient, however a solid leans over a floor") {
    const Kernel<2> kernel(KernelKind::cubic, 1.0);
    for (const double angle : {0.0, 0.4, 1.1, 1.9, 2.8, 4.0, 5.5}) {
        const double c = std::cos(angle), d = std::sin(angle), s = 0.2, t = 0.3, step = 1e-5;
        const auto at = [&](double x, double y) { return seen(kernel, s + y, t - c * x - d * y, c, d); };
        const Seen here = at(0, 0);
        // central differences: step squared times third derivatives of some hundred
        EXPECT_NEAR(here.x, (at(step, 0).part - at(-step, 0).part) / (2 * step), 1e-7) << angle;
        EXPECT_NEAR(here.y, (at(0, step).part - at(0, -step).part) / (2 * step), 1e-7) << angle;
    }
}
