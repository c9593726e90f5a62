// Reads case.toml: checked against case_keys(), then as a whole, then resolved for one size.
#include "validation/harness/case.hpp"

#include "scene/names.hpp"
#include "validation/harness/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace weir::validation {
namespace {

using scene::Table;

constexpr std::array<std::string_view, 4> kinds = {"exact", "convergence", "benchmark", "iterations"};
constexpr std::array<std::string_view, 10> tests = {"at_most",      "at_least",    "within",          "equals",          "order_at_least",
                                                    "order_within", "gci_at_most", "never_increases", "never_decreases", "agrees_with"};
constexpr real round_off_slack = 1e-12;  // relative; what 1e4 additions of doubles may leave

/// Reads one file; collects what the schema alone cannot see.
class Reader {
public:
    Reader(std::string_view source, std::string file, std::filesystem::path folder, Size size)
        : source_(source), file_(std::move(file)), folder_(std::move(folder)), variants_(file_, folder_, size) {}

    Case read() {
        const Table root = scene::parse_table(source_, file_, case_keys());
        Case c;
        c.name = folder_.filename().string(), c.folder = folder_, c.size = variants_.size();
        c.question = variants_.said(root, "question"), c.blind_to = variants_.said(root, "blind_to");
        c.kind = static_cast<Kind>(std::find(kinds.begin(), kinds.end(), root.text("kind")) - kinds.begin());
        for (const Variant& v : variants_.read(root, "variants", [this](Variant&to, const Table&t) { add_claims(to, t); })) {
            if (v.accept.empty()) continue;
            check(v, c.kind);
            check_experiments(c.variants, v);
            c.variants.push_back(v);
        }
        if (claims_ == 0) problem(root.place("kind"), "the case makes no claim: add an [[accept]] entry to it or its variants");
        if (!variants_.problems().empty()) throw scene::BadScene(variants_.problems(), source_);
        return c;
    }

private:
    void problem(scene::Place at, std::string message, std::string hint = "") {
        variants_.problem(at, std::move(message), std::move(hint));
    }

    void add_claims(Variant& v, const Table& t) {
        for (const Table& a : t.tables("accept")) {
            const Criterion criterion = read_criterion(a);
            if (!a.has("size") || a.text("size") == name(variants_.size())) v.accept.push_back(criterion);
        }
    }

    Criterion read_criterion(const Table& t) {
        ++claims_;
        Criterion c{.metric = variants_.said(t, "metric"), .why = variants_.said(t, "why"), .place = t.place("metric")};
        if (t.has("not_reached")) c.not_reached = variants_.said(t, "not_reached");
        std::vector<std::string_view> given;
        for (const std::string_view test : tests)
            if (t.has(test)) given.push_back(test);
        if (given.size() != 1) {
            problem(t.place("metric"),
                    given.empty() ? fmt::format("\"{}\" has no test", c.metric)
                                  : fmt::format("\"{}\" has {} tests, one is needed", c.metric, given.size()),
                    fmt::format("known: {}", fmt::join(tests, ", ")));
            return c;
        }
        c.test = static_cast<Criterion::Test>(std::find(tests.begin(), tests.end(), given.front()) - tests.begin());
        read_bound(c, t, given.front());
        c.every = t.has("every") && t.flag("every");
        if (t.has("at")) c.at = t.number("at");
        return c;
    }

    void read_bound(Criterion& c, const Table& t, std::string_view key) {
        using Test = Criterion::Test;
        switch (c.test) {
            case Test::at_most:
            case Test::gci_at_most:
                c.high = t.number(key);
                break;
            case Test::at_least:
            case Test::order_at_least:
                c.low = t.number(key);
                break;
            case Test::within:
            case Test::order_within:
                c.low = t.numbers(key).at(0), c.high = t.numbers(key).at(1);
                if (c.low > c.high) problem(t.place(key), fmt::format("\"{}\" needs its lower bound first", key));
                break;
            case Test::equals:
                if (!t.has("tolerance")) problem(t.place(key), "\"equals\" needs a \"tolerance\"");
                c.low = t.number(key) - t.number_or("tolerance", 0), c.high = t.number(key) + t.number_or("tolerance", 0);
                break;
            case Test::never_increases:
            case Test::never_decreases:
                if (!t.flag(key)) problem(t.place(key), fmt::format("\"{} = false\" makes no claim", key));
                c.high = t.number_or("slack", round_off_slack);
                break;
            case Test::agrees_with:
                c.experiment = read_experiment(t.table(key));
                break;
        }
        c.formal_order = t.number_or("formal_order", std::nan(""));
    }

    static Experiment read_experiment(const Table& t) {
        Experiment e{.mean = t.number("mean"), .deviation = t.number("deviation"), .samples = static_cast<int>(t.integer("samples"))};
        if (t.has("median")) e.median = t.number("median");
        e.power = t.number("power");
        if (t.has("grids")) e.grids = t.text("grids");
        return e;
    }

    /// The variants whose grids give an uncertainty come before those that use it, and measure what they compare.
    void check_experiments(std::vector<Variant>& before, const Variant& v) {
        for (const Criterion& c : v.accept) {
            if (!c.experiment) continue;
            if (v.runs() < 2) problem(c.place, "an ensemble needs a sweep of at least two values");
            const auto grids = std::find_if(before.begin(), before.end(), [&](const Variant& b) { return b.name == c.experiment->grids; });
            if (grids != before.end())
                grids->measured_too.push_back(c.metric);
            else if (!c.experiment->grids.empty())
                problem(c.place, fmt::format("grids = {} is no variant before this one", scene::quote(c.experiment->grids)));
        }
    }

    /// What kind and claims need of the variant's sweep.
    void check(const Variant& v, Kind kind) {
        const std::size_t grids = v.runs();
        if (kind == Kind::convergence && grids < 2)
            problem(v.accept.front().place, "kind \"convergence\" needs a sweep of at least two values");
        for (const Criterion& c : v.accept) {
            if (c.is_order() && grids < 2) problem(c.place, "an order needs a sweep of at least two values");
            if (c.test == Criterion::Test::gci_at_most && (grids < 2 || (grids == 2 && std::isnan(c.formal_order))))
                problem(c.place, "a grid convergence index needs three grids, or two and a \"formal_order\"");
            if (!c.at) continue;
            if (!v.sweep)
                problem(c.place, "\"at\" names a sweep value, but the case has no sweep");
            else if (std::find(v.sweep->values.begin(), v.sweep->values.end(), *c.at) == v.sweep->values.end())
                problem(c.place, fmt::format("at = {} is no value of the sweep at {} size", *c.at, name(variants_.size())),
                        fmt::format("values: {}", fmt::join(v.sweep->values, ", ")));
        }
    }

    std::string_view source_;
    std::string file_;
    std::filesystem::path folder_;
    VariantReader variants_;
    int claims_ = 0;
};

}  // namespace

std::string_view name(Size size) { return size == Size::ci ? "ci" : "full"; }
std::string_view name(Kind kind) { return kinds[static_cast<std::size_t>(kind)]; }
std::string_view name(Criterion::Test test) { return tests[static_cast<std::size_t>(test)]; }

Case parse_case(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size) {
    return Reader(text, file, folder, size).read();
}

Case read_case(const std::filesystem::path& folder, Size size) {
    const auto file = folder / "case.toml";
    return parse_case(scene::read_text(file), file.string(), folder, size);
}

Case cut_short(Case c, std::int64_t steps) {
    const auto first_alone = [](std::vector<real>& values) { values.resize(1); };
    for (Variant& v : c.variants) {
        if (!v.sweep) continue;
        first_alone(v.sweep->values);
        for (auto& also : v.sweep->also) first_alone(also.values);
    }
    c.cut = steps;
    return c;
}

std::filesystem::path frames_folder(const Case& c, const Variant& variant, std::size_t i) {
    std::filesystem::path folder = c.name;
    if (!variant.name.empty()) folder /= variant.name;
    if (variant.sweep) folder /= fmt::format("{:g}", variant.sweep->values.at(i));
    return folder;
}

std::vector<std::filesystem::path> find_cases(const std::filesystem::path& root) {
    std::vector<std::filesystem::path> found;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(root, unreadable))
        if (std::filesystem::exists(entry.path() / "case.toml")) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace weir::validation
