// Tall cells beside the uniform grid's water, in the same run.
#include "support/test.hpp"
#include "tallcell/solver.hpp"
#include "water/solver.hpp"

#include <fmt/format.h>

namespace weir::test::agreement_tests {
namespace {

/// The height of the surface over each column, in cells from the bottom.
std::vector<real> surface(const Solver& solver) {
    const FieldSet fields = solver.fields();
    const auto phi = fields.find(level_set_name)->data[0];
    const int nx = fields.grid.cells[0], ny = fields.grid.cells[1];
    std::vector<real> height(static_cast<std::size_t>(nx), 0);
    for (int i = 0; i < nx; ++i)
        for (int j = ny - 2; j >= 0; --j) {
            const auto at = static_cast<std::size_t>(i + nx * j), above = at + static_cast<std::size_t>(nx);
            if (phi[at] >= 0) continue;
            height[static_cast<std::size_t>(i)] = j + 0.5 + phi[at] / (phi[at] - phi[above]);
            break;
        }
    return height;
}

struct Apart {
    real largest = 0;  // of the RMS over columns, at any time [cells]
    real moved = 0;    // how far the surface itself went from where it began (RMS)
};

real rms(const std::vector<real>& a, const std::vector<real>& b) {
    real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<real>(a.size()));
}

Apart apart(const std::string& tank, const std::string& tall, real end, real dt) {
    const auto build = [&](const scene::SolverKind& kind, const std::string& scheme) {
        const std::string text = "solver = \"" + kind.schema.name + "\"\ndim = 2\ntime = { end = 10.0 }\nfluid = { density = 1000.0 }\n" +
                                 tank + "\neffects.gravity.g = [0.0, -9.81]\nscheme = { " + scheme + " }\n";
        return kind.make(scene::parse(text, "tank", {kind.schema}), {});
    };
    const auto uniform = build(water::kind(), "transfer = \"grid\""), columns = build(tallcell::kind(), tall);
    const auto start = surface(*uniform);
    Apart result;
    while (uniform->time() < end) {
        uniform->step(dt);
        columns->step(dt);
        const auto now = surface(*uniform);
        result.largest = std::max(result.largest, rms(surface(*columns), now));
        result.moved = std::max(result.moved, rms(now, start));
    }
    return result;
}

TEST("a wave over deep water has its surface within a cell of the uniform grid's") {
    const std::string tank =
        "grid = { cells = [64, 160], size = [1.0, 2.5] }\n"
        "liquid = [ { shape = \"wave\", level = 2.2, amplitude = 0.04, wavelength = 1.0 } ]";
    for (const std::string columns : {"stacked", "single"}) {
        const Apart wave = apart(tank, "columns = \"" + columns + "\", layers = 16", 1.6, 0.008);  // two periods
        EXPECT_GT(wave.moved, 3) << "there was a wave";
        EXPECT_LT(wave.largest, 1) << columns;
        testing::Test::RecordProperty("apart_" + columns, std::to_string(wave.largest));
    }
}

TEST("a column of water that collapses has its surface within a cell of the uniform grid's") {
    const std::string tank =
        "grid = { cells = [96, 64], size = [1.5, 1.0] }\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.5, 0.75] } ]";
    for (const std::string columns : {"stacked", "single"}) {
        const Apart fall = apart(tank, "columns = \"" + columns + "\"", 0.3, 0.003);  // the front has not reached the wall
        EXPECT_GT(fall.moved, 10) << "it fell";
        EXPECT_LT(fall.largest, 1) << columns;
        testing::Test::RecordProperty("apart_" + columns, std::to_string(fall.largest));
    }
}

}  // namespace
}  // namespace weir::test::agreement_tests
