// Initial particles of ice: a lattice with the spacing of its density, centred in each frozen part.
#include "particles/heat/ice.hpp"
#include "geometry/shape.hpp"

#include <algorithm>
#include <numeric>

namespace weir::particles {

namespace {

/// Cells of the grid that contain frozen liquid, and their connected parts.
template <int D>
struct FrozenCells {
    Index<D> cells;
    std::vector<int> part;  // of each cell; -1: none
    int parts = 0;

    Index<D> at(std::size_t c) const {
        Index<D> to;
        for (int a = 0; a < D; ++a)
            to[a] = static_cast<int>(c % static_cast<std::size_t>(cells[a])), c /= static_cast<std::size_t>(cells[a]);
        return to;
    }
    std::size_t number(const Index<D>& at) const {
        std::size_t c = 0;
        for (int a = D - 1; a >= 0; --a) c = c * static_cast<std::size_t>(cells[a]) + static_cast<std::size_t>(at[a]);
        return c;
    }
    bool has(const Index<D>& at) const {
        for (int a = 0; a < D; ++a)
            if (at[a] < 0 || at[a] >= cells[a]) return false;
        return true;
    }

    FrozenCells(const Index<D>& grid, const std::vector<char>& frozen) : cells(grid), part(frozen.size(), -1) {
        std::vector<std::size_t> open;
        for (std::size_t c = 0; c < frozen.size(); ++c) {
            if (!frozen[c] || part[c] >= 0) continue;
            part[c] = parts;
            open.push_back(c);
            while (!open.empty()) {
                const Index<D> here = at(open.back());
                open.pop_back();
                for (int a = 0; a < D; ++a)
                    for (const Index<D> next : {here + e<D>(a), here - e<D>(a)}) {
                        if (!has(next) || !frozen[number(next)] || part[number(next)] >= 0) continue;
                        part[number(next)] = parts;
                        open.push_back(number(next));
                    }
            }
            ++parts;
        }
    }
};

/// The lattice of one part: along each axis the number of points that best fills its bounding box, centred.
template <int D, class F>
void each_point(const FrozenCells<D>& frozen, int part, const Domain<D>& domain, real spacing, F&& f) {
    Index<D> lo = frozen.cells, hi{};
    for (std::size_t c = 0; c < frozen.part.size(); ++c) {
        if (frozen.part[c] != part) continue;
        for (int a = 0; a < D; ++a) lo[a] = std::min(lo[a], frozen.at(c)[a]), hi[a] = std::max(hi[a], frozen.at(c)[a] + 1);
    }
    Index<D> count, at{};
    Vec<D> first;
    for (int a = 0; a < D; ++a) {
        count[a] = std::max(1, static_cast<int>(std::lround((hi[a] - lo[a]) * domain.spacing / spacing)));
        first[a] = domain.lo[a] + 0.5 * (lo[a] + hi[a]) * domain.spacing - 0.5 * (count[a] - 1) * spacing;
    }
    for (std::size_t c = 0; c < product(count); ++c) {
        f(first + spacing * to_vec(at));
        for (int a = 0; a < D && ++at[a] == count[a]; ++a) at[a] = 0;
    }
}

}  // namespace

template <int D>
void spread_ice(const scene::Scene& scene, Fluid<D>& fluid) {
    if (!heat_is_named(scene) || scene.text("heat.frozen") != "free") return;
    const Heat<D> heat(scene, fluid.domain);
    const auto frozen_at = frozen_at_start<D>(scene);
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const Domain<D>& domain = fluid.domain;
    const Index<D> cells = scene.index<D>("grid.cells");
    const auto cell_of = [&](const Vec<D>& x) {
        Index<D> at;
        for (int a = 0; a < D; ++a) at[a] = static_cast<int>(std::floor((x[a] - domain.lo[a]) / domain.spacing));
        return at;
    };
    std::vector<char> frozen(product(cells), 0);
    const FrozenCells<D> none(cells, frozen);
    for (int i = 0; i < fluid.count(); ++i)
        if (frozen_at(fluid.position(i))) frozen[none.number(cell_of(fluid.position(i)))] = 1;
    fluid.remove_if([&](int i) { return frozen_at(fluid.position(i)); });
    const FrozenCells<D> parts(cells, frozen);
    const real spacing = domain.spacing / std::pow(heat.solid_rest(), 1.0 / D);
    for (int part = 0; part < parts.parts; ++part)
        each_point(parts, part, domain, spacing, [&](const Vec<D>& x) {
            const bool inside = std::any_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s->contains(x); });
            if (!inside || !frozen_at(x) || !parts.has(cell_of(x)) || parts.part[parts.number(cell_of(x))] != part) return;
            if (domain.solids.empty() || domain.solids.distance(x) > 0.25 * domain.spacing) fluid.add(x, Vec<D>{});
        });
    std::iota(fluid.id.begin(), fluid.id.end(), 0);
    fluid.next_id = fluid.count();
}

template void spread_ice(const scene::Scene&, Fluid<2>&);
template void spread_ice(const scene::Scene&, Fluid<3>&);

}  // namespace weir::particles
