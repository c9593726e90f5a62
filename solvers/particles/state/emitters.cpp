#include "particles/state/emitters.hpp"

#include "particles/heat/heat.hpp"

#include <algorithm>

namespace weir::particles {

namespace {

/// The inflow site of every lattice column of the shape along `axis`.
template <int D>
std::vector<Vec<D>> upstream_sites(const geometry::Shape<D>& shape, const Domain<D>& domain, int axis, bool forward) {
    std::vector<Vec<D>> sites;
    Index<D> cells, column{};
    for (int a = 0; a < D; ++a) cells[a] = static_cast<int>(std::lround((domain.hi[a] - domain.lo[a]) / domain.spacing));
    const int depth = cells[axis];
    cells[axis] = 1;
    for (std::size_t c = 0; c < product(cells); ++c) {
        for (int k = 0; k < depth; ++k) {
            Index<D> at = column;
            at[axis] = forward ? k : depth - 1 - k;
            const Vec<D> x = domain.lo + domain.spacing * (to_vec(at) + Vec<D>::constant(0.5));
            if (!shape.contains(x)) continue;
            sites.push_back(x);
            break;
        }
        for (int a = 0; a < D && ++column[a] == cells[a]; ++a) column[a] = 0;
    }
    return sites;
}

}  // namespace

template <int D>
Emitters<D>::Emitters(const scene::Scene& scene, const Domain<D>& domain) {
    for (const auto& table : scene.root().tables("emitters")) {
        Emitter e;
        if (table.has("velocity")) e.velocity = table.vec<D>("velocity");
        e.start = table.number_or("start", 0);
        e.end = table.number_or("end", infinity);
        int axis = 0;
        for (int a = 1; a < D; ++a)
            if (std::abs(e.velocity[a]) > std::abs(e.velocity[axis])) axis = a;
        const std::string path = "emitters[" + std::to_string(emitters_.size()) + "]";
        if (e.velocity[axis] == 0) scene.refuse(path, "an emitter of particles requires a velocity");
        e.period = domain.spacing / std::abs(e.velocity[axis]);
        e.sites = upstream_sites<D>(*geometry::make_shape<D>(table), domain, axis, e.velocity[axis] > 0);
        if (e.sites.empty()) scene.refuse(path, "the emitter is thinner than the particles' spacing: it covers the centre of no cell");
        if (std::all_of(e.sites.begin(), e.sites.end(), [&](const Vec<D>& x) { return domain.solids.distance(x) <= 0; }))
            scene.refuse(path, "the emitter begins inside solids: nothing can leave it");
        if (heat_is_named(scene)) e.enthalpy = emitted_enthalpy(scene, emitters_.size());
        emitters_.push_back(std::move(e));
    }
    if (scene.has("sinks")) sinks_ = geometry::make_shapes<D>(scene.root().tables("sinks"));
    layers_.assign(emitters_.size(), 0);
}

template <int D>
void Emitters<D>::apply(Fluid<D>& fluid, real dt) {
    emit(fluid.time, dt, [&](const Vec<D>& x, const Vec<D>& u, real h) { fluid.add(fluid.domain.kept(x, fluid.corrections), u, h); });
    if (!sinks_.empty())
        fluid.remove_if([&](int i) {
            const Vec<D> x = fluid.position(i);
            return std::any_of(sinks_.begin(), sinks_.end(), [&](const auto& s) { return s->contains(x); });
        });
}

template <int D>
real Emitters<D>::entered(real time) const {
    real sum = 0;
    for (const Emitter& e : emitters_) {
        const real last = std::min(e.end, time);
        if (last >= e.start) sum += static_cast<real>(e.sites.size()) * (std::floor((last - e.start) / e.period) + 1);
    }
    return sum;
}

template <int D>
void Emitters<D>::save(Checkpoint& to) const {
    to.put("particles.layers", layers_);
}
template <int D>
void Emitters<D>::restore(const Checkpoint& from) {
    from.get("particles.layers", std::span(layers_));
    for (const auto layers : layers_)
        Checkpoint::require_within("particles.layers", static_cast<std::int64_t>(layers), 0, std::int64_t{1} << 53);
}

template class Emitters<2>;
template class Emitters<3>;

}  // namespace weir::particles
