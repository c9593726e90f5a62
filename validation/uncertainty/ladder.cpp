#include "validation/uncertainty/ladder.hpp"

#include "core/error.hpp"
#include "scene/names.hpp"
#include "sim/balance.hpp"
#include "sim/simulation.hpp"
#include "validation/harness/band.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace weir::validation {
namespace {

constexpr int fewest_rows = 300;      // of a probe over the run
constexpr int fewest_cells = 4;       // along an axis
constexpr double thinnest_solid = 2;  // cells: a thinner one blocks the flow, but its forces and its edges are of no use
constexpr int largest_search = 64;    // numbers that are tried for the coarsest grid

struct Words {
    std::string solver{};
    std::vector<scene::Override> more{};
};

/// The solver of a word, and what else it sets.
Words words_of(const std::string& word) {
    static const std::map<std::string, Words> models{{"shallow_water", {"heightfield", {{"scheme.model", "\"shallow_water\""}}}},
                                                     {"columns", {"heightfield", {{"scheme.model", "\"columns\""}}}}};
    if (const auto model = models.find(word); model != models.end()) return model->second;
    const auto colon = word.find(':');
    if (colon == std::string::npos) return {word, {}};
    return {word.substr(0, colon), {scene::to_override(word.substr(colon + 1))}};
}

bool is_of_columns(const std::string& solver) { return solver == "heightfield" || solver == "waves"; }

std::string cells_text(const std::vector<int>& cells) { return fmt::format("[{}]", fmt::join(cells, ", ")); }

/// The solver's cells: one along the vertical, y, for height fields; square ones where the scene has only one there.
std::vector<int> cells_for(const std::string& solver, const scene::Scene& scene) {
    std::vector<int> cells;
    for (const double n : scene.root().numbers("grid.cells")) cells.push_back(static_cast<int>(n));
    const auto& size = scene.root().numbers("grid.size");
    if (is_of_columns(solver)) {
        cells.at(1) = 1;
    } else if (is_of_columns(scene.solver())) {
        const real tall = size.at(1) / (size.at(0) / cells.at(0));
        cells.at(1) = static_cast<int>(std::lround(tall));
        if (std::abs(tall - cells[1]) > 1e-6 * tall)
            throw BadInput(fmt::format("{} requires square cells, and grid.size is {:g} cells tall", solver, tall));
    }
    return cells;
}

/// Probes with few rows get more: their interpolation would be an error that no grid shows. Lines have many values per row, and stay.
std::vector<std::pair<std::string, std::string>> sampling(const scene::Scene& scene) {
    std::vector<std::pair<std::string, std::string>> changes;
    const real longest = scene.number("time.end") / fewest_rows;
    const auto& probes = scene.root().tables("probes");
    for (std::size_t i = 0; i < probes.size(); ++i)
        if (probes[i].has("every") && probes[i].number("every") > longest * (1 + 1e-9) && probes[i].text("kind") != "line")
            changes.emplace_back(fmt::format("probes[{}].every", i),
                                 fmt::format("{:.15g}", longest * (1 - 1e-12)));  // the last row is not beyond the end
    return changes;
}

std::string text_of(const scene::Scene& scene, const char* key) { return scene.has(key) ? scene.text(key) : ""; }

}  // namespace

Method method_of(const scene::Scene& scene, const std::string& word, const Solvers& solvers) {
    Method method{.name = word.empty() ? scene.solver() : word, .overrides = scene.overrides()};
    const Words words = words_of(method.name);
    method.solver = words.solver;
    std::vector<std::string> known;
    for (const auto& kind : solvers) known.push_back(kind.schema.name);
    if (std::find(known.begin(), known.end(), method.solver) == known.end())
        throw BadInput(
            fmt::format("--with {}: unknown solver {}{}", word, scene::quote(method.solver), scene::did_you_mean(method.solver, known)));
    if (method.solver != scene.solver()) {
        method.overrides.push_back({"solver", "\"" + method.solver + "\""});
        if (scene.root().find("scheme")) method.overrides.push_back({"scheme", "{}"});
        method.overrides.push_back({"grid.cells", cells_text(cells_for(method.solver, scene))});
    }
    method.overrides.insert(method.overrides.end(), words.more.begin(), words.more.end());
    try {
        method.formal_order = formal_order(method.solver, text_of(scene_of(scene, method, solvers), "scheme.advection"));
    } catch (const BadInput&) {
        if (word.empty()) throw;  // of another solver the ladder says what is wrong
    }
    return method;
}

scene::Scene scene_of(const scene::Scene& scene, const Method& method, const Solvers& solvers) {
    return scene::parse(scene.source(), scene.file(), scene::schemas_of(solvers), method.overrides);
}

std::string Grid::text() const { return fmt::format("{}", fmt::join(cells, " x ")); }

Ladder::Ladder(const scene::Scene& scene, Method method, const Solvers& solvers)
    : scene_(scene_of(scene, method, solvers)), method_(std::move(method)), solvers_(&solvers) {
    own_ = 0;
    for (const double n : scene_.root().numbers("grid.cells"))
        if (n > 1) own_ = std::gcd(own_, static_cast<int>(n));
    own_ = std::max(own_, 1);
}

Grid Ladder::grid(int number, real dt, int dt_number) const {
    Grid grid{.number = number, .factor = static_cast<real>(own_) / number};
    for (const double n : scene_.root().numbers("grid.cells")) grid.cells.push_back(n > 1 ? static_cast<int>(n) / own_ * number : 1);
    grid.h = scene_.root().numbers("grid.size").at(0) / grid.cells.at(0);
    const auto set = [&](const char* key, const std::string& value) { grid.overrides.push_back({key, value}); };
    set("grid.cells", cells_text(grid.cells));
    real longest = scene_.root().number_or("time.max_dt", infinity) * grid.factor;
    if (dt > 0) longest = std::min(longest, dt * dt_number / number);
    if (scene_.has("time.dt"))
        set("time.dt", fmt::format("{:.9g}", scene_.number("time.dt") * grid.factor));
    else if (longest < infinity)
        set("time.max_dt", fmt::format("{:.9g}", longest));
    for (const auto& [key, every] : sampling(scene_)) set(key.c_str(), every);
    if (method_.solver == "tallcell" && scene_.has("scheme.layers"))
        set("scheme.layers", fmt::format("{}", std::lround(static_cast<real>(scene_.integer("scheme.layers")) / grid.factor)));
    return grid;
}

scene::Scene Ladder::scene(const Grid& grid, const std::vector<scene::Override>& more) const {
    std::vector<scene::Override> overrides = method_.overrides;
    overrides.insert(overrides.end(), grid.overrides.begin(), grid.overrides.end());
    overrides.insert(overrides.end(), more.begin(), more.end());
    return scene::parse(scene_.source(), scene_.file(), scene::schemas_of(*solvers_), overrides);
}

int Ladder::coarsest(std::string& left_out) const {
    for (int number = 1; number <= std::max(own_, largest_search); ++number) {
        const Grid g = grid(number);
        const auto few = std::find_if(g.cells.begin(), g.cells.end(), [](int n) { return n > 1 && n < fewest_cells; });
        if (few != g.cells.end() || *std::max_element(g.cells.begin(), g.cells.end()) < 2 * fewest_cells) continue;
        try {
            const Simulation trial(scene(g), *solvers_);
            const auto thin = sim::thin_solids(trial.scene(), trial.fields().grid);
            if (thin.empty() || thin.front().second >= thinnest_solid) return number;
            left_out = fmt::format("{} cells and coarser: {} is {:.2g} cells thick; two are required", g.text(), thin.front().first,
                                   thin.front().second);
        } catch (const std::runtime_error& wrong) {  // BadInput, NumericalFailure
            if (number == own_) throw;               // the scene itself is wrong
            const std::string what = wrong.what();
            left_out = fmt::format("{} cells and coarser: {}", g.text(), what.substr(0, what.find('\n')));
        }
    }
    throw BadInput("no grid resolves this scene: " + left_out);
}

std::vector<int> numbers_of_ladder(int coarsest, int finest, int count, real ratio) {
    std::vector<int> numbers{finest};
    while (static_cast<int>(numbers.size()) < count) {
        const int last = numbers.back();
        const int next = std::min(last - 1, static_cast<int>(std::lround(last / ratio)));
        if (next < coarsest) break;
        numbers.push_back(next);
    }
    std::reverse(numbers.begin(), numbers.end());
    return numbers;
}

}  // namespace weir::validation
