// `weir validate`: finds cases, runs them, prints and writes what came out.
#pragma once
#include "sim/registry.hpp"
#include "validation/harness/case.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace weir::validation {

struct ValidateOptions {
    std::vector<std::string> names{};  // cases by name, or folders with a case.toml
    bool all = false;                  // every case
    bool list = false;                 // name and question of each, nothing is run
    Size size = Size::ci;
    std::filesystem::path out = "out/validate";  // verdicts.json, svg/, csv/ and the frames of each run
    std::filesystem::path publish{};             // folder of the published page; empty: not published
    std::filesystem::path compare{};             // published folder to compare the ci size with; empty: not compared
    bool page = false;                           // write its index.html too
    bool quiet = false;                          // no progress on the terminal
    std::int64_t steps = 0;                      // cut_short() by so many, and judge nothing; 0: whole runs
    std::string backend{};                       // for every scene that has scheme.backend; empty: its own
};

/// Where cases may lie: ./cases, those installed with this program, those of the source tree that it was built from.
std::vector<std::filesystem::path> case_roots();
/// The first of these that is there.
std::filesystem::path case_root();
/// The folder of a case that has a scene.toml, by its name. Throws BadInput with where was looked and the nearest known name.
std::filesystem::path find_case_scene(const std::string& name);
/// What a user names: a path; or, where nothing stands there, a case.
std::filesystem::path scene_named(const std::string& word);
/// The first folder of published tables that is there, beside the cases: of weir cost ("cost"), ...
std::filesystem::path published(const std::string& what);
/// The folder of a case by its name, or a folder that holds a case.toml. Throws BadInput with the nearest known name.
std::filesystem::path find_case(const std::string& name);
/// The folders that a command works on: those named, or all that `find` gives. Throws BadInput where the choice is none or both.
std::vector<std::filesystem::path> chosen_folders(const std::string& command, const std::vector<std::string>& names, bool all, bool list,
                                                  const std::function<std::vector<std::filesystem::path>()>& find);

/// Runs the command and returns its exit code: 0, 1 (a claim failed, published results are older than the code), 2 (a case asks for what is
/// not there). Throws BadInput before anything is run or written when a name is unknown or a case file or its scene is wrong.
int validate_command(const ValidateOptions& options, const std::vector<scene::SolverKind>& solvers = sim::registry());

}  // namespace weir::validation
