#include "support/test.hpp"
#include "unit/scene/schema.hpp"

namespace rules_tests {

using namespace weir;
using namespace weir::scene;

namespace {

/// The messages, without excerpts, of a scene that is well-formed but for `more`.
std::vector<std::string> refused(const std::string& more, const std::string& dim = "2") {
    const std::string head = "solver = \"smoke\"\ndim = " + dim + "\ngrid.cells = " + (dim == "2" ? "[4, 4]" : "[4, 4, 4]") +
                             "\ngrid.size = " + (dim == "2" ? "[1, 1]" : "[1, 1, 1]") + "\ntime.end = 1\n";
    std::vector<std::string> messages;
    try {
        (void)parse(head + more, "scene.toml", made_up::schemas());
    } catch (const BadScene& e) {
        for (const auto& p : e.problems) messages.push_back(p.message);
    }
    return messages;
}

using List = std::vector<std::string>;

}  // namespace

TEST("an axis is periodic at both ends or at none") {
    EXPECT_EQ(refused("sides.x_min = \"periodic\"\n"), List{"sides.x_min is periodic, but sides.x_max is \"wall\""});
    EXPECT_EQ(refused("grid.periodic = [\"y\"]\nsides.y_max = \"outflow\"\n"),
              List{"sides.y_max is \"outflow\", but grid.periodic names \"y\""});
    EXPECT_EQ(refused("grid.periodic = [\"z\"]\n"), List{"grid.periodic names \"z\"; this scene has dim = 2"});
    EXPECT_EQ(refused("grid.periodic = [\"z\"]\n", "3"), List{});
}

TEST("shapes have extent, also inside unions and differences") {
    EXPECT_EQ(refused("solids = [{ shape = \"box\", min = [0, 1], max = [1, 0.5] }]\n"),
              List{"solids[0].max is not above its min along y: 0.5 m against 1 m"});
    EXPECT_EQ(refused("solids = [{ shape = \"union\", of = [{ shape = \"plane\", point = [0, 0], normal = [0, 0] }] }]\n"),
              List{"solids[0].of[0].normal is the zero vector; it must have a direction"});
    EXPECT_EQ(refused("solids = [{ shape = \"difference\", from = { shape = \"cylinder\", from = [0, 0], to = [0, 0], radius = 1 }, minus "
                      "= [{ shape = "
                      "\"sphere\", centre = [0, 0], radius = 1 }] }]\n"),
              List{"solids[0].from.to is the same point as its from; a cylinder needs a length"});
}

TEST("liquid and emitters outside the domain are refused, solids there are not") {
    const std::string away = "shape = \"sphere\", centre = [-2, 0], radius = 1 }]\n";
    EXPECT_EQ(refused("liquid = [{ " + away), List{"liquid[0] lies outside the domain, so it adds no fluid"});
    EXPECT_EQ(refused("emitters = [{ " + away), List{"emitters[0] lies outside the domain, so it adds no fluid"});
    EXPECT_EQ(refused("solids = [{ " + away), List{});
    EXPECT_EQ(refused("liquid = [{ shape = \"plane\", point = [0, -1], normal = [0, 1] }]\n").size(), 1U);
    EXPECT_EQ(refused("liquid = [{ shape = \"plane\", point = [0, 0.5], normal = [0, 1] }]\n"), List{});
    EXPECT_EQ(refused("liquid = [{ shape = \"union\", of = [{ " + away.substr(0, away.size() - 1) + " }]\n").size(), 1U);
}

TEST("moments of a motion stand in order, and an axis has a direction") {
    const std::string sphere = "solids = [{ shape = \"sphere\", centre = [0, 0, 0], radius = 1, motion = { ";
    EXPECT_EQ(refused(sphere + "kind = \"keyframes\", frames = [{ t = 0 }, { t = 2 }, { t = 2 }] } }]\n", "3"),
              List{"solids[0].motion.frames[2].t is 2 s; it must be after 2 s of the previous keyframe"});
    EXPECT_EQ(refused(sphere + "kind = \"rotation\", rate = 1, axis = [0, 0, 0] } }]\n", "3"),
              List{"solids[0].motion.axis is the zero vector; it must have a direction"});
}

TEST("a wall of the domain moves along itself") {
    EXPECT_EQ(refused("sides.y_max = { kind = \"moving_wall\", velocity = [1, 0] }\n"), List{});
    EXPECT_EQ(refused("sides.x_max = { kind = \"moving_wall\", velocity = [1, 0] }\n"),
              List{"sides.x_max.velocity has 1 m/s along x; a wall of the domain moves only along itself"});
}

TEST("probes have names of their own that can name files, and lie in the domain") {
    EXPECT_EQ(refused("probes = [{ name = \"a\", kind = \"front\" }, { name = \"a\", kind = \"front\" }]\n"),
              List{"two probes have the name \"a\"; each writes its own file"});
    EXPECT_EQ(refused("probes = [{ name = \"../a\", kind = \"front\" }]\n"),
              List{"probes[0].name is \"../a\", which is not a valid file name"});
    EXPECT_EQ(refused("probes = [{ name = \"a\", kind = \"point\", field = \"pressure\", at = [0.5, 1.5] }]\n"),
              List{"probes[0].at lies outside the domain"});
}

TEST("a grid fits into the machine and into the precision of its numbers") {
    EXPECT_EQ(refused("").size(), 0U);
    const auto cells = [](const std::string& text) {
        try {
            (void)parse("solver = \"smoke\"\ndim = 2\n" + text + "\ntime.end = 1\n", "scene.toml", made_up::schemas());
        } catch (const BadScene& e) {
            return e.problems.front().message;
        }
        return std::string();
    };
    EXPECT_EQ(cells("grid = { cells = [100000, 100000], size = [1, 1] }"),
              "grid.cells makes 1e+10 cells; at most 2147483647 can be numbered");
    EXPECT_EQ(cells("grid = { cells = [10, 10], size = [1, 1e-9], origin = [0, 1e6] }"),
              "cells of 1e-10 m along y cannot be distinguished at y = 1e+06 m in double precision");
    EXPECT_EQ(cells("grid = { cells = [10, 10], size = [1, 1e-9] }"), "");
}

TEST("a fixed step is not longer than the longest allowed one") {
    EXPECT_EQ(refused("time.dt = 0.2\ntime.max_dt = 0.1\n"), List{"time.dt is 0.2 s, above time.max_dt = 0.1 s"});
}

TEST("a rule says nothing about values that are refused already") {
    EXPECT_EQ(
        refused("solids = [{ shape = \"box\", min = \"low\", max = [1, 0.5] }, 3, { shape = \"box\", min = [0, 0], max = [1, -1] }]\n"),
        (List{"solids[0].min must be a list of 2 numbers [m]; found the text \"low\"",
              "solids[1] must be a table with a \"shape\"; found the integer 3",
              "solids[2].max is not above its min along y: -1 m against 0 m"}));
}

}  // namespace rules_tests
