// Reads case.toml: checked against case_keys(), then as a whole, then resolved for one size.
#include "validation/harness/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace weir::validation {
namespace {

using scene::Override;
using scene::Problem;
using scene::Table;

constexpr std::array<std::string_view, 4> kinds = {"exact", "convergence", "benchmark", "iterations"};
constexpr std::array<std::string_view, 9> tests = {"at_most",      "at_least",    "within",          "equals",         "order_at_least",
                                                   "order_within", "gci_at_most", "never_increases", "never_decreases"};
constexpr real round_off_slack = 1e-12;  // relative; what 1e4 additions of doubles may leave

/// Reads one file; collects what the schema alone cannot see.
class Reader {
public:
    Reader(std::string_view source, std::string file, std::filesystem::path folder, Size size)
        : source_(source), file_(std::move(file)), folder_(std::move(folder)), size_(size) {}

    Case read() {
        const Table root = scene::parse_table(source_, file_, case_keys());
        Case c;
        c.name = folder_.filename().string(), c.folder = folder_, c.size = size_;
        c.question = said(root, "question"), c.blind_to = said(root, "blind_to");
        c.kind = static_cast<Kind>(std::find(kinds.begin(), kinds.end(), root.text("kind")) - kinds.begin());
        for (const Variant& v : all_variants(root)) {
            if (v.accept.empty()) continue;
            check(v, c.kind);
            c.variants.push_back(v);
        }
        if (claims_ == 0) problem(root.place("kind"), "the case claims nothing: no [[accept]] entry in it or its variants");
        if (!problems_.empty()) throw scene::BadScene(problems_, source_);
        return c;
    }

private:
    void problem(scene::Place at, std::string message, std::string hint = "") {
        const auto same = [&](const Problem& p) { return p.place.line == at.line && p.place.column == at.column && p.message == message; };
        if (std::none_of(problems_.begin(), problems_.end(), same))  // what the case says is read again for each variant
            problems_.push_back({.file = file_, .place = at, .message = std::move(message), .hint = std::move(hint)});
    }
    /// A text that must say something.
    std::string said(const Table& t, const std::string& key) {
        const std::string& text = t.text(key);
        if (text.find_first_not_of(" \t\n") == std::string::npos) problem(t.place(key), fmt::format("\"{}\" says nothing", key));
        return text;
    }
    std::vector<real> numbers_of_size(const Table& t) const {
        return size_ == Size::ci && t.has("ci") ? t.numbers("ci") : t.numbers("values");
    }

    std::vector<Variant> all_variants(const Table& root) {
        Variant common{.name = "", .scene = folder_ / "scene.toml"};
        merge(common, root);
        std::vector<Variant> list;
        if (root.has("over")) {
            const Table& over = root.table("over");
            for (const std::string& value : size_ == Size::ci && over.has("ci") ? over.texts("ci") : over.texts("values")) {
                list.push_back(common);
                list.back().name = value;
                list.back().overrides.push_back({over.text("key"), value});
            }
            if (!root.tables("variants").empty()) problem(over.place("key"), "a case has [over] or [[variants]], not both");
        }
        for (const Table& t : root.tables("variants")) {
            list.push_back(common);
            list.back().name = said(t, "name");
            check_variant_name(t, list);
            merge(list.back(), t);
            if (t.has("size") && t.text("size") != name(size_)) list.back().accept.clear();
        }
        if (list.empty()) list.push_back(common);
        return list;
    }

    void check_variant_name(const Table& t, const std::vector<Variant>& list) {
        const std::string& n = list.back().name;  // it names a folder, so no spaces and no slashes
        if (n.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+.") != std::string::npos)
            problem(t.place("name"), fmt::format("variant name \"{}\" may have letters, digits and _ - + . only", n));
        if (std::count_if(list.begin(), list.end(), [&](const Variant& v) { return v.name == n; }) > 1)
            problem(t.place("name"), fmt::format("two variants are called \"{}\"", n));
    }

    /// Lays what a table says over `v`: changes and claims add up, the rest replaces.
    void merge(Variant& v, const Table& t) {
        if (t.has("scene")) v.scene = folder_ / t.text("scene");
        if (t.has("reference")) v.reference = t.text("reference");
        if (t.has("sweep")) v.sweep = sweep(t.table("sweep"));
        add_changes(v, t);
        for (const std::string_view size : {"ci", "full"}) {
            if (!t.has(size)) continue;
            Variant sized = v;
            add_changes(sized, t.table(size));
            sized.time_limit = t.table(size).number_or("time_limit", v.time_limit);
            if (size == name(size_)) v = sized;
        }
        for (const Table& a : t.tables("accept")) {
            const Criterion criterion = read_criterion(a);
            if (!a.has("size") || a.text("size") == name(size_)) v.accept.push_back(criterion);
        }
    }

    void add_changes(Variant& v, const Table& t) {
        if (!t.has("set")) return;
        for (const std::string& change : t.texts("set")) try {
                v.overrides.push_back(scene::to_override(change));
            } catch (const BadInput& wrong) {
                problem(t.place("set"), wrong.what());
            }
    }

    Sweep sweep(const Table& t) {
        Sweep s{.key = t.text("key"), .values = numbers_of_size(t), .axis = t.text("axis").front() - 'x'};
        if (t.has("keep"))
            for (const auto& axis : t.texts("keep")) s.keep.push_back(axis.front() - 'x');
        if (s.values.empty()) problem(t.place("values"), "a sweep needs at least one value");
        for (const Table& also : t.tables("also")) {
            s.also.push_back({also.text("key"), numbers_of_size(also)});
            const std::size_t count = s.also.back().values.size();
            if (count != s.values.size())
                problem(also.place("key"), fmt::format("\"{}\" has {} values at {} size, the sweep has {}", s.also.back().key, count,
                                                       name(size_), s.values.size()));
        }
        return s;
    }

    Criterion read_criterion(const Table& t) {
        ++claims_;
        Criterion c{.metric = said(t, "metric"), .why = said(t, "why"), .place = t.place("metric")};
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
                if (!t.flag(key)) problem(t.place(key), fmt::format("\"{} = false\" claims nothing", key));
                c.high = t.number_or("slack", round_off_slack);
                break;
        }
        c.formal_order = t.number_or("formal_order", std::nan(""));
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
                problem(c.place, "\"at\" speaks of a sweep value, and there is no sweep");
            else if (std::find(v.sweep->values.begin(), v.sweep->values.end(), *c.at) == v.sweep->values.end())
                problem(c.place, fmt::format("at = {} is no value of the sweep at {} size", *c.at, name(size_)),
                        fmt::format("values: {}", fmt::join(v.sweep->values, ", ")));
        }
    }

    std::string_view source_;
    std::string file_;
    std::filesystem::path folder_;
    Size size_;
    int claims_ = 0;
    std::vector<Problem> problems_;
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
