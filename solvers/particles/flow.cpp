#include "particles/flow.hpp"

#include <memory>

namespace weir::particles {

using scene::Key;
using scene::Type;

template <int D>
void Flow<D>::load_velocity() {
    pairs.fit(velocity, 4);
    pairs.fit(change, 4);
    pairs.each([&](int k) {
        const Vec<D> u = fluid.velocity(pairs.owner(k));
        float* four = velocity.data() + 4 * k;
        four[2] = four[3] = 0;
        for (int a = 0; a < D; ++a) four[a] = static_cast<float>(u[a]);
    });
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

constexpr const char *pair_velocity = "velocity of pairs", *pair_change = "change of pairs";  // Flow's scratch

/// v += dt g.
template <int D>
struct Gravity final : Effect<Flow<D>> {
    Vec<D> g{};
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override {
        for (int a = 0; a < D; ++a) {
            auto& va = f.fluid.v[static_cast<std::size_t>(a)];
            parallel_for(0, f.fluid.count(), [&](int i) { va[static_cast<std::size_t>(i)] += dt * g[a]; });
        }
    }
};

/// f = -omega^2 (x - centre): the drop in a central field.
template <int D>
struct CentralForce final : Effect<Flow<D>> {
    real omega = 0;
    Vec<D> centre{};
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override {
        parallel_for(0, f.fluid.count(), [&](int i) {
            Fluid<D>::put(f.fluid.v, i, f.fluid.velocity(i) - dt * omega * omega * (f.fluid.position(i) - centre));
        });
    }
    real max_dt(const Flow<D>&) const override { return omega > 0 ? 0.5 / omega : infinity; }
};

/// v_i += c sum_j (m / rho0) W (v_j - v_i)                                            Schechter & Bridson 2012; Macklin & Müller 2013, eq.
/// 17
template <int D>
struct Xsph final : Effect<Flow<D>> {
    real c = 0;
    Stage stage() const override { return Stage::finish; }
    void needs(FieldPlan& plan) const override { plan.scratch(pair_velocity).scratch(pair_change); }
    void apply(Flow<D>& f, real) override {
        f.load_velocity();
        const FinishPass job = f.pass(f.velocity, f.change);
        const auto& table = f.pairs.table().finish[f.kernel];
        f.pairs.list().each_chunk([&](const ListChunk& chunk) { table.smooth(job, chunk); });
        f.add_change(c);
    }
};

/// v += dt epsilon N x omega                                                            Macklin & Müller 2013, eq. 15-16
template <int D>
struct Confinement final : Effect<Flow<D>> {
    real epsilon = 0;
    std::vector<float> omega;
    Stage stage() const override { return Stage::finish; }
    std::size_t bytes() const override { return omega.capacity() * sizeof(float); }
    void needs(FieldPlan& plan) const override { plan.scratch(pair_velocity).scratch(pair_change); }
    void apply(Flow<D>& f, real dt) override {
        f.load_velocity();
        f.pairs.fit(omega, 4);
        const auto& table = f.pairs.table().finish[f.kernel];
        const FinishPass curl = f.pass(f.velocity, omega);
        f.pairs.list().each_chunk([&](const ListChunk& chunk) { table.curl(curl, chunk); });
        f.pairs.refresh_images(omega.data(), false);
        const FinishPass confine = f.pass(omega, f.change);
        f.pairs.list().each_chunk([&](const ListChunk& chunk) { table.confine(confine, chunk); });
        f.add_change(dt * epsilon);
    }
};

Key number(const char* name, const char* doc, const char* unit) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true};
}

}  // namespace

std::vector<scene::Variant> effect_schemas() {
    Key omega = number("omega", "Angular frequency of the field.", "1/s");
    omega.min = 0;
    return {{"gravity",
             "A constant acceleration.",
             {{.name = "g", .type = Type::numbers, .doc = "The acceleration.", .unit = "m/s^2", .required = true, .length = -1}},
             {"g"}},
            {"central_force",
             "An acceleration -omega^2 (x - centre).",
             {omega, {.name = "centre", .type = Type::numbers, .doc = "Where it vanishes.", .unit = "m", .required = true, .length = -1}},
             {"omega"}},
            {"xsph",
             "Velocities are smoothed over neighbours (Schechter & Bridson 2012).",
             {{.name = "c",
               .type = Type::number,
               .doc = "How much of the mean is taken in each step.",
               .fallback = 0.01,
               .min = 0.0,
               .max = 1.0}},
             {"c"}},
            {"vorticity",
             "Vorticity confinement (Macklin & Müller 2013, eq. 16).",
             {{.name = "epsilon", .type = Type::number, .doc = "Its strength.", .unit = "m/s", .required = true, .min = 0}},
             {"epsilon"}}};
}

template <int D>
void add_effects(const scene::Scene& scene, Effects<Flow<D>>& effects) {
    if (const auto* t = scene.effect("gravity")) {
        auto e = std::make_unique<Gravity<D>>();
        e->g = t->template vec<D>("g");
        effects.add("gravity", std::move(e));
    }
    if (const auto* t = scene.effect("central_force")) {
        auto e = std::make_unique<CentralForce<D>>();
        e->omega = t->number("omega");
        e->centre = t->template vec<D>("centre");
        effects.add("central_force", std::move(e));
    }
    if (const auto* t = scene.effect("xsph")) {
        auto e = std::make_unique<Xsph<D>>();
        e->c = t->number("c");
        effects.add("xsph", std::move(e));
    }
    if (const auto* t = scene.effect("vorticity")) {
        auto e = std::make_unique<Confinement<D>>();
        e->epsilon = t->number("epsilon");
        effects.add("vorticity", std::move(e));
    }
}

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
            .doc = "Regions that take particles out.",
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

template <int D>
Fluid<D> initial_fluid(const scene::Scene& scene) {
    Fluid<D> fluid(scene);
    set_initial_velocity(scene, fluid);
    return fluid;
}

template struct Flow<2>;
template struct Flow<3>;
template void add_effects(const scene::Scene&, Effects<Flow<2>>&);
template void add_effects(const scene::Scene&, Effects<Flow<3>>&);
template void set_initial_velocity(const scene::Scene&, Fluid<2>&);
template void set_initial_velocity(const scene::Scene&, Fluid<3>&);
template Fluid<2> initial_fluid(const scene::Scene&);
template Fluid<3> initial_fluid(const scene::Scene&);

}  // namespace weir::particles
