// What a scene says of bodies becomes bodies; what cannot be is refused.
#include "support.hpp"

using namespace weir;
using namespace weir::rigid;
using namespace weir::test;

namespace {

std::string refusal(int dim, const std::string& lines) {
    try {
        const auto scene = body_scene(dim, lines);
        if (dim == 2)
            Bodies<2> bodies(scene);
        else
            Bodies<3> bodies(scene);
    } catch (const BadInput& e) {
        return e.what();
    }
    return "accepted";
}

}  // namespace

TEST("mass and moments of inertia are those of the textbook") {
    Bodies<3> bodies(body_scene(3,
                                "bodies = [ { shape = \"box\", min = [1.0, 1.0, 1.0], max = [2.0, 1.5, 1.2], density = 500.0 }, { shape = "
                                "\"sphere\", centre = [3.0, 3.0, 3.0], radius = 0.3, mass = 7.0 } ]"));
    EXPECT_NEAR(bodies[0].mass, 50.0, 1e-12);
    const auto m = bodies[0].mass_matrix();
    EXPECT_NEAR(m[3][3], 50.0 * (0.25 + 0.04) / 12, 1e-12);
    EXPECT_NEAR(m[4][4], 50.0 * (1 + 0.04) / 12, 1e-12);
    EXPECT_NEAR(m[5][5], 50.0 * (1 + 0.25) / 12, 1e-12);
    EXPECT_NEAR(bodies[1].mass_matrix()[4][4], 0.4 * 7.0 * 0.09, 1e-12);
    Bodies<2> flat(
        body_scene(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, mass = 3.0, centre_of_mass = [1.0, 0.8] } ]"));
    EXPECT_NEAR(flat[0].mass_matrix()[2][2], 3.0 * (0.5 * 0.25 + 0.04), 1e-12);  // Steiner
}

TEST("the inertia tensor turns with the body") {
    Bodies<3> bodies(body_scene(3, "bodies = [ { shape = \"box\", min = [1.0, 1.0, 1.0], max = [2.0, 1.5, 1.2], density = 500.0 } ]"));
    const auto before = bodies[0].mass_matrix();
    bodies[0].orientation = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // a quarter turn about z
    const auto after = bodies[0].mass_matrix();
    EXPECT_NEAR(after[3][3], before[4][4], 1e-12);
    EXPECT_NEAR(after[4][4], before[3][3], 1e-12);
    EXPECT_NEAR(after[5][5], before[5][5], 1e-12);
}

TEST("what cannot be a body is refused, with the reason") {
    const auto says = [](int dim, const std::string& line, const std::string& words) {
        const std::string text = refusal(dim, line);
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5 } ]", "neither density nor mass");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, mass = 1.0, density = 1.0 } ]", "a mass and a density");
    says(2, "bodies = [ { shape = \"plane\", point = [1.0, 1.0], normal = [0.0, 1.0], density = 1.0 } ]", "has no end");
    says(2, "bodies = [ { shape = \"sphere\", centre = [9.0, 1.0], radius = 0.5, density = 1.0 } ]", "outside the domain");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0, spin = [0.0, 0.0, 1.0] } ]",
         "in 2D a body turns");
    says(3, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0, 1.0], radius = 0.5, density = 1.0, spin = [1.0] } ]", "about x, y and z");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0, fixed = [\"z\"] } ]", "dim = 2");
    says(2,
         "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0 }, { shape = \"sphere\", centre = [1.4, 1.0], "
         "radius "
         "= 0.5, density = 1.0 } ]",
         "in the same place");
    says(2, "grid.periodic = [\"x\"]\nbodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0 } ]", "periodic");
    says(2, "bodies = [ { shape = \"box\", min = [1.0, 1.0], max = [0.5, 2.0], density = 1.0 } ]", "not above its min");
}

TEST_IN_2D_AND_3D("a checkpoint brings bodies back bit for bit") {
    const std::string line =
        D == 2
            ? "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.2, density = 2.0, velocity = [1.0, 3.0], spin = [0.7] } ]"
            : "bodies = [ { shape = \"box\", min = [1.0, 1.0, 1.0], max = [1.5, 1.7, 1.2], density = 2.0, velocity = [1.0, 3.0, "
              "0.5], spin = [0.3, 0.2, 2.0] } ]";
    Bodies<D> one(body_scene(D, line)), two(body_scene(D, line));
    for (int i = 0; i < 7; ++i) one[0].fly(0.013, {});
    Checkpoint checkpoint;
    one.save(checkpoint);
    two.restore(checkpoint);
    for (int i = 0; i < 7; ++i) one[0].fly(0.013, {}), two[0].fly(0.013, {});
    EXPECT_EQ(one[0].at, two[0].at);
    EXPECT_EQ(one[0].orientation, two[0].orientation);
    EXPECT_EQ(one[0].velocity, two[0].velocity);
}
