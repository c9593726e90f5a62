// Planes in cells: cut volumes, their inverse, normals.
#include "support.hpp"

#include <cmath>
#include <random>

namespace plane_tests {

using namespace weir;
using namespace weir::two_phase;

namespace {

/// Normals of all kinds: along axes, almost along axes, and in between.
template <int D>
std::vector<Vec<D>> normals() {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> uniform(-1, 1);
    std::vector<Vec<D>> list;
    for (int i = 0; i < 400; ++i) {
        Vec<D> m;
        real sum = 0;
        for (int d = 0; d < D; ++d) {
            m[d] = uniform(random);
            if (i % 4 == 1 && d == 0) m[d] *= 1e-7;
            if (i % 4 == 2 && d < D - 1) m[d] *= 1e-13;
            if (i % 4 == 3 && d == 1) m[d] = 0;
            sum += std::abs(m[d]);
        }
        list.push_back(m / sum);
    }
    return list;
}

const std::vector<real> fractions_to_try{1e-12, 1e-9, 1e-6, 1e-3, 0.03, 0.16, 0.25, 0.4, 0.5, 0.6, 0.87, 0.999, 1 - 1e-6, 1 - 1e-9};

}  // namespace

// Round-off: volumes and their terms are of order 1, and each formula has some ten operations.
TEST_IN_2D_AND_3D("a plane that was found for a fraction cuts off that fraction") {
    for (const auto& m : normals<D>())
        for (const real f : fractions_to_try) EXPECT_NEAR(volume_below(m, plane_constant(m, f)), f, 2e-15) << m[0] << ' ' << m[1];
}

TEST_IN_2D_AND_3D("the volumes below and above a plane add up to the cell, and a plane of opposite normal cuts off the rest") {
    for (const auto& m : normals<D>())
        for (const real f : fractions_to_try) {
            const real alpha = plane_constant(m, f);
            EXPECT_NEAR(volume_below(m, alpha) + volume_below(-m, -alpha), 1, 4e-15);
        }
}

// The sum of two boxes' volumes; each is exact to round-off in its own size.
TEST_IN_2D_AND_3D("the parts of a cell on both sides of any cut have together the liquid of the cell") {
    for (const auto& m : normals<D>())
        for (const real f : {1e-6, 0.1, 0.37, 0.5, 0.8})
            for (int axis = 0; axis < D; ++axis) {
                const Plane<D> plane{m, plane_constant(m, f)};
                Vec<D> lo{}, hi = Vec<D>::constant(1), cut = hi, from = lo;
                cut[axis] = from[axis] = 0.3;
                EXPECT_NEAR(0.3 * fraction_of_box(plane, lo, cut) + 0.7 * fraction_of_box(plane, from, hi), f, 1e-14);
            }
}

// Volumes by a grid of 200 lines per axis along x: each line is exact, and the integrand is continuous with kinks: 1/200² per kink.
TEST("cut volumes are those of a count over lines") {
    for (const auto& m : normals<3>())
        for (const real f : {0.05, 0.3, 0.6}) {
            const real alpha = plane_constant(m, f);
            real sum = 0;
            const int n = 200;
            for (int j = 0; j < n; ++j)
                for (int k = 0; k < n; ++k) {
                    const real rest = alpha - m[1] * (j + 0.5) / n - m[2] * (k + 0.5) / n;
                    if (m[0] == 0) {
                        sum += rest > 0;
                        continue;
                    }
                    const real x = rest / m[0];
                    sum += m[0] > 0 ? std::clamp(x, 0.0, 1.0) : 1 - std::clamp(x, 0.0, 1.0);
                }
            const bool steep = std::abs(m[0]) > 1e-3;  // otherwise lines are wholly in or out: 1/200 per line of the edge
            EXPECT_NEAR(sum / (n * n), f, steep ? 2e-4 : 1e-2);
        }
}

namespace {

template <int D>
Strides<D> strides() {
    Strides<D> stride{};
    for (int d = 0, n = 1; d < D; ++d, n *= 3) stride[static_cast<std::size_t>(d)] = n;
    return stride;
}

/// Fractions of 3^D cells around 0 below the plane m·(x − middle) = beta.
template <int D>
std::vector<real> stencil(const Vec<D>& m, real beta) {
    std::vector<real> f;
    for (int code = 0; code < (D == 2 ? 9 : 27); ++code) {
        real alpha = beta;
        for (int d = 0, rest = code; d < D; ++d, rest /= 3) alpha -= m[d] * (rest % 3 - 1 - 0.5);
        f.push_back(volume_below(m, alpha));
    }
    return f;
}

}  // namespace

// Exact where all columns along the steepest axis end within the three cells (Aulisa et al. 2007): slopes up to 1/3 through the middle.
TEST_IN_2D_AND_3D("the normal of a plane that cuts all columns of 3^D cells is exact") {
    for (int axis = 0; axis < D; ++axis)
        for (const real sign : {-1.0, 1.0})
            for (const real slope : {0.0, 0.1, 0.3}) {
                Vec<D> m = Vec<D>::constant(slope / (D - 1));
                m[axis] = sign;
                real sum = 0;
                for (int d = 0; d < D; ++d) sum += std::abs(m[d]);
                m = m / sum;
                const auto f = stencil<D>(m, 0.05);
                const std::size_t middle = D == 2 ? 4 : 13;
                const Vec<D> found = normal_at<D>(&f[middle], strides<D>());
                for (int d = 0; d < D; ++d) EXPECT_NEAR(found[d], m[d], 1e-14) << axis << ' ' << sign << ' ' << slope;
            }
}

TEST_IN_2D_AND_3D("normals of mirrored fractions are mirrored, to the last bit") {
    std::mt19937 random(3);
    std::uniform_real_distribution<real> uniform(0, 1);
    const std::size_t count = D == 2 ? 9 : 27, middle = count / 2;
    const Strides<D> stride = strides<D>();
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<real> f(count), g(count);
        for (real& value : f) value = uniform(random);
        for (std::size_t i = 0; i < count; ++i) g[i] = f[i - i % 3 + 2 - i % 3];
        const Vec<D> m = normal_at<D>(&f[middle], stride), n = normal_at<D>(&g[middle], stride);
        EXPECT_EQ(m[0], -n[0]);
        for (int d = 1; d < D; ++d) EXPECT_EQ(m[d], n[d]);
    }
}

}  // namespace plane_tests
