#include "support/test.hpp"
#include "unit/scene/schema.hpp"

#include <stdexcept>

namespace reading_tests {

using namespace weir;
using namespace weir::scene;

namespace {

const char* const small = R"(solver = "smoke"
dim = 2
grid = { cells = [64, 32], size = [2, 1.0] }
time = { end = 1.0 }
)";

Scene read_small(const std::string& more = "", const std::vector<Override>& overrides = {}) {
    return parse(small + more, "scene.toml", made_up::schemas(), overrides);
}

}  // namespace

TEST("values are read as what the schema says they are, whole numbers also where any number may stand") {
    const auto s = read_small("title = \"two boxes\"\nfluid.density = 1000\n");
    EXPECT_EQ(s.solver(), "smoke");
    EXPECT_EQ(s.dim(), 2);
    EXPECT_EQ(s.text("title"), "two boxes");
    EXPECT_EQ(s.number("fluid.density"), 1000);
    EXPECT_EQ(s.index<2>("grid.cells"), (Index<2>{64, 32}));
    EXPECT_EQ(s.vec<2>("grid.size"), (Vec<2>{2.0, 1.0}));
    EXPECT_EQ(s.integer("scheme.poisson.max_iterations"), 200);
    EXPECT_FALSE(s.flag("scheme.poisson.fixed"));
}

TEST("defaults are filled in, also in tables that the scene does not name") {
    const auto s = read_small();
    EXPECT_EQ(s.number("time.cfl"), 0.5);
    EXPECT_EQ(s.vec<2>("grid.origin"), (Vec<2>{0.0, 0.0}));
    EXPECT_EQ(s.number("fluid.viscosity"), 0);
    EXPECT_EQ(s.text("sides.x_min.kind"), "wall");
    EXPECT_EQ(s.text("sides.y_max.slip"), "free");
    EXPECT_EQ(s.text("scheme.poisson.method"), "multigrid");
    EXPECT_TRUE(s.root().tables("solids").empty());
}

TEST("what a scene does not give and the schema has no default for is absent") {
    const auto s = read_small();
    for (const char* path : {"time.dt", "initial.velocity", "sides.x_min.temperature", "sides.z_min", "output.every"})
        EXPECT_FALSE(s.has(path)) << path;
    EXPECT_EQ(s.effect("gravity"), nullptr);
    EXPECT_EQ(s.root().number_or("time.dt", 0.25), 0.25);
    EXPECT_EQ(s.root().text_or("initial.velocity.name", "rest"), "rest");
}

TEST("an effect that the scene names has its defaults, and others are not there") {
    const auto s = read_small("effects.buoyancy = {}\n");
    ASSERT_NE(s.effect("buoyancy"), nullptr);
    EXPECT_EQ(s.effect("buoyancy")->number("beta"), 0.1);
    EXPECT_EQ(s.effect("confinement"), nullptr);
}

TEST("reading a key that is not there, or as what it is not, is our mistake and no user's") {
    const auto s = read_small();
    EXPECT_THROW((void)s.number("time.dt"), std::logic_error);
    EXPECT_THROW((void)s.number("time.ent"), std::logic_error);
    EXPECT_THROW((void)s.number("solver"), std::logic_error);
    EXPECT_THROW((void)s.text("dim"), std::logic_error);
    EXPECT_THROW((void)s.root().table("grid.cells"), std::logic_error);
    EXPECT_THROW((void)s.root().tables("grid"), std::logic_error);
}

TEST("entries of lists of tables are reached by index in a path") {
    const auto s = read_small(R"([[solids]]
shape = "sphere"
centre = [1, 0.5]
radius = 0.1
[[solids]]
shape = "union"
of = [ { shape = "box", min = [0, 0], max = [1, 1] }, { shape = "difference", from = { shape = "sphere", centre = [0, 0], radius = 2 }, minus = [ { shape = "plane", point = [0, 0], normal = [1, 0] } ] } ]
motion = { kind = "rotation", rate = 3 }
)");
    EXPECT_EQ(s.number("solids[0].radius"), 0.1);
    EXPECT_FALSE(s.has("solids[0].motion"));
    EXPECT_FALSE(s.has("solids[2].radius"));
    EXPECT_EQ(s.number("solids[1].motion.rate"), 3);
    EXPECT_EQ(s.number("solids[1].of[1].from.radius"), 2);
    EXPECT_EQ(s.root().tables("solids")[1].tables("of")[1].tables("minus")[0].vec<2>("normal"), (Vec<2>{1.0, 0.0}));
}

TEST("every value knows its line and column, and a default has none") {
    const auto s = read_small("[effects.gravity]\ng = [0, -9.81]\n");
    EXPECT_EQ(s.root().place("grid.cells").line, 3);
    EXPECT_EQ(s.root().place("grid.cells").column, 18);
    EXPECT_EQ(s.root().place("effects.gravity.g").line, 6);
    EXPECT_EQ(s.root().place("effects.gravity.g").column, 5);
    EXPECT_EQ(s.root().place("time.cfl").line, 0);
}

TEST("a name in place of a table chooses what the table is") {
    const auto s = read_small("sides.x_max = \"outflow\"\nsides.x_min = { kind = \"inflow\", velocity = [1, 0] }\n");
    EXPECT_EQ(s.text("sides.x_max.kind"), "outflow");
    EXPECT_EQ(s.text("sides.x_min.profile"), "uniform");
}

TEST("open is another word for outflow") { EXPECT_EQ(read_small("sides.x_max = \"open\"\n").text("sides.x_max.kind"), "outflow"); }

TEST("an axis is periodic by grid.periodic or by both its sides, and both then say so") {
    for (const char* text : {"grid.periodic = [\"x\"]\n", "sides.x_min = \"periodic\"\nsides.x_max = \"periodic\"\n"}) {
        const std::string head = "solver = \"smoke\"\ndim = 2\ngrid.cells = [4, 4]\ngrid.size = [1, 1]\ntime.end = 1\n";
        const auto s = parse(head + text, "scene.toml", made_up::schemas());
        EXPECT_EQ(s.root().texts("grid.periodic"), std::vector<std::string>{"x"});
        EXPECT_EQ(s.text("sides.x_min.kind"), "periodic");
        EXPECT_EQ(s.text("sides.x_max.kind"), "periodic");
        EXPECT_EQ(s.text("sides.y_min.kind"), "wall");
    }
}

TEST("a solver's own keys lie over the common ones: another default, keys of its own") {
    const std::string text = std::string(small).replace(10, 5, "water") + "liquid = [{ shape = \"box\", min = [0, 0], max = [1, 1] }]\n";
    const auto s = parse(text, "scene.toml", made_up::schemas());
    EXPECT_EQ(s.number("time.cfl"), 1.0);
    EXPECT_EQ(s.integer("markers"), 2);
    EXPECT_EQ(s.number("time.end"), 1.0);
}

TEST("in 3D lists have three entries, and the sides along z are there") {
    const auto s = parse("solver = \"smoke\"\ndim = 3\ngrid = { cells = [4, 5, 6], size = [1, 1, 1] }\ntime.end = 1\n", "scene.toml",
                         made_up::schemas());
    EXPECT_EQ(s.index<3>("grid.cells"), (Index<3>{4, 5, 6}));
    EXPECT_EQ(s.root().numbers("grid.origin").size(), 3U);
    EXPECT_EQ(s.text("sides.z_max.kind"), "wall");
}

TEST("a scene written out reads back as the same scene") {
    const auto s = read_small(
        "title = \"quotes \\\" and \\\\ and \\u0007 and é\"\nfluid.viscosity = 1.2345678901234567e-5\neffects.gravity.g = [0.1, -9.81]\n"
        "solids = [{ shape = \"sphere\", centre = [1, 0.3333333333333333], radius = 1e-300, motion = { kind = \"constant\", velocity = [1, "
        "0] } }]\n");
    const auto again = parse(to_toml(s.root()), "again.toml", made_up::schemas());
    EXPECT_EQ(to_toml(again.root()), to_toml(s.root()));
    EXPECT_EQ(again.number("fluid.viscosity"), 1.2345678901234567e-5);
    EXPECT_EQ(again.number("solids[0].radius"), 1e-300);
    EXPECT_EQ(again.text("title"), s.text("title"));
}

TEST("a table is written as JSON") {
    Table inner, table;
    inner.set("x", 0.1);
    table.set("flag", true);
    table.set("count", std::int64_t{3});
    table.set("name", std::string("a \"b\"\n"));
    table.set("list", std::vector<double>{1, 2.5});
    table.set("of", std::vector<Table>{inner, Table{}});
    EXPECT_EQ(to_json(table), R"({"flag": true, "count": 3, "name": "a \"b\"\u000a", "list": [1, 2.5], "of": [{"x": 0.1}, {}]})");
}

TEST("any TOML can be read against any keys, not only scenes") {
    const std::vector<Key> keys = {{.name = "why", .type = Type::text, .required = true},
                                   {.name = "at_most", .type = Type::number, .fallback = 2.0}};
    const auto table = parse_table("why = \"formal order\"\n", "case.toml", keys);
    EXPECT_EQ(table.text("why"), "formal order");
    EXPECT_EQ(table.number("at_most"), 2);
    EXPECT_THROW((void)parse_table("wy = \"x\"\n", "case.toml", keys), BadScene);
}

}  // namespace reading_tests
