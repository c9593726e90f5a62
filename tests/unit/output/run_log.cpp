#include "output/run_log.hpp"

#include "core/step_quantities.hpp"

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

#include <nlohmann/json.hpp>

namespace run_log_tests {

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
    log.set_status(weir::output::RunStatus::finished);
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

/// Fails on every text of a JSON value that is not a name.
void expect_names(const nlohmann::json& j) {
    if (j.is_structured()) {
        for (const auto& value : j) expect_names(value);
    } else if (j.is_string()) {
        EXPECT_EQ(j.get<std::string>().find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos) << j;
    }
}

TEST("ranks and status of run.json are numbers and names, never sentences") {
    weir::test::TemporaryFolder folder;
    const auto path = folder.path() / "run.json";
    using weir::output::RunLog;
    using weir::scene::ReplicatedWork;
    RunLog log(path, fake_simulation("time = { end = 0.1 }").scene());
    const std::vector<ReplicatedWork> all{ReplicatedWork::everything,         ReplicatedWork::surface_row,
                                          ReplicatedWork::pressure,           ReplicatedWork::pressure_matrix,
                                          ReplicatedWork::pressure_levels,    ReplicatedWork::small_pressure_levels,
                                          ReplicatedWork::level_set_in_solids};
    for (const auto storage : {RunLog::Storage::replicated, RunLog::Storage::planes, RunLog::Storage::particles}) {
        log.set_ranks({.count = 2, .cut = {{0, 4}}, .storage = storage, .replicated_work = all, .sent = {{}}, .states = {{}}});
        log.set_status(weir::output::RunStatus::interrupted);
        log.write();
        const auto j = read(path);
        EXPECT_EQ(j["status"], "interrupted");
        expect_names(j["ranks"]);
        EXPECT_EQ(j["ranks"]["replicated_work"].size(), all.size());
        EXPECT_EQ(j["ranks"].contains("cut"), storage != RunLog::Storage::particles);
        EXPECT_EQ(j["ranks"]["partition"], storage == RunLog::Storage::particles ? "particles" : "planes");
    }
    log.set_ranks({.count = 2});
    log.write();
    EXPECT_EQ(read(path)["ranks"].dump(), R"({"count":2,"cut":[],"partition":"none","replicated_work":[],"storage":"replicated"})");
}

TEST("every quantity of a step's report has a column, and its two names find it") {
    weir::test::TemporaryFolder folder;
    weir::output::StepLog log(folder);
    log.begin();
    std::string head;
    std::getline(std::ifstream(folder.path() / "steps.csv") >> std::ws, head);
    for (const weir::StepQuantity& q : weir::step_quantities) {
        EXPECT_NE(head.find(std::string(",") + q.name), std::string::npos) << q.name;
        EXPECT_EQ(weir::find_step_quantity(q.name), &q);
        EXPECT_EQ(weir::find_step_quantity(q.short_name), &q);
    }
    EXPECT_EQ(weir::find_step_quantity("viscous"), nullptr);
    EXPECT_EQ(sizeof(weir::StepReport), 8 * sizeof(weir::real) + 4 * sizeof(int))
        << "a new member needs a line in core/step_quantities.hpp";
}

TEST("a file that cannot be replaced still says what happened: the status is set in place, and nothing else changes") {
    weir::test::TemporaryFolder folder;
    const auto path = folder.path() / "run.json";
    weir::output::RunLog log(path, fake_simulation("time = { end = 0.1 }").scene());
    log.write();
    const auto size = std::filesystem::file_size(path);
    EXPECT_EQ(read(path)["status"], "running");
    EXPECT_TRUE(log.overwrite_status(weir::output::RunStatus::failed, "cannot write \"frame\": No space left\nand more"));
    const auto j = read(path);
    EXPECT_EQ(j["status"], "failed");
    EXPECT_EQ(j["failure"], "cannot write \"frame\": No space left");
    EXPECT_EQ(j["steps"]["count"], 0);
    EXPECT_EQ(std::filesystem::file_size(path), size);
    EXPECT_TRUE(log.overwrite_status(weir::output::RunStatus::failed, std::string(1000, 'x')));
    EXPECT_EQ(read(path)["failure"], std::string(200, 'x'));
}

}  // namespace

}  // namespace run_log_tests
