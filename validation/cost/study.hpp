// A study of what accuracy costs: methods (solvers, schemes, backends) on one problem, each through several settings, one error measured
// against the problem's reference, against computing time. Read from cases/<name>/cost.toml; a case without one is its own study.
// A new solver joins by a [[methods]] entry that names its scene.
#pragma once
#include "validation/harness/case.hpp"
#include "validation/harness/runner.hpp"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// What time is counted by: a simulated second, or a step (where a solve is the problem and time means nothing).
enum class Price { second, step };

struct Study {
    std::string name{};
    std::filesystem::path folder{};
    std::string question{};
    std::string error{};              // the metric on the vertical axis
    std::vector<std::string> also{};  // further metrics, for the table
    real good_enough = 0;             // the error at which the sentences compare methods; 0: none is given
    std::string why{};                // where that error comes from
    real known_to = 0;                // how well the reference itself is known: errors below it are not told apart
    std::string known_why{};          // where that comes from
    real diverged_above = infinity;   // a run that ends with a larger error has diverged, though every number is finite
    std::string diverged_why{};       // where that comes from
    Price price = Price::second;
    Size size = Size::ci;
    std::vector<Variant> methods{};

    /// An error as far as the reference can tell.
    real told(real e) const { return std::max(e, known_to); }
};

/// What cost.toml may contain.
const std::vector<scene::Key>& study_keys();

/// cases/<name>/cost.toml, or the case itself with the first claim's metric as the error. Throws scene::BadScene or BadInput.
Study read_study(const std::filesystem::path& folder, Size size);
Study parse_study(std::string_view text, const std::string& file, const std::filesystem::path& folder, Size size);

/// The study with one method at one setting of its sweep and nothing else; without a method where it has no such setting.
Study study_of_row(const Study& study, const std::string& method, std::size_t index);

/// Folders below `root` with a cost.toml, in alphabetical order.
std::vector<std::filesystem::path> find_studies(const std::filesystem::path& root);

/// --vary "key=v1,v2,...": every method through these values in place of its own sweep (grid.cells counts cells along x), or, after a
/// first one, once for each value. A name without a dot is looked for in scheme, scheme.poisson and time, in this order. A method whose
/// solver does not know the key stays as it is. Throws BadInput where none knows it.
void vary(Study& study, const std::vector<std::string>& changes, const Solvers& solvers);

}  // namespace weir::validation
