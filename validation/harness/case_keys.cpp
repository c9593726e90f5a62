// Schema of case.toml.
#include "validation/harness/case.hpp"
#include "validation/harness/variants.hpp"

namespace weir::validation {
namespace {

using scene::Key;
using scene::Type;

Key text(std::string name, std::string doc, bool required = false) {
    return {.name = std::move(name), .type = Type::text, .doc = std::move(doc), .required = required};
}
Key number(std::string name, std::string doc) { return {.name = std::move(name), .type = Type::number, .doc = std::move(doc)}; }
Key pair(std::string name, std::string doc) { return {.name = std::move(name), .type = Type::numbers, .doc = std::move(doc), .length = 2}; }
Key flag(std::string name, std::string doc) { return {.name = std::move(name), .type = Type::flag, .doc = std::move(doc)}; }
Key values(std::string name, std::string doc, bool required = false) {
    return {.name = std::move(name), .type = Type::numbers, .doc = std::move(doc), .required = required};
}
Key positive(std::string name, std::string doc, std::string unit = "") {
    return {.name = std::move(name), .type = Type::number, .doc = std::move(doc), .unit = std::move(unit), .min = 0, .min_open = true};
}
Key table(std::string name, std::string doc, std::vector<Key> keys) {
    return {.name = std::move(name), .type = Type::table, .doc = std::move(doc), .keys = std::move(keys)};
}
Key tables(std::string name, std::string doc, std::vector<Key> keys) {
    return {.name = std::move(name), .type = Type::tables, .doc = std::move(doc), .keys = std::move(keys)};
}
Key changes() { return {.name = "set", .type = Type::texts, .doc = "Changes to the scene, as --set takes them: \"key = value\"."}; }

Key sweep() {
    return table(
        "sweep", "One key of the scene through several values.",
        {text("key", "The key; grid.cells counts cells along `axis`, other axes keep the scene's proportions.", true),
         values("values", "Its values at full size, from coarse to fine.", true),
         values("ci", "Its values at ci size; absent: the same."),
         {.name = "axis", .type = Type::choice, .doc = "The axis that grid.cells counts.", .fallback = "x", .choices = {"x", "y", "z"}},
         {.name = "keep", .type = Type::texts, .doc = "Axes whose cells stay as the scene has them.", .choices = {"x", "y", "z"}},
         tables("also", "Keys that move with it, value by value.",
                {text("key", "The key.", true), values("values", "Values at full size.", true), values("ci", "Values at ci size.")})});
}

Key accept() {
    return tables(
        "accept", "A claim: a metric, one test, and the rationale of the bound.",
        {text("metric", "What is measured.", true),
         text("why", "Rationale of the bound.", true),
         text("not_reached",
              "Reason why this bound, an open target, is not met: it is listed and not claimed, and an error once it is met."),
         number("at_most", "Measured <= this."),
         number("at_least", "Measured >= this."),
         pair("within", "low <= measured <= high."),
         number("equals", "|measured - this| <= tolerance."),
         positive("tolerance", "Absolute, for `equals`."),
         number("order_at_least", "Observed order at the finest grids."),
         pair("order_within", "low <= observed order <= high."),
         positive("gci_at_most",
                  "Uncertainty of the finest grid, relative (0.01: one per cent): the band of three grids, or with two the grid "
                  "convergence index."),
         positive("formal_order", "Formal order assumed by gci_at_most on two grids."),
         flag("never_increases", "The series never rises over the run, beyond `slack`."),
         flag("never_decreases", "The series never falls over the run, beyond `slack`."),
         table(
             "agrees_with",
             "The mean over the sweep, an ensemble, differs from that of repeated experiments by at most twice the validation uncertainty "
             "(ASME V&V 20).",
             {{.name = "mean", .type = Type::number, .doc = "Mean of the experiments.", .required = true},
              {.name = "deviation", .type = Type::number, .doc = "Their standard deviation.", .required = true, .min = 0},
              {.name = "samples", .type = Type::integer, .doc = "Their number.", .required = true, .min = 1},
              number("median", "Their median."),
              {.name = "power",
               .type = Type::number,
               .doc = "The model error, relative to the mean, that the comparison must be able to tell apart; else it fails.",
               .fallback = 1.0,
               .min = 0,
               .min_open = true},
              text("grids", "The variant whose grids give the numerical uncertainty.")}),
         positive("slack", "For never_*: allowed change per step, relative to the largest value. Absent: 1e-12, round-off of a long sum."),
         number("at", "The sweep value to which the claim applies; absent: the last."),
         flag("every", "The claim applies to the worst value of the whole sweep."),
         {.name = "size", .type = Type::choice, .doc = "Claimed only at this size; absent: at both.", .choices = {"ci", "full"}}});
}

std::vector<Key> of_one_size() { return {changes(), positive("time_limit", "A run that takes longer fails.", "s")}; }

/// What a variant may say, and the case for all its variants.
std::vector<Key> shared_keys() {
    std::vector<Key> keys = variant_keys();
    keys.push_back(accept());
    return keys;
}

}  // namespace

std::vector<Key> variant_keys() {
    return {text("scene", "The scene's file, from the folder of this one; absent: scene.toml."),
            text("reference", "What the runs are compared with, by name."),
            changes(),
            sweep(),
            table("ci", "Only at ci size.", of_one_size()),
            table("full", "Only at full size.", of_one_size())};
}

const std::vector<Key>& case_keys() {
    static const std::vector<Key> keys = [] {
        std::vector<Key> list = {text("question", "Question of the case.", true),
                                 text("blind_to", "What it does not cover.", true),
                                 {.name = "kind",
                                  .type = Type::choice,
                                  .doc = "exact and convergence verify, benchmark validates, iterations weighs accuracy against work.",
                                  .required = true,
                                  .choices = {"exact", "convergence", "benchmark", "iterations"}}};
        std::vector<Key> variant = {text("name", "Its name in tables, plots and folders.", true)};
        variant.push_back(
            {.name = "size", .type = Type::choice, .doc = "Run only at this size; absent: at both.", .choices = {"ci", "full"}});
        for (const Key& k : shared_keys()) list.push_back(k), variant.push_back(k);
        list.push_back(table("over", "One variant for each value of a key of the scene, named by the value.",
                             {text("key", "The key.", true),
                              {.name = "values", .type = Type::texts, .doc = "Its values at full size.", .required = true},
                              {.name = "ci", .type = Type::texts, .doc = "Its values at ci size; absent: the same."}}));
        list.push_back(tables("variants", "Configurations, each run and evaluated separately; keys of the case apply to all.", variant));
        return list;
    }();
    return keys;
}

}  // namespace weir::validation
