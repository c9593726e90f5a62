#include "sph/rest.hpp"

#include "parallel/communicator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace weir::sph {

namespace {

/// State of a cell of the initial particle lattice.
enum class Place : char { empty, liquid, closed };

/// Cells of the lattice, their state, and the height of their particles.
template <int D>
struct Vessel {
    Index<D> cells{};
    int up = 0, way = 1;  // upwards: axis and sign
    std::vector<Place> places;
    std::vector<real> top;  // height of the particles in a cell, along `way` [m]; particles beside a body may be off the lattice

    std::size_t linear(const Index<D>& I) const {
        std::size_t at = 0;
        for (int a = D - 1; a >= 0; --a) at = at * static_cast<std::size_t>(cells[a]) + static_cast<std::size_t>(I[a]);
        return at;
    }
    Index<D> index(std::size_t at) const {
        Index<D> I;
        for (int a = 0; a < D; ++a)
            I[a] = static_cast<int>(at % static_cast<std::size_t>(cells[a])), at /= static_cast<std::size_t>(cells[a]);
        return I;
    }
};

/// A connected set of particles, and whether it is at rest.
struct Pool {
    real low = infinity, high = -infinity;  // of their heights
    bool held = true;                       // by walls, solids and each other, except above
    bool has_top() const { return low <= high; }
};

template <int D>
Index<D> cell_of(const particles::Domain<D>& domain, const Vessel<D>& v, const Vec<D>& x) {
    Index<D> I;
    for (int a = 0; a < D; ++a) I[a] = std::clamp(static_cast<int>(std::floor((x[a] - domain.lo[a]) / domain.spacing)), 0, v.cells[a] - 1);
    return I;
}

/// In parallel each rank has a part of the particles: combines the cells of all ranks.
template <int D>
Vessel<D> vessel_of(const particles::Fluid<D>& fluid, int up, int way) {
    Vessel<D> v;
    v.up = up, v.way = way;
    const auto& domain = fluid.domain;
    for (int a = 0; a < D; ++a) v.cells[a] = std::max(1, static_cast<int>(std::lround((domain.hi[a] - domain.lo[a]) / domain.spacing)));
    v.places.assign(product(v.cells), Place::empty), v.top.assign(v.places.size(), -infinity);
    struct Stands {
        std::uint64_t cell;
        real height;
    };
    std::vector<Stands> own;
    for (int i = 0; i < fluid.count(); ++i) {
        const Vec<D> x = fluid.position(i);
        own.push_back({v.linear(cell_of(domain, v, x)), v.way * x[v.up]});
    }
    for (const Stands& s : fluid.shared ? of_all_ranks(own) : own)
        v.places[s.cell] = Place::liquid, v.top[s.cell] = std::max(v.top[s.cell], s.height);
    return v;
}

/// State of a cell without particles: closed by a solid within half a spacing of its centre, otherwise empty.
template <int D>
Place look(const particles::Domain<D>& domain, Vessel<D>& v, const Index<D>& I) {
    Place& place = v.places[v.linear(I)];
    if (place != Place::empty || domain.solids.empty()) return place;
    Vec<D> x;
    for (int a = 0; a < D; ++a) x[a] = domain.lo[a] + domain.spacing * (I[a] + 0.5);
    if (domain.solids.distance(x) < 0.5 * domain.spacing) place = Place::closed;
    return place;
}

/// The connected set of cells of the first one, and its support.
template <int D>
Pool find_pool(const particles::Domain<D>& domain, Vessel<D>& v, std::size_t first, int number, std::vector<int>& pool_of) {
    Pool pool;
    std::vector<std::size_t> stack{first};
    pool_of[first] = number;
    while (!stack.empty()) {
        const std::size_t at = stack.back();
        stack.pop_back();
        const Index<D> I = v.index(at);
        for (int a = 0; a < D; ++a)
            for (const int side : {-1, 1}) {
                Index<D> N = I;
                N[a] += side;
                const bool above = a == v.up && side == v.way;
                if (N[a] < 0 || N[a] == v.cells[a]) {
                    if (!domain.sides.periodic(a)) {
                        const bool walled = domain.walled(a, side < 0 ? 0 : 1);
                        pool.held = pool.held && (walled || above);
                        if (above && !walled) pool.low = std::min(pool.low, v.top[at]), pool.high = std::max(pool.high, v.top[at]);
                        continue;
                    }
                    N[a] = side < 0 ? v.cells[a] - 1 : 0;
                }
                const Place beside = look(domain, v, N);
                if (beside == Place::empty && above) pool.low = std::min(pool.low, v.top[at]), pool.high = std::max(pool.high, v.top[at]);
                if (beside == Place::empty && !above) pool.held = false;
                const std::size_t next = v.linear(N);
                if (beside == Place::liquid && pool_of[next] < 0) pool_of[next] = number, stack.push_back(next);
            }
    }
    return pool;
}

constexpr real flat = 0.25;  // in spacings

}  // namespace

template <int D>
std::string start_at_rest(particles::Fluid<D>& fluid) {
    int up = -1;
    for (int a = 0; a < D; ++a)
        if (fluid.gravity[a] != 0) up = up < 0 ? a : D;
    if (up < 0) return {};
    if (up == D)
        return "gravity is not along an axis, so no liquid starts with hydrostatic pressure, and pressure waves follow; give "
               "initial.surface, a point of the surface";
    const int way = fluid.gravity[up] < 0 ? 1 : -1;
    Vessel<D> v = vessel_of(fluid, up, way);
    const auto& domain = fluid.domain;
    std::vector<int> pool_of(v.places.size(), -1);
    std::vector<Pool> pools;
    for (std::size_t at = 0; at < v.places.size(); ++at)
        if (v.places[at] == Place::liquid && pool_of[at] < 0)
            pools.push_back(find_pool(domain, v, at, static_cast<int>(pools.size()), pool_of));
    const auto rests = [&](const Pool& p) { return p.held && p.has_top() && p.high - p.low <= flat * domain.spacing; };
    const real g = std::abs(fluid.gravity[up]);
    for (int i = 0; i < fluid.count(); ++i) {
        const Vec<D> x = fluid.position(i);
        const Pool& pool = pools[static_cast<std::size_t>(pool_of[v.linear(cell_of(domain, v, x))])];
        if (!rests(pool)) continue;
        const real depth = pool.high + 0.5 * domain.spacing - way * x[up];
        fluid.carried[static_cast<std::size_t>(i)] = std::max<real>(0, fluid.rho0 * g * depth);
    }
    for (const Pool& pool : pools)
        if (!rests(pool) && pool.has_top() && pool.high - pool.low > flat * domain.spacing)
            return fmt::format(
                "liquid whose top is not flat (from {0} = {1:.4g} to {2:.4g} m) starts without hydrostatic pressure, and pressure waves "
                "follow; give initial.surface, a point of the surface",
                "xyz"[up], way * (way > 0 ? pool.low : pool.high), way * (way > 0 ? pool.high : pool.low));
    return {};
}

template std::string start_at_rest(particles::Fluid<2>&);
template std::string start_at_rest(particles::Fluid<3>&);

}  // namespace weir::sph
