#include "mac/grid/closed_volume.hpp"

#include "core/error.hpp"
#include "mac/grid/own_planes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;

namespace {

/// Relative to the swept volume: smaller growth is round-off or the error of face fractions.
constexpr real distinguishable = 1e-3;

/// The boundary of one cell's fluid.
template <int D>
struct Around {
    real growth = 0, swept = 0;
    bool open = false;
    std::array<std::ptrdiff_t, 2 * D> next{};  // neighbours that fluid can flow to; −1: none
};

template <int D>
Around<D> around(const MacState<D>& s, const Index<D>& I) {
    Around<D> all;
    for (int a = 0; a < D; ++a) {
        const real area = s.u.cell_volume() / s.u.h[a];
        for (const int end : {0, 1}) {
            auto& next = all.next[static_cast<std::size_t>(2 * a + end)];
            next = -1;
            const Index<D> F = end == 0 ? I : I + e<D>(a);
            const auto at = static_cast<std::size_t>(a);
            const real w = s.solid.any() ? s.solid.open[at](F) : 1, v = s.solid.any() ? s.solid.velocity[at](F) : 0;
            const auto moves = [&](real by) {
                all.growth += (end == 0 ? -1 : 1) * area * by;
                all.swept += area * std::abs(by);
            };
            moves((1 - w) * v);
            if (w == 0) continue;
            Index<D> N = end == 0 ? I - e<D>(a) : I + e<D>(a);
            if (N[a] < 0 || N[a] == s.u.cells[a]) {
                if (s.sides.open(a, end)) all.open = true;
                if (!s.sides.periodic(a)) {
                    moves(w * s.u[a](F));
                    continue;
                }
                N[a] = end == 0 ? s.u.cells[a] - 1 : 0;
            }
            if (s.cells(N) == Cell::air) all.open = true;
            if (s.cells(N) == Cell::fluid) next = static_cast<std::ptrdiff_t>(s.cells.linear(N));
        }
    }
    return all;
}

/// The solid with the largest swept volume.
template <int D>
std::size_t who_sweeps(const MacState<D>& s, const geometry::Solids<D>& solids) {
    std::vector<real> by(std::max<std::size_t>(solids.count(), 1), 0.0);
    for (int a = 0; a < D && s.solid.any(); ++a) {
        const auto at = static_cast<std::size_t>(a);
        for (std::size_t i = 0; i < s.cells.size(); ++i) {
            if (s.cells[i] != Cell::fluid) continue;
            const Index<D> I = index_of<D>(s.extent(), i);
            for (const int end : {0, 1}) {
                const Index<D> F = end == 0 ? I : I + e<D>(a);
                const real swept = (1 - s.solid.open[at](F)) * s.solid.velocity[at](F);
                if (swept != 0) by[solids.in_list(solids.nearest(s.u.face_centre(a, F)))] += (end == 0 ? -1 : 1) * swept / s.u.h[a];
            }
        }
    }
    return static_cast<std::size_t>(std::max_element(by.begin(), by.end(), [](real x, real y) { return std::abs(x) < std::abs(y); }) -
                                    by.begin());
}

/// In parallel: all fluid as one region.
template <int D>
Squeezed<D> find_in_all(const MacState<D>& s) {
    const auto sum = [&](auto&& f) {
        return sum_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? f(around(s, I)) : 0.0; });
    };
    Squeezed<D> region;
    if (sum([](const Around<D>& c) { return c.open ? 1.0 : 0.0; }) > 0) return region;
    const real growth = sum([](const Around<D>&c) { return c.growth; }), swept = sum([](const Around<D>&c) { return c.swept; });
    if (!(std::abs(growth) > distinguishable * swept)) return region;
    const real cells = sum([](const Around<D>&) { return 1.0; });
    region.growth = growth, region.cells = static_cast<std::size_t>(cells), region.volume = region.all = cells * s.u.cell_volume();
    for (int a = 0; a < D; ++a) region.middle[a] = s.u.origin[a] + 0.5 * s.u.h[a] * s.u.cells[a];
    return region;
}

}  // namespace

template <int D>
Squeezed<D> find_squeezed(const MacState<D>& s, const geometry::Solids<D>& solids) {
    if (s.own().distributed()) return find_in_all(s);
    std::vector<char> seen(s.cells.size(), 0);
    std::vector<std::size_t> stack;
    std::size_t fluid = 0;
    for (std::size_t i = 0; i < s.cells.size(); ++i) fluid += s.cells[i] == Cell::fluid;
    Squeezed<D> worst;
    for (std::size_t first = 0; first < s.cells.size(); ++first) {
        if (seen[first] || s.cells[first] != Cell::fluid) continue;
        Squeezed<D> region;
        real swept = 0;
        bool open = false;
        seen[first] = 1;
        stack.assign(1, first);
        while (!stack.empty()) {
            const Index<D> I = index_of<D>(s.extent(), stack.back());
            stack.pop_back();
            const Around<D> c = around(s, I);
            region.growth += c.growth, swept += c.swept, open = open || c.open;
            region.middle += s.u.cell_centre(I), ++region.cells;
            for (const std::ptrdiff_t next : c.next)
                if (next >= 0 && !seen[static_cast<std::size_t>(next)]) {
                    seen[static_cast<std::size_t>(next)] = 1;
                    stack.push_back(static_cast<std::size_t>(next));
                }
        }
        if (open || 100 * region.cells <= fluid || !(std::abs(region.growth) > distinguishable * swept)) continue;
        if (std::abs(region.growth) <= std::abs(worst.growth)) continue;
        worst = region;
    }
    if (!worst.any()) return worst;
    worst.middle = worst.middle / static_cast<real>(worst.cells);
    worst.volume = static_cast<real>(worst.cells) * s.u.cell_volume();
    worst.all = static_cast<real>(fluid) * s.u.cell_volume();
    worst.solid = who_sweeps(s, solids);
    return worst;
}

template <int D>
std::string text_of(const Squeezed<D>& region) {
    std::string middle;
    for (int a = 0; a < D; ++a) middle += fmt::format("{}{:.4g}", a ? ", " : "", region.middle[a]);
    return fmt::format("the closed region of {:.4g} {} around [{}] m {} by {:.4g} {}/s", region.volume, D == 2 ? "m^2" : "m^3", middle,
                       region.growth < 0 ? "shrinks" : "grows", std::abs(region.growth), D == 2 ? "m^2" : "m^3");
}

template <int D>
bool move_as_prescribed(const geometry::Solids<D>& solids) {
    for (std::size_t i = 0; i < solids.count(); ++i)
        if (solids[i].motion.moves()) return true;
    return false;
}

/// A region of L cells has an error of about 1/L of the rate at which a solid crosses cells.
template <int D>
void require_room(const MacState<D>& s, const SolidPlacement<D>& solids, real divergence, real dt, std::optional<real> in_films) {
    constexpr real of_rate = 1e-5, of_fluid = 1e-3;
    const bool prescribed = move_as_prescribed(solids.solids());
    if (prescribed) {
        if (const real rate = solids.max_rate(s); !(rate > 0 && divergence > of_rate * rate)) return;
    } else if (!in_films || !(divergence * dt > of_fluid)) {
        return;
    }
    const Squeezed<D> region = find_squeezed(s, solids.solids());
    if (!region.any()) return;
    const real lost = std::abs(region.growth) - in_films.value_or(0);
    if (prescribed && lost > 0)
        throw NumericalFailure(
            "volume", fmt::format("solids[{}] moves so that {}: an incompressible fluid has no outflow", region.solid, text_of(region)));
    if (!prescribed && lost * dt > of_fluid * region.all)
        throw NumericalFailure(
            "volume",
            fmt::format("bodies move so that {}: an incompressible fluid that they close off does not let them", text_of(region)));
}

#define WEIR_INSTANTIATE(D)                                                             \
    template Squeezed<D> find_squeezed(const MacState<D>&, const geometry::Solids<D>&); \
    template std::string text_of(const Squeezed<D>&);                                   \
    template bool move_as_prescribed(const geometry::Solids<D>&);                       \
    template void require_room(const MacState<D>&, const SolidPlacement<D>&, real, real, std::optional<real>);
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::mac
