#include "validation/cost/rank.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

/// Two settings whose errors are further apart do not tell how the error falls between them: one has converged to round-off.
constexpr real widest_fall = 1e5;

/// y where x lies between x0 and x1, by the power of x that the two ends show.
real along_power(real x, real x0, real x1, real y0, real y1) { return y0 * std::pow(y1 / y0, std::log(x / x0) / std::log(x1 / x0)); }

}  // namespace

std::vector<Envelope> envelopes(const StudyResult& result) {
    std::vector<const CostPoint*> by_price;
    for (const CostPoint& p : result.points)
        if (!p.failure) by_price.push_back(&p);
    const Price price = result.study.price;
    std::stable_sort(by_price.begin(), by_price.end(), [&](auto* a, auto* b) { return a->price(price) < b->price(price); });
    std::vector<Envelope> list;
    for (const CostPoint* p : by_price) {
        auto at = std::find_if(list.begin(), list.end(), [&](const Envelope& e) { return e.label == p->label(); });
        if (at == list.end()) at = list.insert(at, {.label = p->label(), .points = {}});
        if (at->points.empty() || p->error < at->points.back().error) at->points.push_back({p->price(price), p->error});
    }
    return list;
}

std::optional<PriceAt> price_at(const Envelope& method, real error) {
    const auto& p = method.points;
    const auto reached = std::find_if(p.begin(), p.end(), [&](const auto& q) { return q.error <= error; });
    if (reached == p.end()) return std::nullopt;
    if (reached == p.begin()) return PriceAt{reached->price, reached->error < error};
    const auto before = reached - 1;
    if (before->price <= 0 || reached->error <= 0 || before->error / reached->error > widest_fall) return PriceAt{reached->price, true};
    return PriceAt{along_power(error, before->error, reached->error, before->price, reached->price), false};
}

real error_at(const Envelope& method, double price) {
    const auto& p = method.points;
    const auto above = std::find_if(p.begin(), p.end(), [&](const auto& q) { return q.price > price; });
    if (above == p.begin()) return p.front().error;
    const auto before = above - 1;
    if (above == p.end() || before->price <= 0 || above->error <= 0 || before->error / above->error > widest_fall) return before->error;
    return along_power(price, before->price, above->price, before->error, above->error);
}

Ranking rank(const std::vector<Envelope>& methods, real error, real known_to) {
    Ranking ranking;
    std::vector<const Envelope*> order;
    for (const Envelope& m : methods)
        if (price_at(m, error))
            order.push_back(&m);
        else
            ranking.missing.push_back(m.label);
    std::stable_sort(order.begin(), order.end(), [&](auto* a, auto* b) { return price_at(*a, error)->price < price_at(*b, error)->price; });
    for (const Envelope* m : order) {
        const PriceAt first = *price_at(*order.front(), error), at = *price_at(*m, error);
        const bool as_cheap = m->points.front().price <= first.price;
        const bool alike = as_cheap && error_at(*m, first.price) - error_at(*order.front(), first.price) < known_to;
        ranking.reached.push_back({m->label, at, first.price > 0 ? at.price / first.price : 1, m != order.front() && alike});
    }
    return ranking;
}

}  // namespace weir::validation
