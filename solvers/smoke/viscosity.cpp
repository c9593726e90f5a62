// Viscosity of the fluid and diffusion of advected fields, with constant coefficients.
//
// Crank-Nicolson is solved for the correction to the field before the step, with the old pressure gradient inside the solve, so that the
// tangential velocity at walls is second order in dt (van Kan 1986):
//     (I − dt/2 ν∇²)(u* − uⁿ) = (ũ − uⁿ) + dt ν∇²uⁿ − (dt/ρ)∇pⁿ,      u = u* + (dt/ρ)∇pⁿ,      ũ: all explicit rates are in.
// For MacCormack, ũ includes half of dt ν∇²uⁿ from the departure point, and the other half is added here.
#include "mac/bodies/bodies_in_flow.hpp"
#include "mac/grid/projection.hpp"
#include "smoke/body_friction.hpp"
#include "smoke/effects.hpp"
#include "smoke/helmholtz.hpp"
#include "smoke/wall_rates.hpp"

#include <memory>

namespace weir::smoke {

namespace {

using scene::Type;
enum class Time { explicit_, crank_nicolson, implicit };

Time time_named(const std::string& name) {
    return name == "explicit" ? Time::explicit_ : name == "implicit" ? Time::implicit : Time::crank_nicolson;
}
scene::Key time_key() {
    return {.name = "scheme",
            .type = Type::choice,
            .doc = "Scheme in time: explicit limits the step to h^2/(2 dim nu); crank-nicolson is second order; implicit damps most.",
            .fallback = std::string("crank-nicolson"),
            .choices = {"explicit", "crank-nicolson", "implicit"}};
}

/// A time scheme, and whether half of the explicit part is applied at the departure points.
struct TimeRule {
    Time time;
    bool explicit_half_before;
    WallShares walls() const {
        return {time == Time::implicit ? 0.0 : 0.5, !explicit_half_before && time != Time::implicit, before_share(), implicit_share()};
    }
    TimeRule(const scene::Table& table, const scene::Scene& scene)
        : time(time_named(table.text("scheme"))), explicit_half_before(scheme_of(scene) == Scheme::maccormack && time != Time::implicit) {}
    /// Weight of the previous Laplacian at the arrival points, and that of the Laplacian at the end of the step.
    real before_share() const { return explicit_half_before ? 0.5 : 1; }
    real implicit_share() const { return time == Time::implicit ? 1 : 0.5; }
};

/// Explicit Euler neither oscillates nor grows below dt = 1 / (2 ν Σ 1/h²).
template <int D>
real explicit_limit(real nu, const Vec<D>& h) {
    real sum = 0;
    for (int a = 0; a < D; ++a) sum += 1 / (h[a] * h[a]);
    return nu > 0 ? 1 / (2 * nu * sum) : infinity;
}

/// Diffusion of one quantity from its previous values `before`: explicit, or by an implicit solve.
template <int D>
class Diffuser {
public:
    Diffuser(const Nodes<D>& nodes, const MacState<D>& s, const Boundary<D>& boundary, OpenFaces<D> open, const Extent<D>& extent)
        : nodes_(nodes), h_(s.u.h), open_(open), mask_(), rows_(), rhs_(extent), solver_(nodes, h_, boundary, open, extent) {}
    Mask<D>& mask() { return mask_; }
    const Mask<D>& mask() const { return mask_; }
    std::size_t bytes() const { return mask_.bytes() + rows_.bytes() + rhs_.bytes() + solver_.bytes(); }

    void add(const Padded<D>& before, real dt_nu, Grid<real, D>& q) {
        add(before, dt_nu, mask_, q, [](Grid<real, D>&) {});
    }
    /// `at_walls` adds the contribution of walls to the previous ∇².
    template <class AtWalls>
    void add(const Padded<D>& before, real dt_nu, const Mask<D>& mask, Grid<real, D>& q, AtWalls&& at_walls) {
        laplacian(before, h_, nodes_, mask, open_, rhs_);
        at_walls(rhs_);
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) { q(I) += dt_nu * rhs_(I); });
    }
    void solve(const Padded<D>& before, real dt_nu, const TimeRule& rule, std::span<const Held> held, Grid<real, D>& q, const char* what) {
        solve(before, dt_nu, rule, held, mask_, q, what, [](Grid<real, D>&, WallRows<D>&) {});
    }
    template <class AtWalls>
    void solve(const Padded<D>& before, real dt_nu, const TimeRule& rule, std::span<const Held> held, const Mask<D>& mask, Grid<real, D>& q,
               const char* what, AtWalls&& at_walls) {
        laplacian(before, h_, nodes_, mask, open_, rhs_);
        at_walls(rhs_, rows_);
        const real explicit_part = rule.before_share() * dt_nu;
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) {
            const real takes_part = mask.empty() ? 1 : mask(I);
            rhs_(I) = takes_part * (q(I) - before(I) + explicit_part * rhs_(I));
        });
        solver_.solve(rhs_, rule.implicit_share() * dt_nu, mask, held, what, rows_);
        for_each_in(nodes_.lo, nodes_.hi, [&](const Index<D>& I) {
            if (mask.empty() || mask(I) != 0) q(I) = before(I) + rhs_(I);
        });
    }

private:
    Nodes<D> nodes_;
    Vec<D> h_;
    OpenFaces<D> open_;
    Mask<D> mask_;
    WallRows<D> rows_;
    Grid<real, D> rhs_;
    Helmholtz<D> solver_;
};

/// Marks the nodes whose weight is positive.
template <int D, class Weight>
void set_mask(Mask<D>& mask, const Extent<D>& extent, Weight weight) {
    if (mask.empty()) mask = Mask<D>(extent);
    for_each_cell(extent, [&](const Index<D>& I) { mask(I) = weight(I) ? 1 : 0; });
    fill_ghosts(mask, Boundary<D>{}, 1);
}

/// du/dt = ν ∇²u
template <int D>
struct Viscosity final : MacEffect<D> {
    TimeRule rule;
    std::vector<Diffuser<D>> axes;
    std::unique_ptr<BodyFriction<D>> friction;  // nullptr without no-slip bodies
    Viscosity(const scene::Table& table, const scene::Scene& scene) : rule(table, scene) { refuse_explicit_friction(table, scene); }
    Stage stage() const override { return rule.time == Time::explicit_ ? Stage::force : Stage::implicit; }
    void apply_before_advection(MacState<D>& s, real dt) override {
        if (rule.explicit_half_before) add(s, dt);
    }
    void apply(MacState<D>& s, real dt) override {
        if (s.nu == 0) return;
        if (rule.time == Time::explicit_) return add(s, dt);
        if (s.no_slip_walls) return viscosity_with_bodies(s, dt);
        prepare(s);
        add_gradient(s.u, s, -dt / s.rho);
        for (int a = 0; a < D; ++a)
            axes[static_cast<std::size_t>(a)].solve(s.before[a], dt * s.nu, rule, {}, mask(s, a), s.u[a], "velocity",
                                                    [&](Grid<real, D>& rate, WallRows<D>& rows) {
                                                        if (s.walls) set_wall_rows(s, a, rule.walls(), dt * s.nu, s.before[a], rate, rows);
                                                    });
        sync_periodic(s.u, s.sides);
        add_gradient(s.u, s, dt / s.rho);
    }
    real max_dt(const MacState<D>& s) const override { return rule.time == Time::explicit_ ? explicit_limit<D>(s.nu, s.u.h) : infinity; }
    std::size_t bytes() const override {
        std::size_t total = sizeof(*this) + axes.capacity() * sizeof(Diffuser<D>);
        for (const auto& axis : axes) total += axis.bytes();
        return total + (friction ? friction->bytes() : 0);
    }

private:
    void viscosity_with_bodies(MacState<D>& s, real dt) {
        if (!friction) friction = std::make_unique<BodyFriction<D>>(s);
        add_gradient(s.u, s, -dt / s.rho);
        friction->solve(s, dt);
        friction->carry(s);
        add_gradient(s.u, s, dt / s.rho);
    }
    void add(MacState<D>& s, real dt) {
        if (s.nu == 0) return;
        prepare(s);
        for (int a = 0; a < D; ++a) {
            axes[static_cast<std::size_t>(a)].add(s.before[a], dt * s.nu, mask(s, a), s.u[a], [&](Grid<real, D>& rate) {
                if (s.walls) add_wall_rates(s, a, s.before[a], rate);
            });
            if (s.walls && rule.time == Time::explicit_) pull_to_walls(s, a, dt * s.nu, s.u[a]);
        }
        sync_periodic(s.u, s.sides);
    }
    void prepare(const MacState<D>& s) {
        for (int a = static_cast<int>(axes.size()); a < D; ++a)
            axes.emplace_back(free_faces(s.u, s.sides, a), s, s.boundary[static_cast<std::size_t>(a)], nullptr, s.u[a].extent());
    }
    const Mask<D>& mask(const MacState<D>& s, int a) const {
        return s.walls ? s.walls->takes_part(a) : axes[static_cast<std::size_t>(a)].mask();
    }
};

/// dq/dt = κ ∇²q for the temperature, the smoke, or both; no flux into solids.
template <int D>
struct Diffusion final : MacEffect<D> {
    struct Carried {
        std::string name;
        real kappa;
        std::optional<Diffuser<D>> diffuser;
    };
    TimeRule rule;
    Stage at;
    std::vector<Carried> list;
    Diffusion(const scene::Table& table, const scene::Scene& scene)
        : rule(table, scene), at(rule.time == Time::explicit_ && scheme_of(scene) == Scheme::conservative ? Stage::force : Stage::carried) {
        for (const char* name : {"temperature", "smoke"})
            if (table.has(name) && table.number(name) > 0) list.push_back({name, table.number(name), {}});
    }
    Stage stage() const override { return at; }
    void needs(FieldPlan& plan) const override {
        for (const auto& carried : list) plan.advected(carried.name);
    }
    void apply_before_advection(MacState<D>& s, real dt) override {
        if (!rule.explicit_half_before) return;
        for (auto& carried : list) {
            auto& field = prepare(s, carried);
            carried.diffuser->add(field.before, dt * carried.kappa, field.values);
        }
    }
    void apply(MacState<D>& s, real dt) override {
        for (auto& carried : list) {
            auto& field = prepare(s, carried);
            if (rule.time == Time::explicit_)
                carried.diffuser->add(field.before, rule.before_share() * dt * carried.kappa, field.values);
            else
                carried.diffuser->solve(field.before, dt * carried.kappa, rule, field.held, field.values, carried.name.c_str());
        }
    }
    real max_dt(const MacState<D>& s) const override {
        real limit = infinity;
        for (const auto& carried : list)
            if (rule.time == Time::explicit_) limit = std::min(limit, explicit_limit<D>(carried.kappa, s.u.h));
        return limit;
    }
    std::size_t bytes() const override {
        std::size_t total = list.capacity() * sizeof(Carried);
        for (const auto& carried : list) total += carried.diffuser ? carried.diffuser->bytes() : 0;
        return total;
    }

private:
    NamedField<D>& prepare(MacState<D>& s, Carried& carried) const {
        auto& field = s.field(carried.name);
        if (!carried.diffuser)
            carried.diffuser.emplace(all_cells<D>(s.extent()), s, field.boundary, s.solid.any() ? &s.solid.open : nullptr, s.extent());
        if (s.solid.any())
            set_mask(carried.diffuser->mask(), s.extent(), [&](const Index<D>& I) { return s.cells(I) == poisson::Cell::fluid; });
        return field;
    }
};

scene::Key diffusivity(const char* name) {
    return {.name = name,
            .type = Type::number,
            .doc = std::string("Diffusivity of the ") + name + ".",
            .unit = "m^2/s",
            .min = 0,
            .steerable = true};
}

}  // namespace

EffectKind viscosity() {
    return effect_kind<Viscosity>({"viscosity", "Viscous friction with fluid.viscosity.", {time_key()}, {"fluid.viscosity"}});
}

EffectKind diffusion() {
    return effect_kind<Diffusion>({"diffusion",
                                   "Diffusion of temperature or smoke.",
                                   {time_key(), diffusivity("temperature"), diffusivity("smoke")},
                                   {"temperature", "smoke"}});
}

}  // namespace weir::smoke
