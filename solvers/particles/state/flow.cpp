#include "particles/state/flow.hpp"

#include "particles/heat/heat.hpp"
#include "particles/heat/ice.hpp"
#include "particles/state/emitters.hpp"
#include "scene/names.hpp"

namespace weir::particles {

using scene::Key;
using scene::Type;

template <int D>
void Flow<D>::share_velocity() {
    std::array<std::vector<real>*, D> all;
    for (std::size_t a = 0; a < D; ++a) all[a] = &fluid.v[a];
    pairs.share(all);
}

template <int D>
void Flow<D>::load_velocity() {
    pairs.fit(velocity, 4);
    pairs.fit(change, 4);
    share_velocity();
    pairs.each_read([&](int k) {
        const Vec<D> u = fluid.velocity(pairs.owner(k));
        float* four = velocity.data() + 4 * k;
        four[2] = four[3] = 0;
        for (int a = 0; a < D; ++a) four[a] = static_cast<float>(u[a]);
    });
    pairs.clear_dummies(velocity);
}

template <int D>
FinishPass Flow<D>::pass(const std::vector<float>& values, std::vector<float>& to) {
    return {&params, pairs.size(), pairs.a(), values.data(), to.data(), pairs.list().first(), pairs.list().rows()};
}

template <int D>
void Flow<D>::add_change(real factor) {
    pairs.each([&](int k) {
        if (pairs.is_image(k)) return;
        const int i = pairs.owner(k);
        Vec<D> u = fluid.velocity(i);
        for (int a = 0; a < D; ++a) u[a] += factor * static_cast<real>(change[static_cast<std::size_t>(4 * k + a)]);
        Fluid<D>::put(fluid.v, i, u);
    });
}

namespace {

Key number(const char* name, const char* doc, const char* unit) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true};
}

}  // namespace

Key initial_key() {
    Key velocity{.name = "velocity", .type = Type::table};
    const Key centre{.name = "centre", .type = Type::numbers, .doc = "Where it vanishes.", .unit = "m", .required = true, .length = -1};
    velocity.variants = {
        {"strain", "(-rate x, rate y) about the centre: the stretching drop of Monaghan 1994.", {number("rate", "A.", "1/s"), centre}},
        {"rotation", "omega (-y, x) about the centre, like a rigid body.", {number("omega", "Angular velocity.", "1/s"), centre}}};
    return {.name = "initial", .type = Type::table, .keys = {velocity}};
}

Key sinks_key() {
    return {.name = "sinks",
            .type = Type::tables,
            .doc = "Sinks: regions that remove particles.",
            .selector = "shape",
            .variants_from = &scene::shapes};
}

template <int D>
void set_initial_velocity(const scene::Scene& scene, Fluid<D>& fluid) {
    if (!scene.has("initial.velocity")) return;
    const scene::Table& table = scene.root().table("initial.velocity");
    const std::string& name = table.text("name");
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> u{};
        if (name == "constant") {
            u = table.vec<D>("value");
        } else {
            const Vec<D> r = fluid.position(i) - table.vec<D>("centre");
            if (name == "strain")
                u[0] = -table.number("rate") * r[0], u[1] = table.number("rate") * r[1];
            else
                u[0] = -table.number("omega") * r[1], u[1] = table.number("omega") * r[0];
        }
        Fluid<D>::put(fluid.v, i, u);
    }
}

namespace {

/// Rejects scenes without liquid and without emitters, which never move; most often their shapes fall between the lattice points.
template <int D>
void refuse_nothing(const scene::Scene& scene, const Fluid<D>& fluid) {
    if (fluid.next_id > 0 || Emitters<D>(scene, fluid.domain).entered(scene.number("time.end")) > 0) return;
    const bool named = scene.has("liquid") && !scene.root().tables("liquid").empty();
    const std::string spacing = scene::number_text(fluid.domain.spacing);
    scene.refuse(
        "liquid",
        named ? "the liquid contains no particle: it lies inside solids, or is thinner than the particle spacing of " + spacing + " m"
              : "a scene of particles requires liquid: at least one shape, or an emitter that starts before time.end",
        named ? "particles start at cell centres" : "");
}

}  // namespace

template <int D>
Fluid<D> initial_fluid(const scene::Scene& scene) {
    Fluid<D> fluid(scene);
    spread_ice(scene, fluid);
    refuse_nothing(scene, fluid);
    set_initial_velocity(scene, fluid);
    if (heat_is_named(scene)) Heat<D>(scene, fluid.domain).start(scene, fluid);
    return fluid;
}

template struct Flow<2>;
template struct Flow<3>;
template void set_initial_velocity(const scene::Scene&, Fluid<2>&);
template void set_initial_velocity(const scene::Scene&, Fluid<3>&);
template Fluid<2> initial_fluid(const scene::Scene&);
template Fluid<3> initial_fluid(const scene::Scene&);

}  // namespace weir::particles
