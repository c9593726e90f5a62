#include "particles/state/domain.hpp"

#include "rigid/bodies.hpp"

namespace weir::particles {

template <int D>
Domain<D>::Domain(const scene::Scene& scene) : sides(scene), solids(scene) {
    const Index<D> cells = scene.index<D>("grid.cells");
    const Vec<D> size = scene.vec<D>("grid.size");
    lo = scene.vec<D>("grid.origin");
    hi = lo + size;
    spacing = size[0] / cells[0];
    margin = wall_margin * spacing;
    for (int a = 0; a < D; ++a) {
        keep_lo[a] = walled(a, 0) ? lo[a] + margin : -infinity;
        keep_hi[a] = walled(a, 1) ? hi[a] - margin : infinity;
    }
    for (int a = 1; a < D; ++a)
        if (std::abs(size[a] / cells[a] - spacing) > 1e-6 * spacing)
            scene.refuse("grid.cells", "particles require cubic cells: the cell width is the particles' spacing");
    if (!scene.has("bodies") || scene.root().tables("bodies").empty()) return;
    bodies = std::make_shared<rigid::Bodies<D>>(scene);
    bodies->join(solids);
}

template <int D>
std::size_t Domain<D>::first_body() const {
    return solids.count() - (bodies ? bodies->count() : 0);
}

template <int D>
Frame Domain<D>::frame() const {
    Frame f;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        f.centre[at] = centre()[a];
        f.lo[at] = lo[a];
        f.period[at] = sides.periodic(a) ? hi[a] - lo[a] : 0;
    }
    return f;
}

template <int D>
Vec<D> Domain<D>::wrapped(Vec<D> x) const {
    for (int a = 0; a < D; ++a)
        if (sides.periodic(a)) x[a] -= (hi[a] - lo[a]) * std::floor((x[a] - lo[a]) / (hi[a] - lo[a]));
    return x;
}

template <int D>
bool Domain<D>::left(const Vec<D>& x) const {
    for (int a = 0; a < D; ++a)
        if ((x[a] < lo[a] && !walled(a, 0)) || (x[a] > hi[a] && !walled(a, 1))) return true;
    return false;
}

template <int D>
bool Domain<D>::outside(const Vec<D>& x) const {
    for (int a = 0; a < D; ++a)
        if ((x[a] < lo[a] && walled(a, 0)) || (x[a] > hi[a] && walled(a, 1))) return true;
    return !solids.empty() && solids.distance(x) < 0;
}

template <int D>
template <class Params>
Params Domain<D>::walls(const Kernel<D>& density, const Kernel<D>& gradient) const {
    using Number = decltype(Params::inv_h);
    constexpr Number far = static_cast<Number>(1e30);
    Params w{};
    for (int a = 0; a < 3; ++a) {
        w.lo[a] = w.keep_lo[a] = -far;
        w.hi[a] = w.keep_hi[a] = far;
        if (a >= D) continue;
        const real middle = centre()[a];
        if (walled(a, 0)) w.lo[a] = static_cast<Number>(lo[a] - middle), w.keep_lo[a] = static_cast<Number>(lo[a] + margin - middle);
        if (walled(a, 1)) w.hi[a] = static_cast<Number>(hi[a] - middle), w.keep_hi[a] = static_cast<Number>(hi[a] - margin - middle);
    }
    w.inv_h = static_cast<Number>(1 / density.support());
    const WallSeries fraction = behind_series(density), slope = plane_series(gradient);
    static_assert(wall_terms == WEIR_WALL_TERMS);
    for (std::size_t k = 0; k < fraction.size(); ++k) {
        w.fraction[k] = static_cast<Number>(fraction[k]);
        w.slope[k] = static_cast<Number>(slope[k]);
    }
    return w;
}

template <int D>
void refuse_idle_walls(const scene::Scene& scene, const Domain<D>& domain, bool viscous, const std::string& instead) {
    for (int a = 0; a < D; ++a)
        for (int end = 0; end < 2; ++end) {
            const auto& side = domain.sides.side(a, end);
            const std::string path = std::string("sides.") + "xyz"[a] + (end == 0 ? "_min" : "_max");
            if (side.kind == geometry::SideKind::inflow)
                scene.refuse(path, "particles cannot enter through a side",
                             "use emitters for inflow and a side of kind \"open\" for outflow");
            if (side.no_slip && domain.walled(a, end) && !viscous)
                scene.refuse(path, "slip = \"no\" of a wall requires viscosity", instead);
        }
    for (std::size_t i = 0; i < domain.solids.count(); ++i)
        if (domain.solids[i].no_slip && !viscous)
            scene.refuse(
                domain.solids[i].free ? "bodies[" + std::to_string(i - domain.first_body()) + "]" : "solids[" + std::to_string(i) + "]",
                domain.solids[i].free ? "slip = \"no\" of a body requires viscosity" : "slip = \"no\" of a solid requires viscosity",
                instead);
}

template void refuse_idle_walls(const scene::Scene&, const Domain<2>&, bool, const std::string&);
template void refuse_idle_walls(const scene::Scene&, const Domain<3>&, bool, const std::string&);
template struct Domain<2>;
template struct Domain<3>;
template single::WallParams Domain<2>::walls(const Kernel<2>&, const Kernel<2>&) const;
template single::WallParams Domain<3>::walls(const Kernel<3>&, const Kernel<3>&) const;
template plain::WallParams Domain<2>::walls(const Kernel<2>&, const Kernel<2>&) const;
template plain::WallParams Domain<3>::walls(const Kernel<3>&, const Kernel<3>&) const;

}  // namespace weir::particles
