// What a diagram says to somebody with a budget.
#include "validation/cost/rank.hpp"
#include "validation/cost/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace weir::validation {
namespace {

using Points = std::vector<const CostPoint*>;

constexpr double frame_ms = 1000.0 / 60;  // what there is at 60 frames a second

std::string in_frames(const CostPoint& p) {
    const double ms = p.seconds_per_second * frame_ms;
    return p.seconds_per_second <= 1 ? fmt::format("{:.3g} ms of each 16.7 ms frame", ms)
                                     : fmt::format("{:.3g} ms per frame of 16.7 ms", ms);
}

/// A run that is too short for the clock has no factor.
std::string priced(const CostPoint& p, Price by) {
    if (by == Price::step) return fmt::format("{:.3g} ms per step", p.ms_per_step);
    return in_frames(p) + (p.seconds_per_second > 0 ? fmt::format(" ({:.3g} times real time)", 1 / p.seconds_per_second) : "");
}

/// A reference without an uncertainty distinguishes all errors, also from zero.
bool within_reference(const Study& study, const CostPoint& p) { return study.known_to > 0 && p.error <= study.known_to; }

std::string plain(const CostPoint& p) { return p.name().empty() ? "the only configuration" : p.name(); }

constexpr real largest_drift = 0.01;  // of the volume; what changes it more is not recommended, however small its error

/// Relative change of the volume over the run, where the study measures it.
real volume_drift(const CostPoint& p) {
    const auto drift = p.also.find("volume.drift");
    return drift == p.also.end() ? 0 : std::abs(drift->second);
}

/// Which configurations create or lose liquid; nothing where none does.
std::string that_volume_changes(const Points& by_price) {
    std::vector<std::string> names;
    real most = 0;
    for (const CostPoint* p : by_price)
        if (volume_drift(*p) > largest_drift) names.push_back(plain(*p)), most = std::max(most, volume_drift(*p));
    if (names.empty()) return "";
    return fmt::format("The volume changes by more than {:g}% with {}: by up to {:.2g}%. They are not recommended.", 100 * largest_drift,
                       fmt::join(names, ", "), 100 * most);
}

/// The cheapest setting that is good enough: what somebody can take.
std::string at_good_enough(const Study& study, const Points& by_price) {
    const auto good = std::find_if(by_price.begin(), by_price.end(),
                                   [&](auto* p) { return p->error <= study.good_enough && volume_drift(*p) <= largest_drift; });
    if (good == by_price.end()) {
        const auto nearest = *std::min_element(by_price.begin(), by_price.end(), [](auto* a, auto* b) { return a->error < b->error; });
        return fmt::format("No configuration reaches {} = {:g}; the nearest is {} with {:.3g}, for {}.", study.error, study.good_enough,
                           plain(*nearest), nearest->error, priced(*nearest, study.price));
    }
    return fmt::format("For {} <= {:g} take {}: {}.", study.error, study.good_enough, plain(**good), priced(**good, study.price));
}

std::string times_of(const Rank& r) { return fmt::format("{} {}{:.3g}", r.label, r.at.at_most ? "at most " : "", r.times); }

/// How the methods stand to each other at that error, whatever settings were measured; nothing where fewer than two reach it.
std::string ranks_at_good_enough(const StudyResult& result) {
    const Study& study = result.study;
    const Ranking ranking = rank(envelopes(result), study.good_enough, study.known_to);
    if (ranking.reached.size() < 2) return "";
    std::vector<std::string> others, alike;
    for (const Rank& r : ranking.reached) {
        if (&r != &ranking.reached.front()) others.push_back(times_of(r));
        if (r.alike) alike.push_back(r.label);
    }
    const Rank& first = ranking.reached.front();
    std::string s =
        fmt::format("Interpolated along each method's curve at {} = {:g}, in units of the time of {}{}: {}", study.error, study.good_enough,
                    first.label, first.at.at_most ? " (at most that of its cheapest configuration)" : "", fmt::join(others, ", "));
    if (!alike.empty())
        s += fmt::format(
            ". Not distinguishable from {}, because at its cost their errors differ by less than the reference uncertainty of {:g}: {}",
            first.label, study.known_to, fmt::join(alike, ", "));
    if (!ranking.missing.empty()) s += fmt::format(". Not reached by {}", fmt::join(ranking.missing, ", "));
    return s + ".";
}

std::string in_real_time(const Study& study, const Points& by_price) {
    if (by_price.size() == 1) {
        const CostPoint& only = *by_price.front();
        return fmt::format("{} {} in real time: {}.", only.name().empty() ? "The only configuration" : only.name(),
                           only.seconds_per_second <= 1 ? "runs" : "does not run", in_frames(only));
    }
    Points fast;
    std::copy_if(by_price.begin(), by_price.end(), std::back_inserter(fast), [](auto* p) { return p->seconds_per_second <= 1; });
    if (fast.empty())
        return fmt::format("No configuration runs in real time; the nearest is {} with {}.", plain(*by_price.front()),
                           in_frames(*by_price.front()));
    const auto best = *std::min_element(fast.begin(), fast.end(), [](auto* a, auto* b) { return a->error < b->error; });
    if (const auto as_good = std::count_if(fast.begin(), fast.end(), [&](auto* p) { return within_reference(study, *p); }); as_good > 0)
        return fmt::format("{} of {} configurations run in real time, {} of them within the reference uncertainty.", fast.size(),
                           by_price.size(), as_good);
    return fmt::format("{} of {} configurations run in real time; the most accurate of them is {}: {} = {:.3g}, for {}.", fast.size(),
                       by_price.size(), plain(*best), study.error, best->error, in_frames(*best));
}

std::string along_the_front(const Study& study, const Points& by_price) {
    Points front;
    std::copy_if(by_price.begin(), by_price.end(), std::back_inserter(front), [](auto* p) { return p->on_front; });
    const CostPoint &from = *front.front(), &to = *front.back();
    const bool to_the_limit = within_reference(study, to);
    if (by_price.size() < 2) return "";  // nothing to compare with
    if (front.size() < 2)
        return fmt::format("{} is {}.", plain(from),
                           to_the_limit ? "the cheapest, and within the reference uncertainty" : "both the cheapest and the most accurate");
    const std::string fall =
        to.error > 0 ? fmt::format("by a factor of {:.3g}", from.error / to.error) : fmt::format("from {:.3g} to zero", from.error);
    const double price = from.price(study.price), times = to.price(study.price) / price;
    return fmt::format("From {}, the cheapest, to {}, {}, the error falls {}{}.", plain(from), plain(to),
                       to_the_limit ? "which is within the reference uncertainty" : "the most accurate", fall,
                       price > 0 ? fmt::format(" for {:.3g} times the time", times) : "");
}

/// Where most methods are no more accurate at their most expensive configuration than at their cheapest, that is what to know; nothing
/// otherwise.
std::string that_finer_does_not_pay(const Study& study, const Points& by_price) {
    std::map<std::string, std::pair<const CostPoint*, const CostPoint*>> ends;  // of each method: cheapest, most expensive
    for (const CostPoint* p : by_price) ends.try_emplace(p->method, p, p).first->second.second = p;
    std::size_t refined = 0, worse = 0;
    double least = infinity, most = 0;
    for (const auto& [method, end] : ends) {
        const real first = study.told(end.first->error), last = study.told(end.second->error);
        if (end.first == end.second || std::max(first, last) <= study.known_to) continue;  // nothing can be told of it
        ++refined;
        if (last < first) continue;
        const double cheapest = end.first->price(study.price), times = cheapest > 0 ? end.second->price(study.price) / cheapest : 1;
        ++worse, least = std::min(least, times), most = std::max(most, times);
    }
    if (refined < 2 || 2 * worse <= refined) return "";
    return fmt::format(
        "Refinement does not pay off here: for {} of {} methods the most expensive configuration is no more accurate than the cheapest, at "
        "{:.2g} to {:.2g} times the cost.",
        worse, refined, least, most);
}

/// What the reference cannot tell, where it has a limit that settings reach.
std::string below_what_is_known(const Study& study, const Points& by_price) {
    const auto within = [&](const CostPoint* p) { return within_reference(study, *p); };
    const auto first = std::find_if(by_price.begin(), by_price.end(), within);
    if (first == by_price.end()) return "";
    return fmt::format(
        "{} of {} configurations lie within the reference uncertainty of {:g}, where they cannot be ranked ({}); the cheapest of them is "
        "{}.",
        std::count_if(first, by_price.end(), within), by_price.size(), study.known_to, study.known_why, plain(**first));
}

}  // namespace

std::vector<std::string> advice(const StudyResult& result) {
    const Study& study = result.study;
    Points by_price;
    for (const CostPoint& p : result.points)
        if (!p.failure) by_price.push_back(&p);
    if (by_price.empty()) return {"Every configuration failed."};
    std::sort(by_price.begin(), by_price.end(), [&](auto* a, auto* b) { return a->price(study.price) < b->price(study.price); });
    std::vector<std::string> sentences;
    if (study.good_enough > 0) sentences.push_back(at_good_enough(study, by_price));
    if (const std::string changes = that_volume_changes(by_price); !changes.empty()) sentences.push_back(changes);
    if (const std::string ranks = study.good_enough > 0 ? ranks_at_good_enough(result) : ""; !ranks.empty()) sentences.push_back(ranks);
    if (study.price == Price::second) sentences.push_back(in_real_time(study, by_price));
    const std::string in_vain = that_finer_does_not_pay(study, by_price);
    if (const std::string s = in_vain.empty() ? along_the_front(study, by_price) : in_vain; !s.empty()) sentences.push_back(s);
    if (const std::string limit = below_what_is_known(study, by_price); !limit.empty()) sentences.push_back(limit);
    const auto count = [&](auto holds) { return std::count_if(result.points.begin(), result.points.end(), holds); };
    if (const auto failed = count([](const CostPoint& p) { return p.failure && p.was_run(); }); failed > 0)
        sentences.push_back(fmt::format("{} of {} configurations failed: see the table.", failed, result.points.size()));
    if (const auto missing = count([](const CostPoint& p) { return !p.was_run(); }); missing > 0)
        sentences.push_back(
            fmt::format("{} of {} configurations could not be run here: the table gives the reason.", missing, result.points.size()));
    return sentences;
}

}  // namespace weir::validation
