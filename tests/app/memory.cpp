// What a run takes of memory and disk, as the executable takes it, against what is told and asked before.
#include "app/process.hpp"
#include "core/parallel.hpp"
#include "sim/memory_estimate.hpp"
#include "sim/registry.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

namespace weir {
namespace {

const std::string plume =
    "solver = \"mac\"\ndim = 3\ngrid = { cells = [100, 100, 100], size = [1.0, 1.0, 1.0] }\ntime = { end = 0.011, max_dt = 0.005 }\n"
    "effects = { buoyancy = { alpha = 0.0, beta = 0.03, ambient = 293.0 }, confinement = { epsilon = 0.2 } }\n"
    "emitters = [ { shape = \"sphere\", centre = [0.5, 0.3, 0.5], radius = 0.2, smoke = 1.0, temperature = 323.0 } ]\n"
    "output = { every = 0.01, compression = \"none\" }\n";

}  // namespace

// A run of the smallest grid shows what program and libraries take themselves. The rest is the solver's, estimated within a tenth, and
// copies of state and frame, the same: 15 per cent is a tenth and what an allocator keeps of freed blocks that do not fit the next ones.
TEST("a run with frames takes as much memory as is estimated") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "plume.toml") << plume;
    const auto taken = [&](const std::string& cells) {
        test::Process run({"run", folder.path() / "plume.toml", "--quiet", "--threads", "1", "--out", folder.path() / "out", "--set",
                           "grid.cells=" + cells},
                          folder.path() / "log");
        EXPECT_EQ(run.wait(), 0) << run.said();
        return run.most_memory();
    };
    const double bytes = taken("[100, 100, 100]") - taken("[8, 8, 8]");
    const auto scene = scene::read(folder.path() / "plume.toml", sim::schemas());
    const double told = sim::bytes_of_run(scene, sim::estimate_memory(scene, sim::registry()), true);
    std::printf("%.1f MB taken, %.1f MB estimated\n", bytes / 1e6, told / 1e6);
    EXPECT_NEAR(told / bytes, 1, 0.15);
}

TEST("frames that do not fit on the disk are refused before the run, with both numbers; --any-size begins all the same") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "plume.toml") << plume;
    const std::vector<std::string> arguments{"run",   folder.path() / "plume.toml", "--out", folder.path() / "out",
                                             "--set", "grid.cells=[8,8,8]",         "--set", "output.every=1e-15"};  // 10^13 frames
    test::Process refused(arguments, folder.path() / "log");
    EXPECT_EQ(refused.wait(), 2);
    const std::string said = refused.said();
    EXPECT_NE(said.find("GB in all"), std::string::npos) << said;
    EXPECT_NE(said.find("are free there"), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "out" / "run.json"));
    test::Process fits({"run", folder.path() / "plume.toml", "--out", folder.path() / "out", "--set", "grid.cells=[8,8,8]"},
                       folder.path() / "log");
    EXPECT_EQ(fits.wait(), 0);
    EXPECT_NE(fits.said().find("3 frames of "), std::string::npos) << fits.said();
}

}  // namespace weir
