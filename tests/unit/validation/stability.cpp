// From stability.toml to the limit: the bisection, the invariants, the floor, on a solver whose numbers are known.
#include "validation/stability/command.hpp"

#include "core/error.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

using namespace weir;
using namespace weir::validation;
namespace fs = std::filesystem;

namespace {

/// The fake solver's step is at most 0.03 s; `stall_at` is the step after which its advised step is nothing.
const std::string axis = "[[axes]]\nname = \"end\"\nkey = \"time.end\"\nlow = 0.05\nhigh = 2\nhard_because = \"it is long\"\n";
const std::string stalls = "question = \"q\"\nset = [\"stall_at = 10\"]\n";

fs::path add(const fs::path& root, const std::string& text) {
    const fs::path folder = root / "study";
    fs::create_directories(folder);
    std::ofstream(folder / "stability.toml") << text;
    std::ofstream(folder / "case.toml") << "";  // found by name
    std::ofstream(folder / "scene.toml") << "solver = \"fake\"\ndim = 2\ngrid = { cells = [8, 4], size = [1, 1] }\ntime = { end = 0.1 }\n";
    return folder;
}

Stress only(const fs::path& folder) { return read_stability(folder, Size::ci).stresses.at(0); }

std::string refusal(const std::string& text) {
    try {
        parse_stability(text, "stability.toml", "cases/sample", Size::ci);
    } catch (const BadInput& wrong) {
        return wrong.what();
    }
    return "accepted";
}

}  // namespace

TEST("the bisection closes in on the limit within its factor, and says where neither end is a limit") {
    const auto breaks_above = [](real limit) {
        return [limit](real value) { return value > limit ? std::optional<Break>({"it broke", 3, 0.5}) : std::nullopt; };
    };
    const Stress stress{.low = 0.1, .high = 100};
    const Limit found = bisect(stress, 1.1, breaks_above(7));
    EXPECT_LE(*found.last_stable, 7);
    EXPECT_GT(*found.first_unstable, 7);
    EXPECT_LT(*found.first_unstable / *found.last_stable, 1.1);
    EXPECT_EQ(found.broke.what, "it broke");
    EXPECT_FALSE(bisect(stress, 1.1, breaks_above(1000)).first_unstable) << "the high end is stable";
    EXPECT_FALSE(bisect(stress, 1.1, breaks_above(0.01)).last_stable) << "the low end is not";
}

TEST("a run that fails is a break, with its step and time") {
    const test::TemporaryFolder folder;
    const Stress stress = only(add(folder.path(), stalls + axis));
    EXPECT_FALSE(push(stress, 0.05, test::fake_kinds()));
    const auto broke = push(stress, 2, test::fake_kinds());
    ASSERT_TRUE(broke);
    EXPECT_EQ(broke->step, 11);
    EXPECT_NE(broke->what.find("time no longer advances"), std::string::npos) << broke->what;
}

TEST("each kind of invariant is watched after every step; an axis without its own has those of the study") {
    const test::TemporaryFolder folder;
    const auto breaks = [&](const std::string& watch) {
        const std::string text = "question = \"q\"\nwatch = [{ series = \"mass\", why = \"w\", " + watch + " }]\n" + axis;
        return push(only(add(folder.path(), text)), 0.5, test::fake_kinds()).has_value();
    };
    // The fake mass is 1 + a number in [0, 1) that changes every step.
    EXPECT_FALSE(breaks("at_most = 2"));
    EXPECT_TRUE(breaks("at_most = 1"));
    EXPECT_FALSE(breaks("at_least = 1"));
    EXPECT_TRUE(breaks("at_least = 2"));
    EXPECT_FALSE(breaks("drift = 1"));
    EXPECT_TRUE(breaks("drift = 0.001"));
    EXPECT_TRUE(breaks("never_rises = 0.001"));
    EXPECT_FALSE(breaks("at_most = 4, times_value = true")) << "4 times 0.5";
    EXPECT_TRUE(breaks("at_most = 2, times_value = true")) << "2 times 0.5";
}

TEST("what is wrong in stability.toml is named") {
    EXPECT_NE(refusal("question = \"q\"\nwatch = [{ series = \"mass\", why = \"w\" }]\n" + axis).find("needs one of: at_most"),
              std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "floor = 1\n").find("\"floor\" needs a \"floor_why\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "theory = 1\n").find("\"theory\" needs a \"theory_source\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n").find("axes"), std::string::npos);
}

TEST("the command writes limits and page; a floor that does not hold is exit code 1, in both modes") {
    const test::TemporaryFolder folder;
    const auto run = [&](real floor, bool floors) {
        const auto study = add(folder.path(), stalls + axis + "floor = " + std::to_string(floor) + "\nfloor_why = \"w\"\n");
        StabilityOptions options;
        options.names = {study.string()}, options.floors = floors, options.quiet = true;
        options.out = folder.path() / "out", options.publish = folder.path() / "page";
        return stability_command(options, test::fake_kinds());
    };
    EXPECT_EQ(run(0.1, false), exit_success);
    EXPECT_EQ(run(1.5, false), exit_claim_failed);
    EXPECT_EQ(run(0.1, true), exit_success);
    EXPECT_EQ(run(1.5, true), exit_claim_failed);
    std::ifstream page(folder.path() / "page/index.md");
    std::ostringstream text;
    text << page.rdbuf();
    EXPECT_NE(text.str().find("below its floor"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder.path() / "out/study.json"));
}
