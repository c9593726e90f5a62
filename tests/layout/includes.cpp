// The layer rule (CONTRIBUTING.md, "Modules"): a folder may include what its target links, directly or through public links, and nothing
// else of ours; and the link lists themselves keep to the levels.
#include "support/test.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Library {
    std::string folder;  // "solvers/water"
    std::set<std::string> links, public_links;
};

/// "weir::core" and "weir_core" are the target weir_core; others are not ours.
std::set<std::string> ours(const std::string& list) {
    std::set<std::string> names;
    std::istringstream plain(std::regex_replace(list, std::regex("weir::"), "weir_"));
    for (std::string word; plain >> word;)
        if (word.starts_with("weir_") && word != "weir_flags") names.insert(word);
    return names;
}

/// What CMake wrote: "target|folder|links|public links" a line.
std::map<std::string, Library> read_libraries() {
    std::map<std::string, Library> libraries;
    std::ifstream file(WEIR_LINKS);
    for (std::string line; std::getline(file, line);) {
        std::vector<std::string> part(1);
        for (const char c : line)
            if (c == '|')
                part.emplace_back();
            else
                part.back() += c;
        if (part.size() == 4) libraries[part[0]] = {part[1], ours(part[2]), ours(part[3])};
    }
    return libraries;
}

/// Folders that a target sees: its own, its links', and whatever those pass on.
std::set<std::string> seen_by(const std::string& target, const std::map<std::string, Library>& libraries) {
    std::set<std::string> folders{libraries.at(target).folder}, done;
    std::vector<std::string> open(libraries.at(target).links.begin(), libraries.at(target).links.end());
    while (!open.empty()) {
        const std::string next = open.back();
        open.pop_back();
        if (!done.insert(next).second || !libraries.count(next)) continue;
        folders.insert(libraries.at(next).folder);
        open.insert(open.end(), libraries.at(next).public_links.begin(), libraries.at(next).public_links.end());
    }
    return folders;
}

struct Include {
    std::string file, what;
    int line = 0;
    bool angled = false;
};

/// The levels: a folder sees those below its own. Peers never see each other.
const std::map<std::string, int>& level() {
    static const std::map<std::string, int> table = {
        {"solvers/core", 0},         {"solvers/parallel", 1},      {"solvers/scene", 1},
        {"solvers/backend", 2},      {"solvers/geometry", 2},      {"solvers/thermo", 2},
        {"solvers/poisson", 3},      {"solvers/particles", 4},     {"solvers/rigid", 3},
        {"solvers/mac", 4},          {"solvers/free_surface", 5},  {"solvers/smoke", 6},
        {"solvers/water", 6},        {"solvers/studies", 6},       {"solvers/tallcell", 6},
        {"solvers/two_phase", 6},
        {"solvers/heightfield", 6},  {"solvers/waves", 6},         {"solvers/sph", 6},
        {"solvers/pbf", 6},          {"solvers/sim", 8},           {"solvers/output", 7},
        {"solvers/parallel/mpi", 8}, {"validation/references", 9}, {"validation/metrics", 9},
        {"validation/harness", 10},  {"validation/page", 11},      {"validation/report", 12},
        {"validation/cost", 13},     {"validation/stability", 13}, {"validation/uncertainty", 14},
        {"solvers/matter", 3},       {"solvers/surfaces", 5},      {"solvers/linear", 1},
    };
    return table;
}

std::vector<Include> includes_of(const fs::path& folder) {
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^">]+)[">])");
    std::vector<Include> list;
    for (auto at = fs::recursive_directory_iterator(folder); at != fs::recursive_directory_iterator(); ++at) {
        const auto& entry = *at;
        if (entry.is_directory() && level().count(fs::relative(entry.path(), WEIR_SOURCE_DIR).string())) at.disable_recursion_pending();
        const auto extension = entry.path().extension();
        if (extension != ".hpp" && extension != ".cpp" && extension != ".inl" && extension != ".h") continue;
        std::ifstream file(entry.path());
        int number = 0;
        for (std::string line; std::getline(file, line);) {
            ++number;
            std::smatch match;
            if (std::regex_search(line, match, pattern)) list.push_back({entry.path().string(), match[2], number, match[1] == "<"});
        }
    }
    return list;
}

/// The folder of ours with a target that an include names, relative to the root; empty where it is none. Folders without a target of their
/// own (solvers/particles/kernels) count as the one above them.
std::string folder_of(const std::string& what) {
    const fs::path folder = fs::path(what).parent_path();
    if (folder.empty()) return "";
    for (fs::path candidate : {"solvers" / folder, folder}) {
        if (!fs::exists(fs::path(WEIR_SOURCE_DIR) / candidate / fs::path(what).filename())) continue;
        while (candidate.has_parent_path() && !level().count(candidate.string())) candidate = candidate.parent_path();
        return candidate.string();
    }
    return "";
}

/// The types that references and metrics are written in. They stand beside the harness that calls them.
const std::set<std::string> contract_headers{"validation/harness/curve.hpp", "validation/harness/fitting.hpp",
                                             "validation/harness/metric.hpp", "validation/harness/reference.hpp",
                                             "validation/harness/run_record.hpp"};
/// Those of references: data of core and scene only, so that no reference sees a solver through them; a test below holds them to that.
const std::set<std::string> reference_headers{"validation/harness/curve.hpp", "validation/harness/fitting.hpp",
                                              "validation/harness/reference.hpp"};

TEST("every #include names a folder that the target links") {
    const auto libraries = read_libraries();
    ASSERT_GE(libraries.size(), 8u) << "CMake wrote no link lists";
    int checked = 0;
    for (const auto& [target, library] : libraries) {
        const auto seen = seen_by(target, libraries);
        for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / library.folder)) {
            const std::string folder = folder_of(include.what);
            if (folder.empty() || contract_headers.count(include.what)) continue;
            ++checked;
            EXPECT_TRUE(seen.count(folder)) << include.file << ':' << include.line << ": " << library.folder << " includes \""
                                            << include.what << "\", but " << target << " does not link the target of " << folder;
        }
    }
    EXPECT_GT(checked, 100);  // else the pattern finds nothing
}

/// Of output and references the rule is stricter: they see core and scene only.
bool may_see(const std::string& folder, const std::string& other) {
    if (folder == "solvers/output" || folder == "validation/references")
        return other == "solvers/core" || other == "solvers/scene" || (folder == "solvers/output" && other == "solvers/parallel");
    return level().count(other) && level().at(other) < level().at(folder);
}

TEST("no folder includes one above its level, whatever CMake links; a new folder must be given its place in this test") {
    for (const auto& [target, library] : read_libraries()) {
        ASSERT_TRUE(level().count(library.folder)) << library.folder << " has no place among the levels";
        for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / library.folder)) {
            const std::string folder = folder_of(include.what);
            if (folder.empty() || folder == library.folder || contract_headers.count(include.what)) continue;
            EXPECT_TRUE(may_see(library.folder, folder))
                << include.file << ':' << include.line << ": " << library.folder << " must not see " << folder;
        }
    }
}

TEST("VTK is included by solvers/output, for files, by solvers/surfaces, for contours, and by nothing else of the library") {
    for (const auto& [target, library] : read_libraries()) {
        if (library.folder == "solvers/output" || library.folder == "solvers/surfaces") continue;
        for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / library.folder))
            EXPECT_FALSE(include.what.starts_with("vtk")) << include.file << ':' << include.line;
    }
}

TEST("MPI is included by one file: solvers/parallel/mpi/mpi_communicator.cpp") {
    int found = 0;
    for (const auto& [target, library] : read_libraries())
        for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / library.folder)) {
            if (include.what != "mpi.h") continue;
            ++found;
            EXPECT_TRUE(include.file.ends_with("solvers/parallel/mpi/mpi_communicator.cpp")) << include.file << ':' << include.line;
        }
    EXPECT_EQ(found, 1);
}

TEST("every folder of sources below solvers and validation is a target of its own") {
    std::set<std::string> folders;
    for (const auto& [target, library] : read_libraries()) folders.insert(library.folder);
    for (const std::string root : {"solvers", "validation"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(WEIR_SOURCE_DIR) / root)) {
            if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
            const std::string folder = fs::relative(entry.path().parent_path(), WEIR_SOURCE_DIR).string();
            EXPECT_TRUE(folders.count(folder) || folders.count(fs::path(folder).parent_path().string()))
                << entry.path() << " belongs to no target";
        }
}

TEST("references see no solver, not even through the contract of validation") {
    for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / "validation/references"))
        EXPECT_TRUE(!contract_headers.count(include.what) || reference_headers.count(include.what))
            << include.file << " includes " << include.what;
    for (const auto& include : includes_of(fs::path(WEIR_SOURCE_DIR) / "validation/harness")) {
        const std::string header = fs::relative(include.file, WEIR_SOURCE_DIR).string(), folder = folder_of(include.what);
        if (!reference_headers.count(header) || folder.empty()) continue;
        EXPECT_TRUE(folder == "solvers/core" || folder == "solvers/scene" || reference_headers.count(include.what))
            << header << " includes " << include.what;
    }
}

}  // namespace
