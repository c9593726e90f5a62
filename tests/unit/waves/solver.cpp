#include "sim/simulation.hpp"
#include "unit/waves/support.hpp"

namespace solver_tests {

using namespace weir;
using namespace weir::waves;
using weir::test::sea_scene;
using weir::test::wave_scene;

namespace {

const std::string probes =
    "probes = [ { name = \"g\", kind = \"gauge\", at = [33.3, 0.0, 71.1] }, { name = \"v\", kind = \"point\", field = \"velocity\", at = "
    "[33.3, -2.0, 71.1] } ]\ntime.max_dt = 0.7\n";

std::vector<std::vector<real>> all_fields(const FieldSet& set) {
    std::vector<std::vector<real>> all;
    for (const FieldView& f : set.fields)
        for (const auto& values : f.data) all.emplace_back(values.begin(), values.end());
    return all;
}

}  // namespace

TEST("probes ask the formula, not the grid") {
    Simulation simulation(sea_scene("", "[48, 1, 36]", probes));
    simulation.step();
    std::array<real, 1> height{};
    ASSERT_TRUE(simulation.solver().answer("surface", {{33.3, 0, 71.1}}, height));
    EXPECT_EQ(simulation.probe_series("g").values.back()[0], height[0] + 5);  // over the domain's floor
    std::array<real, 3> velocity{};
    ASSERT_TRUE(simulation.solver().answer("velocity", {{33.3, -2, 71.1}}, velocity));
    for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(simulation.probe_series("v").values.back()[a], velocity[a]);
}

TEST("any time is reached in one step, and a run goes on from a checkpoint to the last bit") {
    Simulation whole(sea_scene(", choppiness = 1.0", "[48, 1, 36]", probes)), half(sea_scene(", choppiness = 1.0", "[48, 1, 36]", probes));
    whole.run_until(7);
    half.run_until(3.5);
    Checkpoint saved;
    half.save(saved);
    Simulation rest(sea_scene(", choppiness = 1.0", "[48, 1, 36]", probes));
    rest.restore(saved);
    rest.run_until(7);
    EXPECT_EQ(all_fields(whole.fields()), all_fields(rest.fields()));
    EXPECT_EQ(whole.probe_series("g").values, rest.probe_series("g").values);
    Simulation free(
        wave_scene(2, "[16, 1]", "[20.0, 10.0]", "waves = { model = \"sines\", trains = [ { amplitude = 0.1, wavelength = 10.0 } ] }"));
    free.step();
    EXPECT_EQ(free.time(), 100);  // the scene's end
}

TEST("without velocities there are none, and foam is there where it is named") {
    Waves bare(sea_scene(", velocity = false, choppiness = 1.0")),
        foamy(sea_scene(", choppiness = 1.0", "[48, 1, 36]", "effects.foam = {}\n"));
    EXPECT_EQ(bare.fields().find("velocity"), nullptr);
    EXPECT_EQ(bare.fields().find("foam"), nullptr);
    EXPECT_NE(foamy.fields().find("foam"), nullptr);
    EXPECT_LT(bare.bytes(), foamy.bytes());
}

TEST("the surface is a sheet of points in rows, which every field of the set follows") {
    Waves solver(sea_scene(", choppiness = 1.0"));
    const FieldSet fields = solver.fields();
    ASSERT_EQ(fields.sheets.size(), 1U);
    EXPECT_EQ(fields.sheets[0].points, (std::array{48, 36}));
    for (const FieldView& f : fields.fields)
        for (const auto& values : f.data) EXPECT_EQ(values.size(), 48U * 36U) << f.name;
}

}  // namespace solver_tests
