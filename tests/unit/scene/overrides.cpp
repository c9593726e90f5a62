#include "support/test.hpp"
#include "unit/scene/schema.hpp"

namespace overrides_tests {

using namespace weir;
using namespace weir::scene;

namespace {

Scene with(const std::vector<Override>& overrides) {
    return parse(R"(solver = "smoke"
dim = 2
grid = { cells = [64, 32], size = [2, 1.0] }
time = { end = 1.0 }
solids = [{ shape = "sphere", centre = [1, 0.5], radius = 0.1 }]
)",
                 "scene.toml", made_up::schemas(), overrides);
}

std::string refusal(const Override& change) {
    try {
        (void)with({change});
    } catch (const BadScene& e) {
        return e.what();
    }
    return "accepted";
}

}  // namespace

TEST("an override replaces a value of the file") {
    const auto s = with({{"grid.cells", "[8, 4]"}, {"time.end", "2"}, {"solids[0].centre", "[0.5, 0.25]"}});
    EXPECT_EQ(s.index<2>("grid.cells"), (Index<2>{8, 4}));
    EXPECT_EQ(s.number("time.end"), 2);
    EXPECT_EQ(s.vec<2>("solids[0].centre"), (Vec<2>{0.5, 0.25}));
    EXPECT_EQ(s.number("solids[0].radius"), 0.1);
    EXPECT_EQ(s.overrides().size(), 3U);
}

TEST("an override makes the tables and list entries that it needs") {
    const auto s = with({{"effects.buoyancy.alpha", "0.25"},
                         {"emitters[0]", "{ shape = \"sphere\", centre = [0, 0], radius = 1 }"},
                         {"emitters[0].smoke", "1"}});
    ASSERT_NE(s.effect("buoyancy"), nullptr);
    EXPECT_EQ(s.effect("buoyancy")->number("alpha"), 0.25);
    EXPECT_EQ(s.number("emitters[0].smoke"), 1);
}

TEST("one entry of a list of numbers can be changed") {
    EXPECT_EQ(with({{"grid.cells[1]", "16"}}).index<2>("grid.cells"), (Index<2>{64, 16}));
}

TEST("a bare word is a text, and later overrides win") {
    EXPECT_EQ(with({{"scheme.poisson.method", "cg"}}).text("scheme.poisson.method"), "cg");
    EXPECT_EQ(with({{"title", "\"a b\""}}).text("title"), "a b");
    EXPECT_TRUE(with({{"scheme.poisson.fixed", "true"}}).flag("scheme.poisson.fixed"));
    EXPECT_EQ(with({{"time.cfl", "2"}, {"time.cfl", "3"}}).number("time.cfl"), 3);
}

TEST("[:] of a list says how many of its entries stay") {
    const std::string three =
        "[{ shape = \"sphere\", centre = [0, 0], radius = 1 }, { shape = \"sphere\", centre = [0, 0], radius = 2 }, "
        "{ shape = \"sphere\", centre = [0, 0], radius = 3 }]";
    const auto left = with({{"solids", three}, {"solids[:]", "2"}});
    EXPECT_EQ(left.root().tables("solids").size(), 2U);
    EXPECT_EQ(left.root().tables("solids")[1].number("radius"), 2);
    EXPECT_TRUE(with({{"solids[:]", "0"}}).root().tables("solids").empty());
    EXPECT_EQ(refusal({"solids[:]", "2"}),
              "--set solids[:]=2: solids[:] is the number of entries of solids to keep, from 0 to 1; found the integer 2\n"
              "      | solids[:]=2\n"
              "      |       ^");
    EXPECT_EQ(refusal({"solids[:].radius", "1"}),
              "--set solids[:].radius=1: [:] ends a key\n"
              "      | solids[:].radius=1\n"
              "      |       ^   a key looks like grid.cells or solids[0].centre");
    EXPECT_EQ(refusal({"grid[:]", "1"}).substr(0, 46), "--set grid[:]=1: grid is a table, not a list\n ");
}

TEST("what is wrong with an override is shown in the override") {
    EXPECT_EQ(refusal({"grid.cels", "[8, 4]"}),
              "--set grid.cels=[8, 4]: unknown key \"cels\" in grid; did you mean \"cells\"?\n"
              "      | grid.cels=[8, 4]\n"
              "      |      ^~~~   known: cells, size, origin, periodic");
    EXPECT_EQ(refusal({"solids[0].radius", "-1"}),
              "--set solids[0].radius=-1: solids[0].radius is -1 m; it must be greater than 0 m\n"
              "      | solids[0].radius=-1\n"
              "      |                  ^~");
    EXPECT_EQ(refusal({"solids[3].radius", "1"}),
              "--set solids[3].radius=1: solids has 1 entry; only [0] or, to add one, [1] can be set\n"
              "      | solids[3].radius=1\n"
              "      |       ^");
    EXPECT_EQ(refusal({"time.end", "[1"}),
              "--set time.end=[1: this list is not closed\n"
              "      | time.end=[1\n"
              "      |          ^");
    EXPECT_EQ(refusal({"time.end", ""}),
              "--set time.end=: the value is missing\n"
              "      | time.end=\n"
              "      |          ^");
    EXPECT_EQ(refusal({"time..end", "1"}),
              "--set time..end=1: a key is missing\n"
              "      | time..end=1\n"
              "      |      ^   a key looks like grid.cells or solids[0].centre");
    EXPECT_EQ(refusal({"time.end.of", "1"}),
              "--set time.end.of=1: time.end is the number 1, not a table\n"
              "      | time.end.of=1\n"
              "      |          ^");
}

TEST("a value cannot smuggle in other keys") {
    EXPECT_NE(refusal({"title", "\"a\"\nsolver = \"water\""}), "accepted");
    EXPECT_NE(refusal({"time.end", "1 # comment\nx = 2"}), "accepted");
}

TEST("an override on the command line is key=value") {
    const auto change = to_override("grid.cells = [8, 4]");
    EXPECT_EQ(change.key, "grid.cells");
    EXPECT_EQ(change.value, "[8, 4]");
    EXPECT_THROW((void)to_override("grid.cells"), BadInput);
    EXPECT_THROW((void)to_override("=3"), BadInput);
}

}  // namespace overrides_tests
