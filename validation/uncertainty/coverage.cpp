#include "validation/uncertainty/coverage.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace weir::validation {
namespace {

constexpr real negligible = 1e-12;  // of the size of a quantity

/// The coarsest of the first `count` grids whose bound, and that of all finer ones, is at most `wish`.
std::optional<std::size_t> recommended(const KnownQuantity& q, std::size_t count, real wish) {
    const std::vector<GridValue> run(q.values.begin(), q.values.begin() + static_cast<std::ptrdiff_t>(count));
    const auto bounds = error_bounds(run, band(run, q.formal_order).width);
    std::optional<std::size_t> coarsest;
    for (std::size_t k = count; k-- > 0 && bounds[k] <= wish;) coarsest = k;
    return coarsest;
}

real median(std::vector<real> values) {
    if (values.empty()) return std::nan("");
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

}  // namespace

std::vector<CheckedBand> check_bands(const std::vector<KnownQuantity>& quantities) {
    std::vector<CheckedBand> checked;
    for (std::size_t i = 0; i < quantities.size(); ++i) {
        const KnownQuantity& q = quantities[i];
        for (std::size_t finest = 2; finest < q.values.size(); ++finest) {
            const auto from = q.values.begin() + static_cast<std::ptrdiff_t>(finest - 2);
            CheckedBand c{.quantity = i, .finest = finest, .band = band({from, from + 3}, q.formal_order), .error = q.error(finest)};
            c.covered = c.error <= c.band.width + negligible * std::max(size_of(q.truth), q.scales.at(finest));
            checked.push_back(c);
        }
    }
    return checked;
}

real Coverage::share() const { return all > 0 ? static_cast<real>(covered) / static_cast<real>(all) : std::nan(""); }

Coverage coverage_of(const std::vector<CheckedBand>& bands, const std::function<bool(const CheckedBand&)>& belongs) {
    Coverage coverage;
    std::vector<real> ratios;
    for (const CheckedBand& b : bands) {
        if (!belongs(b)) continue;
        ++coverage.all, coverage.covered += b.covered ? 1 : 0;
        ratios.push_back(b.ratio());
    }
    coverage.median_ratio = median(std::move(ratios));
    return coverage;
}

real Advice::wrong_share() const { return answered > 0 ? static_cast<real>(wrong) / static_cast<real>(answered) : std::nan(""); }

GridAdvice grid_for(const KnownQuantity& q, real wish) {
    GridAdvice advice;
    for (std::size_t count = 3; count <= q.values.size() && !advice.grid; ++count) {
        advice.wish = wish * q.scales.at(count - 1);
        advice.grid = recommended(q, count, advice.wish);
    }
    advice.wrong = advice.grid && q.error(*advice.grid) > advice.wish;
    advice.none = q.error(q.values.size() - 1) > wish * q.scales.back();
    return advice;
}

Advice advice_for(const std::vector<KnownQuantity>& quantities, real wish) {
    Advice sum;
    for (const KnownQuantity& q : quantities) {
        if (q.values.size() < 3) continue;
        const GridAdvice advice = grid_for(q, wish);
        ++(advice.grid ? sum.answered : sum.refused);
        sum.wrong += advice.wrong ? 1 : 0;
        sum.rightly_refused += !advice.grid && advice.none ? 1 : 0;
    }
    return sum;
}

Advice advice_for_all(const std::vector<KnownQuantity>& quantities) {
    Advice sum;
    for (const real wish : counted_wishes) {
        const Advice one = advice_for(quantities, wish);
        sum.answered += one.answered, sum.wrong += one.wrong;
        sum.refused += one.refused, sum.rightly_refused += one.rightly_refused;
    }
    return sum;
}

std::vector<real> extrapolated(const std::vector<GridValue>& grids, real formal_order) {
    if (grids.size() < 3) throw BadInput("an extrapolation requires three grids");
    const auto& [h1, f1] = grids[grids.size() - 1];
    const auto& [h2, f2] = grids[grids.size() - 2];
    const auto& [h3, f3] = grids[grids.size() - 3];
    const real p = std::clamp(observed_order(distance(f1, f2), distance(f2, f3), h1, h2, h3), real(1), std::max(real(1), formal_order));
    const real over = 1 / (std::pow(h2 / h1, p) - 1);
    std::vector<real> truth;
    for (std::size_t i = 0; i < f1.size(); ++i) truth.push_back(f1[i] + over * (f1[i] - f2.at(i)));
    return truth;
}

std::string family_of(const std::string& solver) {
    if (solver == "transport") return "mac";
    return solver == "sph" || solver == "pbf" ? "particles" : solver;
}

}  // namespace weir::validation
