#include "particles/fluid.hpp"

#include "core/error.hpp"
#include "particles/beside_bodies.hpp"

#include <algorithm>

namespace weir::particles {

template <int D>
Fluid<D>::Fluid(const scene::Scene& scene) : domain(scene), rho0(scene.number("fluid.density")) {
    mass = rho0 * cell_volume<D>(domain.spacing);
    if (const auto* g = scene.effect("gravity")) gravity = g->template vec<D>("g");
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const Index<D> cells = scene.index<D>("grid.cells");
    std::vector<Vec<D>> beside;
    Index<D> at{};
    for (std::size_t c = 0; c < product(cells); ++c) {
        const Vec<D> centre = domain.lo + domain.spacing * (to_vec(at) + Vec<D>::constant(0.5));
        const bool wet = std::any_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s->contains(centre); });
        if (wet && domain.bodies && away_from_bodies(domain, centre) < 0.5 * std::sqrt(1.0 * D) * domain.spacing)
            beside.push_back(centre);
        else if (wet && (domain.solids.empty() || domain.solids.distance(centre) > 0.25 * domain.spacing))
            add(centre, Vec<D>{});
        for (int a = 0; a < D && ++at[a] == cells[a]; ++a) at[a] = 0;
    }
    if (!beside.empty())
        for (const Vec<D>& place : places_beside_bodies(domain, beside)) add(place, Vec<D>{});
    scratch_.reserve(id.size());  // of reorder(), which must not allocate in a step
}

template <int D>
void Fluid<D>::add(const Vec<D>& at, const Vec<D>& velocity, real h) {
    for (int a = 0; a < D; ++a) {
        x[static_cast<std::size_t>(a)].push_back(at[a]);
        v[static_cast<std::size_t>(a)].push_back(velocity[a]);
    }
    id.push_back(next_id++);
    density.push_back(rho0);
    carried.push_back(0);
    if (warm) enthalpy.push_back(h);
}

template <int D>
void Fluid<D>::resize(int count) {
    const auto n = static_cast<std::size_t>(count);
    for (std::size_t a = 0; a < D; ++a) x[a].resize(n), v[a].resize(n);
    id.resize(n);
    density.resize(n);
    carried.resize(n);
    if (warm) enthalpy.resize(n);
}

template <int D>
void Fluid<D>::cross_sides() {
    bool open = false, repeats = false;
    for (int a = 0; a < D; ++a) {
        repeats = repeats || domain.sides.periodic(a);
        for (int end = 0; end < 2; ++end) open = open || (!domain.walled(a, end) && !domain.sides.periodic(a));
    }
    if (repeats) parallel_for(0, count(), [&](int i) { put(x, i, domain.wrapped(position(i))); });
    if (open) remove_if([&](int i) { return domain.left(position(i)); });
}

template <int D>
void Fluid<D>::reorder(const std::vector<int>& order) {
    const auto arrange = [&](std::vector<real>& f) {
        scratch_.resize(f.size());
        parallel_for(0, count(), [&](int k) {
            scratch_[static_cast<std::size_t>(k)] = f[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])];
        });
        f.swap(scratch_);
    };
    for (std::size_t a = 0; a < D; ++a) arrange(x[a]), arrange(v[a]);
    arrange(id);
    arrange(density);
    arrange(carried);
    if (warm) arrange(enthalpy);
}

template <int D>
real Fluid<D>::max_speed() const {
    if (count() == 0) return 0;
    // 0 x makes a position that is not finite turn the speed into NaN: one sweep finds both
    const real fastest = block_max(count(), [&](int i) {
        const Vec<D> u = velocity(i);
        return dot(u, u) + 0 * dot(u, position(i));
    });
    if (std::isfinite(fastest)) return std::sqrt(fastest);
    for (std::size_t a = 0; a < D; ++a)
        for (const real value : x[a])
            if (!std::isfinite(value)) throw NumericalFailure("position", "a particle's position is not finite");
    throw NumericalFailure("velocity", "a particle's velocity is not finite");
}

template <int D>
void Fluid<D>::show(FieldSet& fields) const {
    const auto vectors = [&](const char* name, const char* unit, const std::array<std::vector<real>, D>& f) {
        FieldView view{name, unit, Where::particle, "particles", {}};
        for (const auto& axis : f) view.data.emplace_back(axis);
        fields.fields.push_back(std::move(view));
    };
    vectors("position", "m", x);
    vectors("velocity", "m/s", v);
    fields.fields.push_back({"density", "kg/m^3", Where::particle, "particles", {std::span<const real>(density)}});
    fields.fields.push_back({"id", "1", Where::particle, "particles", {std::span<const real>(id)}});
    fields.grid.dim = D;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        fields.grid.cells[at] = static_cast<int>(std::lround((domain.hi[a] - domain.lo[a]) / domain.spacing));
        fields.grid.origin[at] = domain.lo[a];
        fields.grid.spacing[at] = domain.spacing;
    }
}

template <int D>
std::vector<Integral> Fluid<D>::integrals() const {
    const char* axes[] = {"x", "y", "z"};
    const int n = count();
    std::vector<Integral> list;
    list.push_back({"mass", "kg", mass * n});
    list.push_back({"volume", "m^3", mass * n / rho0});
    list.push_back({"particles", "1", static_cast<real>(n)});
    list.push_back({"kinetic_energy", "J", block_sum(n, [&](int i) { return 0.5 * mass * dot(velocity(i), velocity(i)); })});
    list.push_back({"potential_energy", "J", block_sum(n, [&](int i) { return -mass * dot(gravity, position(i) - domain.lo); })});
    for (int a = 0; a < D; ++a) {
        const auto& va = v[static_cast<std::size_t>(a)];
        list.push_back(
            {std::string("momentum_") + axes[a], "kg m/s", block_sum(n, [&](int i) { return mass * va[static_cast<std::size_t>(i)]; })});
    }
    list.push_back({"angular_momentum_z", "kg m^2/s", block_sum(n, [&](int i) {
                        const Vec<D> r = position(i) - domain.centre(), u = velocity(i);
                        return mass * (r[0] * u[1] - r[1] * u[0]);
                    })});
    list.push_back({"max_speed", "m/s", max_speed()});
    list.push_back({"outside", "1", block_sum(n, [&](int i) { return domain.outside(position(i)) ? 1.0 : 0.0; })});
    list.push_back({"clamped", "1", static_cast<real>(clamps.count)});
    list.push_back({"clamp_depth", "1", clamps.farthest / domain.spacing});
    list.push_back({"mean_height", "m", n ? block_sum(n, [&](int i) { return position(i)[1] - domain.lo[1]; }) / n : 0});
    list.push_back({"mean_density", "kg/m^3", n ? block_sum(n, [&](int i) { return density[static_cast<std::size_t>(i)]; }) / n : 0});
    return list;
}

template <int D>
void Fluid<D>::save(Checkpoint& to) const {
    for (std::size_t a = 0; a < D; ++a) {
        to.put("particles.x" + std::to_string(a), x[a]);
        to.put("particles.v" + std::to_string(a), v[a]);
    }
    to.put("particles.id", id);
    to.put("particles.density", density);
    to.put("particles.carried", carried);
    if (warm) to.put("particles.enthalpy", enthalpy);
    to.put("particles.clock", std::vector<real>{time, next_id});
    to.put_value("particles.steps", steps);
    to.put_value("particles.clamps", clamps);
}

template <int D>
void Fluid<D>::restore(const Checkpoint& from) {
    for (std::size_t a = 0; a < D; ++a) {
        from.get("particles.x" + std::to_string(a), x[a]);
        from.get("particles.v" + std::to_string(a), v[a]);
    }
    from.get("particles.id", id);
    from.get("particles.density", density);
    from.get("particles.carried", carried);
    if (warm) from.get("particles.enthalpy", enthalpy);
    std::vector<real> clock;
    from.get("particles.clock", clock);
    time = clock.at(0);
    next_id = clock.at(1);
    steps = from.get_value<std::int64_t>("particles.steps");
    if (from.has("particles.clamps")) clamps = from.get_value<Clamps>("particles.clamps");
    if (!domain.solids.empty()) domain.solids.set_time(time);
}

template struct Fluid<2>;
template struct Fluid<3>;

}  // namespace weir::particles
