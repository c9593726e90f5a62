#include "metamorphic/small_scenes.hpp"

#include "metamorphic/transformation.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "validation/harness/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace weir::metamorphic {
namespace {

using scene::Table;

/// Cells of a small scene: a step of them takes about a millisecond.
constexpr double most_cells_2d = 1100, most_cells_3d = 2200;
constexpr std::size_t most_bodies = 8;

double product(const std::vector<double>& n) {
    double p = 1;
    for (const double v : n) p *= v;
    return p;
}

/// Cells over the least whole number that leaves few enough, one that divides all of them where there is one near.
std::vector<double> fewer(const std::vector<double>& cells, double most) {
    const auto divided = [&](double f) {
        std::vector<double> n = cells;
        for (double& v : n)
            if (v > 1) v = std::max(4.0, std::round(v / f));
        return n;
    };
    double least = 1;
    while (product(divided(least)) > most && least < 1000) ++least;
    for (double f = least; f <= 1.6 * least; ++f)
        if (std::all_of(cells.begin(), cells.end(), [&](double v) { return v == 1 || std::fmod(v, f) == 0; })) return divided(f);
    return divided(least);
}

/// The domain is a whole number of the new cells, which are as flat as the old ones.
void coarsen(Table& root) {
    Table& grid = *root.find_table("grid");
    const auto cells = grid.numbers("cells");
    auto size = grid.numbers("size");
    const double most = cells.size() == 3 && cells[1] > 1 ? most_cells_3d : most_cells_2d;
    if (product(cells) <= most) return;
    const auto n = fewer(cells, most);
    const double f = cells[0] / n[0];
    if (grid.numbers("size").size() == cells.size())
        for (std::size_t a = 0; a < n.size(); ++a)
            if (n[a] > 1 && n[a] * f != cells[a]) size[a] *= n[a] * f / cells[a];
    grid.set("cells", n, {1, 1}), grid.set("size", size, {1, 1});
}

scene::Scene without_output(const scene::Scene& scene, bool coarse, real tolerance) {
    Table root = scene.root();
    root.set("probes", std::vector<Table>{}), root.set("title", std::string());
    if (Table* output = root.find_table("output"))
        for (const char* key : {"every", "fields", "faces", "precision", "compression"}) output->erase(key);
    if (Table* output = root.find_table("output"); output && scene.solver() != "reconstruction") output->erase("surface");
    if (Table* time = root.find_table("time")) time->erase("stop_when_steady");
    if (root.has("bodies") && root.tables("bodies").size() > most_bodies && (!root.has("joints") || root.tables("joints").empty())) {
        auto bodies = root.tables("bodies");
        bodies.resize(most_bodies);
        root.set("bodies", bodies, root.place("bodies"));
    }
    if (coarse) coarsen(root);
    // Two runs are compared more closely than the usual tolerance of the pressure leaves them.
    if (root.has("scheme.poisson.fixed") && !root.flag("scheme.poisson.fixed"))
        root.find_table("scheme.poisson")->set("tolerance", tolerance, {1, 1});
    return scene_of_table(root, scene.file());
}

bool runs(const scene::Scene& scene) {
    try {
        Simulation simulation(scene);
        for (int step = 0; step < steps; ++step) simulation.step();
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace

std::vector<NamedScene> small_scenes(const std::filesystem::path& cases) {
    std::vector<NamedScene> list;
    const auto add = [&](const std::string& name, const scene::Scene& scene) {
        // 1e-12 is below round-off where the matrix is worse than 1000:1; the coupling of bodies solves to half of the tolerance
        const bool coupled = scene.solver() == "two_phase" && !scene.root().tables("bodies").empty();
        for (const bool coarse : {true, false})
            for (const real tolerance : {coupled ? 1e-10 : 1e-12, 1e-10})
                if (scene::Scene small = without_output(scene, coarse, tolerance); runs(small))
                    return list.push_back({name, std::move(small)});
    };
    std::vector<std::filesystem::path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(cases))
        if (std::filesystem::exists(entry.path() / "case.toml") || std::filesystem::exists(entry.path() / "scene.toml"))
            folders.push_back(entry.path());
    std::sort(folders.begin(), folders.end());
    for (const auto& folder : folders) {
        const std::string name = folder.filename().string();
        if (!std::filesystem::exists(folder / "case.toml")) {
            add(name, scene::read(folder, sim::schemas()));
            continue;
        }
        std::set<std::string> seen;
        for (const auto& variant : validation::read_case(folder, validation::Size::ci).variants) {
            const scene::Scene scene = validation::scene_of(variant, 0, sim::schemas());
            const std::string transfer = scene.has("scheme.transfer") ? scene.text("scheme.transfer") : "";
            // The family of everyday scenes varies one scene in many ways, of which most are properties here.
            const std::string kind = name.starts_with("everyday_") ? scene.solver() : scene.solver() + transfer + variant.scene.string();
            if (!seen.insert(kind).second) continue;
            add(variant.name.empty() ? name : name + "/" + variant.name, scene);
        }
    }
    return list;
}

}  // namespace weir::metamorphic
