// Methods ranked at an error that none of their settings has exactly: each one's time is read along its curve of error against time, by
// powers between two settings (both axes logarithmic), so that no rank hangs on where a setting happens to lie. Nothing is read beyond
// the settings that were measured.
#pragma once
#include "validation/cost/measure.hpp"

#include <optional>
#include <string>
#include <vector>

namespace weir::validation {

/// The settings of a method that no cheaper one of its own equals: price rises, error falls.
struct Envelope {
    std::string label{};
    struct Point {
        double price;
        real error;
    };
    std::vector<Point> points{};
};
/// One for each method with a setting that did not fail.
std::vector<Envelope> envelopes(const StudyResult& result);

struct PriceAt {
    double price = 0;
    bool at_most = false;  // the cheapest setting reaches the error already, or the error falls too far at once to be read between
};
/// The price at which a method reaches an error; nothing where no setting does.
std::optional<PriceAt> price_at(const Envelope& method, real error);
/// The error within a budget of at least the cheapest configuration; beyond the most expensive one, the error of that one.
real error_at(const Envelope& method, double price);

struct Rank {
    std::string label;
    PriceAt at{};
    double times = 1;    // of the cheapest method's price
    bool alike = false;  // not told apart from the cheapest method: see rank()
};
struct Ranking {
    std::vector<Rank> reached{};         // by price
    std::vector<std::string> missing{};  // methods that do not reach the error
};
/// Methods by the price at which they reach `error`. A method is alike to the cheapest where for the price of that one it has an error that
/// is larger by less than the reference is known to, `known_to`. One that does not fit the budget is more expensive, whatever its error.
Ranking rank(const std::vector<Envelope>& methods, real error, real known_to);

}  // namespace weir::validation
