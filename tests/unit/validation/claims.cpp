// What the cases of the tree claim: nothing that cannot change, and no bound on an error that refinement makes larger.
#include "geometry/sides.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/case.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

using namespace weir;
using namespace weir::validation;

namespace {

const std::filesystem::path root = WEIR_SOURCE_DIR;

/// f(case, variant) of all cases at a size.
template <class F>
void for_each_variant(Size size, F&& f) {
    for (const auto& folder : find_cases(root / "cases")) {
        const Case c = read_case(folder, size);
        for (const Variant& v : c.variants) f(c, v);
    }
}

template <int D>
bool has_open_side(const scene::Scene& scene) {
    const geometry::Sides<D> sides(scene);
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            const auto kind = sides.side(a, end).kind;
            if (kind == geometry::SideKind::inflow || kind == geometry::SideKind::outflow) return true;
        }
    return false;
}

/// Particles have one mass: the number, the mass and the volume of a set that nothing joins and nothing leaves are the length of a list.
bool is_length_of_a_list(const std::string& metric, const scene::Scene& scene) {
    if (scene.solver() != "sph" && scene.solver() != "pbf") return false;
    if (metric == "volume_after") return true;
    const bool fixed =
        !scene.has("emitters") && !scene.has("sinks") && !(scene.dim() == 2 ? has_open_side<2>(scene) : has_open_side<3>(scene));
    const std::string subject = metric.substr(0, metric.find('.')), operation = metric.substr(std::min(metric.size(), subject.size() + 1));
    const bool counts = subject == "particles" || subject == "mass" || subject == "volume";
    return fixed && counts &&
           (operation.empty() || operation == "drift" || operation == "change" || operation == "min" || operation == "max");
}

/// Published measurements of a case at full size: by variant and metric, from coarse to fine.
std::map<std::pair<std::string, std::string>, std::vector<real>> published(const std::string& name) {
    std::map<std::pair<std::string, std::string>, std::vector<real>> found;
    std::ifstream file(root / "results/csv" / (name + ".csv"));
    std::vector<std::string> columns;
    for (std::string line; std::getline(file, line);) {
        if (line.empty() || line[0] == '#') continue;
        std::vector<std::string> cells;
        std::istringstream rest(line);
        for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
        if (columns.empty()) {
            columns = cells;
            continue;
        }
        const auto cell = [&](const char* column) {
            return cells.at(static_cast<std::size_t>(std::find(columns.begin(), columns.end(), column) - columns.begin()));
        };
        if (!cell("measured").empty()) found[{cell("variant"), cell("metric")}].push_back(std::stod(cell("measured")));
    }
    return found;
}

/// By more than a twentieth, over all grids and between the two finest. An error below a third of its bound may scatter.
bool grows(const std::vector<real>& errors, real bound) {
    if (errors.size() < 2 || !(errors.back() > bound / 3)) return false;
    return errors.back() > 1.05 * errors.front() && errors.back() > errors[errors.size() - 2];
}

bool claims_order(const Variant& v, const std::string& metric) {
    return std::any_of(v.accept.begin(), v.accept.end(), [&](const Criterion& c) { return c.metric == metric && c.is_order(); });
}

}  // namespace

TEST("no case claims that the number of its particles stays what it is") {
    for (const Size size : {Size::ci, Size::full})
        for_each_variant(size, [](const Case& c, const Variant& v) {
            const scene::Scene scene = scene_of(v, 0, sim::schemas());
            for (const Criterion& claim : v.accept)
                EXPECT_FALSE(is_length_of_a_list(claim.metric, scene)) << c.name << ", " << v.name << ": " << claim.metric;
        });
}

TEST("a published error that grows under refinement below its bound has an order, claimed or listed as an open target") {
    for_each_variant(Size::full, [](const Case& c, const Variant& v) {
        if (!v.sweep || v.sweep->key != "grid.cells") return;
        const auto measured = published(c.name);
        for (const Criterion& claim : v.accept) {
            if (claim.test != Criterion::Test::at_most || !claim.not_reached.empty() || quantity_of(claim.metric) != Quantity::error)
                continue;
            const auto at = measured.find({v.name, claim.metric});
            if (at == measured.end() || !grows(at->second, claim.high)) continue;
            EXPECT_TRUE(claims_order(v, claim.metric))
                << c.name << ", " << v.name << ": " << claim.metric << " grows to " << at->second.back();
        }
    });
}
