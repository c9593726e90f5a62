// Schema and reader of stability.toml.
#include "validation/harness/variants.hpp"
#include "validation/stability/limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace weir::validation {
namespace {

using scene::Key;
using scene::Table;
using scene::Type;

constexpr std::array<std::string_view, 4> tests = {"at_most", "at_least", "drift", "never_rises"};

Key text(std::string name, std::string doc, bool required = false) {
    return {.name = std::move(name), .type = Type::text, .doc = std::move(doc), .required = required};
}
Key positive(std::string name, std::string doc, bool required = false) {
    return {.name = std::move(name), .type = Type::number, .doc = std::move(doc), .required = required, .min = 0, .min_open = true};
}
Key tables(std::string name, std::string doc, std::vector<Key> keys, bool required = false) {
    return {.name = std::move(name), .type = Type::tables, .doc = std::move(doc), .required = required, .keys = std::move(keys)};
}

Key methods_of_key() { return {.name = "methods", .type = Type::texts, .doc = "Only these of the study's methods; absent: all."}; }

Key watch_key() {
    return tables(
        "watch", "Invariants, checked after every step.",
        {text("series", "An integral, or divergence, density_error, iterations, dt; or a sum or a difference of two, a+b, a-b.", true),
         text("why", "Rationale.", true),
         {.name = "at_most", .type = Type::number, .doc = "value <= this"},
         {.name = "at_least", .type = Type::number, .doc = "value >= this"},
         {.name = "power",
          .type = Type::number,
          .doc = "at_most and at_least apply at a key of 1 and scale with this power of the key.",
          .fallback = 0.0},
         positive("drift", "|value - first| / |first| <= this"),
         methods_of_key(),
         positive("never_rises", "No step raises the value by more than this fraction of the largest.")});
}

Key proof_key() {
    return tables(
        "proof", "Evidence that the run is as difficult as its axis states, checked at each value; otherwise the study is invalid.",
        {text("quantity", "An integral, a value of the step's report, or a count: wet_cells, film, gap, pockets, ...", true),
         text("why", "What it demonstrates.", true),
         {.name = "at_least", .type = Type::number, .doc = "value >= this"},
         {.name = "at_most", .type = Type::number, .doc = "value <= this"},
         {.name = "power", .type = Type::number, .doc = "Both apply at a key of 1 and scale with this power of the key.", .fallback = 0.0},
         {.name = "when",
          .type = Type::choice,
          .doc = "Before the first step; the largest of the run; at its end.",
          .fallback = std::string("start"),
          .choices = {"start", "most", "end"}},
         methods_of_key()},
        true);
}

Key unbroken_key() {
    return tables("unbroken", "For a limit that is not reached: why it cannot fail.", {text("why", "The reason.", true), methods_of_key()});
}

Key steps_key() { return {.name = "steps", .type = Type::integer, .doc = "Longest run.", .min = 1}; }

std::vector<Key> axis_keys() {
    std::vector<Key> axis = variant_keys();
    for (Key k : {text("name", "Its name.", true),
                  text("key", "The scene key that is raised; absent where changes contain the value as <a>, <a^p> or <a^p round>."),
                  positive("low", "First value.", true),
                  positive("high", "Last value.", true),
                  {.name = "kind",
                  .type = Type::choice,
                  .doc = "limit: raised until an invariant fails; units: dimensionally similar, a check of units; guard: a check of what "
                         "takes over or refuses.",
                  .required = true,
                  .choices = {"limit", "units", "guard"}},
                  text("hard_because", "Difficulty.", true),
                  proof_key(),
                  unbroken_key(),
                  positive("theory", "Theoretical limit."),
                  text("theory_source", "Source of that limit."),
                  positive("floor", "Guaranteed range: the smallest value up to which runs must be stable."),
                  text("floor_why", "Rationale of the guaranteed range."),
                  positive("asked", "Open target beyond the floor, not met: it is listed, and an error once it is met."),
                  text("not_reached", "Reason why it is not met."),
                  {.name = "slow",
                  .type = Type::flag,
                  .doc = "A comparison at ci size runs the end of the guaranteed range only; at full size both sides of the limit.",
                  .fallback = false},
                  {.name = "nested",
                  .type = Type::flag,
                  .doc = "A run at one value includes those at all smaller ones (steps, time): the last value is tried first.",
                  .fallback = false},
                  steps_key(),
                  methods_of_key(),
                  watch_key()})
        axis.push_back(std::move(k));
    return axis;
}

std::vector<Key> map_keys() {
    const auto values = [](std::string name, std::string doc) {
        return Key{.name = std::move(name),
                   .type = Type::table,
                   .doc = std::move(doc),
                   .required = true,
                   .keys = {text("key", "The key.", true),
                            text("label", "Quantity and unit; absent: the key."),
                            {.name = "values", .type = Type::texts, .doc = "Its values at full size.", .required = true},
                            {.name = "ci", .type = Type::texts, .doc = "Its values at ci size; absent: the same."}}};
    };
    std::vector<Key> map = variant_keys();
    for (Key k : {text("name", "Its name.", true), values("x", "From left to right."), values("y", "From the bottom to the top."),
                  text("hard_because", "Difficulty.", true), steps_key(), methods_of_key(), watch_key()})
        map.push_back(std::move(k));
    return map;
}

std::vector<Key> make_keys() {
    std::vector<Key> method = variant_keys();
    method.insert(method.begin(), text("name", "Its name.", true));
    std::vector<Key> keys = {text("question", "Question of the study.", true),
                             {.name = "steps", .type = Type::integer, .doc = "Longest run.", .fallback = std::int64_t{2000}, .min = 1},
                             watch_key(),
                             tables("methods", "Each axis is tried with each of these.", method),
                             tables("axes", "Parameters that are raised.", axis_keys(), true),
                             tables("maps", "Pairs of keys, every value of one with every value of the other.", map_keys())};
    for (const Key& k : variant_keys()) keys.push_back(k);
    return keys;
}

std::optional<real> optional_number(const Table& t, std::string_view key) {
    return t.has(key) ? std::optional<real>(t.number(key)) : std::nullopt;
}

/// Whether an entry is for this method: it is for all that it does not tell apart.
bool is_for(const Table& entry, const std::string& method) {
    if (!entry.has("methods")) return true;
    const auto& of = entry.texts("methods");
    return std::find(of.begin(), of.end(), method) != of.end();
}

std::vector<Precondition> preconditions(const Table& axis, const std::string& method, VariantReader& reader) {
    std::vector<Precondition> list;
    for (const Table& p : axis.tables("proof")) {
        if (!is_for(p, method)) continue;
        list.push_back({.when = p.text("when") == "start"  ? Precondition::When::start
                                : p.text("when") == "most" ? Precondition::When::most
                                                           : Precondition::When::end,
                        .quantity = reader.said(p, "quantity"),
                        .at_least = optional_number(p, "at_least"),
                        .at_most = optional_number(p, "at_most"),
                        .power = p.number("power"),
                        .why = reader.said(p, "why")});
        if (!list.back().at_least && !list.back().at_most)
            reader.problem(p.place("quantity"), fmt::format("\"{}\" needs one of: at_least, at_most", list.back().quantity));
    }
    if (list.empty())
        reader.problem(axis.place("name"), fmt::format("\"{}\" gives no evidence of its difficulty{}{}", axis.text("name"),
                                                       method.empty() ? "" : " for ", method));
    return list;
}

std::string why_unbroken(const Table& axis, const std::string& method, AxisKind kind, VariantReader& reader) {
    for (const Table& u : axis.tables("unbroken")) {
        if (kind != AxisKind::limit) reader.problem(u.place("why"), "only an axis of kind \"limit\" may state why it is not reached");
        if (is_for(u, method)) return reader.said(u, "why");
    }
    return {};
}

AxisKind kind_of(const Table& axis) {
    for (const AxisKind kind : {AxisKind::units, AxisKind::guard})
        if (axis.text("kind") == name(kind)) return kind;
    return AxisKind::limit;
}

/// What a table watches of one method.
std::vector<Invariant> invariants(const Table& t, const std::string& method, VariantReader& reader) {
    std::vector<Invariant> list;
    for (const Table& w : t.tables("watch")) {
        if (!is_for(w, method)) continue;
        Invariant invariant{.series = reader.said(w, "series"), .power = w.number("power"), .why = reader.said(w, "why")};
        int given = 0;
        for (std::size_t i = 0; i < tests.size(); ++i)
            if (w.has(tests[i])) invariant.test = static_cast<Invariant::Test>(i), invariant.bound = w.number(tests[i]), ++given;
        if (given != 1) reader.problem(w.place("series"), fmt::format("\"{}\" needs one of: {}", invariant.series, fmt::join(tests, ", ")));
        list.push_back(std::move(invariant));
    }
    return list;
}

Stress stress_of(const Table& axis, const Variant& method, VariantReader& reader) {
    Stress s{.name = reader.said(axis, "name"),
             .method = method.name,
             .kind = kind_of(axis),
             .solver = {},
             .key = axis.text_or("key", ""),
             .low = axis.number("low"),
             .high = axis.number("high"),
             .hard_because = reader.said(axis, "hard_because"),
             .theory = optional_number(axis, "theory"),
             .theory_source = axis.text_or("theory_source", ""),
             .guaranteed = optional_number(axis, "floor"),
             .guaranteed_why = axis.text_or("floor_why", ""),
             .open_target = optional_number(axis, "asked"),
             .not_reached = axis.text_or("not_reached", ""),
             .nested = axis.flag("nested"),
             .slow = axis.flag("slow"),
             .base = method};
    if (s.low >= s.high) reader.problem(axis.place("low"), "\"low\" must be less than \"high\"");
    if (s.guaranteed && s.guaranteed_why.empty()) reader.problem(axis.place("floor"), "\"floor\" needs a \"floor_why\"");
    if (s.slow && !s.guaranteed) reader.problem(axis.place("slow"), "\"slow\" needs a \"floor\": nothing would be compared at ci size");
    if (s.open_target && s.not_reached.empty()) reader.problem(axis.place("asked"), "\"asked\" needs a \"not_reached\"");
    if (s.open_target && (!s.guaranteed || *s.guaranteed >= *s.open_target))
        reader.problem(axis.place("asked"), "\"asked\" needs a \"floor\" that is smaller");
    if (s.theory && s.theory_source.empty()) reader.problem(axis.place("theory"), "\"theory\" needs a \"theory_source\"");
    s.preconditions = preconditions(axis, method.name, reader);
    s.unbroken = why_unbroken(axis, method.name, s.kind, reader);
    reader.lay_over(s.base, axis);
    const auto holds_value = [](const scene::Override& change) { return change.value.find('<') != std::string::npos; };
    if (s.key.empty() && std::none_of(s.base.overrides.begin(), s.base.overrides.end(), holds_value))
        reader.problem(axis.place("name"), "an axis needs a \"key\", or changes with <a> for the value");
    return s;
}

MapAxis map_axis(const Table& t, Size size) {
    return {.key = t.text("key"),
            .label = t.text_or("label", t.text("key")),
            .values = size == Size::ci && t.has("ci") ? t.texts("ci") : t.texts("values")};
}

StressMap map_of(const Table& t, const Variant& method, VariantReader& reader) {
    StressMap map{.stress = {.name = reader.said(t, "name"),
                             .method = method.name,
                             .solver = {},
                             .hard_because = reader.said(t, "hard_because"),
                             .base = method},
                  .x = map_axis(t.table("x"), reader.size()),
                  .y = map_axis(t.table("y"), reader.size())};
    reader.lay_over(map.stress.base, t);
    for (const auto& [axis, values] : {std::pair{"x", map.x.values}, {"y", map.y.values}})
        if (values.empty()) reader.problem(t.table(axis).place("values"), "an axis of a map needs a value");
    return map;
}

/// The study's methods that an axis or map asks for.
std::vector<Variant> methods_of(const Table& t, const std::vector<Variant>& methods, VariantReader& reader) {
    if (!t.has("methods")) return methods;
    std::vector<Variant> chosen;
    for (const std::string& name : t.texts("methods")) {
        const auto at = std::find_if(methods.begin(), methods.end(), [&](const Variant& v) { return v.name == name; });
        if (at == methods.end())
            reader.problem(t.place("methods"), fmt::format("no method is called \"{}\"", name));
        else
            chosen.push_back(*at);
    }
    return chosen;
}

}  // namespace

const std::vector<Key>& stability_keys() {
    static const std::vector<Key> keys = make_keys();
    return keys;
}

StressStudy parse_stability(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size) {
    const Table root = scene::parse_table(text, file, stability_keys());
    VariantReader reader(file, folder, size);
    StressStudy study{.name = folder.filename().string(), .folder = folder, .question = reader.said(root, "question")};
    const auto methods = reader.read(root, "methods", nullptr);
    const auto watch_over = [&](Stress& s, const Table& t) {
        s.steps = t.has("steps") ? t.integer("steps") : root.integer("steps");
        s.watch = invariants(t.tables("watch").empty() ? root : t, s.method, reader);
    };
    for (const Table& axis : root.tables("axes"))
        for (const Variant& method : methods_of(axis, methods, reader)) {
            study.stresses.push_back(stress_of(axis, method, reader));
            watch_over(study.stresses.back(), axis);
        }
    for (const Table& map : root.tables("maps")) {
        const auto chosen = methods_of(map, methods, reader);
        for (const Variant& method : chosen) {
            study.maps.push_back(map_of(map, method, reader));
            watch_over(study.maps.back().stress, map);
            if (chosen.size() == 1) study.maps.back().stress.method.clear();  // nothing to tell apart
        }
    }
    if (!reader.problems().empty()) throw scene::BadScene(reader.problems(), text);
    return study;
}

StressStudy read_stability(const std::filesystem::path& folder, Size size) {
    const auto file = folder / "stability.toml";
    return parse_stability(scene::read_text(file), file.string(), folder, size);
}

std::vector<std::filesystem::path> find_stability(const std::filesystem::path& root) {
    std::vector<std::filesystem::path> found;
    std::error_code unreadable;
    for (const auto& entry : std::filesystem::directory_iterator(root, unreadable))
        if (std::filesystem::exists(entry.path() / "stability.toml")) found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace weir::validation
