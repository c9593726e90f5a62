#include "validation/uncertainty/coverage_scenes.hpp"

#include "core/error.hpp"
#include "validation/harness/runner.hpp"
#include "validation/harness/variants.hpp"
#include "validation/uncertainty/exact_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weir::validation {
namespace {

using scene::Key;
using scene::Type;

constexpr double time_limit = 120;  // computing seconds of one run

std::vector<Key> scene_keys() {
    const auto text = [](std::string name, std::string doc, bool required = false) {
        return Key{.name = std::move(name), .type = Type::text, .doc = std::move(doc), .required = required};
    };
    return {text("name", "Its name in tables.", true),
            text("scene", "The scene's file, from the folder of this one.", true),
            {.name = "set", .type = Type::texts, .doc = "Changes to the scene, as --set takes them: \"key = value\"."},
            text("reference", "The reference whose fields are the truth, by name."),
            {.name = "grids", .type = Type::integers, .doc = "Cells along x, from coarse to fine.", .required = true, .min = 1},
            {.name = "finer", .type = Type::integer, .doc = "Cells along x of the grid for a truth by extrapolation.", .min = 1},
            {.name = "new", .type = Type::flag, .doc = "Not used when the formula of the band was chosen.", .fallback = false},
            {.name = "of",
             .type = Type::tables,
             .doc = "Quantities, as weir plan --of takes them.",
             .required = true,
             .keys = {text("quantity", "The quantity.", true),
                      text("formula", "The true series, a formula of t."),
                      text("curve", "The true series, a curve of the reference."),
                      {.name = "value", .type = Type::number, .doc = "The true value."}}}};
}

CoverageScene read_scene(const scene::Table& t, VariantReader& reader, const std::filesystem::path& folder) {
    CoverageScene s{.name = reader.said(t, "name"),
                    .scene = (folder / reader.said(t, "scene")).lexically_normal(),
                    .reference = t.text_or("reference", ""),
                    .added = t.flag("new")};
    if (t.has("set"))
        for (const std::string& change : t.texts("set")) try {
                s.set.push_back(scene::to_override(change));
            } catch (const BadInput& wrong) {
                reader.problem(t.place("set"), wrong.what());
            }
    for (const double n : t.numbers("grids")) s.grids.push_back(static_cast<int>(n));
    if (t.has("finer")) s.finer = static_cast<int>(t.integer("finer"));
    if (s.grids.size() < 3) reader.problem(t.place("grids"), "a band requires three grids");
    std::vector<int> all = s.grids;
    if (s.finer) all.push_back(*s.finer);
    if (std::adjacent_find(all.begin(), all.end(), std::greater_equal<>()) != all.end())
        reader.problem(t.place("grids"), "grids go from coarse to fine, and `finer` is finer than all of them");
    for (const scene::Table& q : t.tables("of")) {
        CoverageQuantity quantity{.of = reader.said(q, "quantity"),
                                  .formula = q.text_or("formula", ""),
                                  .curve = q.text_or("curve", ""),
                                  .place = q.place("quantity")};
        if (q.has("value")) quantity.value = q.number("value");
        if (!quantity.curve.empty() && s.reference.empty()) reader.problem(q.place("curve"), "a curve requires a reference");
        s.quantities.push_back(std::move(quantity));
    }
    return s;
}

std::string kind_of(const NamedQuantity& quantity) {
    if (quantity.is_time()) return "time";
    switch (quantity.kind) {
        case Statistic::max:
        case Statistic::min:
        case Statistic::range:
            return "extremum";
        case Statistic::mean:
        case Statistic::rms:
            return "mean";
        case Statistic::drift:
        case Statistic::change:
            return "change";
        case Statistic::curve:
            return "curve";
        case Statistic::picture:
            return "picture";
        default:
            return "end";
    }
}

/// The ladder of one scene, its runs and the scene of the finest.
struct Climbed {
    Ladder ladder;
    Reference reference{};
    std::vector<scene::Override> pictures{};
    std::vector<GridRun> runs{};
    std::optional<GridRun> finer{};
    scene::Scene scene{};

    void add(int cells, const std::string& name, bool is_finer, const Solvers& solvers) {
        const Grid own = ladder.grid(ladder.own());
        if (cells * ladder.own() % own.cells.front() != 0)
            throw BadInput(fmt::format("{}: no grid of the scene's proportions has {} cells along x", name, cells));
        const Grid grid = next_grid(ladder, runs, cells * ladder.own() / own.cells.front());
        GridRun run{grid, record_run(ladder.scene(grid, pictures), {}, time_limit, solvers)};
        if (is_finer)
            finer = std::move(run);
        else
            runs.push_back(std::move(run));
    }
};

std::optional<RecordedSeries> true_series(const RecordedSeries& series, const CoverageQuantity& quantity, const Climbed& climbed) {
    if (!quantity.formula.empty()) return series_from_formula(series, quantity.formula);
    if (!quantity.curve.empty()) return series_from_curve(series, climbed.reference.curve(quantity.curve));
    return exact_series(series, climbed.scene, climbed.reference);
}

/// The exact value of a quantity; empty where only a finer grid gives it.
std::vector<real> exact_value(const CoverageQuantity& quantity, const Asked& asked, std::size_t number, const Climbed& climbed) {
    if (quantity.value) return {*quantity.value};
    const RecordedRun& finest = climbed.runs.back().run;
    RecordedRun exact{.cells = finest.cells};
    const std::string prefix = fmt::format("weir_picture_{}_", number);
    const bool picture = asked.quantity.kind == Statistic::picture;
    for (const RecordedSeries& s : finest.series) {
        if (picture ? !s.name.starts_with(prefix) : &s != &series_named(finest.series, asked.quantity.series)) continue;
        const auto series = true_series(s, quantity, climbed);
        if (!series) return {};
        exact.series.push_back(*series);
    }
    const Value value = value_of(exact, asked, number);
    if (!value.unknown.empty()) throw BadInput("the true value is not known: " + value.unknown);
    return value.samples;
}

std::vector<real> true_value(const CoverageQuantity& quantity, const Asked& asked, std::size_t number, const Climbed& climbed,
                             KnownQuantity& known) {
    const auto exact = exact_value(quantity, asked, number, climbed);
    if (!exact.empty()) return exact;
    known.exact = false;
    if (!climbed.finer) throw BadInput("neither the reference nor a finer grid gives the true value");
    const Value value = value_of(climbed.finer->run, asked, number);
    if (!value.unknown.empty()) throw BadInput("not known on the finer grid: " + value.unknown);
    std::vector<GridValue> all = known.values;
    all.push_back({climbed.finer->grid.h, value.samples});
    return extrapolated(all, known.formal_order);
}

/// Returns why a quantity has no value on some grid; empty where it has.
std::string take_values(const Asked& asked, std::size_t number, const Climbed& climbed, KnownQuantity& known) {
    for (const GridRun& g : climbed.runs) {
        const Value value = value_of(g.run, asked, number);
        if (!value.unknown.empty()) return fmt::format("{} cells: {}", g.grid.text(), value.unknown);
        known.grids.push_back(g.grid.text());
        known.values.push_back({g.grid.h, value.samples});
        known.scales.push_back(value.scale);
    }
    return "";
}

Climbed climb_scene(const CoverageScene& s, const std::vector<Asked>& asked, const Solvers& solvers) {
    const scene::Scene scene = scene::read(s.scene, scene::schemas_of(solvers), s.set);
    Climbed climbed{.ladder = Ladder(scene, method_of(scene, "", solvers), solvers), .pictures = picture_probes(asked, scene)};
    for (const int cells : s.grids) climbed.add(cells, s.name, false, solvers);
    if (s.finer) climbed.add(*s.finer, s.name, true, solvers);
    climbed.scene = climbed.ladder.scene(climbed.runs.back().grid, climbed.pictures);
    climbed.reference = make_reference(s.reference, climbed.scene, s.scene.parent_path());
    return climbed;
}

}  // namespace

const std::vector<Key>& coverage_keys() {
    static const std::vector<Key> keys = {
        {.name = "scenes", .type = Type::tables, .doc = "One entry per ladder.", .required = true, .keys = scene_keys()}};
    return keys;
}

std::vector<CoverageScene> parse_coverage_scenes(std::string_view text, const std::string& file, const std::filesystem::path& folder) {
    const scene::Table root = scene::parse_table(text, file, coverage_keys());
    VariantReader reader(file, folder, Size::ci);
    std::vector<CoverageScene> scenes;
    for (const scene::Table& t : root.tables("scenes")) {
        scenes.push_back(read_scene(t, reader, folder));
        const auto same = [&](const CoverageScene& s) { return s.name == scenes.back().name; };
        if (std::count_if(scenes.begin(), scenes.end(), same) > 1)
            reader.problem(t.place("name"), fmt::format("two scenes are called {}", scenes.back().name));
        for (const CoverageQuantity& q : scenes.back().quantities) try {
                (void)parse_asked({q.of});
            } catch (const BadInput& wrong) {
                reader.problem(q.place, wrong.what());
            }
    }
    if (!reader.problems().empty()) throw scene::BadScene(reader.problems(), text);
    return scenes;
}

void run_coverage_scene(const CoverageScene& s, const Solvers& solvers, CoverageRuns& runs) {
    std::vector<std::string> of;
    for (const CoverageQuantity& q : s.quantities) of.push_back(q.of);
    const std::vector<Asked> asked = parse_asked(of);
    const Climbed climbed = climb_scene(s, asked, solvers);
    for (std::size_t i = 0; i < asked.size(); ++i) try {
            KnownQuantity known{.scene = s.name,
                                .quantity = of[i],
                                .family = family_of(climbed.ladder.method().solver),
                                .kind = kind_of(asked[i].quantity),
                                .added = s.added,
                                .formal_order = climbed.ladder.method().formal_order};
            if (const std::string why = take_values(asked[i], i, climbed, known); !why.empty()) {
                runs.unknown.push_back(fmt::format("{} {}, {}", s.name, of[i], why));
                continue;
            }
            known.truth = true_value(s.quantities[i], asked[i], i, climbed, known);
            runs.quantities.push_back(std::move(known));
        } catch (const std::runtime_error& wrong) {  // BadInput, BadFormula
            throw BadInput(fmt::format("{} {}: {}", s.name, of[i], wrong.what()));
        }
    ++runs.scenes, runs.runs += climbed.runs.size() + (climbed.finer ? 1 : 0);
    for (const GridRun& g : climbed.runs) runs.seconds += g.run.seconds;
    if (climbed.finer) runs.seconds += climbed.finer->run.seconds;
}

CoverageRuns run_coverage_scenes(const std::filesystem::path& file, const Solvers& solvers, const Tell& tell, std::size_t most) {
    const std::string text = scene::read_text(file);
    const auto scenes = parse_coverage_scenes(text, file.string(), file.parent_path());
    CoverageRuns runs;
    for (std::size_t i = 0; i < std::min(most, scenes.size()); ++i) {
        const double before = runs.seconds;
        run_coverage_scene(scenes[i], solvers, runs);
        tell(fmt::format("{}: {:.2f} s", scenes[i].name, runs.seconds - before));
    }
    return runs;
}

}  // namespace weir::validation
