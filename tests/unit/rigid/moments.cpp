// Mass properties: closed formulas against quadrature, quadrature against what unions and differences are by hand.
#include "rigid/moments.hpp"

#include "support.hpp"
#include "support/temporary_folder.hpp"

#include <fstream>
#include <random>

namespace moments_tests {

using namespace weir;
using namespace weir::rigid;
using namespace weir::test;

namespace {

/// Greatest difference of two sets of moments, in units of the box around the shape.
template <int D>
real difference(const Moments<D>& a, const Moments<D>& b, const Bounds<D>& box) {
    real volume = 1, d = 0;
    const Vec<D> size = box.max - box.min;
    for (int k = 0; k < D; ++k) volume *= size[k];
    d = std::abs(a.volume - b.volume) / volume;
    for (int i = 0; i < D; ++i) {
        d = std::max(d, std::abs(a.centre[i] - b.centre[i]) / size[i]);
        for (int j = 0; j < D; ++j) {
            const auto k = static_cast<std::size_t>(i);
            d = std::max(d, std::abs(a.second[k][j] - b.second[k][j]) / (volume * size[i] * size[j]));
        }
    }
    return d;
}

template <int D>
std::vector<std::string> primitives() {
    if (D == 2)
        return {"shape = \"box\", min = [0.3, 0.5], max = [1.1, 0.8]", "shape = \"sphere\", centre = [1.0, 1.2], radius = 0.4",
                "shape = \"capsule\", from = [0.7, 0.6], to = [1.4, 1.1], radius = 0.25",
                "shape = \"cylinder\", from = [0.7, 0.6], to = [1.4, 1.1], radius = 0.25"};
    return {"shape = \"box\", min = [0.3, 0.5, 0.2], max = [1.1, 0.8, 1.5]", "shape = \"sphere\", centre = [1.0, 1.2, 0.9], radius = 0.4",
            "shape = \"capsule\", from = [0.7, 0.6, 0.5], to = [1.4, 1.1, 0.9], radius = 0.25",
            "shape = \"cylinder\", from = [0.7, 0.6, 0.5], to = [1.4, 1.1, 0.9], radius = 0.25"};
}

}  // namespace

TEST_IN_2D_AND_3D("the closed formulas of the primitives are what quadrature finds, to 1e-6") {
    for (const auto& text : primitives<D>()) {
        const auto table = shape_table(D, text);
        const auto box = bounds_of<D>(table);
        // 1e-7 is asked for of the integral over each axis; 1e-6 is what mass properties are to be good to.
        EXPECT_LT(difference<D>(moments_of<D>(table), integrate<D>(*geometry::make_shape<D>(table), box), box), 1e-6) << text;
    }
}

TEST_IN_2D_AND_3D("a difference is its whole less its hole, a union of overlapping halves is the whole, to 1e-6") {
    const std::string ball =
        D == 2 ? "shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5" : "shape = \"sphere\", centre = [1.0, 1.0, 1.0], radius = 0.5";
    const std::string hole =
        D == 2 ? "shape = \"box\", min = [0.9, 0.8], max = [1.2, 1.1]" : "shape = \"box\", min = [0.9, 0.8, 0.9], max = [1.2, 1.1, 1.2]";
    const auto whole = moments_of<D>(shape_table(D, ball)), cut = moments_of<D>(shape_table(D, hole));
    const auto table = shape_table(D, "shape = \"difference\", from = { " + ball + " }, minus = [ { " + hole + " } ]");
    const auto difference_found = moments_of<D>(table);
    Moments<D> expected;
    expected.volume = whole.volume - cut.volume;
    expected.centre = (whole.volume * whole.centre - cut.volume * cut.centre) / expected.volume;
    for (std::size_t a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
            const auto about = [&](const Moments<D>& m) {  // the expected centre
                return m.second[a][b] + m.volume * (m.centre[a] - expected.centre[a]) * (m.centre[b] - expected.centre[b]);
            };
            expected.second[a][b] = about(whole) - about(cut);
        }
    EXPECT_LT(difference<D>(difference_found, expected, bounds_of<D>(table)), 1e-6);

    const std::string left = D == 2 ? "min = [0.2, 0.5], max = [0.9, 0.8]" : "min = [0.2, 0.5, 0.1], max = [0.9, 0.8, 0.3]";
    const std::string right = D == 2 ? "min = [0.5, 0.5], max = [1.3, 0.8]" : "min = [0.5, 0.5, 0.1], max = [1.3, 0.8, 0.3]";
    const std::string both = D == 2 ? "min = [0.2, 0.5], max = [1.3, 0.8]" : "min = [0.2, 0.5, 0.1], max = [1.3, 0.8, 0.3]";
    const auto united = shape_table(D, "shape = \"union\", of = [ { shape = \"box\", " + left + " }, { shape = \"box\", " + right + " } ]");
    EXPECT_LT(difference<D>(moments_of<D>(united), moments_of<D>(shape_table(D, "shape = \"box\", " + both)), bounds_of<D>(united)), 1e-6);
}

TEST(
    "a scaled and turned mesh has the moments of the box that it is: volumes with the third power of the scale, second moments with the "
    "fifth") {
    const TemporaryFolder folder;
    const auto file = folder.path() / "box.obj";
    std::ofstream obj(file);
    for (int c = 0; c < 8; ++c) obj << "v " << (c & 1 ? 0.6 : 0.1) << ' ' << (c & 2 ? 0.5 : 0.2) << ' ' << (c & 4 ? 0.9 : 0.7) << '\n';
    obj << "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";
    obj.close();
    for (const real scale : {0.5, 1.0, 2.0}) {
        const auto found = moments_of<3>(shape_table(
            3, fmt::format("shape = \"mesh\", file = \"{}\", scale = {}, at = [1.0, 1.2, 0.3], axis = [0.0, 0.0, 1.0], angle = {:.17g}",
                           file.string(), scale, 0.5 * pi)));
        // Turned by a quarter about z: what was along x lies along y. 0.5 x 0.3 x 0.2 m; files and moments have double precision.
        const real s3 = scale * scale * scale, volume = 0.03 * s3;
        EXPECT_NEAR(found.volume, volume, 1e-14 * s3) << scale;
        const std::array<real, 3> edges{0.3 * scale, 0.5 * scale, 0.2 * scale};
        for (std::size_t a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
                EXPECT_NEAR(found.second[a][b], static_cast<int>(a) == b ? volume * edges[a] * edges[a] / 12 : 0, 1e-13 * volume) << scale;
    }
}

TEST("a half space and a wave have no end") {
    EXPECT_FALSE(bounds_of<2>(shape_table(2, "shape = \"plane\", point = [0, 0], normal = [0, 1]")).finite());
    EXPECT_FALSE(bounds_of<2>(shape_table(2, "shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1.0")).finite());
}

}  // namespace moments_tests
