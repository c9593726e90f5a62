// What a scene does not name costs nothing: no field, no pass, no byte, and no step allocates.
#include "support/count_allocations.hpp"
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

#include "core/parallel.hpp"
#include "tallcell/solver.hpp"
#include "water/solver.hpp"

namespace weir {

namespace {

using Names = std::vector<std::string>;

Names field_names(const Solver& solver) {
    Names names;
    for (const auto& field : solver.fields().fields) names.push_back(field.name);
    return names;
}
Names pass_names(const Solver& solver) {
    Names names;
    for (const auto& pass : solver.passes().list()) names.push_back(pass.name);
    return names;
}

const char* const stirred = "initial.velocity = { name = \"random\" }\n";

std::unique_ptr<Solver> make(int dim, const std::string& rest) {
    return smoke::kind().make(test::mac_scene(test::unit_box(dim, 16, stirred + rest)), {});
}

/// A tank of 1.5 m by 1 m (by 0.75 m) with a block of water in its lower left corner.
std::unique_ptr<Solver> make_water(int dim, const std::string& transfer, const std::string& width, const std::string& height) {
    const bool flat = dim == 2;
    const std::string text = "solver = \"mac_water\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = [24, 16" + (flat ? "" : ", 12") +
                             "], size = [1.5, 1.0" + (flat ? "" : ", 0.75") + "] }\ntime = { end = 9.0 }\nfluid = { density = 1000.0 }\n" +
                             "liquid = [ { shape = \"box\", min = " + test::list(dim, "0.0") + ", max = [" + width + ", " + height +
                             (flat ? "" : ", 0.75") + "] } ]\neffects = { gravity = { g = [0.0, -9.81" + (flat ? "" : ", 0.0") +
                             "] } }\nscheme = { transfer = \"" + transfer + "\" }\n";
    return water::kind().make(scene::parse(text, "water.toml", {water::kind().schema}), {});
}

/// Water 36 cells deep on tall cells, with a wave that moves knots of the columns up and down; `more` is added.
std::unique_ptr<Solver> make_tall(int dim, const std::string& scheme, const std::string& more) {
    const bool flat = dim == 2;
    const std::string text = "solver = \"tallcell\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = [24, 48" + (flat ? "" : ", 10") +
                             "], size = [0.75, 1.5" + (flat ? "" : ", 0.3125") +
                             "] }\ntime = { end = 9.0 }\nfluid = { density = 1000.0 }\n" +
                             "liquid = [ { shape = \"wave\", level = 1.13, amplitude = 0.12, wavelength = 0.75 } ]\n" +
                             "effects.gravity.g = [0.0, -9.81" + (flat ? "" : ", 0.0") + "]\nscheme = { " + scheme + " }\n" + more;
    return tallcell::kind().make(scene::parse(text, "tall.toml", {tallcell::kind().schema}), {});
}

}  // namespace

TEST_IN_2D_AND_3D("a scene without effects has velocity and pressure, and three passes") {
    const auto flow = make(D, "");
    flow->step(0.01);
    EXPECT_EQ(field_names(*flow), (Names{"velocity", "pressure"}));
    EXPECT_EQ(pass_names(*flow), (Names{"ghosts", "advect velocity", "project"}));
}

TEST_IN_2D_AND_3D("an effect brings the fields that it needs and no others; two effects share theirs") {
    EXPECT_EQ(field_names(*make(D, "effects = { gravity = { g = " + test::list(D, "0.0") + " } }")), (Names{"velocity", "pressure"}));
    EXPECT_EQ(field_names(*make(D, "effects = { buoyancy = { beta = 1.0 } }")), (Names{"velocity", "pressure", "temperature"}));
    EXPECT_EQ(field_names(*make(D, "effects = { buoyancy = { alpha = 1.0 } }")), (Names{"velocity", "pressure", "smoke"}));
    EXPECT_EQ(field_names(*make(D, "effects = { buoyancy = { beta = 1.0 }, cooling = { rate = 1.0 }, diffusion = { temperature = 0.1 } }")),
              (Names{"velocity", "pressure", "temperature"}));
}

TEST_IN_2D_AND_3D("memory grows only with what is named") {
    const auto bytes = [&](const std::string& rest) {
        const auto flow = make(D, rest);
        flow->step(0.01);
        return flow->bytes();
    };
    const auto plain = bytes("");
    EXPECT_EQ(bytes("effects = { gravity = { g = " + test::list(D, "1.0") + " } }"), plain);
    EXPECT_GT(bytes("effects = { confinement = { epsilon = 0.1 } }"), plain);
    EXPECT_GT(bytes("effects = { buoyancy = { alpha = 1.0 } }"), plain);
}

TEST_IN_2D_AND_3D("an effect of strength zero changes no bit") {
    const auto without = make(D, ""),
               with = make(D, "effects = { gravity = { g = " + test::list(D, "0.0") + " }, confinement = { epsilon = 0.0 } }");
    for (int i = 0; i < 3; ++i) without->step(0.01), with->step(0.01);
    EXPECT_TRUE(test::same_bits(*without, *with));
}

TEST_IN_2D_AND_3D("after the first, a step allocates nothing, whatever the scheme and the effects") {
    set_threads(1);  // OpenMP's runtime allocates when it makes its threads
    const std::string all =
        "fluid = { viscosity = 0.01 }\neffects = { buoyancy = { alpha = 1.0, beta = 1.0 }, confinement = { epsilon = 0.1 }, "
        "viscosity = {}, diffusion = { smoke = 0.01 }, decay = { rate = 0.1 } }\n"
        "emitters = [ { shape = \"sphere\", centre = " +
        test::list(D, "0.3") +
        ", radius = 0.2, smoke = 1.0 } ]\n"
        "solids = [ { shape = \"sphere\", centre = " +
        test::list(D, "0.7") + ", radius = 0.2 } ]\n";
    for (const char* advection : {"semi_lagrangian", "maccormack", "conservative"})
        for (const std::string& rest : {std::string(), all}) {
            const auto flow = make(D, std::string("scheme = { advection = \"") + advection + "\" }\n" + rest);
            flow->step(0.01);
            const long before = test::allocations;
            flow->step(0.01);
            flow->step(0.01);
            EXPECT_EQ(test::allocations - before, 0) << advection << (rest.empty() ? " alone" : " with everything");
        }
}

TEST_IN_2D_AND_3D("a step of water allocates nothing after the first while its surface keeps its length") {
    set_threads(1);
    for (const char* transfer : {"grid", "pic", "flip", "apic"}) {
        const auto water = make_water(D, transfer, "0.5", "0.5");
        water->step(0.001);
        const long before = test::allocations;
        for (int i = 0; i < 5; ++i) water->step(0.001);
        EXPECT_EQ(test::allocations - before, 0) << transfer;
    }
}

TEST_IN_2D_AND_3D("a step on tall cells allocates nothing after the first while columns keep their knots") {
    set_threads(1);
    for (const char* columns : {"stacked", "single", "uniform"})
        for (const char* advection : {"maccormack", "semi_lagrangian"})
            for (const std::string& more : {std::string(), std::string("effects.volume_control = {}\n")}) {
                const auto water = make_tall(D, std::string("columns = \"") + columns + "\", advection = \"" + advection + "\"", more);
                water->step(0.001);
                const long before = test::allocations;
                for (int i = 0; i < 5; ++i) water->step(0.001);
                EXPECT_EQ(test::allocations - before, 0) << columns << ' ' << advection << ' ' << more;
            }
}

// Lists get an eighth more room at least each time that they need more. There are 25 to each of the six levels of this tank's hierarchy and
// 30 besides, and they go with the rows that columns share, 30 at least and 48 at most: four times an eighth.
TEST_IN_2D_AND_3D("as a wave moves knots, steps on tall cells allocate only where lists grow") {
    set_threads(1);
    const auto water = make_tall(D, "columns = \"stacked\"", "");
    const auto unknowns = [&] {
        for (const auto& value : water->integrals())
            if (value.name == "pressure_unknowns") return value.value;
        return real{0};
    };
    water->step(0.01);
    const real at_first = unknowns();
    bool knots_moved = false;
    long allocated = 0;
    for (int i = 0; i < 100; ++i) {  // of a period of 0.69 s and a half
        const long before = test::allocations;
        water->step(0.01);
        allocated += test::allocations - before;
        knots_moved = knots_moved || unknowns() != at_first;
    }
    EXPECT_TRUE(knots_moved);
    EXPECT_LE(allocated, 4 * (6 * 25 + 30));
}

// A vector grows only past twice its largest size so far. Some 40 vectors have the surface's, the spray's or the components' size; from the
// column to the most broken surface these grow to at most 16 times (4 doublings), and none ever grows again after its largest.
TEST_IN_2D_AND_3D("a breaking dam allocates only as its surface grows, by doubling") {
    set_threads(1);
    const auto water = make_water(D, "flip", "0.3", "0.7");
    water->step(0.004);
    const long before = test::allocations;
    for (int i = 0; i < 400; ++i) water->step(0.004);
    EXPECT_GT(test::allocations - before, 0) << "nothing grew: the scene does not show what it is for";
    EXPECT_LE(test::allocations - before, 40 * 4);
}

}  // namespace weir
