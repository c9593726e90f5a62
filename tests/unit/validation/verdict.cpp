// The judge on runs whose numbers are made up.
#include "validation/harness/verdict.hpp"

#include "support/test.hpp"

namespace verdict_tests {

using namespace weir;
using namespace weir::validation;
using Test = Criterion::Test;

namespace {

Criterion claim(Test test, real low, real high) {
    Criterion c{.metric = "velocity.l2", .test = test, .low = low, .high = high, .why = "a test"};
    return c;
}

RunResult run(real n, real error) {
    RunResult r{.label = std::to_string(static_cast<int>(n)), .value = n, .h = 1 / n, .seconds = 2};
    r.measured["velocity.l2"] = error;
    return r;
}

Verdict judged(const Criterion& c, const std::vector<RunResult>& runs) {
    const auto verdicts = judge({.name = "v", .accept = {c}}, runs);
    EXPECT_EQ(verdicts.size(), 1u);
    return verdicts.at(0);
}

constexpr real inf = infinity;

}  // namespace

TEST("a bound holds on its edge and fails just beyond it") {
    EXPECT_TRUE(judged(claim(Test::at_most, -inf, 0.1), {run(8, 0.1)}).pass);
    EXPECT_FALSE(judged(claim(Test::at_most, -inf, 0.1), {run(8, std::nextafter(0.1, 1))}).pass);
    EXPECT_FALSE(judged(claim(Test::at_least, 0.2, inf), {run(8, 0.1)}).pass);
    EXPECT_FALSE(judged(claim(Test::within, 0.2, 0.3), {run(8, 0.31)}).pass);
    EXPECT_TRUE(judged(claim(Test::within, 0.2, 0.3), {run(8, 0.25)}).pass);
}

TEST("NaN, infinity and a metric that was not measured fail every kind of claim") {
    for (const Test test : {Test::at_most, Test::at_least, Test::within, Test::order_at_least, Test::gci_at_most, Test::never_increases}) {
        const real low = test == Test::at_most ? -inf : -10, high = test == Test::at_least ? inf : 10;
        const Verdict v = judged(claim(test, low, high), {run(8, 0.1), run(16, std::nan(""))});
        EXPECT_FALSE(v.pass) << name(test);
        EXPECT_TRUE(std::isnan(v.measured)) << name(test);
        RunResult empty = run(16, 0);
        empty.measured.clear();
        EXPECT_FALSE(judged(claim(test, low, high), {run(8, 0.1), empty}).pass) << name(test);
    }
    EXPECT_FALSE(judged(claim(Test::at_most, -inf, 10), {run(8, inf)}).pass);
}

TEST("an ensemble agrees with experiments within twice the validation uncertainty, whose parts are those of V&V 20") {
    Criterion c = claim(Test::agrees_with, -inf, inf);
    c.metric = "kinetic_energy";
    c.experiment = Experiment{.mean = 10, .deviation = 4, .samples = 16, .median = 9.5, .grids = "grids"};  // u_D = 1
    Variant of_grids{.name = "grids", .sweep = Sweep{.key = "grid.cells", .values = {10, 20, 40}}};
    VariantResult grids{.plan = of_grids, .runs = {run(10, 0), run(20, 0), run(40, 0)}, .verdicts = {}};
    for (RunResult& r : grids.runs) r.measured = {{"kinetic_energy", 2 + 160 * r.h}};  // first order: U = 1.5 times 4, u_num = 3
    const auto judged_with = [&](real first, real second, const std::vector<VariantResult>& before) {
        std::vector<RunResult> ensemble = {run(1, 0), run(2, 0)};
        ensemble[0].measured = {{"kinetic_energy", first}}, ensemble[1].measured = {{"kinetic_energy", second}};
        return judge({.name = "v", .accept = {c}}, ensemble, before).at(0);
    };
    const real two = std::sqrt(2.0);  // of m -+ sqrt(2): mean m, standard deviation u_input = 2
    const Verdict close = judged_with(15 - two, 15 + two, {grids});
    EXPECT_NEAR(close.measured, 0.5, 1e-12);
    EXPECT_NEAR(close.high, 2 * std::sqrt(9.0 + 4.0 + 1.0) / 10, 1e-9);
    EXPECT_TRUE(close.pass);
    EXPECT_NE(close.note.find("a model error above 74.8% would be told apart"), std::string::npos) << close.note;
    c.experiment->power = 0.7;
    EXPECT_FALSE(judged_with(15 - two, 15 + two, {grids}).pass);  // it could not tell 70% apart
    c.experiment->power = 1;
    EXPECT_FALSE(judged_with(18 - two, 18 + two, {grids}).pass);
    EXPECT_FALSE(judged_with(2 - two, 2 + two, {grids}).pass);  // below as well
    EXPECT_FALSE(judged_with(10, std::nan(""), {grids}).pass);
    grids.runs[1].measured = {{"kinetic_energy", std::nan("")}};
    EXPECT_FALSE(judged_with(10, 11, {grids}).pass);  // no band, no verdict
}

TEST("a value of a sweep over three grids has a band, and its claim is judged by it") {
    Criterion uncertainty = claim(Test::gci_at_most, -inf, 0.1), bound = claim(Test::at_least, 1, inf);
    uncertainty.metric = bound.metric = "kinetic_energy";
    const Variant plan{.name = "v", .sweep = Sweep{.key = "grid.cells", .values = {10, 20, 40}}, .accept = {uncertainty, bound}};
    std::vector<RunResult> runs = {run(10, 0), run(20, 0), run(40, 0)};
    for (RunResult& r : runs) r.measured = {{"kinetic_energy", 2 + 4 * r.h}};
    const auto verdicts = judge(plan, runs);
    EXPECT_NEAR(verdicts[0].measured, 1.5 * 0.1 / 2.1, 1e-9);  // first order: U = 1.5 times the error
    EXPECT_TRUE(verdicts[0].pass);
    EXPECT_NEAR(verdicts[1].band, 0.15, 1e-9);
    runs[1].measured["kinetic_energy"] = 2;
    const Verdict oscillating = judge(plan, runs)[0];
    EXPECT_EQ(oscillating.note, "oscillates");
    EXPECT_NEAR(oscillating.measured, 2 * 0.4 / 2 / 2.1, 1e-9);  // the coarse difference counts
    EXPECT_FALSE(oscillating.pass);
}

TEST("a run that failed fails the claims that rest on it, with its message, and no other") {
    RunResult broken = run(16, 0.01);
    broken.failure = "step 41: the velocity is not finite";
    const Verdict last = judged(claim(Test::at_most, -inf, 1), {run(8, 0.1), broken});
    EXPECT_FALSE(last.pass);
    EXPECT_EQ(last.note, "step 41: the velocity is not finite");
    EXPECT_FALSE(judged(claim(Test::order_at_least, 0.1, inf), {broken, run(32, 1e-4), run(64, 1e-5)}).pass);
    Criterion first = claim(Test::at_most, -inf, 1);
    first.at = 8;
    EXPECT_TRUE(judged(first, {run(8, 0.1), broken}).pass);
}

TEST("a claim speaks of the last run, of the one it names, or of the worst of all") {
    const std::vector<RunResult> runs = {run(8, 0.3), run(16, 0.5), run(32, 0.1)};
    Criterion c = claim(Test::at_most, -inf, 0.2);
    EXPECT_EQ(judged(c, runs).measured, 0.1);
    c.at = 8;
    EXPECT_EQ(judged(c, runs).measured, 0.3);
    c.at.reset();
    c.every = true;
    const Verdict worst = judged(c, runs);
    EXPECT_EQ(worst.measured, 0.5);
    EXPECT_EQ(worst.at, "16");
    EXPECT_FALSE(worst.pass);
    EXPECT_EQ(worst.seconds, 6);
    const Verdict unknown = judged(claim(Test::at_most, -inf, 0.6), {run(8, 0.3), run(16, std::nan("")), run(32, 0.1)});
    EXPECT_TRUE(unknown.pass) << "of the last run alone";
    Criterion all = claim(Test::at_most, -inf, 0.6);
    all.every = true;
    EXPECT_FALSE(judged(all, {run(8, 0.3), run(16, std::nan("")), run(32, 0.1)}).pass) << "what is not a number is the worst";
}

TEST("an order is taken from the finest pair, and a stalled one fails") {
    const std::vector<RunResult> runs = {run(8, 1), run(16, 0.3), run(32, 0.075)};
    EXPECT_NEAR(judged(claim(Test::order_at_least, 1.9, inf), runs).measured, 2, 1e-12);
    EXPECT_TRUE(judged(claim(Test::order_at_least, 1.9, inf), runs).pass);
    EXPECT_FALSE(judged(claim(Test::order_at_least, 1.9, inf), {run(8, 1), run(16, 0.25), run(32, 0.24)}).pass);
    EXPECT_FALSE(judged(claim(Test::order_within, 1.98, 2.02), {run(8, 1), run(16, 0.25), run(32, 0.05)}).pass);
}

TEST("the order of a value whose grids oscillate may not be quoted") {
    Criterion c = claim(Test::order_at_least, 0.5, inf);
    c.metric = "nusselt";  // not an error: its limit is unknown
    std::vector<RunResult> runs;
    const std::vector<std::pair<real, real>> swinging = {{8, 6.0909}, {16, 5.9624}, {32, 6.0042}},
                                             clean = {{8, 2.16}, {16, 2.04}, {32, 2.01}};
    for (const auto& [n, value] : swinging) runs.push_back(run(n, 0)), runs.back().measured["nusselt"] = value;
    const Verdict v = judged(c, runs);
    EXPECT_FALSE(v.pass);
    EXPECT_NE(v.note.find("oscillating"), std::string::npos);
    runs.clear();
    for (const auto& [n, value] : clean) runs.push_back(run(n, 0)), runs.back().measured["nusselt"] = value;
    EXPECT_NEAR(judged(c, runs).measured, 2, 1e-6);
    EXPECT_TRUE(judged(c, runs).pass);
}

TEST("a series that rises once fails never_increases, by how much it rose") {
    const Curve falling{.label = "e", .x = {0, 1, 2}, .y = {4, 2, 1}}, rising{.label = "e", .x = {0, 1, 2}, .y = {4, 2, 2.5}};
    EXPECT_LT(largest_rise(falling), 0);
    EXPECT_NEAR(largest_rise(rising), 0.5 / 4, 1e-15);
    EXPECT_NEAR(largest_rise(falling, true), 0.5, 1e-15);
    EXPECT_TRUE(std::isnan(largest_rise(Curve{.label = "e", .x = {0, 1}, .y = {1, std::nan("")}})));
    EXPECT_TRUE(std::isnan(largest_rise(Curve{.label = "e", .x = {0}, .y = {1}})));
    RunResult r = run(8, 0);
    r.series["velocity.l2"] = rising;
    EXPECT_FALSE(judged(claim(Test::never_increases, -inf, 1e-12), {r}).pass);
    r.series["velocity.l2"] = falling;
    EXPECT_TRUE(judged(claim(Test::never_increases, -inf, 1e-12), {r}).pass);
}

}  // namespace verdict_tests
