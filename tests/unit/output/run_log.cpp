#include "output/run_log.hpp"

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

namespace {

using weir::test::fake_simulation;

nlohmann::json read(const std::filesystem::path& file) {
    std::ifstream in(file);
    return nlohmann::json::parse(in);
}

TEST("run.json holds scene, machine, commit, run, and a summary of the steps; quantities that the solver lacks are absent") {
    weir::test::TemporaryFolder folder;
    const auto file = folder.path() / "run.json";
    auto simulation = fake_simulation("time = { end = 0.1 }");
    weir::output::RunLog log(file, simulation.scene(), "0123");
    log.steps().begin();
    for (int i = 0; i < 2; ++i) {
        const auto report = simulation.step();
        log.steps().add(simulation.steps(), simulation.time(), report, simulation.solver().passes(), 0.005);
    }
    log.set_status("finished");
    log.write();
    const auto j = read(file);
    EXPECT_EQ(j["status"], "finished");
    EXPECT_EQ(j["run"], "0123");
    EXPECT_EQ(j["scene"]["values"]["solver"], "fake");
    EXPECT_EQ(j["scene"]["values"]["time"]["cfl"], 0.5);  // a default: the scene as understood
    EXPECT_FALSE(j["commit"].get<std::string>().empty());
    EXPECT_GE(j["machine"]["logical_cores"], 1);
    EXPECT_EQ(j["steps"]["count"], 2);
    EXPECT_EQ(j["steps"]["columns"]["t [s]"]["max"], simulation.time());
    EXPECT_EQ(j["steps"]["columns"]["iterations"]["max"], 2);
    EXPECT_EQ(j["steps"]["milliseconds"]["all"]["sum"], 10.0);
    EXPECT_TRUE(j["steps"]["milliseconds"].contains("fake"));
    EXPECT_FALSE(j["steps"]["columns"].contains("density_error"));
}

TEST("a file that cannot be replaced still says what happened: the status is set in place, and nothing else changes") {
    weir::test::TemporaryFolder folder;
    const auto path = folder.path() / "run.json";
    weir::output::RunLog log(path, fake_simulation("time = { end = 0.1 }").scene());
    log.write();
    const auto size = std::filesystem::file_size(path);
    EXPECT_TRUE(log.overwrite_status("failed: cannot write \"frame\": No space left\nand more"));
    const auto j = read(path);
    EXPECT_EQ(j["status"], "failed: cannot write \"frame\": No space left");
    EXPECT_EQ(j["steps"]["count"], 0);
    EXPECT_EQ(std::filesystem::file_size(path), size);
    EXPECT_TRUE(log.overwrite_status(std::string(1000, 'x')));
    EXPECT_EQ(read(path)["status"], std::string(200, 'x'));
}

}  // namespace
