// How often the bands of weir plan contain the true error, and how often its advice is wrong: over quantities whose true value is known,
// each on a ladder of grids.
#pragma once
#include "validation/harness/band.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// A quantity on the grids of a ladder, and its true value.
struct KnownQuantity {
    std::string scene{}, quantity{};
    std::string family{};  // "mac", "mac_water", "tallcell", "heightfield", "waves", "particles"
    std::string kind{};    // "end", "extremum", "mean", "change", "time", "curve", "picture"
    bool exact = true;     // the truth is exact; else it is extrapolated from a finer grid
    bool added = false;    // the scene was not used when the formula of the band was chosen
    real formal_order = 1;
    std::vector<std::string> grids{};  // cells, from coarse to fine
    std::vector<GridValue> values{};   // from coarse to fine
    std::vector<real> scales{};        // what a percentage refers to, per grid
    std::vector<real> truth{};

    real error(std::size_t grid) const { return distance(values.at(grid).value, truth); }
};

/// The band of three neighbouring grids of a quantity, and the true error of the finest of them.
struct CheckedBand {
    std::size_t quantity = 0, finest = 0;
    Band band{};
    real error = 0;
    bool covered = false;  // the error is at most the width, up to round-off of the quantity
    /// Width over error; infinite where the error is zero.
    real ratio() const { return error > 0 ? band.width / error : infinity; }
};

/// Every triple of neighbouring grids of every quantity.
std::vector<CheckedBand> check_bands(const std::vector<KnownQuantity>& quantities);

struct Coverage {
    std::size_t covered = 0, all = 0;
    real median_ratio = 0;  // of width over error
    /// NaN where there are none.
    real share() const;
};
/// Of the bands that `belongs` accepts.
Coverage coverage_of(const std::vector<CheckedBand>& bands, const std::function<bool(const CheckedBand&)>& belongs);

/// The wishes for which advice is counted, as parts of a quantity's scale.
inline constexpr real counted_wishes[] = {0.01, 0.02, 0.05, 0.1};

/// The grid that is recommended for a wish; none where the wish is refused.
struct GridAdvice {
    std::optional<std::size_t> grid{};
    real wish = 0;       // absolute
    bool wrong = false;  // the true error of that grid is larger than the wish
    bool none = false;   // the finest grid is not accurate enough
};
/// As weir plan recommends: grids are added from coarse to fine, from three on, until the bound of one of them and of all finer ones is
/// within `wish` times the scale.
GridAdvice grid_for(const KnownQuantity& quantity, real wish);

/// The number of recommendations.
struct Advice {
    std::size_t answered = 0, wrong = 0, refused = 0;
    std::size_t rightly_refused = 0;  // no grid of the ladder is accurate enough
    real wrong_share() const;
};
/// For every quantity with at least three grids.
Advice advice_for(const std::vector<KnownQuantity>& quantities, real wish);
/// The sum over the counted wishes.
Advice advice_for_all(const std::vector<KnownQuantity>& quantities);

/// Truth extrapolated from the finest two grids: observed order p of the last three, clipped to [1, formal order]. Values from coarse to
/// fine, at least three.
std::vector<real> extrapolated(const std::vector<GridValue>& grids, real formal_order);

/// The family of a solver.
std::string family_of(const std::string& solver);

}  // namespace weir::validation
