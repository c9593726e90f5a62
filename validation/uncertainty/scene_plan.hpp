// weir plan SCENE --of QUANTITY: which method on which grid gives a quantity of a scene of one's own to the wanted accuracy within a
// budget.
#pragma once
#include "validation/uncertainty/method_study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

struct ScenePlanOptions {
    std::string scene{};  // a path, or a case
    std::vector<scene::Override> set{};
    std::vector<std::string> of{};
    std::vector<std::string> error{};  // one for all quantities, or one for each; empty: the most accurate within the budget
    std::string budget{}, frame{}, time_limit{};
    std::string with{};           // methods, separated by commas, beside the scene's own
    std::filesystem::path out{};  // empty: out/NAME/plan
    bool keep = true;             // runs and results are written
    bool quiet = false;
};

/// A method compared with the scene's own over the whole series of a quantity.
struct Apart {
    real distance = 0;  // of the finest results
    real bands = 0;     // sum of both
    real z() const { return bands > 0 ? distance / bands : distance > 0 ? infinity : 0; }
    std::string of{};  // the quantity
    std::string unit{};
};

struct PlannedMethod {
    MethodStudy study{};
    std::optional<Apart>
        apart{};  // from the scene's own method, of the quantity with the largest z; none: it is the scene's own, or unknown
    bool other_equations() const { return apart && apart->z() > 1; }
};

struct Recommended {
    std::size_t method = 0, grid = 0;
    double seconds = 0;  // of computing per frame
};

struct ScenePlan {
    std::string name{}, file{}, title{};
    std::string command{};  // that asks again
    std::vector<Asked> asked{};
    std::vector<Wish> wishes{};  // none, or one for each quantity
    Limits limits{};
    std::vector<PlannedMethod> methods{};  // the scene's own first
    std::optional<Recommended> take{};
    std::filesystem::path folder{};  // of plan.json, plan.svg, index.html and the runs; empty: not kept
    double others = 0;               // cores that other programs used meanwhile
    double spent = 0;                // computing seconds of the runs made now
    std::vector<scene::Override> set{};
};

/// Throws BadInput.
ScenePlan plan_scene(const ScenePlanOptions& options, const Solvers& solvers, const Tell& tell);

/// The cheapest grid of which every finer one meets all wishes too, within the budget; without wishes the most accurate within the budget.
/// Methods that solve other equations than the scene's own are left out, and grids whose balance warns.
std::optional<Recommended> recommended(const ScenePlan& plan);

/// How far a grid meets the request, in words: "recommended", "meets the request", or why it is not recommended.
std::string_view verdict_of(const ScenePlan& plan, std::size_t method, std::size_t grid);

/// The command that asks this question.
std::string plan_line(const ScenePlanOptions& options);
/// The command that runs a grid of a method.
std::string run_line(const ScenePlan& plan, const Recommended& choice);
/// What a method leaves out of the equations of fluids; empty for an unknown one.
std::string_view left_out_by(std::string_view solver);

std::string plan_text(const ScenePlan& plan);
std::string plan_json(const ScenePlan& plan);
/// Value with its band against computing time per frame; for series, the finest results.
void draw_plan(const ScenePlan& plan, const std::filesystem::path& svg);

/// The plan as one HTML file that needs no network, in the style of the page of results. `svg`: the text of its figure; may be empty.
std::string plan_page(const ScenePlan& plan, const std::string& svg);

/// Writes plan.json, plan.svg and index.html into the plan's folder, where it has one. Throws OutputError; without gnuplot the page has no
/// figure.
void keep_results(const ScenePlan& plan);

/// Plans, prints, and keeps plan.json, plan.svg, index.html and the runs beside the results of the scene. Returns the exit code: 1 where
/// nothing meets the wishes.
int scene_plan_command(const ScenePlanOptions& options, const Solvers& solvers);

}  // namespace weir::validation
