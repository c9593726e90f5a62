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

TEST("run.json holds scene, machine, commit, and what each step answered; quantities that the solver lacks are absent") {
    weir::test::TemporaryFolder folder;
    const auto file = folder.path() / "run.json";
    auto simulation = fake_simulation("time = { end = 0.1 }");
    weir::output::RunLog log(file, simulation.scene());
    for (int i = 0; i < 2; ++i) {
        const auto report = simulation.step();
        log.add_step(simulation.steps(), simulation.time(), report, simulation.solver().passes(), 0.005);
    }
    log.set_status("finished");
    log.write();
    const auto j = read(file);
    EXPECT_EQ(j["status"], "finished");
    EXPECT_EQ(j["scene"]["values"]["solver"], "fake");
    EXPECT_EQ(j["scene"]["values"]["time"]["cfl"], 0.5);  // a default: the scene as understood
    EXPECT_FALSE(j["commit"].get<std::string>().empty());
    EXPECT_GE(j["machine"]["logical_cores"], 1);
    ASSERT_EQ(j["steps"].size(), 2u);
    EXPECT_EQ(j["steps"][1]["time"], simulation.time());
    EXPECT_EQ(j["steps"][1]["iterations"], 2);
    EXPECT_EQ(j["steps"][1]["milliseconds"], 5.0);
    EXPECT_TRUE(j["steps"][1]["passes"].contains("fake"));
    EXPECT_FALSE(j["steps"][1].contains("density_error"));
}

TEST("a resumed log keeps the steps up to the checkpoint and drops those after it") {
    weir::test::TemporaryFolder folder;
    const auto file = folder.path() / "run.json";
    auto simulation = fake_simulation("time = { end = 0.1 }");
    {
        weir::output::RunLog log(file, simulation.scene());
        for (int step = 1; step <= 4; ++step) log.add_step(step, 0.1 * step, {.dt = 0.1}, simulation.solver().passes(), 0);
        log.write();
    }
    weir::output::RunLog log(file, simulation.scene());
    log.resume(2);
    log.add_step(3, 0.35, {.dt = 0.15}, simulation.solver().passes(), 0);
    log.write();
    const auto j = read(file);
    ASSERT_EQ(j["steps"].size(), 3u);
    EXPECT_EQ(j["steps"][1]["time"], 0.2);
    EXPECT_EQ(j["steps"][2]["dt"], 0.15);
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
    EXPECT_TRUE(j["steps"].empty());
    EXPECT_EQ(std::filesystem::file_size(path), size);
    EXPECT_TRUE(log.overwrite_status(std::string(1000, 'x')));
    EXPECT_EQ(read(path)["status"], std::string(200, 'x'));
}

}  // namespace
