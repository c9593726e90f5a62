#include "particles/boundaries/beside_bodies.hpp"

#include "rigid/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weir::particles {

namespace {

/// Samples of a cell along each axis.
constexpr int samples = 8;

/// Volume fraction of a cell outside bodies and solids.
template <int D>
real open_part(const Domain<D>& domain, const Vec<D>& middle) {
    int open = 0, all = 1;
    for (int a = 0; a < D; ++a) all *= samples;
    for (int s = 0; s < all; ++s) {
        Vec<D> x = middle;
        for (int a = 0, rest = s; a < D; ++a, rest /= samples) x[a] += domain.spacing * ((rest % samples + 0.5) / samples - 0.5);
        open += domain.solids.distance(x) > 0;
    }
    return 1.0 * open / all;
}

}  // namespace

template <int D>
real away_from_bodies(const Domain<D>& domain, const Vec<D>& x) {
    real nearest = infinity;
    for (std::size_t s = domain.first_body(); s < domain.solids.count(); ++s) nearest = std::min(nearest, domain.solids.distance(s, x));
    return nearest;
}

/// Orders cells by distance from bodies; those at equal distance in a low-discrepancy order (multiples of the golden ratio).
template <int D>
std::vector<Vec<D>> places_beside_bodies(const Domain<D>& domain, const std::vector<Vec<D>>& middles) {
    constexpr real golden = 0.6180339887498949;
    real room = 0;
    for (const Vec<D>& middle : middles) room += open_part(domain, middle);
    std::vector<std::pair<real, real>> far(middles.size());
    for (std::size_t i = 0; i < middles.size(); ++i)
        far[i] = {-std::round(1e6 * domain.solids.distance(middles[i]) / domain.spacing), std::fmod(golden * static_cast<real>(i), 1)};
    std::vector<std::size_t> order(middles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return far[i] < far[j]; });
    std::vector<Vec<D>> places;
    for (std::size_t k = 0; k < std::min(order.size(), static_cast<std::size_t>(std::lround(room))); ++k)
        places.push_back(domain.solids.push_out(middles[order[k]], 0.25 * domain.spacing, 1e-3 * domain.spacing));
    return places;
}

template real away_from_bodies(const Domain<2>&, const Vec<2>&);
template real away_from_bodies(const Domain<3>&, const Vec<3>&);
template std::vector<Vec<2>> places_beside_bodies(const Domain<2>&, const std::vector<Vec<2>>&);
template std::vector<Vec<3>> places_beside_bodies(const Domain<3>&, const std::vector<Vec<3>>&);

}  // namespace weir::particles
