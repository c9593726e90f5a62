// What a scene will hold in memory and write, estimated from small copies of it, against what it then holds and writes. For every solver
// that is registered, with none of its effects and with all of them, in boxes of several proportions; for each pressure method; and for
// liquid that a copy is too coarse to see.
#include "sim/memory_estimate.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "output/frames.hpp"
#include "poisson/poisson.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "sim/small_copy.hpp"
#include "support/size.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "validation/cost/effect_scene.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

namespace weir::memory_estimate_tests {
namespace {

/// What a guard against running out of memory can be off by and still be of use.
constexpr double bar = 0.1;

/// A scene with other cells; the box keeps their width, so that particles keep their cubes.
scene::Scene resized(const scene::Scene& scene, const std::vector<int>& cells, std::vector<scene::Override> more = {}) {
    std::string n, size;
    for (const int c : cells) {
        n += (n.empty() ? "[" : ", ") + std::to_string(c);
        size += fmt::format("{}{}", size.empty() ? "[" : ", ", static_cast<double>(c) / *std::max_element(cells.begin(), cells.end()));
    }
    auto overrides = scene.overrides();
    overrides.push_back({"grid.cells", n + "]"});
    overrides.push_back({"grid.size", size + "]"});
    overrides.insert(overrides.end(), more.begin(), more.end());
    return scene::parse(scene.source(), scene.file(), sim::schemas(), overrides);
}

void expect_estimate(const scene::Scene& scene, const std::string& name) {
    const sim::MemoryEstimate f = sim::estimate_memory(scene, sim::registry());
    Simulation run(scene);
    run.step();
    const auto bytes = static_cast<double>(run.solver().bytes());
    std::printf("%-44s %6.1f MB estimated %+5.1f%%\n", name.c_str(), bytes / 1e6, 100 * (f.bytes / bytes - 1));
    const bool columns =
        sim::kind_named(scene.solver(), sim::registry()).schema.columns;  // one cell along y: these are small enough to be built
    EXPECT_TRUE(columns || !f.exact) << name << " is built itself: it proves nothing";
    EXPECT_NEAR(f.bytes / bytes, 1, bar) << name;
}

std::vector<std::string> effects_of(const scene::SolverKind& kind) {
    std::vector<std::string> names;
    for (const auto& effect : kind.schema.effects) names.push_back(effect.name);
    return names;
}

}  // namespace

TEST_IN_2D_AND_3D("memory is estimated within a tenth for every solver, plain and with all its effects, whatever the box's proportions") {
    const std::vector<std::vector<int>> boxes =
        D == 2 ? std::vector<std::vector<int>>{{640, 640}, {1000, 217}} : std::vector<std::vector<int>>{{80, 80, 80}, {60, 131, 40}};
    for (const auto& kind : sim::registry()) {
        if (kind.schema.study) continue;
        for (const bool with_effects : {false, true})
            for (const auto& box : boxes) {
                if (!full_size() && with_effects != (box == boxes.back())) continue;  // each box with one of the two
                const auto scene = with_effects ? validation::scene_with(kind, D, 8, effects_of(kind), validation::negligible)
                                                : validation::plain_scene(kind, D, 8);
                expect_estimate(resized(scene, box), kind.schema.name + (with_effects ? ", all effects, " : ", plain, ") +
                                                         std::to_string(D) + "D " + std::to_string(box[0]) + " across");
            }
    }
}

TEST("memory is estimated within a tenth for every pressure method, and for the studies' own solvers") {
    const std::string cases = std::string(WEIR_SOURCE_DIR) + "/cases/";
    const auto read = [&](const std::string& scene, std::vector<scene::Override> more) {
        return scene::read(cases + scene, sim::schemas(), more);
    };
    for (const poisson::Method& method : poisson::methods()) {
        if (method.whole_box_only || (method.needs_petsc && !poisson::has_petsc())) continue;
        expect_estimate(read("smoke_obstacle_2d", {{"grid.cells", "[384, 576]"},
                                                   {"time.max_dt", "1e-4"},
                                                   {"scheme.poisson.fixed", "true"},
                                                   {"scheme.poisson.max_iterations", "2"},
                                                   {"scheme.poisson.method", '"' + method.name + '"'}}),
                        "smoke_obstacle_2d, " + method.name);
    }
    expect_estimate(read("zalesak", {{"grid.cells", "[500, 500]"}, {"time.dt", "1e-4"}}), "transport");
    expect_estimate(read("poisson_mms", {{"grid.cells", "[500, 500]"}}), "poisson");
    expect_estimate(read("phase_diagram", {{"grid.cells", "[500, 500]"}}), "phase_diagram");
    expect_estimate(read("closed_vessel", {{"grid.cells", "[500, 500]"}}), "closed_vessel");
}

TEST("liquid that a small copy would not see is estimated: a film of two cells, a drop, a pool with a solid in it") {
    const auto fluid = [](const char* solver, const char* liquid, const std::string& cells) {
        return scene::parse(std::string("solver = \"") + solver + "\"\ndim = 3\ngrid = { cells = " + cells +
                                ", size = [1.0, 1.0, 1.0] }\ntime = { end = 1.0 }\nliquid = [ " + liquid + " ]\n",
                            "scene.toml", sim::schemas());
    };
    for (const char* solver : {"mac_water", "sph", "pbf"}) {
        const std::string name = solver, cells = "[100, 100, 100]";
        expect_estimate(fluid(solver, "{ shape = \"box\", min = [0, 0, 0], max = [1, 0.0201, 1] }", cells), name + ", a film");
        expect_estimate(fluid(solver, "{ shape = \"sphere\", centre = [0.5, 0.7, 0.5], radius = 0.2 }", cells), name + ", a drop");
    }
}

TEST("the part of the domain that liquid fills is counted by cell centres, outside solids") {
    const auto part = [](const std::string& more, const char* cells) {
        return sim::liquid_fraction(scene::parse(std::string("solver = \"mac_water\"\ndim = 3\ngrid = { cells = ") + cells +
                                                     ", size = [1.0, 1.0, 1.0] }\ntime = { end = 1.0 }\n" + more,
                                                 "scene.toml", sim::schemas()));
    };
    const std::string half = "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [1, 0.5, 1] } ]\n";
    const std::string solid = "solids = [ { shape = \"box\", min = [0.25, 0.25, 0.25], max = [0.75, 0.75, 0.75] } ]\n";
    EXPECT_EQ(part(half, "[8, 8, 8]"), 0.5) << "every cell of a small grid is looked at";
    EXPECT_EQ(part(half + solid, "[8, 8, 8]"), 0.5 - 0.0625);
    EXPECT_NEAR(part(half + solid, "[200, 200, 200]"), 0.5 - 0.0625, 1e-3) << "of a large one a sample";
    const std::string film = "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [1, 0.0249, 1] } ]\n";
    EXPECT_NEAR(part(film, "[100, 100, 100]"), 0.02, 2e-4) << "two layers of cells have their centres in it";
}

TEST("a scene that needs more memory than there is is refused in less than a second, with both numbers; what fits is not asked") {
    const auto scene = [](const char* cells) {
        return scene::parse(
            std::string("solver = \"mac\"\ndim = 3\ngrid = { cells = ") + cells +
                ", size = [1.0, 1.0, 1.0] }\ntime = { end = 1.0 }\neffects.buoyancy = { alpha = 0.0, beta = 0.03, ambient = "
                "293.0 }\n",
            "scene.toml", sim::schemas());
    };
    const auto large = scene("[500, 500, 500]");
    const auto start = std::chrono::steady_clock::now();
    try {
        sim::require_memory(large, sim::registry(), sim::Use::solver, 8e9);
        FAIL() << "125 million cells do not fit into 8 GB";
    } catch (const BadInput& no) {
        const std::string text = no.what();
        EXPECT_NE(text.find("1.25e+08 cells require"), std::string::npos) << text;
        EXPECT_NE(text.find("8 GB"), std::string::npos) << text;
    }
    // some tenths on a quiet machine, and a rival for its cores
    EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2.0);
    const double solver = sim::estimate_memory(large, sim::registry()).bytes;
    EXPECT_NO_THROW(sim::require_memory(large, sim::registry(), sim::Use::solver, 1.01 * solver));
    EXPECT_THROW(sim::require_memory(large, sim::registry(), sim::Use::run, 1.01 * solver), BadInput) << "the last good state is a copy";
    EXPECT_NO_THROW(sim::require_memory(large, sim::registry(), sim::Use::run_with_frames, 1e12));
    EXPECT_NO_THROW(sim::require_memory(scene("[32, 32, 32]"), sim::registry(), sim::Use::solver, 1e9));
    EXPECT_THROW((void)scene("[2000, 2000, 2000]"), BadInput) << "more cells than can be numbered";
}

TEST_IN_2D_AND_3D("frames take on the disk what is estimated for them, without compression") {
    if (!output::frame_format().unavailable.empty()) GTEST_SKIP() << "this build writes no frames";
    for (const auto& kind : sim::registry()) {
        if (kind.schema.study) continue;
        for (const bool single : {false, true}) {
            const int cells = D == 3 ? 40 : kind.schema.columns ? 8192 : 128;  // a line of columns is short
            const auto plain = validation::plain_scene(kind, D, cells);
            auto overrides = plain.overrides();
            overrides.push_back({"output.every", "0.4"});
            overrides.push_back({"output.precision", single ? "\"single\"" : "\"double\""});
            Simulation run(scene::parse(plain.source(), plain.file(), {kind.schema}, overrides));
            const auto told = sim::estimate_output(run.scene(), run.fields());
            EXPECT_EQ(told.frames, 4) << "at 0, 0.4, 0.8 and 1 s";
            const test::TemporaryFolder folder;
            output::Frames frames(folder.path(), {.compression = output::Compression::none, .single_precision = single});
            frames.write(run.fields(), 0);
            double bytes = 0;
            for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path()))
                if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
            EXPECT_NEAR(told.bytes_of_frame / bytes, 1, 0.05) << kind.schema.name << ": headers are some kilobytes";
        }
    }
}

}  // namespace weir::memory_estimate_tests
