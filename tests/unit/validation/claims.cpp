// What the cases of the tree claim: nothing that cannot change, and no bound on an error that refinement makes larger.
#include "geometry/sides.hpp"
#include "sim/registry.hpp"
#include "support/test.hpp"
#include "validation/harness/case.hpp"
#include "validation/harness/generic_metrics.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <sstream>

namespace claims_tests {

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

/// Published measurements of a case at full size: (h, measured) from coarse to fine, by variant and metric.
std::map<std::pair<std::string, std::string>, std::vector<std::array<real, 2>>> published(const std::string& name) {
    std::map<std::pair<std::string, std::string>, std::vector<std::array<real, 2>>> found;
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
        if (!cell("measured").empty())
            found[{cell("variant"), cell("metric")}].push_back({std::stod(cell("h")), std::stod(cell("measured"))});
    }
    return found;
}

/// Errors in cells or spacings become lengths.
bool is_in_cells(const std::string& metric) { return find_metric(metric)->unit == "cells" || metric == "surface.hausdorff"; }

/// By more than a twentieth, over all grids and between the two finest. An error below a third of its bound may scatter.
bool grows(const std::string& metric, const std::vector<std::array<real, 2>>& measured, real bound) {
    if (measured.size() < 2 || !(measured.back()[1] > bound / 3)) return false;
    const bool scale = find_metric(metric) != nullptr && is_in_cells(metric);
    const auto error = [&](const std::array<real, 2>& m) { return scale ? m[0] * m[1] : m[1]; };
    return error(measured.back()) > 1.05 * error(measured.front()) && error(measured.back()) > error(measured[measured.size() - 2]);
}

/// By an order or a GCI, claimed or an open target, by a bound that is an open target on another grid, or by bounds that fall from grid to
/// grid.
bool speaks_of_convergence(const Variant& v, const Criterion& claim) {
    return std::any_of(v.accept.begin(), v.accept.end(), [&](const Criterion& c) {
        if (c.test == Criterion::Test::gci_at_most) return true;
        return c.metric == claim.metric && (c.is_order() || !c.not_reached.empty() || (c.at && claim.at && c.high != claim.high));
    });
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

TEST("a case with a published error that grows under refinement says so: it claims an order or a GCI, or lists it as an open target") {
    for_each_variant(Size::full, [](const Case& c, const Variant& v) {
        if (!v.sweep || v.sweep->key != "grid.cells") return;
        const auto measured = published(c.name);
        for (const Criterion& claim : v.accept) {
            if (claim.test != Criterion::Test::at_most || !claim.not_reached.empty() || quantity_of(claim.metric) != Quantity::error)
                continue;
            const auto at = measured.find({v.name, claim.metric});
            if (at == measured.end() || !grows(claim.metric, at->second, claim.high)) continue;
            EXPECT_TRUE(speaks_of_convergence(v, claim))
                << c.name << ", " << v.name << ": " << claim.metric << " grows to " << at->second.back()[1];
        }
    });
}

}  // namespace claims_tests
