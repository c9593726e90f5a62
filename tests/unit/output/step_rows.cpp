#include "output/step_rows.hpp"

#include "core/error.hpp"
#include "core/solver.hpp"
#include "output/step_log.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <iterator>

namespace step_rows_tests {

namespace {

using weir::real;
using weir::output::StepRows;

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void add(StepRows& rows, std::int64_t step) {
    const real values[] = {0.1 * static_cast<real>(step), step == 2 ? weir::not_applicable : 1 / static_cast<real>(step)};
    rows.add(step, values);
}

std::string whole(const std::filesystem::path& path, std::int64_t steps) {
    StepRows rows(path, {"a", "b [s]"});
    rows.begin();
    for (std::int64_t step = 1; step <= steps; ++step) add(rows, step);
    return text_of(path);
}

TEST("rows are in the file as soon as they are added; a value that is not there leaves its cell empty; whole numbers have no exponent") {
    weir::test::TemporaryFolder folder;
    StepRows rows(folder.path() / "a.csv", {"a", "b [s]"});
    rows.begin();
    EXPECT_EQ(text_of(folder.path() / "a.csv"), "step,a,b [s]\n");
    const real values[] = {100000, weir::not_applicable};
    rows.add(1, values);
    EXPECT_EQ(text_of(folder.path() / "a.csv"), "step,a,b [s]\n1,100000,\n");
    EXPECT_EQ(rows.columns()[0].count, 1);
    EXPECT_EQ(rows.columns()[1].count, 0);
}

TEST("a file cut anywhere, as a killed run leaves it, continues from a step to the same bytes and summary as one written at once") {
    weir::test::TemporaryFolder folder;
    const auto path = folder.path() / "a.csv";
    const std::string all = whole(path, 6);
    const std::string three = whole(path, 3);
    for (std::size_t size = three.size(); size <= all.size(); ++size) {
        std::ofstream(path, std::ios::binary) << all.substr(0, size);
        StepRows rows(path, {"a", "b [s]"});
        rows.resume(3);
        EXPECT_EQ(text_of(path), three) << size;
        for (std::int64_t step = 4; step <= 6; ++step) add(rows, step);
        EXPECT_EQ(text_of(path), all) << size;
        EXPECT_EQ(rows.count(), 6);
        EXPECT_EQ(rows.columns()[1].count, 5);
        EXPECT_EQ(rows.columns()[1].min, real(1) / 6);
        real sum = 0;
        for (const int step : {1, 3, 4, 5, 6}) sum += real(1) / step;
        EXPECT_EQ(rows.columns()[1].sum, sum);
    }
}

TEST("a file of another kind, or none, is begun anew by a run that goes on") {
    weir::test::TemporaryFolder folder;
    const auto path = folder.path() / "a.csv";
    for (const char* there : {"", "step,a\n1,2\n", "step,a,b [s]", "\0\0\0"}) {
        std::ofstream(path, std::ios::binary) << there;
        StepRows rows(path, {"a", "b [s]"});
        rows.resume(3);
        EXPECT_EQ(text_of(path), "step,a,b [s]\n") << there;
    }
    std::filesystem::remove(path);
    StepRows rows(path, {"a"});
    rows.resume(3);
    EXPECT_EQ(text_of(path), "step,a\n");
    StepRows nowhere(folder.path() / "none" / "a.csv", {"a"});
    EXPECT_THROW(nowhere.begin(), weir::OutputError);
}

TEST("a pass that is timed for the first time later has a column, empty before; a run that goes on keeps it") {
    weir::test::TemporaryFolder folder;
    weir::Passes passes;
    {
        weir::output::StepLog log(folder.path());
        log.begin();
        passes.add("first", 1, 1);
        log.add(1, 0.1, {.dt = 0.1}, passes, 2);
        passes.add("second", 0.5, 1);
        log.add(2, 0.2, {.dt = 0.1}, passes, 1);
        log.add(3, 0.3, {.dt = 0.1}, passes, 1);
    }
    EXPECT_EQ(text_of(folder.path() / "timings.csv"), "step,all [ms],first [ms],second [ms]\n1,2000,1000,\n2,1000,,500\n3,1000,,\n");
    weir::output::StepLog log(folder.path());
    log.resume(2);
    weir::Passes anew;  // another process counts from the start, in its own order
    anew.add("second", 0.25, 1);
    log.add(3, 0.35, {.dt = 0.15}, anew, 1);
    EXPECT_EQ(text_of(folder.path() / "timings.csv"), "step,all [ms],first [ms],second [ms]\n1,2000,1000,\n2,1000,,500\n3,1000,,250\n");
    const std::string summary = log.summary();
    EXPECT_NE(summary.find("\"count\":3"), std::string::npos) << summary;
    EXPECT_NE(summary.find("\"second\":{\"sum\":750.0,\"max\":500.0}"), std::string::npos) << summary;
    EXPECT_NE(text_of(folder.path() / "steps.csv").find("\n3,0.35,0.15,"), std::string::npos);
}

}  // namespace

}  // namespace step_rows_tests
