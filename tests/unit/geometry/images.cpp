// Solids at periodic sides: what leaves through one comes in through the other.
#include "geometry/solids.hpp"

#include "support/test.hpp"

#include <fmt/format.h>

namespace images_tests {

using namespace weir;
using namespace weir::geometry;

namespace {

template <int D>
scene::Scene scene_of(const std::string& periodic, const std::string& solids) {
    static const std::vector<scene::SolverSchema> schemas{{.name = "none", .doc = "Solids alone."}};
    return scene::parse(fmt::format("solver = \"none\"\ndim = {}\ngrid = {{ cells = {}, size = {}, origin = {}, periodic = [{}] }}\n"
                                    "time = {{ end = 1.0 }}\nsolids = [ {} ]\n",
                                    D, D == 2 ? "[20, 10]" : "[20, 10, 10]", D == 2 ? "[2.0, 1.0]" : "[2.0, 1.0, 1.0]",
                                    D == 2 ? "[-0.5, 0.0]" : "[-0.5, 0.0, 0.0]", periodic, solids),
                        "solids.toml", schemas);
}

template <int D>
std::string ball(real x, const std::string& motion) {
    return fmt::format("{{ shape = \"sphere\", centre = {}, radius = 0.2{} }}",
                       D == 2 ? fmt::format("[{}, 0.5]", x) : fmt::format("[{}, 0.5, 0.5]", x), motion);
}

template <int D>
Vec<D> at(real x, real y) {
    Vec<D> p = Vec<D>::constant(0.5);
    p[0] = x, p[1] = y;
    return p;
}

/// Along x, of a ball at `centre` that is repeated every 2 m.
real repeated(real x, real y, real centre) {
    real d = infinity;
    for (int k = -20; k <= 20; ++k) d = std::min(d, std::hypot(x - centre - 2 * k, y - 0.5) - 0.2);
    return d;
}

}  // namespace

TEST_IN_2D_AND_3D("a solid that moves through periodic sides is there a period on, at any time, with its velocity") {
    Solids<D> solids(scene_of<D>("\"x\"", ball<D>(1.2, std::string(", motion = { kind = \"constant\", velocity = ") +
                                                           (D == 2 ? "[0.7, 0.0]" : "[0.7, 0.0, 0.0]") + " }")));
    EXPECT_EQ(solids.count(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(solids.in_list(i), 0u);
    for (const real t : {0.0, 0.3, 0.43, 1.0, 2.9, 17.1})  // over the side at 0.14, after 17.1 s six times through
        for (real x = -0.5; x <= 1.5; x += 0.05)
            for (const real y : {0.05, 0.5, 0.71}) {
                solids.set_time(t);
                EXPECT_NEAR(solids.distance(at<D>(x, y)), repeated(x, y, 1.2 + 0.7 * t), 1e-13) << t << ' ' << x;  // of 12 m
                EXPECT_EQ(solids.velocity(at<D>(x, y))[0], 0.7);
            }
}

TEST_IN_2D_AND_3D("the points of a solid that turns across a periodic side move as its image's do") {
    Solids<D> solids(scene_of<D>("\"x\"", ball<D>(1.45, std::string(", motion = { kind = \"rotation\", rate = 2.0") +
                                                            (D == 3 ? ", axis = [0.0, 0.0, 1.0]" : "") + " }")));
    solids.set_time(0.4);
    const Vec<D> here = solids.velocity(at<D>(1.5, 0.6)), there = solids.velocity(at<D>(-0.5, 0.6));  // one place
    EXPECT_NEAR(norm(here - there), 0, 1e-14);
    EXPECT_NEAR(here[0], -2.0 * 0.1, 1e-14);
    EXPECT_NEAR(here[1], 2.0 * 0.05, 1e-14);
}

TEST_IN_2D_AND_3D("a solid that stands across a periodic side closes both ends; one that stands clear of them has no image") {
    Solids<D> across(scene_of<D>("\"x\"", ball<D>(1.4, "")));
    EXPECT_NEAR(across.distance(at<D>(-0.45, 0.5)), -0.05, 1e-15);
    EXPECT_NEAR(across.distance(at<D>(1.5, 0.5)), across.distance(at<D>(-0.5, 0.5)), 1e-15);
    Solids<D> clear(scene_of<D>("\"x\"", ball<D>(0.5, "")));
    EXPECT_EQ(clear.count(), 1u);
    Solids<D> walled(scene_of<D>(
        "", ball<D>(1.4, ", motion = { kind = \"constant\", velocity = [0.7" + std::string(D == 2 ? "" : ", 0.0") + ", 0.0] }")));
    EXPECT_EQ(walled.count(), 1u);
    EXPECT_GT(walled.distance(at<D>(-0.45, 0.5)), 1.6);
}

TEST_IN_2D_AND_3D("along two periodic axes there are images across the corners") {
    Solids<D> solids(scene_of<D>("\"x\", \"y\"", ball<D>(1.4, std::string(", motion = { kind = \"constant\", velocity = ") +
                                                                  (D == 2 ? "[0.0, 0.5]" : "[0.0, 0.5, 0.0]") + " }")));
    solids.set_time(1.0);  // its middle is at (1.4, 1.0)
    for (const auto& [x, y] : {std::pair{1.4, 0.0}, {1.4, 1.0}, {-0.5, 0.0}, {-0.5, 1.0}})
        EXPECT_NEAR(solids.distance(at<D>(x, y)), (x > 0 ? 0.0 : 0.1) - 0.2, 1e-14) << x << ' ' << y;
}

}  // namespace images_tests
