// The scenes of the experiment on coverage, as data: a scene, its grids, quantities, and how their true values are known.
#pragma once
#include "scene/schema.hpp"
#include "scene/solver_kind.hpp"
#include "validation/uncertainty/coverage.hpp"
#include "validation/uncertainty/method_study.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace weir::validation {

/// A quantity, and its truth where the scene's reference and its finer grid do not give it.
struct CoverageQuantity {
    std::string of{};
    std::string formula{};        // of the series, of t
    std::string curve{};          // of the reference: that of the series
    std::optional<real> value{};  // of the quantity
    scene::Place place{};
};

struct CoverageScene {
    std::string name{};
    std::filesystem::path scene{};
    std::vector<scene::Override> set{};
    std::string reference{};
    std::vector<int> grids{};    // cells along the first axis, from coarse to fine
    std::optional<int> finer{};  // for a truth by extrapolation
    bool added = false;
    std::vector<CoverageQuantity> quantities{};
};

/// What a file of scenes may contain.
const std::vector<scene::Key>& coverage_keys();
/// Reads the scenes; `folder` is that of the file. Throws scene::BadScene with every problem.
std::vector<CoverageScene> parse_coverage_scenes(std::string_view text, const std::string& file, const std::filesystem::path& folder);

/// The runs of one or more scenes.
struct CoverageRuns {
    std::vector<KnownQuantity> quantities{};
    std::vector<std::string> unknown{};  // quantities without a value on some grid, and why
    std::size_t scenes = 0, runs = 0;
    double seconds = 0;  // of computing
};

/// Runs a scene on its grids as weir plan does. Throws BadInput where a quantity or its truth is unknown.
void run_coverage_scene(const CoverageScene& scene, const Solvers& solvers, CoverageRuns& runs);
/// All scenes of a file, or the first `most`.
CoverageRuns run_coverage_scenes(const std::filesystem::path& file, const Solvers& solvers, const Tell& tell, std::size_t most = 1000);

/// Coverage and width by family, by kind of quantity, by verdict, for added scenes; advice per wish; and the bands that do not contain
/// the true error.
std::string coverage_text(const CoverageRuns& runs);

}  // namespace weir::validation
