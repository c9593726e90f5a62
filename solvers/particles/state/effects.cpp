// The effects of every particle method. A new one is a struct here and a row of offers(): it is then available in scenes and acts on
// threads. The other backends reject it by name until they support it (device_effects.cpp; reference_solver.cpp of the method).
#include "geometry/brush.hpp"
#include "geometry/rotating_frame.hpp"
#include "particles/state/flow.hpp"
#include "scene/gravity.hpp"

#include <cmath>
#include <memory>

namespace weir::particles {

using scene::Key;
using scene::Type;

namespace {

constexpr const char *pair_velocity = "velocity of pairs", *pair_change = "change of pairs";  // Flow's scratch

/// v += dt g.
template <int D>
struct Gravity final : Effect<Flow<D>> {
    Vec<D> g;
    Gravity(const scene::Table& t, const scene::Scene&) : g(t.vec<D>("g")) {}
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override {
        for (int a = 0; a < D; ++a) {
            auto& va = f.fluid.v[static_cast<std::size_t>(a)];
            parallel_for(0, f.fluid.count(), [&](int i) { va[static_cast<std::size_t>(i)] += dt * g[a]; });
        }
    }
};

/// The frame of a tank that rolls. The Coriolis force turns the velocity, between halves of the other forces (Boris 1970): it does no work
/// in any step. Gravity, which acts before, is taken half back for that.
template <int D>
struct RotatingFrame final : Effect<Flow<D>> {
    geometry::RotatingFrame<D> frame;
    RotatingFrame(const scene::Table& t, const scene::Scene& scene) : frame(t, scene) {}
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override {
        const auto roll = frame.at(f.fluid.time);  // forces act where particles are
        const real c = std::cos(2 * roll.rate * dt), s = std::sin(2 * roll.rate * dt);
        const int p = frame.p(), q = frame.q();
        parallel_for(0, f.fluid.count(), [&](int i) {
            const Vec<D> a = frame.acceleration(roll, f.fluid.position(i));
            Vec<D> v = f.fluid.velocity(i) + (dt / 2) * (a - frame.gravity());
            const real vp = c * v[p] + s * v[q];
            v[q] = c * v[q] - s * v[p];
            v[p] = vp;
            Fluid<D>::put(f.fluid.v, i, v + (dt / 2) * (a + frame.gravity()));
        });
    }
    real max_dt(const Flow<D>& f) const override {
        const real most = frame.most(f.fluid.domain.lo, f.fluid.domain.hi);
        return most > 0 ? 0.5 * std::sqrt(f.fluid.domain.spacing / most) : infinity;
    }
};

/// f = -omega^2 (x - centre): the drop in a central field.
template <int D>
struct CentralForce final : Effect<Flow<D>> {
    real omega;
    Vec<D> centre;
    CentralForce(const scene::Table& t, const scene::Scene&) : omega(t.number("omega")), centre(t.vec<D>("centre")) {}
    Stage stage() const override { return Stage::force; }
    void apply(Flow<D>& f, real dt) override {
        parallel_for(0, f.fluid.count(), [&](int i) {
            Fluid<D>::put(f.fluid.v, i, f.fluid.velocity(i) - dt * omega * omega * (f.fluid.position(i) - centre));
        });
    }
    real max_dt(const Flow<D>&) const override { return omega > 0 ? 0.5 / omega : infinity; }
};

/// v_i += c sum_j (m / rho0) W (v_j - v_i)          Schechter & Bridson 2012; Macklin & Müller 2013, eq. 17
template <int D>
struct Xsph final : Effect<Flow<D>> {
    real c;
    Xsph(const scene::Table& t, const scene::Scene&) : c(t.number("c")) {}
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

/// v += dt epsilon N x omega                         Macklin & Müller 2013, eq. 15-16
template <int D>
struct Confinement final : Effect<Flow<D>> {
    real epsilon;
    std::vector<float> omega;
    Confinement(const scene::Table& t, const scene::Scene&) : epsilon(t.number("epsilon")) {}
    Stage stage() const override { return Stage::finish; }
    std::size_t bytes() const override { return omega.capacity() * sizeof(float); }
    void needs(FieldPlan& plan) const override { plan.scratch(pair_velocity).scratch(pair_change); }
    void apply(Flow<D>& f, real dt) override {
        f.load_velocity();
        f.pairs.fit(omega, 4);
        const auto& table = f.pairs.table().finish[f.kernel];
        const FinishPass curl = f.pass(f.velocity, omega);
        f.pairs.list().each_chunk([&](const ListChunk& chunk) { table.curl(curl, chunk); });
        f.pairs.refresh(omega.data(), false);
        f.pairs.clear_dummies(omega);
        const FinishPass confine = f.pass(omega, f.change);
        f.pairs.list().each_chunk([&](const ListChunk& chunk) { table.confine(confine, chunk); });
        f.add_change(dt * epsilon);
    }
};

/// The schema of an effect, and its factory.
template <int D>
struct Offer {
    scene::Variant schema;
    std::unique_ptr<Effect<Flow<D>>> (*make)(const scene::Table&, const scene::Scene&);
};
template <int D, class E>
std::unique_ptr<Effect<Flow<D>>> make(const scene::Table& table, const scene::Scene& scene) {
    return std::make_unique<E>(table, scene);
}

/// In the order in which they act.
template <int D>
std::vector<Offer<D>> offers() {
    const Key omega{.name = "omega",
                    .type = Type::number,
                    .doc = "Angular frequency of the field.",
                    .unit = "1/s",
                    .required = true,
                    .min = 0,
                    .steerable = true};
    const Key centre{.name = "centre", .type = Type::numbers, .doc = "Where it vanishes.", .unit = "m", .required = true, .length = -1};
    const Key c{.name = "c",
                .type = Type::number,
                .doc = "Weight of the neighbours' mean velocity in each step.",
                .fallback = 0.01,
                .min = 0.0,
                .max = 1.0,
                .steerable = true};
    const Key epsilon{
        .name = "epsilon", .type = Type::number, .doc = "Strength.", .unit = "m/s", .required = true, .min = 0, .steerable = true};
    return {{scene::gravity_effect("A constant acceleration."), make<D, Gravity<D>>},
            {{"central_force", "An acceleration -omega^2 (x - centre).", {omega, centre}, {"omega"}}, make<D, CentralForce<D>>},
            {geometry::rotating_frame_schema(), make<D, RotatingFrame<D>>},
            {{"xsph", "Velocities are smoothed over neighbours (Schechter & Bridson 2012).", {c}, {"c"}}, make<D, Xsph<D>>},
            {{"vorticity", "Vorticity confinement (Macklin & Müller 2013, eq. 16).", {epsilon}, {"epsilon"}}, make<D, Confinement<D>>}};
}

}  // namespace

std::vector<scene::Variant> effect_schemas() {
    std::vector<scene::Variant> list;
    for (auto& offer : offers<2>()) list.push_back(std::move(offer.schema));
    list.push_back(geometry::brush_schema());
    return list;
}

template <int D>
void add_effects(const scene::Scene& scene, Effects<Flow<D>>& effects) {
    for (const auto& offer : offers<D>())
        if (const auto* table = scene.effect(offer.schema.name)) effects.add(offer.schema.name, offer.make(*table, scene));
}

template void add_effects(const scene::Scene&, Effects<Flow<2>>&);
template void add_effects(const scene::Scene&, Effects<Flow<3>>&);

}  // namespace weir::particles
