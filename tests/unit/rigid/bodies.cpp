// What a scene says of bodies becomes bodies; what cannot be is refused.
#include "support.hpp"

namespace bodies_tests {

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

TEST("a turn carries a box through space as far as its corners, a ball with free slip not at all, one off its centre by as much as that") {
    const auto speed = [](const std::string& shape) {
        Bodies<2> bodies(body_scene(2, "bodies = [ { density = 1.0, spin = [3.0], velocity = [0.5, 0.0], " + shape + " } ]"));
        return bodies[0].max_speed();
    };
    const std::string ball = "shape = \"sphere\", centre = [2.0, 2.0], radius = 0.5";
    EXPECT_EQ(speed(ball), 0.5);
    EXPECT_NEAR(speed(ball + ", centre_of_mass = [2.0, 1.8]"), 0.5 + 3 * 0.2, 1e-15);
    EXPECT_NEAR(speed(ball + ", slip = \"no\""), 0.5 + 3 * std::sqrt(0.5), 1e-15);  // it takes the fluid along: to its box's corners
    EXPECT_NEAR(speed("shape = \"box\", min = [1.0, 1.0], max = [1.6, 1.8]"), 0.5 + 3 * 0.5, 1e-15);
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

TEST("a body that begins through a wall, in a solid or in another body is refused with both names and the depth; one that touches is not") {
    const auto says = [](int dim, const std::string& lines, const std::string& words) {
        const std::string text = refusal(dim, lines);
        EXPECT_NE(text.find(words), std::string::npos) << lines << '\n' << text;
    };
    const std::string ball = "bodies = [ { name = \"float\", shape = \"sphere\", radius = 0.5, density = 1.0, centre = ";
    says(2, ball + "[1.0, 3.6] } ]", "bodies[0] (\"float\") overlaps the wall y_max at y = 4 m by 0.1 m");
    says(2, ball + "[1.0, 3.6], fixed = [\"x\", \"y\"] } ]", "overlaps the wall y_max at y = 4 m by 0.1 m");
    says(2, ball + "[0.3, 1.0] } ]", "overlaps the wall x_min at x = 0 m by 0.2 m");
    says(3, ball + "[1.0, 1.0, 3.75] } ]", "overlaps the wall z_max at z = 4 m by 0.25 m");
    says(2, ball + "[0.5, 3.5] } ]", "accepted");                                       // it touches two walls
    says(2, ball + "[1.0, 3.5004] } ]", "accepted");                                    // within a thousandth of its radius
    says(2, ball + "[1.0, 3.6], fixed = [\"x\", \"y\", \"turning\"] } ]", "accepted");  // nothing can push it
    for (const int dim : {2, 3}) {
        const std::string z = dim == 2 ? "" : ", 1.0", at = "[1.0, 1.0" + z + "] } ]\n";
        const auto box = [&](const std::string& low, const std::string& high) {
            return "solids = [ { shape = \"box\", min = [" + low + (dim == 2 ? "" : ", 0.0") + "], max = [" + high +
                   (dim == 2 ? "" : ", 4.0") + "] } ]";
        };
        says(dim, ball + at + box("0.0, 0.0", "4.0, 0.6"), "bodies[0] (\"float\") overlaps solids[0] by 0.1 m");
        says(dim, ball + at + box("0.0, 0.0", "4.0, 0.5"), "accepted");
        says(dim, ball + at + box("0.0, 0.0", "4.0, 4.0"), "overlaps solids[0] by ");   // it is wholly inside
        says(dim, ball + at + box("0.97, 0.7", "1.0, 1.9"), "overlaps solids[0] by ");  // a plate through it
        says(dim, ball + at + box("0.0, 1.2", "0.9, 1.23"), "overlaps solids[0] by ");
    }
    // Two bars that cross away from where they have contact spheres: 0.01 m is the width of each.
    says(2,
         "bodies = [ { shape = \"box\", min = [1.0, 1.0], max = [3.0, 1.01], density = 1.0 }, "
         "{ shape = \"box\", min = [1.3, 0.2], max = [1.31, 3.0], density = 1.0 } ]",
         "bodies[0] and bodies[1] overlap by 0.009");
    // A solid counts where it is at t = 0, turned as its motion says.
    says(2,
         ball +
             "[2.0, 1.0] } ]\nsolids = [ { shape = \"box\", min = [0.5, 2.9], max = [3.5, 3.1], motion = { kind = \"keyframes\", centre = "
             "[2.0, 3.0], frames = [ { t = 0.0, angle = 1.5707963 }, { t = 1.0 } ] } } ]",
         "accepted");
    says(2,
         ball +
             "[2.0, 1.1] } ]\nsolids = [ { shape = \"box\", min = [0.5, 2.9], max = [3.5, 3.1], motion = { kind = \"keyframes\", centre = "
             "[2.0, 3.0], frames = [ { t = 0.0, angle = 1.5707963 }, { t = 1.0 } ] } } ]",
         "overlaps solids[0] by");
}

TEST("what cannot be a body is refused, with the reason") {
    const auto says = [](int dim, const std::string& line, const std::string& words) {
        const std::string text = refusal(dim, line);
        EXPECT_NE(text.find(words), std::string::npos) << text;
    };
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5 } ]", "neither density nor mass");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, mass = 1.0, density = 1.0 } ]", "a mass and a density");
    says(2, "bodies = [ { shape = \"plane\", point = [1.0, 1.0], normal = [0.0, 1.0], density = 1.0 } ]", "is unbounded");
    says(2, "bodies = [ { shape = \"sphere\", centre = [9.0, 1.0], radius = 0.5, density = 1.0 } ]", "outside the domain");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0, spin = [0.0, 0.0, 1.0] } ]",
         "in 2D a body turns");
    says(3, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0, 1.0], radius = 0.5, density = 1.0, spin = [1.0] } ]", "about x, y and z");
    says(2, "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0, fixed = [\"z\"] } ]", "dim = 2");
    says(2,
         "bodies = [ { shape = \"sphere\", centre = [1.0, 1.0], radius = 0.5, density = 1.0 }, { shape = \"sphere\", centre = [1.4, 1.0], "
         "radius "
         "= 0.5, density = 1.0 } ]",
         "overlap by");
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
    for (int i = 0; i < 7; ++i) one[0].advance_free(0.013, {});
    Checkpoint checkpoint;
    one.save(checkpoint);
    two.restore(checkpoint);
    for (int i = 0; i < 7; ++i) one[0].advance_free(0.013, {}), two[0].advance_free(0.013, {});
    EXPECT_EQ(one[0].at, two[0].at);
    EXPECT_EQ(one[0].orientation, two[0].orientation);
    EXPECT_EQ(one[0].velocity, two[0].velocity);
}

}  // namespace bodies_tests
