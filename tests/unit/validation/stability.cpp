// From stability.toml to the limit: the bisection, the invariants, the guaranteed range, on a solver whose numbers are known.
#include "validation/stability/command.hpp"

#include "core/error.hpp"
#include "smoke/solver.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

namespace stability_tests {

using namespace weir;
using namespace weir::validation;
namespace fs = std::filesystem;

namespace {

/// The fake solver's step is at most 0.03 s; `stall_at` is the step after which its advised step is nothing.
const std::string bare_axis = "[[axes]]\nname = \"end\"\nkey = \"time.end\"\nlow = 0.05\nhigh = 2\nhard_because = \"it is long\"\n";
const std::string mass_precondition = "proof = [{ quantity = \"mass\", at_least = 1, why = \"there is something\" }]\n";
const std::string axis = bare_axis + "kind = \"limit\"\n" + mass_precondition;
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
        return [limit](real value) { return value > limit ? std::optional<Break>({"it broke", "it", 3, 0.5}) : std::nullopt; };
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

TEST("an island of breaks below a stable end is found: the axis is climbed, not only tried at its ends") {
    const auto island = [](real value) {
        return value > 5 && value < 20 ? std::optional<Break>({"it broke", "it", 3, 0.5}) : std::nullopt;
    };
    const Limit found = bisect({.low = 0.25, .high = 50}, 1.1, island);
    ASSERT_TRUE(found.first_unstable);
    EXPECT_LE(*found.last_stable, 5);
    EXPECT_LT(*found.first_unstable / *found.last_stable, 1.1);
}

TEST("where runs are nested one run at the end of the axis is enough") {
    const auto counted = [](real limit, int& runs) {
        return [limit, &runs](real value) {
            return ++runs, value > limit ? std::optional<Break>({"it broke", "it", 3, 0.5}) : std::nullopt;
        };
    };
    int runs = 0;
    EXPECT_FALSE(bisect({.low = 1, .high = 100, .nested = true}, 1.1, counted(1000, runs)).first_unstable);
    EXPECT_EQ(runs, 1);
    const Limit found = bisect({.low = 1, .high = 100, .nested = true}, 1.1, counted(7, runs));
    EXPECT_LE(*found.last_stable, 7);
    EXPECT_LT(*found.first_unstable / *found.last_stable, 1.1);
}

TEST("what is watched of some methods only is not required of others") {
    const std::string text =
        "question = \"q\"\nwatch = [{ series = \"mass\", at_most = 2, why = \"w\", methods = [\"a\"] }]\n"
        "[[methods]]\nname = \"a\"\n[[methods]]\nname = \"b\"\n" +
        axis;
    const StressStudy study = parse_stability(text, "stability.toml", "cases/sample", Size::ci);
    EXPECT_EQ(study.stresses.at(0).watch.size(), 1u);
    EXPECT_EQ(study.stresses.at(1).watch.size(), 0u);
}

TEST("an axis may set several keys by powers of its value; what cannot be read is refused") {
    Stress stress{.key = "time.end"};
    stress.base.overrides = {{"grid.cells", "[<8^-1 round>, <4 round>]"}, {"grid.size", "[<0.5>, 1]"}, {"stall_at", "3"}};
    const Variant pushed = pushed_to(stress, 3);
    EXPECT_EQ(pushed.overrides[0].value, "[3, 12]") << "8 / 3 and 4 x 3, as whole numbers";
    EXPECT_EQ(pushed.overrides[1].value, "[1.5, 1]");
    EXPECT_EQ(pushed.overrides[2].value, "3");
    EXPECT_EQ(pushed.overrides[3].key, "time.end");
    stress.base.overrides = {{"grid.size", "[<half>, 1]"}};
    EXPECT_THROW(pushed_to(stress, 3), BadInput);
    EXPECT_NE(
        refusal("question = \"q\"\n[[axes]]\nname = \"n\"\nlow = 1\nhigh = 2\nhard_because = \"h\"\nkind = \"limit\"\n" + mass_precondition)
            .find("an axis needs a \"key\""),
        std::string::npos);
}

TEST("an axis may be for some methods only and have steps of its own; a method that there is not is named") {
    const std::string two = "question = \"q\"\n[[methods]]\nname = \"a\"\n[[methods]]\nname = \"b\"\n" + axis;
    const auto read = [](const std::string& text) { return parse_stability(text, "stability.toml", "cases/sample", Size::ci); };
    EXPECT_EQ(read(two).stresses.size(), 2u);
    const StressStudy one = read(two + "methods = [\"b\"]\nsteps = 7\n");
    ASSERT_EQ(one.stresses.size(), 1u);
    EXPECT_EQ(one.stresses[0].method, "b");
    EXPECT_EQ(one.stresses[0].steps, 7);
    EXPECT_NE(refusal(two + "methods = [\"c\"]\n").find("no method is called \"c\""), std::string::npos);
}

TEST("a map holds one run a pair of values, with what broke first, in JSON, on the terminal, on the page and as a figure") {
    const test::TemporaryFolder folder;
    const std::string map =
        "[[maps]]\nname = \"end against stall\"\nhard_because = \"h\"\nx = { key = \"stall_at\", values = [\"4\", \"1000\"] }\n"
        "y = { key = \"time.end\", values = [\"0.05\", \"1\"] }\n";
    StabilityOptions options;
    options.names = {add(folder.path(), stalls + axis + map).string()}, options.quiet = true;
    options.out = folder.path() / "out", options.publish = folder.path() / "page";
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_success);
    std::ifstream file(folder.path() / "out/study.json");
    const auto json = nlohmann::json::parse(file);
    const auto& cells = json["maps"][0]["cells"];
    EXPECT_TRUE(cells[0][0]["stable"] && cells[1][0]["stable"] && cells[1][1]["stable"]);
    EXPECT_FALSE(cells[0][1]["stable"]);
    EXPECT_EQ(cells[0][1]["step"], 5);
    EXPECT_EQ(cells[0][1]["kind"], "the step failed");
    EXPECT_NE(maps_text(json).find("a the step failed"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder.path() / "page/svg/study-end-against-stall.svg"));
    std::ifstream page(folder.path() / "page/index.md");
    std::ostringstream text;
    text << page.rdbuf();
    EXPECT_NE(text.str().find("svg/study-end-against-stall.svg"), std::string::npos);
    EXPECT_NE(text.str().find("| fake | end |"), std::string::npos) << "the table of all limits names the solver";
}

TEST("published limits are compared with the code by a run at either end: one that moved fails") {
    const test::TemporaryFolder folder;
    StabilityOptions options;
    options.names = {add(folder.path(), stalls + axis).string()}, options.quiet = true;
    options.out = folder.path() / "out", options.publish = folder.path() / "page";
    ASSERT_EQ(stability_command(options, test::fake_kinds()), exit_success);
    options.publish = "", options.compare = folder.path() / "page";
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_success);
    const auto file = folder.path() / "page/pins/study.json";
    std::ifstream stream(file);
    const auto pins = nlohmann::json::parse(stream);
    int ends = 0;
    for (const auto& [name, value] : pins["numbers"].items()) {  // each end as if it had been found elsewhere
        auto moved = pins;
        if (name.ends_with("last stable"))
            moved["numbers"][name] = 10 * value.get<double>(), ++ends;
        else if (name.ends_with("first unstable"))
            moved["numbers"][name] = 0.1 * value.get<double>(), ++ends;
        else
            continue;
        std::ofstream(file) << moved.dump();
        testing::internal::CaptureStderr();
        EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_claim_failed) << name;
        EXPECT_NE(testing::internal::GetCapturedStderr().find(name), std::string::npos);
    }
    EXPECT_GE(ends, 2);
    std::ofstream(file) << pins.dump();
    std::ofstream(folder.path() / "page/study.json") << R"({"limits": []})";
    testing::internal::CaptureStderr();
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_claim_failed);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("its limit is not published"), std::string::npos);
}

TEST("of a slow axis a comparison at ci size runs the guaranteed range alone, and at full size both sides of the limit") {
    const test::TemporaryFolder folder;
    const auto slow = [&](real floor) {
        return add(folder.path(), stalls + axis + "slow = true\nfloor = " + std::to_string(floor) + "\nfloor_why = \"w\"\n").string();
    };
    StabilityOptions options;
    options.names = {slow(0.05)}, options.quiet = true;
    options.out = folder.path() / "out", options.publish = folder.path() / "page";
    ASSERT_EQ(stability_command(options, test::fake_kinds()), exit_success);
    options.publish = "", options.compare = folder.path() / "page";
    const auto file = folder.path() / "page/pins/study.json";
    std::ifstream stream(file);
    auto pins = nlohmann::json::parse(stream);
    for (auto& [name, value] : pins["numbers"].items()) value = 10 * value.get<double>();
    std::ofstream(file) << pins.dump();
    options.size = Size::ci;
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_success) << "the limit is not looked at";
    options.names = {slow(2)};  // it breaks before
    testing::internal::CaptureStdout();
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_claim_failed);
    EXPECT_NE(testing::internal::GetCapturedStdout().find("FAIL  end"), std::string::npos);
    options.names = {slow(0.05)}, options.size = Size::full;
    EXPECT_EQ(stability_command(options, test::fake_kinds()), exit_claim_failed);
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
    EXPECT_FALSE(breaks("at_most = 4, power = 1")) << "4 times 0.5";
    EXPECT_TRUE(breaks("at_most = 2, power = 1")) << "2 times 0.5";
    EXPECT_FALSE(breaks("at_most = 1, power = -1")) << "1 over 0.5";
}

/// The real solver, but for one of its integrals, which is off after the first step.
struct OffByOne final : smoke::FlowSolver<2> {
    std::string name;
    real by;
    OffByOne(const scene::Scene& scene, std::string name_, real by_) : FlowSolver(scene), name(std::move(name_)), by(by_) {}
    std::vector<Integral> integrals() const override {
        auto list = FlowSolver::integrals();
        for (auto& integral : list)
            if (integral.name == name && time() > 0) integral.value += by;
        return list;
    }
};

/// A watch that no run has ever broken might watch nothing.
TEST("each watch of hard_melting sees its own number leave its bound") {
    const auto study = read_stability(WEIR_SOURCE_DIR "/cases/hard_melting", Size::ci);
    const auto of_mac = std::find_if(study.stresses.begin(), study.stresses.end(),
                                     [](const Stress& s) { return s.method == "mac" && s.name == "latent heat"; });
    ASSERT_NE(of_mac, study.stresses.end());
    Stress stress = *of_mac;
    stress.steps = 2, stress.preconditions.clear();
    const auto broke = [&](const std::string& name, real by) {
        auto kind = smoke::kind();
        kind.make = [&, name, by](const scene::Scene& scene, const Partition&) { return std::make_unique<OffByOne>(scene, name, by); };
        return push(stress, 1, {kind});
    };
    EXPECT_FALSE(broke("", 0));
    ASSERT_FALSE(stress.watch.empty());
    for (const Invariant& watch : stress.watch) {
        const std::string series = watch.series.substr(0, watch.series.find('-'));
        const real heat = 1e5;  // of the box: more than 1e5 J/m, so that a millionth of a joule less than that is beyond 1e-12 of it
        const real by = watch.test == Invariant::Test::drift     ? 1e-6 * heat
                        : watch.test == Invariant::Test::at_most ? watch.bound
                                                                 : -2 * std::max<real>(watch.bound, 1);
        const auto seen = broke(series, by);
        ASSERT_TRUE(seen) << watch.text();
        EXPECT_NE(seen->what.find(series), std::string::npos) << seen->what;
        EXPECT_EQ(seen->step, 1) << watch.text();
    }
}

TEST("what is wrong in stability.toml is named") {
    EXPECT_NE(refusal("question = \"q\"\nwatch = [{ series = \"mass\", why = \"w\" }]\n" + axis).find("needs one of: at_most"),
              std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "floor = 1\n").find("\"floor\" needs a \"floor_why\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "slow = true\n").find("\"slow\" needs a \"floor\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "asked = 1\n").find("\"asked\" needs a \"not_reached\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "floor = 1\nfloor_why = \"w\"\nasked = 1\nnot_reached = \"n\"\n")
                  .find("\"asked\" needs a \"floor\" that is smaller"),
              std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + axis + "theory = 1\n").find("\"theory\" needs a \"theory_source\""), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n").find("axes"), std::string::npos);
}

TEST("the command writes limits and page; a guaranteed range that does not pass is exit code 1, in both modes") {
    const test::TemporaryFolder folder;
    const auto run = [&](real floor, bool guaranteed_only) {
        const auto study = add(folder.path(), stalls + axis + "floor = " + std::to_string(floor) + "\nfloor_why = \"w\"\n");
        StabilityOptions options;
        options.names = {study.string()}, options.guaranteed_only = guaranteed_only, options.quiet = true;
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
    EXPECT_NE(text.str().find("below its guaranteed range"), std::string::npos);
    EXPECT_EQ(text.str().find("Open targets"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder.path() / "out/study.json"));
}

TEST("an open target beyond the guaranteed range is listed with its reason, and is an error once it is met") {
    const test::TemporaryFolder folder;
    const auto run = [&](real open_target) {
        const auto study = add(folder.path(), stalls + axis + "floor = 0.1\nfloor_why = \"w\"\nasked = " + std::to_string(open_target) +
                                                  "\nnot_reached = \"its own clock stands still\"\n");
        StabilityOptions options;
        options.names = {study.string()}, options.quiet = true;
        options.out = folder.path() / "out", options.publish = folder.path() / "page";
        return stability_command(options, test::fake_kinds());
    };
    EXPECT_EQ(run(1.5), exit_success);  // it breaks before
    std::stringstream page;
    page << std::ifstream(folder.path() / "page/index.md").rdbuf();
    EXPECT_NE(page.str().find("## Open targets"), std::string::npos);
    EXPECT_NE(page.str().find("its own clock stands still"), std::string::npos);
    EXPECT_EQ(run(0.15), exit_claim_failed);
}

namespace {

/// An axis over a real solver: a film that gets thinner than what the solver can hold.
fs::path film(const fs::path& root, const std::string& solver, const std::string& preconditions) {
    const fs::path folder = root / "film";
    fs::create_directories(folder);
    std::ofstream(folder / "stability.toml")
        << "question = \"q\"\nsteps = 3\n[[axes]]\nname = \"film\"\nlow = 1\nhigh = 4\nhard_because = \"h\"\nkind = \"limit\"\n"
        << "set = [\"liquid = [{ shape = \\\"box\\\", min = [0, 0], max = [1, <0.5^-1>] }]\"]\n"
        << preconditions;
    std::ofstream(folder / "scene.toml") << "solver = \"" << solver
                                         << "\"\ndim = 2\ngrid = { cells = [8, 8], size = [1, 1] }\ntime = { end = 0.1, max_dt = 0.01 }\n";
    return folder;
}

std::string study_error(const Stress& stress, real value) {
    try {
        push(stress, value, sim::registry());
    } catch (const BadInput& wrong) {
        return wrong.what();
    }
    return "";
}

}  // namespace

TEST("an axis must give its preconditions and name its kind; a reason for not being reached belongs to a limit") {
    EXPECT_NE(refusal("question = \"q\"\n" + bare_axis + "kind = \"limit\"\n").find("proof"), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + bare_axis + mass_precondition).find("kind"), std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + bare_axis + "kind = \"units\"\n" + mass_precondition + "unbroken = [{ why = \"w\" }]\n")
                  .find("only an axis"),
              std::string::npos);
    EXPECT_NE(refusal("question = \"q\"\n" + bare_axis + "kind = \"limit\"\nproof = [{ quantity = \"mass\", why = \"w\" }]\n")
                  .find("needs one of: at_least"),
              std::string::npos);
}

TEST("a value without its preconditions is an error of the study, not a limit that was not reached") {
    const test::TemporaryFolder folder;
    const std::string wet = "proof = [{ quantity = \"wet_cells\", at_least = 25, why = \"four layers\" }]\n";
    for (const std::string solver : {"mac_water", "pbf", "sph"}) {
        const Stress stress = only(film(folder.path(), solver, wet));
        EXPECT_EQ(study_error(stress, 1), "") << solver;
        EXPECT_NE(study_error(stress, 4).find("does not meet its stated difficulty: wet_cells is 8, not at least 25: four layers"),
                  std::string::npos)
            << solver << ' ' << study_error(stress, 4);
        EXPECT_THROW(find_limit(stress, 1.5, sim::registry()), BadInput) << solver;
    }
}

TEST("an empty tank is refused by the solver, which breaks the axis") {
    const test::TemporaryFolder folder;
    for (const std::string solver : {"mac_water", "pbf", "sph"}) {
        const Stress stress =
            only(film(folder.path(), solver, "proof = [{ quantity = \"wet_cells\", at_least = 1, why = \"there is liquid\" }]\n"));
        const auto broke = push(stress, 100, sim::registry());
        ASSERT_TRUE(broke) << solver;
        EXPECT_EQ(broke->kind, "refused");
    }
}

TEST("preconditions are measured: film, bodies, pockets, gap, aspect, solids; of the start, the run and its end") {
    const test::TemporaryFolder folder;
    const auto measured = [&](const std::string& solver, const std::string& more) {
        const std::string all =
            "proof = [{ quantity = \"film\", at_least = 0, why = \"w\" }, { quantity = \"bodies\", at_least = 0, why = \"w\" }, "
            "{ quantity = \"pockets\", at_least = 0, why = \"w\" }, { quantity = \"gap\", at_least = 0, why = \"w\" }, "
            "{ quantity = \"aspect\", at_least = 0, why = \"w\" }, { quantity = \"solid_cells\", at_least = 0, why = \"w\" }, "
            "{ quantity = \"solid_speed\", at_least = 0, why = \"w\" }, { quantity = \"dt\", when = \"most\", at_least = 0, why = \"w\" }, "
            "{ quantity = \"steps\", when = \"end\", at_least = 0, why = \"w\" }]\n";
        Stress stress = only(film(folder.path(), solver, all));
        stress.base.overrides.push_back({"solids", more});
        std::vector<MeasuredValue> list;
        EXPECT_FALSE(push(stress, 2, sim::registry(), &list));
        return list;
    };
    // A wall of one cell's width from 1/8 m over the floor to the lid, in a film of 1/4 m: the air above is cut in two.
    const std::string wall =
        "[{ shape = \"box\", min = [0.5, 0.125], max = [0.625, 1], motion = { kind = \"constant\", velocity = [0, 0.01] } }]";
    for (const std::string solver : {"mac_water", "pbf"}) {
        const auto list = measured(solver, wall);
        ASSERT_EQ(list.size(), 9u) << solver;
        const real layers = 15.0 / 8;  // what would be inside the wall is left out
        EXPECT_NEAR(list[0].value, layers, 0.05) << solver << " film";
        EXPECT_EQ(list[1].value, 1) << solver << " bodies, joined below the wall";
        EXPECT_EQ(list[2].value, 2) << solver << " pockets";
        EXPECT_NEAR(list[3].value, 1, 1.0 / 16) << solver << " gap";
        EXPECT_NEAR(list[4].value, 1, 1e-12) << solver << " aspect";
        EXPECT_EQ(list[5].value, 7) << solver << " solid cells";
        EXPECT_NEAR(list[6].value, 0.01, 1e-12) << solver << " speed";
        EXPECT_GT(list[7].value, 0) << solver << " dt";
        EXPECT_EQ(list[8].value, 3) << solver << " steps";
    }
}

TEST("a limit that ends unbroken without a reason, or breaks in spite of one, and units that differ, do not pass") {
    Limit limit{.climbed = true, .last_stable = 1.0};
    EXPECT_NE(limit.doubt(), "");
    limit.stress.unbroken = "nothing can";
    EXPECT_EQ(limit.doubt(), "");
    limit.first_unstable = 2;
    EXPECT_NE(limit.doubt(), "");
    limit.stress.unbroken.clear();
    EXPECT_EQ(limit.doubt(), "");
    limit.stress.kind = AxisKind::units;
    EXPECT_NE(limit.doubt(), "");
    limit.climbed = false;  // a guaranteed range alone does not measure the axis
    EXPECT_EQ(limit.doubt(), "");
}

}  // namespace stability_tests
