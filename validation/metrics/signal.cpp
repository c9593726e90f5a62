#include "validation/metrics/signal.hpp"

#include <cmath>
#include <numeric>

namespace weir::validation {

std::vector<real> zero_crossings(const Curve& c) {
    std::vector<real> times;
    for (std::size_t i = 0; i + 1 < c.size(); ++i)
        if ((c.y[i] > 0) != (c.y[i + 1] > 0)) times.push_back(c.x[i] + (c.x[i + 1] - c.x[i]) * c.y[i] / (c.y[i] - c.y[i + 1]));
    return times;
}

real frequency(const Curve& c) {
    const std::vector<real> t = zero_crossings(c);
    return t.size() < 3 ? std::nan("") : pi * static_cast<real>(t.size() - 1) / (t.back() - t.front());
}

namespace {

/// Top of |y| near point i, on the parabola through it and its neighbours.
std::pair<real, real> vertex(const Curve& c, std::size_t i) {
    const real y0 = std::abs(c.y[i - 1]), y1 = std::abs(c.y[i]), y2 = std::abs(c.y[i + 1]);
    const real l = c.x[i] - c.x[i - 1], r = c.x[i + 1] - c.x[i];
    const real a = ((y2 - y1) / r - (y1 - y0) / l) / (l + r), b = (y2 - y1) / r - a * r;
    const real s = a < 0 ? -b / (2 * a) : 0;
    return {c.x[i] + s, y1 + s * (b + a * s)};
}

}  // namespace

Curve extrema(const Curve& c) {
    Curve tops{.label = c.label, .x = {}, .y = {}, .points = true};
    const std::vector<real> t = zero_crossings(c);
    std::size_t i = 0;
    for (std::size_t k = 0; k + 1 < t.size(); ++k) {
        std::size_t best = 0;
        for (; i < c.size() && c.x[i] < t[k + 1]; ++i)
            if (c.x[i] > t[k] && (best == 0 || std::abs(c.y[i]) > std::abs(c.y[best]))) best = i;
        if (best == 0 || best + 1 >= c.size()) continue;
        const auto [x, y] = vertex(c, best);
        tops.x.push_back(x), tops.y.push_back(y);
    }
    return tops;
}

real slope(const std::vector<real>& x, const std::vector<real>& y) {
    const auto n = static_cast<real>(x.size());
    const real mx = std::accumulate(x.begin(), x.end(), 0.0) / n, my = std::accumulate(y.begin(), y.end(), 0.0) / n;
    real xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) xx += (x[i] - mx) * (x[i] - mx), xy += (x[i] - mx) * (y[i] - my);
    return xy / xx;
}

real decay(const Curve& c) {
    const Curve tops = extrema(c);
    if (tops.size() < 2) return std::nan("");
    std::vector<real> logs;
    for (const real y : tops.y) logs.push_back(std::log(y));
    return -slope(tops.x, logs);
}

real power_law(const Curve& c, real from, real to) {
    std::vector<real> x, y;
    for (std::size_t i = 0; i < c.size(); ++i)
        if (c.x[i] >= from && c.x[i] <= to && c.x[i] > 0 && c.y[i] > 0) x.push_back(std::log(c.x[i])), y.push_back(std::log(c.y[i]));
    return x.size() < 3 ? std::nan("") : slope(x, y);
}

real largest_magnitude(const Curve& c) {
    real most = 0;
    for (const real y : c.y) most = (std::abs(y) > most || std::isnan(y)) ? std::abs(y) : most;
    return most;
}

real largest(const Curve& c) {
    real m = 0;
    for (const real y : c.y) m = (y > m || std::isnan(y)) ? y : m;
    return m;
}

}  // namespace weir::validation
