// A case: a scene, what is claimed about it, why each bound is what it is, and what the case cannot see. Read from
// cases/<name>/case.toml and resolved for one size, so that what follows is a plain list of runs and criteria.
#pragma once
#include "core/types.hpp"
#include "scene/scene.hpp"
#include "validation/harness/experiment.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

enum class Size { ci, full };
std::string_view name(Size size);

/// exact: an identity, or a solution that the scheme reproduces. convergence: an order. Both are verification (are the equations
/// solved right?). benchmark: others' data, which is validation (are they the right equations?). iterations: accuracy against work.
enum class Kind { exact, convergence, benchmark, iterations };
std::string_view name(Kind kind);

/// One claim: a metric, what it must be, and the reason for the bound.
struct Criterion {
    enum class Test {
        at_most,
        at_least,
        within,
        equals,
        order_at_least,
        order_within,
        gci_at_most,
        never_increases,
        never_decreases,
        agrees_with
    };
    std::string metric{};
    Test test = Test::at_most;
    real low = -infinity, high = infinity;   // the bound as an interval; for never_*: high is the slack, relative to the largest value
    std::optional<real> at{};                // the sweep value that it speaks of; absent: the last
    bool every = false;                      // the worst over the sweep
    real formal_order = std::nan("");        // for gci_at_most on two grids
    std::optional<Experiment> experiment{};  // for agrees_with: all runs of the sweep are the ensemble
    std::string why{};
    std::string not_reached{};  // why an open target is not met; empty: the bound is a claim
    scene::Place place{};       // of its metric in case.toml

    bool is_order() const { return test == Test::order_at_least || test == Test::order_within; }
    bool is_monotone() const { return test == Test::never_increases || test == Test::never_decreases; }
};
std::string_view name(Criterion::Test test);

/// One key of the scene through several values; `also` moves others with it (a time step that follows the grid).
/// For grid.cells a value is the number of cells along `axis`; other axes keep the scene's proportions, or stay as they are (`keep`).
struct Sweep {
    std::string key{};
    std::vector<real> values{};
    int axis = 0;
    std::vector<int> keep{};
    struct Follower {
        std::string key;
        std::vector<real> values;
    };
    std::vector<Follower> also{};
};

/// One configuration of the case (a scheme, a solver, a Reynolds number), run once or over a sweep.
struct Variant {
    std::string name{};  // empty where the case has only one
    std::filesystem::path scene{};
    std::string reference{};  // empty: none
    std::vector<scene::Override> overrides{};
    std::optional<Sweep> sweep{};
    std::vector<Criterion> accept{};
    std::vector<std::string> measured_too{};  // metrics that claims of other variants need of this one
    real time_limit = infinity;               // wall seconds of one run
    std::optional<int> threads{};             // of its own; 0: all that the machine has

    std::size_t runs() const { return sweep ? sweep->values.size() : 1; }
};

struct Case {
    std::string name;
    std::filesystem::path folder;
    std::string question, blind_to;
    Kind kind = Kind::exact;
    Size size = Size::ci;
    std::vector<Variant> variants;      // those that claim something at this size
    std::optional<std::int64_t> cut{};  // every run ends after so many steps, and nothing is judged; absent: runs are whole
};

/// The case with runs of at most `steps` steps, each variant at the first value of its sweep: all that a run calls, the scene's frames, the
/// reference and the metrics too, in little time. For tools that watch a program, such as sanitizers.
Case cut_short(Case c, std::int64_t steps);

/// The scene of run `i` of a variant, with the case's changes. Throws BadScene.
scene::Scene scene_of(const Variant& variant, std::size_t i, const std::vector<scene::SolverSchema>& solvers);

/// Where the frames of run `i` go, below the output folder: case/variant/value.
std::filesystem::path frames_folder(const Case& c, const Variant& variant, std::size_t i);

/// Reads and checks cases/<name>; throws scene::BadScene with every problem in the file, or BadInput when it cannot be read.
Case read_case(const std::filesystem::path& folder, Size size);
/// The same from text; `file` is its name in messages.
Case parse_case(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size);
/// What case.toml may contain: the one table behind reader, messages and manual.
const std::vector<scene::Key>& case_keys();

/// Folders below `root` that hold a case.toml, in alphabetical order.
std::vector<std::filesystem::path> find_cases(const std::filesystem::path& root);

}  // namespace weir::validation
