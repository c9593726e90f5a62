#include "validation/uncertainty/coverage_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::validation {
namespace {

using Name = std::function<std::string(const CheckedBand&)>;

std::string row(const std::string& name, const Coverage& c) {
    return fmt::format("| {} | {} | {:.1f}% | {:.1f} |\n", name, c.all, 100 * c.share(), c.median_ratio);
}

/// One row per name, in the order in which names appear.
std::string table(const std::string& title, const std::vector<CheckedBand>& bands, const Name& name) {
    std::string text = fmt::format("| {} | bands | covered | width over error, median |\n|---|---|---|---|\n", title);
    std::vector<std::string> names;
    for (const CheckedBand& b : bands)
        if (std::find(names.begin(), names.end(), name(b)) == names.end()) names.push_back(name(b));
    for (const std::string& n : names) text += row(n, coverage_of(bands, [&](const CheckedBand& b) { return name(b) == n; }));
    return text + "\n";
}

std::string advice_table(const std::vector<KnownQuantity>& quantities) {
    std::string text = "| wish | answered | wrong | refused | no grid was accurate enough |\n|---|---|---|---|---|\n";
    for (const real wish : counted_wishes) {
        const Advice a = advice_for(quantities, wish);
        text += fmt::format("| {:g}% | {} | {} | {} | {} |\n", 100 * wish, a.answered, a.wrong, a.refused, a.rightly_refused);
    }
    return text + "\n";
}

std::string wrong_advice(const std::vector<KnownQuantity>& quantities) {
    std::string text = "| wrong advice | wish | grid | error over wish |\n|---|---|---|---|\n";
    for (const KnownQuantity& q : quantities)
        for (const real wish : counted_wishes) {
            const GridAdvice a = grid_for(q, wish);
            if (a.wrong)
                text += fmt::format("| {} `{}`{} | {:g}% | {} | {:.2f} |\n", q.scene, q.quantity, q.added ? " (new)" : "", 100 * wish,
                                    q.grids[*a.grid], q.error(*a.grid) / a.wish);
        }
    return text + "\n";
}

std::string not_covered(const CoverageRuns& runs, const std::vector<CheckedBand>& bands) {
    std::string text = "| not covered | grids | verdict | order | width over error | error over scale |\n|---|---|---|---|---|---|\n";
    for (const CheckedBand& b : bands) {
        if (b.covered) continue;
        const KnownQuantity& q = runs.quantities[b.quantity];
        text += fmt::format("| {} `{}`{} | {}, {}, {} | {} | {:.1f} | {:.2f} | {:.2g}% |\n", q.scene, q.quantity, q.added ? " (new)" : "",
                            q.grids[b.finest - 2], q.grids[b.finest - 1], q.grids[b.finest], words_of(b.band.convergence),
                            b.band.observed_order, b.ratio(), 100 * b.error / q.scales[b.finest]);
    }
    return text;
}

}  // namespace

std::string coverage_text(const CoverageRuns& runs) {
    const auto bands = check_bands(runs.quantities);
    const auto of = [&](const CheckedBand& b) -> const KnownQuantity& { return runs.quantities[b.quantity]; };
    std::string text = fmt::format("{} quantities of {} scenes, {} bands of three grids, {} runs, {:.0f} s of computing\n\n",
                                   runs.quantities.size(), runs.scenes, bands.size(), runs.runs, runs.seconds);
    text += table("all", bands, [](const CheckedBand&) { return "all"; });
    text += table("family", bands, [&](const CheckedBand& b) { return of(b).family; });
    text += table("quantity", bands, [&](const CheckedBand& b) { return of(b).kind; });
    text += table("verdict", bands, [](const CheckedBand& b) { return std::string(words_of(b.band.convergence)); });
    text += table("truth", bands, [&](const CheckedBand& b) { return of(b).exact ? "exact" : "finer grid"; });
    text += table("scenes", bands, [&](const CheckedBand& b) { return of(b).added ? "new" : "of the prototype"; });
    text += advice_table(runs.quantities) + wrong_advice(runs.quantities) + not_covered(runs, bands);
    for (const std::string& unknown : runs.unknown) text += "\nno value: " + unknown;
    return text + "\n";
}

}  // namespace weir::validation
