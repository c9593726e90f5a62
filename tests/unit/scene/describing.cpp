#include "core/error.hpp"
#include "scene/describe.hpp"
#include "support/test.hpp"
#include "unit/scene/schema.hpp"

namespace describing_tests {

using namespace weir;
using scene::made_up::schemas;

namespace {

std::string about(const char* topic) { return scene::describe(topic, schemas()); }

bool says(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST("a key is described with its type, unit, range and default") {
    EXPECT_EQ(about("fluid.density"),
              "fluid.density: a number [kg/m^3], greater than 0 kg/m^3; 1 if absent\n"
              "    Density.\n");
    EXPECT_EQ(about("scheme.poisson.method"),
              "scheme.poisson.method (solver \"smoke\"): \"multigrid\", \"cg\" or \"cholmod\"; \"multigrid\" if absent\n"
              "    Method.\n");
}

TEST("a shape is described with its keys") {
    EXPECT_EQ(about("sphere"),
              "shape \"sphere\"\n"
              "    A ball; a disc in 2D.\n"
              "    centre: a list of dim numbers [m]; required\n"
              "        Centre.\n"
              "    radius: a number [m], greater than 0 m; required\n"
              "        Radius.\n");
}

TEST("an effect is described once, though several solvers have it") {
    EXPECT_EQ(about("confinement"),
              "effect \"confinement\" of solvers \"smoke\" and \"water\"\n"
              "    Vorticity confinement.\n"
              "    epsilon: a number, at least 0; required\n"
              "        Strength.\n");
}

TEST("a key by its last name, a side, a motion and a solver are found") {
    EXPECT_TRUE(says(about("cfl"), "time.cfl: a number, greater than 0; 0.5 if absent"));
    EXPECT_TRUE(says(about("cfl"), "time.cfl (solver \"water\"): a number, greater than 0; 1 if absent"));
    EXPECT_TRUE(says(about("x_min"), "moving_wall"));
    EXPECT_TRUE(says(about("keyframes"), "frames: a list of tables; required"));
    EXPECT_TRUE(says(about("water"), "surface_tension"));
    EXPECT_TRUE(says(about(""), "Solvers:\n    smoke"));
}

TEST("a solver's own keys are those that it adds or changes") {
    const auto own = scene::own_keys(scene::made_up::water_schema());
    std::vector<std::string> paths;
    for (const auto& leaf : own.leaves) paths.push_back(leaf.path);
    EXPECT_EQ(paths, (std::vector<std::string>{"scheme.advection", "scheme.poisson.method", "scheme.poisson.tolerance",
                                               "scheme.poisson.max_iterations", "scheme.poisson.fixed", "time.cfl", "liquid", "markers"}));
    EXPECT_EQ(own.leaves[5].key.doc.substr(0, 10), "CFL number") << "what the common key says stays said";
}

TEST("an unknown topic names the nearest") {
    try {
        (void)about("gravty");
        FAIL();
    } catch (const BadInput& e) {
        EXPECT_STREQ(e.what(), "unknown name \"gravty\"; did you mean \"gravity\"?");
    }
}

TEST("the manual has a section for every key, shape, motion, solver and effect") {
    const auto text = scene::manual(schemas());
    for (const auto& key : scene::common_keys()) EXPECT_TRUE(says(text, ("`" + key.name + "`").c_str())) << key.name;
    for (const auto& v : scene::shapes()) EXPECT_TRUE(says(text, ("### `" + v.name + "`").c_str())) << v.name;
    for (const auto& v : scene::motions()) EXPECT_TRUE(says(text, ("### `" + v.name + "`").c_str())) << v.name;
    for (const auto& s : schemas()) {
        EXPECT_TRUE(says(text, ("### Solver `" + s.name + "`").c_str())) << s.name;
        for (const auto& e : s.effects) EXPECT_TRUE(says(text, ("#### `" + e.name + "`").c_str())) << e.name;
    }
}

}  // namespace describing_tests
