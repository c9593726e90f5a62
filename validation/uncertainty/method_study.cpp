#include "validation/uncertainty/method_study.hpp"

#include "core/error.hpp"
#include "validation/uncertainty/other_influences.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::validation {
namespace {

constexpr double margin = 1.35;    // over a power law of two grids: measured on 19 scenes the estimate is 0.75 to 1.04 of the true time
constexpr real rung_ratio = 1.45;  // of the cells of neighbouring grids
constexpr real least_ratio = 1.2, most_ratio = 1.7;
constexpr double most_cells_at_first = 20000;
constexpr int most_grids = 12, fewest_grids = 3;
constexpr std::size_t grids_before_chaos = 4;  // no finer grids for a value that chaos refuses

/// y at number n by the power law through two grids; the power is kept between `low` and `high`.
double by_power(int n, const GridRun& coarse, const GridRun& fine, double y0, double y1, double low, double high) {
    const double ratio = std::log(static_cast<double>(fine.grid.number) / coarse.grid.number);
    const double power = y0 > 0 && y1 > 0 ? std::clamp(std::log(y1 / y0) / ratio, low, high) : high;
    return y1 * std::pow(static_cast<double>(n) / fine.grid.number, power);
}

/// Adds grids to a ladder and estimates their cost from the finest two.
class Climber {
public:
    Climber(const Ladder& ladder, MethodStudy& study, const Limits& limits, std::vector<scene::Override> more, RunStore& store,
            const Tell& tell)
        : ladder_(&ladder), study_(&study), limits_(&limits), more_(std::move(more)), store_(&store), tell_(&tell) {}

    void add(int number) {
        const Grid grid = next_grid(*ladder_, study_->grids, number);
        (*tell_)(fmt::format("{}, {} cells", study_->method.name, grid.text()));
        study_->grids.push_back({grid, store_->run(ladder_->scene(grid, more_))});
        study_->spent += study_->grids.back().run.seconds;
    }
    double seconds(int number) const {
        const auto& [coarse, fine] = last_two();
        const double d = static_cast<double>(fine.grid.cells.size());
        return margin * by_power(number, coarse, fine, coarse.run.seconds, fine.run.seconds, 0.5, d + 1.5);
    }
    /// Of a far finer grid: cells times steps at least, since small grids have a cost per step that does not grow.
    double seconds_far(int number) const {
        const auto& [coarse, fine] = last_two();
        const double d = static_cast<double>(fine.grid.cells.size());
        return by_power(number, coarse, fine, coarse.run.seconds, fine.run.seconds, d + 1, d + 1.5);
    }
    double seconds_per_frame(int number) const {
        const auto& [coarse, fine] = last_two();
        const double d = static_cast<double>(fine.grid.cells.size());
        return by_power(number, coarse, fine, coarse.run.seconds_per_frame(limits_->frame), fine.run.seconds_per_frame(limits_->frame), 0,
                        d + 1.5);
    }
    const std::vector<scene::Override>& more() const { return more_; }
    bool affordable(int number) const { return seconds(number) <= limits_->time_limit && seconds_per_frame(number) <= limits_->budget; }

private:
    std::pair<const GridRun&, const GridRun&> last_two() const {
        const auto& grids = study_->grids;
        return {grids[grids.size() - 2], grids[grids.size() - 1]};
    }
    const Ladder* ladder_;
    MethodStudy* study_;
    const Limits* limits_;
    std::vector<scene::Override> more_;
    RunStore* store_;
    const Tell* tell_;
};

/// Whether each wish is met by the finest grid.
bool met(const MethodStudy& study, const std::vector<Wish>& wishes) {
    for (std::size_t q = 0; q < study.quantities.size(); ++q) {
        const QuantityStudy& quantity = study.quantities[q];
        if (!quantity.refused.empty() || !(quantity.width <= absolute(wishes[q], quantity.finest()))) return false;
    }
    return true;
}

/// The next grid that would meet every wish, by h_wish = h1 (wish / U)^(1/q); 0 where that is not known.
int number_for(const MethodStudy& study, const std::vector<Wish>& wishes) {
    int number = 0;
    for (std::size_t q = 0; q < study.quantities.size(); ++q) {
        const QuantityStudy& quantity = study.quantities[q];
        if (!quantity.band || !(quantity.width > 0)) return 0;
        const real wish = absolute(wishes[q], quantity.finest());
        const real finer = std::pow(quantity.width / wish, 1 / quantity.band->order);
        number = std::max(number, static_cast<int>(std::ceil(std::min<real>(finer, farthest) * study.grids.back().grid.number)));
    }
    return number;
}

/// The next number of a ladder: the scene's own grid where it is near.
int next_number(int number, int own) {
    if (own >= least_ratio * number && own <= most_ratio * number) return own;
    return std::max(number + 1, static_cast<int>(std::lround(rung_ratio * number)));
}

/// The numbers from here on: up to what is affordable, without a wish and a budget up to the scene's own grid; at least three grids in all.
std::vector<int> rest_of_ladder(const MethodStudy& study, const Climber& climber, int own, bool to_own) {
    std::vector<int> numbers;
    for (int number = next_number(study.grids.back().grid.number, own);; number = next_number(number, own)) {
        const auto count = static_cast<int>(study.grids.size() + numbers.size());
        const bool wanted = count < fewest_grids || (climber.affordable(number) && (!to_own || number <= own));
        if (!wanted || count == most_grids) return numbers;
        numbers.push_back(number);
    }
}

/// After five grids, a grid that would take hundred times the limit is not worth climbing towards.
bool out_of_reach(const MethodStudy& study, const Climber& climber, const std::vector<Wish>& wishes, const Limits& limits) {
    const int wanted = number_for(study, wishes);
    return study.grids.size() >= 5 && wanted > 0 && climber.seconds_far(wanted) > 100 * limits.time_limit;
}

/// Whether no quantity has a value on the finest grid.
bool none_known(const MethodStudy& study) {
    return std::all_of(study.quantities.begin(), study.quantities.end(), [](const auto& q) { return !q.finest().unknown.empty(); });
}

/// Where a ladder begins: some grids below the scene's own, and coarse enough to be run within seconds.
int first_number(const Ladder& ladder, int least, int own, int rungs) {
    int number = numbers_of_ladder(least, own, rungs, rung_ratio).front();
    const auto cells = [&](int n) {
        double all = 1;
        for (const int along : ladder.grid(n).cells) all *= along;
        return all;
    };
    while (number > least && cells(number) > most_cells_at_first) number = std::max(least, static_cast<int>(number / rung_ratio));
    return number;
}

/// From coarse to fine. The first two grids price the others; with a wish the ladder ends where it is met.
void climb(MethodStudy& study, Climber& climber, const Ladder& ladder, const std::vector<Asked>& asked, const std::vector<Wish>& wishes,
           const Limits& limits, RunStore& store, const Tell& tell) {
    const int least = ladder.coarsest(study.left_out), own = std::max(ladder.own(), least);
    climber.add(first_number(ladder, least, own, limits.rungs));
    assess(study, asked, wishes);
    if (study.grids.front().run.failure) return;
    climber.add(next_number(study.grids.front().grid.number, own));
    assess(study, asked, wishes);
    if (limits.checks && !study.grids.back().run.failure) study_coarsest_grid(study, ladder, climber.more(), store, tell);
    const bool to_own = wishes.empty() && limits.budget == infinity;
    for (bool first = true; !study.grids.back().run.failure; first = false) {
        const auto rest = rest_of_ladder(study, climber, own, to_own);
        if (rest.empty()) break;
        if (first) {
            study.estimated = study.spent;
            for (const int number : rest) study.estimated += climber.seconds(number);
            tell(fmt::format("{}: at most {} grids, {} to {} cells, {} of computing", study.method.name, 2 + rest.size(),
                             study.grids.front().grid.text(), ladder.grid(rest.back()).text(), seconds_text(study.estimated)));
        }
        climber.add(rest.front());
        const bool beyond_limit = leave_out_unfinished(study, limits.time_limit);
        assess(study, asked, wishes);
        if (beyond_limit) break;
        if (limits.checks && study.grids.size() == grids_before_chaos && !study.grids.back().run.failure)
            study_chaos(study, ladder, climber.more(), store, tell);
        if (refuse_after_chaos(study) || none_known(study)) break;
        if (!wishes.empty() && (met(study, wishes) || out_of_reach(study, climber, wishes, limits))) break;
    }
}

/// The grid that would meet the wishes, and its computing time.
void estimate_next(MethodStudy& study, const Climber& climber, const std::vector<Wish>& wishes) {
    const bool finer_helps = !wishes.empty() && !met(study, wishes) && !study.chaotic_after;
    study.next = finer_helps ? number_for(study, wishes) : 0;
    if (study.next > 0) study.next_seconds = climber.seconds_far(study.next);
}

}  // namespace

Grid next_grid(const Ladder& ladder, const std::vector<GridRun>& runs, int number) {
    if (runs.empty()) return ladder.grid(number);
    return ladder.grid(number, runs.front().run.mean_dt, runs.front().grid.number);
}

bool leave_out_unfinished(MethodStudy& study, double time_limit) {
    const RecordedRun& finest = study.grids.back().run;
    if (!finest.failure || !(finest.seconds > time_limit) || study.grids.size() <= static_cast<std::size_t>(fewest_grids)) return false;
    study.left_out += fmt::format("{}{} cells: {}", study.left_out.empty() ? "" : "; ", study.grids.back().grid.text(), *finest.failure);
    study.grids.pop_back();
    return true;
}

void assess(MethodStudy& study, const std::vector<Asked>& asked, const std::vector<Wish>& wishes) {
    study.quantities.resize(asked.size());
    for (std::size_t q = 0; q < asked.size(); ++q) {
        QuantityStudy& quantity = study.quantities[q];
        quantity.asked = asked[q], quantity.values.clear(), quantity.error.clear(), quantity.refused.clear(), quantity.band.reset();
        std::vector<GridValue> values;
        for (const GridRun& g : study.grids) {
            quantity.values.push_back(value_of(g.run, asked[q], q));
            const Value& value = quantity.values.back();
            if (!value.unknown.empty() && quantity.refused.empty())
                quantity.refused = fmt::format("not known on {} cells: {}", g.grid.text(), value.unknown);
            values.push_back({g.grid.h, value.samples});
        }
        if (!quantity.refused.empty()) continue;
        if (values.size() < 3) {
            quantity.refused = "fewer than three grids fit the limits";
            continue;
        }
        quantity.band = band(values, study.method.formal_order);
        quantity.finer = study.grids.back().grid.h / study.grids.front().grid.h;
        quantity.width = quantity.band->width + quantity.finer * (quantity.step + quantity.seeds);
        quantity.error = error_bounds(values, quantity.width);
        const real scale = quantity.finest().scale;
        const bool absolute_wish = q < wishes.size() && !wishes[q].relative;
        if (!absolute_wish && scale > 0 && quantity.width > widest_band * scale)
            quantity.refused = fmt::format("the band is {:.0f}% of {}: too wide to recommend anything", 100 * quantity.width / scale,
                                           quantity.finest().scale_of);
    }
}

MethodStudy study_method(const scene::Scene& scene, const Method& method, const std::vector<Asked>& asked, const std::vector<Wish>& wishes,
                         const Limits& limits, RunStore& store, const Solvers& solvers, const Tell& tell) {
    MethodStudy study{.method = method};
    const Ladder ladder(scene, method, solvers);
    const std::vector<scene::Override> pictures = picture_probes(asked, scene);
    Climber climber(ladder, study, limits, pictures, store, tell);
    climb(study, climber, ladder, asked, wishes, limits, store, tell);
    const auto fails = [](const GridRun& g) { return g.run.failure.has_value(); };
    if (std::any_of(study.grids.begin(), study.grids.end(), fails)) return study;
    if (limits.checks) {
        study_chaos(study, ladder, pictures, store, tell);
        assess(study, asked, wishes);
        refuse_after_chaos(study);
    }
    estimate_next(study, climber, wishes);
    return study;
}

std::string seconds_text(double seconds) {
    return seconds < 10     ? fmt::format("{:.2g} s", seconds)
           : seconds < 120  ? fmt::format("{:.0f} s", seconds)
           : seconds < 7200 ? fmt::format("{:.0f} min", seconds / 60)
                            : fmt::format("{:.0f} h", seconds / 3600);
}

std::string text_with_unit(real value, const std::string& unit, real to) {
    struct Prefix {
        const char *unit, *name;
        real factor;
    };
    static constexpr Prefix prefixes[] = {{"m", "mm", 1e3}, {"s", "ms", 1e3}, {"Pa", "kPa", 1e-3}, {"J", "mJ", 1e3}};
    std::string name = unit;
    for (const Prefix& p : prefixes)
        if (unit == p.unit && (p.factor > 1 ? std::abs(value) < 1 : std::abs(value) >= 1e4))
            name = p.name, value *= p.factor, to *= p.factor;
    int decimals = to > 0 && std::isfinite(to) ? std::clamp(1 - static_cast<int>(std::floor(std::log10(to))), 0, 9) : 4;
    const std::string number =
        std::abs(value) >= 1e7 || decimals >= 9 ? fmt::format("{:.6g}", value) : fmt::format("{:.{}f}", value, decimals);
    return name.empty() ? number : number + " " + name;
}

}  // namespace weir::validation
