#include "particles/state/fluid.hpp"

#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "parallel/plane_checkpoint.hpp"
#include "particles/boundaries/beside_bodies.hpp"
#include "particles/ranks/particle_exchange.hpp"

#include <algorithm>
#include <numeric>

namespace weir::particles {

namespace {

/// This rank's part of `count` particles.
std::array<std::size_t, 2> part_of(std::size_t count) {
    const auto r = static_cast<std::size_t>(communicator().rank()), ranks = static_cast<std::size_t>(communicator().ranks());
    return {count * r / ranks, count * (r + 1) / ranks};
}

}  // namespace

template <int D>
Fluid<D>::Fluid(const scene::Scene& scene) : domain(scene), rho0(scene.number("fluid.density")) {
    mass = rho0 * cell_volume<D>(domain.spacing);
    if (const auto* g = scene.effect("gravity")) gravity = g->template vec<D>("g");
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const Index<D> cells = scene.index<D>("grid.cells");
    std::vector<Vec<D>> beside;
    const auto each_place = [&](auto&& stand) {
        Index<D> at{};
        for (std::size_t c = 0; c < product(cells); ++c) {
            const Vec<D> centre = domain.lo + domain.spacing * (to_vec(at) + Vec<D>::constant(0.5));
            const bool wet = std::any_of(shapes.begin(), shapes.end(), [&](const auto& s) { return s->contains(centre); });
            if (wet && domain.bodies && away_from_bodies(domain, centre) < 0.5 * std::sqrt(1.0 * D) * domain.spacing)
                beside.push_back(centre);
            else if (wet && (domain.solids.empty() || domain.solids.distance(centre) > 0.25 * domain.spacing))
                stand(centre);
            for (int a = 0; a < D && ++at[a] == cells[a]; ++a) at[a] = 0;
        }
    };
    shared = communicator().several() && !communicator().builds_serial();
    if (shared) {
        std::size_t all = 0, n = 0;
        each_place([&](const Vec<D>&) { ++all; });
        const auto [begin, end] = part_of(all);
        each_place([&, first = begin, last = end](const Vec<D>& centre) {
            if (n >= first && n < last) append(centre, {}, 0, static_cast<real>(n), static_cast<real>(n));
            ++n;
        });
        next_id = next_place = static_cast<real>(all);
        return;
    }
    each_place([&](const Vec<D>& centre) { add(centre, Vec<D>{}); });
    if (!beside.empty())
        for (const Vec<D>& at : places_beside_bodies(domain, beside)) add(at, Vec<D>{});
    scratch_.reserve(id.size());  // of reorder(), which must not allocate in a step
}

template <int D>
void Fluid<D>::append(const Vec<D>& at, const Vec<D>& velocity, real h, real born, real stands) {
    for (int a = 0; a < D; ++a) {
        x[static_cast<std::size_t>(a)].push_back(at[a]);
        v[static_cast<std::size_t>(a)].push_back(velocity[a]);
    }
    id.push_back(born);
    density.push_back(rho0);
    carried.push_back(0);
    if (warm) enthalpy.push_back(h);
    if (shared) place.push_back(stands);
}

template <int D>
void Fluid<D>::add(const Vec<D>& at, const Vec<D>& velocity, real h) {
    const real born = next_id++, stands = next_place++;
    if (!shared || communicator().rank() == 0) append(at, velocity, h, born, stands);
}

template <int D>
void Fluid<D>::resize(int count) {
    const auto n = static_cast<std::size_t>(count);
    for_each_array([&](std::vector<real>& f) { f.resize(n); });
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
    for_each_array(arrange);
}

template <int D>
void Fluid<D>::take_setting(const Fluid& from) {
    domain = from.domain, gravity = from.gravity, rho0 = from.rho0, mass = from.mass;
    time = from.time, steps = from.steps, next_id = from.next_id, corrections = from.corrections;
}

template <int D>
void Fluid<D>::deal(Fluid& part) const {
    part.take_setting(*this);
    part.shared = true;
    ParticleExchange::Arrays own, sorted;
    const_cast<Fluid&>(*this).for_each_array([&](std::vector<real>& f) { own.push_back(&f); });  // they are only read
    part.for_each_array([&](std::vector<real>& f) { sorted.push_back(&f); });
    ParticleExchange exchange;
    exchange.clear();
    const int ranks = communicator().ranks();
    for (int i = 0; i < count(); ++i)
        exchange.migrate(std::min(ranks - 1, static_cast<int>(place[static_cast<std::size_t>(i)] * ranks / next_place)), i);
    exchange.run(own, 0);
    part.resize(exchange.migrated());
    exchange.unpack_migrated(sorted, 0);
    std::vector<int> order(part.id.size());
    std::iota(order.begin(), order.end(), 0);
    const auto stands = [&](int i) { return part.place[static_cast<std::size_t>(i)]; };
    std::sort(order.begin(), order.end(), [&](int i, int j) { return stands(i) < stands(j); });
    part.reorder(order);
}

template <int D>
void Fluid<D>::gather(Fluid& all) const {
    all.take_setting(*this);
    const std::vector<real> places = of_all_ranks(place);
    std::vector<int> at(places.empty() ? 0 : static_cast<std::size_t>(next_place), -1), order;  // particle with each place
    for (std::size_t i = 0; i < places.size(); ++i) at[static_cast<std::size_t>(places[i])] = static_cast<int>(i);
    std::copy_if(at.begin(), at.end(), std::back_inserter(order), [](int i) { return i >= 0; });
    const auto fill = [&](std::vector<real>& to, const std::vector<real>& own) {
        const std::vector<real> list = of_all_ranks(own);
        to.resize(order.size());
        parallel_for(0, static_cast<int>(order.size()),
                     [&](int k) { to[static_cast<std::size_t>(k)] = list[static_cast<std::size_t>(order[static_cast<std::size_t>(k)])]; });
    };
    for (std::size_t a = 0; a < D; ++a) fill(all.x[a], x[a]), fill(all.v[a], v[a]);
    fill(all.id, id);
    fill(all.density, density);
    fill(all.carried, carried);
}

template <int D>
real Fluid<D>::fastest() const {
    if (count() == 0) return 0;
    // 0 x turns a position that is not finite into a NaN speed: one pass finds both
    return std::sqrt(block_max(count(), [&](int i) {
        const Vec<D> u = velocity(i);
        return dot(u, u) + 0 * dot(u, position(i));
    }));
}

template <int D>
real Fluid<D>::max_speed() const {
    const real speed = fastest();
    if (!std::isfinite(speed)) fail(std::max(broken(), Quantity::velocity));
    return speed;
}

template <int D>
typename Fluid<D>::Quantity Fluid<D>::broken(bool moving) const {
    const auto is_finite = [](const std::vector<real>& values) {
        return 0 == block_max(static_cast<int>(values.size()), [&](int i) { return 0 * values[static_cast<std::size_t>(i)]; });
    };
    for (std::size_t a = 0; moving && a < D; ++a)
        if (!is_finite(x[a])) return Quantity::position;
    for (std::size_t a = 0; moving && a < D; ++a)
        if (!is_finite(v[a])) return Quantity::velocity;
    if (!is_finite(density)) return Quantity::density;
    return is_finite(carried) ? Quantity::none : Quantity::pressure;
}

template <int D>
void Fluid<D>::fail(Quantity broken) {
    if (broken == Quantity::position) throw NumericalFailure("position", "a particle's position is not finite");
    if (broken == Quantity::velocity) throw NumericalFailure("velocity", "a particle's velocity is not finite");
    if (broken == Quantity::density) throw NumericalFailure("density", "density is no longer finite");
    if (broken == Quantity::pressure) throw NumericalFailure("pressure", "pressure is no longer finite");
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
    fields.rest_density = rho0;
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        fields.grid.cells[at] = static_cast<int>(std::lround((domain.hi[a] - domain.lo[a]) / domain.spacing));
        fields.grid.origin[at] = domain.lo[a];
        fields.grid.spacing[at] = domain.spacing;
        fields.weight[a] = rho0 * gravity[a];
    }
}

template <int D>
std::vector<Integral> Fluid<D>::integrals() const {
    const char* axes[] = {"x", "y", "z"};
    const std::string per_depth = D == 2 ? "/m" : "";
    const int n = count();
    std::vector<Integral> list;
    list.push_back({"mass", "kg" + per_depth, mass * n});
    list.push_back({"volume", D == 2 ? "m^2" : "m^3", mass * n / rho0});
    list.push_back({"particles", "1", static_cast<real>(n)});
    list.push_back({"kinetic_energy", "J" + per_depth, block_sum(n, [&](int i) { return 0.5 * mass * dot(velocity(i), velocity(i)); })});
    list.push_back(
        {"potential_energy", "J" + per_depth, block_sum(n, [&](int i) { return -mass * dot(gravity, position(i) - domain.lo); })});
    for (int a = 0; a < D; ++a) {
        const auto& va = v[static_cast<std::size_t>(a)];
        list.push_back({std::string("momentum_") + axes[a], "kg m/s" + per_depth,
                        block_sum(n, [&](int i) { return mass * va[static_cast<std::size_t>(i)]; })});
    }
    list.push_back({"angular_momentum_z", "kg m^2/s" + per_depth, block_sum(n, [&](int i) {
                        const Vec<D> r = position(i) - domain.centre(), u = velocity(i);
                        return mass * (r[0] * u[1] - r[1] * u[0]);
                    })});
    list.push_back({"max_speed", "m/s", max_speed()});
    list.push_back({"outside", "1", block_sum(n, [&](int i) { return domain.outside(position(i)) ? 1.0 : 0.0; })});
    list.push_back({"clamped", "1", static_cast<real>(corrections.count)});
    list.push_back({"clamp_depth", "1", corrections.farthest / domain.spacing});
    list.push_back({"mean_height", "m", n ? block_sum(n, [&](int i) { return position(i)[1] - domain.lo[1]; }) / n : 0});
    list.push_back({"mean_density", "kg/m^3", n ? block_sum(n, [&](int i) { return density[static_cast<std::size_t>(i)]; }) / n : 0});
    return list;
}

/// Each particle goes to the rank that reads its part of the file.
template <int D>
void Fluid<D>::save_part(Checkpoint& to) const {
    Fluid part;
    deal(part);
    const std::vector<std::size_t> begins = begins_of_ranks(part.id.size());
    const auto put = [&](const std::string& name, const std::vector<real>& f) {
        to.put_part("particles." + name, std::span<const real>(f), begins[static_cast<std::size_t>(communicator().rank())], begins.back());
    };
    for (std::size_t a = 0; a < D; ++a) put("x" + std::to_string(a), part.x[a]), put("v" + std::to_string(a), part.v[a]);
    put("id", part.id);
    put("density", part.density);
    put("carried", part.carried);
}

template <int D>
void Fluid<D>::save(Checkpoint& to) const {
    if (shared) {
        save_part(to);
    } else {
        for (std::size_t a = 0; a < D; ++a) {
            to.put("particles.x" + std::to_string(a), x[a]);
            to.put("particles.v" + std::to_string(a), v[a]);
        }
        to.put("particles.id", id);
        to.put("particles.density", density);
        to.put("particles.carried", carried);
        if (warm) to.put("particles.enthalpy", enthalpy);
    }
    to.put("particles.clock", std::vector<real>{time, next_id});
    to.put_value("particles.steps", steps);
    to.put_value("particles.clamps", corrections);
}

namespace {

/// Checks a list from a file: one finite value per particle.
void require_list(const std::string& name, const std::vector<real>& list, std::size_t count) {
    if (list.size() != count)
        throw std::runtime_error("checkpoint block \"particles." + name + "\" holds " + std::to_string(list.size()) + " values of " +
                                 std::to_string(count) + " particles");
    Checkpoint::require_finite("particles." + name, list);
}

template <int D>
void require_whole(const Fluid<D>& fluid) {
    for (std::size_t a = 0; a < D; ++a)
        require_list("x" + std::to_string(a), fluid.x[a], fluid.id.size()),
            require_list("v" + std::to_string(a), fluid.v[a], fluid.id.size());
    require_list("id", fluid.id, fluid.id.size()), require_list("density", fluid.density, fluid.id.size());
    require_list("carried", fluid.carried, fluid.id.size());
    if (fluid.warm) require_list("enthalpy", fluid.enthalpy, fluid.id.size());
}

}  // namespace

template <int D>
void Fluid<D>::restore(const Checkpoint& from) {
    Checkpoint::Held held = from.held<real>("particles.id");
    if (shared && !held.part) held = held.share(communicator().rank(), communicator().ranks());
    const auto get = [&](const std::string& name, std::vector<real>& f) {
        if (!shared) return from.get("particles." + name, f);
        f.resize(held.end - held.begin);
        from.get_part("particles." + name, std::span<real>(f), held.begin, held.all);
    };
    for (std::size_t a = 0; a < D; ++a) get("x" + std::to_string(a), x[a]), get("v" + std::to_string(a), v[a]);
    get("id", id);
    get("density", density);
    get("carried", carried);
    if (warm) get("enthalpy", enthalpy);
    if (shared) {
        place.resize(id.size());
        std::iota(place.begin(), place.end(), static_cast<real>(held.begin));
        next_place = static_cast<real>(held.all);
    }
    std::vector<real> clock(2);
    from.get("particles.clock", std::span<real>(clock));
    Checkpoint::require_finite("particles.clock", clock);
    time = clock[0];
    next_id = clock[1];
    steps = get_count(from, "particles.steps");
    require_whole(*this);
    if (from.has("particles.clamps")) corrections = from.get_value<BoundaryCorrections>("particles.clamps");
    if (!domain.solids.empty()) domain.solids.set_time(time);
}

template struct Fluid<2>;
template struct Fluid<3>;

}  // namespace weir::particles
