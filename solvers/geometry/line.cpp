#include "geometry/line.hpp"

#include <algorithm>
#include <cmath>

namespace weir::geometry {

namespace {

/// Bisects between a point inside and one outside: the last point inside, to the last bit.
template <int D>
real end_of(const Shape<D>& shape, const Line<D>& line, real in, real out) {
    for (;;) {
        const real mid = 0.5 * (in + out);
        if (mid == in || mid == out) return out;
        (shape.contains(line.at(mid)) ? in : out) = mid;
    }
}

/// From a point inside to both ends.
template <int D>
Interval around(const Shape<D>& shape, const Line<D>& line, real in) {
    Interval all{line.low, line.high};
    if (!shape.contains(line.at(line.low))) all.low = end_of(shape, line, in, line.low);
    if (!shape.contains(line.at(line.high))) all.high = end_of(shape, line, in, line.high);
    return all;
}

template <int D>
void find_in_convex(const Shape<D>& shape, const Line<D>& line, std::vector<Interval>& inside) {
    const real golden = 0.5 * (std::sqrt(5.0) - 1);
    const auto distance = [&](real y) { return shape.distance(line.at(y)); };
    for (const real end : {line.low, line.high})
        if (distance(end) < 0) return inside.push_back(around(shape, line, end));
    real a = line.low, b = line.high, c = b - golden * (b - a), d = a + golden * (b - a), at_c = distance(c), at_d = distance(d);
    for (;;) {
        if (at_c < 0) return inside.push_back(around(shape, line, c));
        if (at_d < 0) return inside.push_back(around(shape, line, d));
        // lower bound of the distance in [a, b] is positive, or the interval cannot be divided further
        if (std::min(at_c, at_d) > shape.steepest() * (b - a) || !(a < c && c < d && d < b)) return;
        if (at_c < at_d) {
            b = d, d = c, at_d = at_c;
            at_c = distance(c = b - golden * (b - a));
        } else {
            a = c, c = d, at_c = at_d;
            at_d = distance(d = a + golden * (b - a));
        }
    }
}

template <int D>
void walk(const Shape<D>& shape, const Line<D>& line, std::vector<Interval>& inside) {
    const real least = (line.high - line.low) / 4096, steepest = shape.steepest();
    real y = line.low, before = line.low, from = line.low;
    bool was_inside = shape.contains(line.at(y));
    while (y < line.high) {
        before = y;
        y = std::min(line.high, y + std::max(least, std::abs(shape.distance(line.at(y))) / steepest));
        const bool is_inside = shape.contains(line.at(y));
        if (is_inside && !was_inside) from = end_of(shape, line, y, before);
        if (!is_inside && was_inside) inside.push_back({from, end_of(shape, line, before, y)});
        was_inside = is_inside;
    }
    if (was_inside) inside.push_back({from, line.high});
}

void sort_and_join(std::vector<Interval>& list) {
    std::sort(list.begin(), list.end(), [](const Interval& a, const Interval& b) { return a.low < b.low; });
    std::size_t kept = 0;
    for (const Interval& next : list)
        if (kept > 0 && next.low <= list[kept - 1].high)
            list[kept - 1].high = std::max(list[kept - 1].high, next.high);
        else
            list[kept++] = next;
    list.resize(kept);
}

void take_away(std::vector<Interval>& list, const std::vector<Interval>& holes) {
    std::vector<Interval> left;
    for (const Interval& whole : list) {
        real low = whole.low;
        for (const Interval& hole : holes) {
            if (hole.high <= low || hole.low >= whole.high) continue;
            if (hole.low > low) left.push_back({low, hole.low});
            low = hole.high;
        }
        if (low < whole.high) left.push_back({low, whole.high});
    }
    list = std::move(left);
}

}  // namespace

template <int D>
void find_inside(const Shape<D>& shape, const Line<D>& line, std::vector<Interval>& inside) {
    inside.clear();
    if (!(line.low < line.high)) return;
    const Parts<D> parts = shape.parts();
    if (parts.united.empty()) {
        if (shape.convex_along(line.at(line.high) - line.at(line.low)))
            find_in_convex(shape, line, inside);
        else
            walk(shape, line, inside);
        return;
    }
    std::vector<Interval> of_part, holes;
    for (const auto& part : parts.united) {
        find_inside(*part, line, of_part);
        inside.insert(inside.end(), of_part.begin(), of_part.end());
    }
    sort_and_join(inside);
    for (const auto& part : parts.removed) {
        find_inside(*part, line, of_part);
        holes.insert(holes.end(), of_part.begin(), of_part.end());
    }
    sort_and_join(holes);
    if (!holes.empty()) take_away(inside, holes);
}

template void find_inside(const Shape<2>&, const Line<2>&, std::vector<Interval>&);
template void find_inside(const Shape<3>&, const Line<3>&, std::vector<Interval>&);

}  // namespace weir::geometry
