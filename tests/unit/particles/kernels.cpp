// The kernels against mathematics: moments by GSL quadrature, derivatives by finite differences, lattice sums and neighbour counts
// against the reference tables (data/, computed with other tools).
#include "particles/state/kernels.hpp"

#include "support/csv.hpp"
#include "support/test.hpp"

#include <gsl/gsl_integration.h>

#include <functional>

namespace kernels_tests {

using namespace weir;
using namespace weir::particles;

namespace {

constexpr KernelKind all_kinds[] = {KernelKind::poly6, KernelKind::spiky, KernelKind::viscosity, KernelKind::cubic, KernelKind::wendland};

real integral(const std::function<real(real)>& f, real a, real b) {
    static gsl_integration_workspace* space = gsl_integration_workspace_alloc(1000);
    gsl_function g{[](double x, void* p) { return (*static_cast<const std::function<real(real)>*>(p))(x); },
                   const_cast<void*>(static_cast<const void*>(&f))};
    double result = 0, error = 0;
    gsl_integration_qags(&g, a, b, 1e-13, 1e-12, 1000, space, &result, &error);
    return result;
}

/// Integral over the ball, split at the cubic spline's knot, of weight(r) times the sphere's measure.
template <int D>
real ball(const std::function<real(real)>& weight, real h) {
    const auto shell = [&](real r) { return weight(r) * (D == 2 ? 2 * pi * r : 4 * pi * r * r); };
    return integral(shell, 0, h / 2) + integral(shell, h / 2, h);
}

}  // namespace

TEST_IN_2D_AND_3D("every kernel integrates to one, and its second moment is the published one") {
    const real h = 0.7;  // any support: the kernel must scale as h^-D
    const real second[5][2] = {
        {1 / 10.0, 1 / 11.0}, {1 / 14.0, 1 / 14.0}, {5 / 84.0, 3 / 56.0}, {31 / 392.0, 3 / 40.0}, {5 / 72.0, 1 / 15.0}};
    for (const auto kind : all_kinds) {
        const Kernel<D> w(kind, h);
        EXPECT_NEAR(ball<D>([&](real r) { return w.value(r); }, h), 1, 1e-10) << kernel_names()[static_cast<std::size_t>(kind)];
        EXPECT_NEAR(ball<D>([&](real r) { return w.value(r) * r * r / D; }, h) / (h * h), second[static_cast<int>(kind)][D - 2], 1e-10);
    }
}

TEST_IN_2D_AND_3D("the first moment vanishes by symmetry, and the gradient's first moment is minus the identity") {
    const real h = 0.7;
    for (const auto kind : all_kinds) {
        const Kernel<D> w(kind, h);
        // integral of x dW/dx = -1 for each axis: integration by parts of the zeroth moment
        EXPECT_NEAR(ball<D>([&](real r) { return w.derivative(r) * r / D; }, h), -1, 1e-10);
        // sum over a lattice symmetric about the centre of W x: odd, so exactly zero
        Vec<D> moment{};
        for (int i = -4; i <= 4; ++i)
            for (int j = -4; j <= 4; ++j) {
                if (i == 0 && j == 0) continue;
                Vec<D> x{};
                x[0] = 0.1 * i, x[1] = 0.1 * j;
                moment += w.value(norm(x)) * x;
            }
        EXPECT_NEAR(norm(moment), 0, 1e-13 * w.value(0.1));
    }
}

TEST_IN_2D_AND_3D("gradient and Laplacian agree with finite differences of the kernel") {
    const real h = 0.7, e = 1e-3;  // sixth and fourth order differences: truncation 1e-10 relative where the kernel is smooth
    for (const auto kind : all_kinds) {
        const Kernel<D> w(kind, h);
        for (const real q : {0.15, 0.3, 0.45, 0.6, 0.75, 0.9}) {
            const real r = q * h;
            const auto W = [&](int k) { return w.value(r + k * e * h); };
            const real first = (W(3) - 9 * W(2) + 45 * W(1) - 45 * W(-1) + 9 * W(-2) - W(-3)) / (60 * e * h);
            const real second =
                (2 * W(3) - 27 * W(2) + 270 * W(1) - 490 * W(0) + 270 * W(-1) - 27 * W(-2) + 2 * W(-3)) / (180 * e * e * h * h);
            EXPECT_NEAR(w.derivative(r), first, 1e-8 * w.scale() / h);
            EXPECT_NEAR(w.laplacian(r), second + (D - 1) * first / r, 1e-6 * w.scale() / (h * h));
        }
    }
}

TEST_IN_2D_AND_3D("value and slope vanish at the support, and nothing acts beyond it") {
    for (const auto kind : all_kinds) {
        const Kernel<D> w(kind, 2.0);
        EXPECT_NEAR(w.value(2 - 1e-9), 0, 1e-15);
        EXPECT_NEAR(w.derivative(2 - 1e-9), 0, 1e-8);
        EXPECT_EQ(w.value(2.0), 0);
        EXPECT_EQ(w.derivative(2.1), 0);
    }
}

TEST_IN_2D_AND_3D("what lies behind a plane is the integral of the planes behind it, and half the kernel lies behind its centre") {
    const real h = 0.7;
    for (const auto kind : all_kinds) {
        const Kernel<D> w(kind, h);
        EXPECT_NEAR(w.behind(0), 0.5, 1e-8);  // the viscosity kernel's pole at r = 0 costs the quadrature some digits
        for (const real q : {0.1, 0.35, 0.6, 0.85}) {
            const real behind = integral([&](real s) { return w.plane(s); }, q * h, h);
            EXPECT_NEAR(w.behind(q * h), behind, 1e-7);
        }
    }
}

TEST_IN_2D_AND_3D("lattice sums agree with the reference table to 1e-6") {
    const auto table = test::read_csv(WEIR_SOURCE_DIR "/tests/unit/particles/data/sph_lattice_density_sums.csv");
    const KernelKind columns[] = {KernelKind::poly6, KernelKind::spiky, KernelKind::cubic, KernelKind::wendland};
    int rows = 0;
    for (const auto& row : table) {
        if (static_cast<int>(row[0]) != D) continue;
        ++rows;
        for (std::size_t k = 0; k < 4; ++k) {
            const Kernel<D> w(columns[k], row[1]);  // lattice spacing 1
            real sum = 0;
            for (int i = -4; i <= 4; ++i)
                for (int j = -4; j <= 4; ++j)
                    for (int l = D == 2 ? 0 : -4; l <= (D == 2 ? 0 : 4); ++l) sum += w.value(std::sqrt(real(i * i + j * j + l * l)));
            EXPECT_NEAR(sum, row[2 + k], 1e-6);
        }
    }
    EXPECT_EQ(rows, 8);
}

}  // namespace kernels_tests
