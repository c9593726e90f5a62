// What case.toml may say, and how it is refused when it says something else.
#include "validation/harness/case.hpp"

#include "support/test.hpp"

namespace case_tests {

using namespace weir;
using namespace weir::validation;

namespace {

const std::string head = R"(
question = "Does it converge?"
blind_to = "everything else"
kind = "convergence"
reference = "taylor_green"
)";

Case read(const std::string& text, Size size = Size::full) { return parse_case(text, "case.toml", "cases/sample", size); }

/// The messages of a refused case, one a line.
std::string refusal(const std::string& text, Size size = Size::full) {
    try {
        read(text, size);
    } catch (const scene::BadScene& bad) {
        std::string all;
        for (const auto& p : bad.problems) all += std::to_string(p.place.line) + ": " + p.message + "\n";
        return all;
    }
    return "accepted";
}

void expect_refused(const std::string& text, const std::string& message) {
    EXPECT_NE(refusal(text).find(message), std::string::npos) << "expected: " << message << "\ngot: " << refusal(text);
}

}  // namespace

TEST("a case is read with its sweep of the requested size, its changes and its claims") {
    const std::string text = head + R"(
set = ["fluid.viscosity = 0.02"]
sweep = { key = "grid.cells", values = [32, 64, 128], ci = [16, 32] }
ci = { set = ["time.end = 0.5"], time_limit = 20 }
accept = [
  { metric = "velocity.l2", order_at_least = 1.8, why = "formal order 2 less 0.2" },
  { metric = "energy", never_increases = true, why = "no forcing", size = "full" },
]
)";
    const Case full = read(text), ci = read(text, Size::ci);
    EXPECT_EQ(full.name, "sample");
    ASSERT_EQ(full.variants.size(), 1u);
    EXPECT_EQ(full.variants[0].sweep->values, (std::vector<real>{32, 64, 128}));
    EXPECT_EQ(full.variants[0].overrides.size(), 1u);
    ASSERT_EQ(full.variants[0].accept.size(), 2u);
    EXPECT_EQ(full.variants[0].accept[0].low, 1.8);
    EXPECT_EQ(full.variants[0].accept[1].test, Criterion::Test::never_increases);
    EXPECT_EQ(ci.variants[0].sweep->values, (std::vector<real>{16, 32}));
    EXPECT_EQ(ci.variants[0].overrides.back().key, "time.end");
    EXPECT_EQ(ci.variants[0].time_limit, 20);
    EXPECT_EQ(ci.variants[0].accept.size(), 1u);  // the other is claimed at full size only
}

TEST("variants add their changes and claims to those of the case, and 'over' makes one for each value") {
    const Case c = read(head + R"(
sweep = { key = "grid.cells", values = [32, 64] }
accept = [ { metric = "divergence.max", at_most = 1e-8, why = "tolerance" } ]
[[variants]]
name = "maccormack"
set = ["scheme.advection = maccormack"]
accept = [ { metric = "velocity.l2", order_at_least = 1.8, why = "formal order" } ]
[[variants]]
name = "slow"
size = "ci"
)");
    ASSERT_EQ(c.variants.size(), 1u);  // "slow" is not run at full size
    EXPECT_EQ(c.variants[0].accept.size(), 2u);
    const Case over = read(head + R"(
sweep = { key = "grid.cells", values = [32, 64] }
over = { key = "scheme.poisson.method", values = ["cg", "multigrid"] }
accept = [ { metric = "pressure.l2", order_within = [1.98, 2.02], why = "second order" } ]
)");
    ASSERT_EQ(over.variants.size(), 2u);
    EXPECT_EQ(over.variants[1].name, "multigrid");
    EXPECT_EQ(over.variants[1].overrides.back().value, "multigrid");
}

TEST("values of 'over' name folders, at either size: what is no such name, or stands twice, is refused with its line") {
    const std::string rest = "accept = [ { metric = \"x\", at_most = 1, why = \"w\" } ]\n";
    const auto over = [&](const std::string& lists) { return head + rest + "over = { key = \"title\", " + lists + " }\n"; };
    for (const std::string value : {"'\"a\"'", "'../x'", "'`x`'", "'a b'", "\"a'b\"", "'..'", "'.'", "''"}) {
        EXPECT_NE(refusal(over("values = ['a', " + value + "]")).find("7: "), std::string::npos) << value;
        EXPECT_NE(refusal(over("values = ['a'], ci = ['a', " + value + "]")).find("7: "), std::string::npos) << value;  // read at full size
    }
    expect_refused(over("values = ['a', 'a']"), "7: two variants are called \"a\"");
    expect_refused(head + rest + "[[variants]]\nname = \"..\"\n", "\"..\" is not a valid name of a variant");
    EXPECT_EQ(refusal(over("values = ['-1.5e+3', 'cg_mic0']")).find("may have"), std::string::npos);
}

TEST("a claim without a reason, and a case that does not say what it does not cover, are refused") {
    expect_refused("question = \"q\"\nkind = \"exact\"\naccept = [ { metric = \"x\", at_most = 1, why = \"w\" } ]", "blind_to");
    expect_refused(head + "sweep = { key = \"grid.cells\", values = [1, 2] }\naccept = [ { metric = \"x\", at_most = 1 } ]", "why");
    expect_refused(head + "sweep = { key = \"grid.cells\", values = [1, 2] }\naccept = [ { metric = \"x\", at_most = 1, why = \" \" } ]",
                   "\"why\" is empty");
}

TEST("unknown keys and kinds are refused with the name that was meant") {
    expect_refused(head + "sweep = { key = \"grid.cells\", values = [1, 2] }\naccept = [ { metric = \"x\", at_mots = 1, why = \"w\" } ]",
                   "did you mean \"at_most\"?");
    expect_refused("question = \"q\"\nblind_to = \"b\"\nkind = \"convergance\"\naccept = [ { metric = \"x\", at_most = 1, why = \"w\" } ]",
                   "did you mean \"convergence\"?");
}

TEST("every problem of the file is listed, with its line") {
    const std::string text = R"(question = "q"
blind_to = "b"
kind = "convergence"
sweep = { key = "grid.cells", values = [16, 32], also = [ { key = "time.dt", values = [0.1] } ] }
accept = [
  { metric = "a", why = "no test" },
  { metric = "b", at_most = 1, at_least = 0, why = "two tests" },
  { metric = "c", equals = 1, why = "no tolerance" },
  { metric = "d", within = [2, 1], why = "upside down" },
  { metric = "e", at_most = 1, at = 64, why = "not in the sweep" },
  { metric = "f", gci_at_most = 0.01, why = "two grids, no order" },
  { metric = "g", never_increases = false, why = "claims nothing" },
])";
    const std::string all = refusal(text);
    for (const char* expected : {"4: \"time.dt\" has 1 values at full size, the sweep has 2", "6: \"a\" has no test",
                                 "7: \"b\" has 2 tests, one is needed", "8: \"equals\" needs a \"tolerance\"",
                                 "9: \"within\" needs its lower bound first", "10: at = 64 is no value of the sweep at full size",
                                 "11: a grid convergence index needs three grids, or two and a \"formal_order\"",
                                 "12: \"never_increases = false\" makes no claim"})
        EXPECT_NE(all.find(expected), std::string::npos) << "expected: " << expected << "\ngot: " << all;
}

TEST("an order without a sweep, a case without a claim, and two variants of one name are refused") {
    expect_refused("question = \"q\"\nblind_to = \"b\"\nkind = \"exact\"\naccept = [ { metric = \"x\", order_at_least = 1, why = \"w\" } ]",
                   "an order needs a sweep of at least two values");
    expect_refused("question = \"q\"\nblind_to = \"b\"\nkind = \"exact\"", "makes no claim");
    expect_refused(head + R"(
accept = [ { metric = "x", at_most = 1, why = "w" } ]
variants = [ { name = "a b" }, { name = "c" }, { name = "c" } ]
)",
                   "two variants are called \"c\"");
}

TEST("a sweep with a value twice is refused: it names a folder and published numbers") {
    expect_refused(
        head + "sweep = { key = \"time.dt\", values = [0.1, 0.2, 0.1] }\naccept = [ { metric = \"x\", at_most = 1, why = \"w\" } ]",
        "the sweep has the value 0.1 twice");
}

TEST("an ensemble needs a sweep, and grids of a variant before it, which then measures what is compared") {
    const auto ensemble = [](const std::string& grids, const std::string& sweep) {
        return head +
               "[[variants]]\nname = \"g\"\nsweep = { key = \"grid.cells\", values = [8, 16, 32] }\n"
               "accept = [ { metric = \"y\", at_most = 1, why = \"w\" } ]\n[[variants]]\nname = \"e\"\n" +
               sweep + "accept = [ { metric = \"x\", agrees_with = { mean = 1, deviation = 1, samples = 9, grids = \"" + grids +
               "\" }, why = \"w\" } ]\n";
    };
    const std::string seeds = "sweep = { key = \"scheme.seed\", values = [1, 2] }\n";
    expect_refused(ensemble("e", seeds), "grids = \"e\" is no variant before this one");
    expect_refused(ensemble("g", ""), "an ensemble needs a sweep of at least two values");
    const Case c = read(ensemble("g", seeds));
    EXPECT_EQ(c.variants.at(0).measured_too, std::vector<std::string>{"x"});
    EXPECT_EQ(c.variants.at(1).accept.at(0).experiment->power, 1);
}

}  // namespace case_tests
