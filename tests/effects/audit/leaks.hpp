// A solver that does next to nothing, and an effect of it called "extra" that is honest or leaks in one way: what shows that the audit of
// the effects can fail.
#pragma once
#include "core/effects.hpp"
#include "core/solver.hpp"
#include "scene/solver_kind.hpp"

#include <memory>
#include <string>
#include <vector>

namespace weir::test {

/// Where an effect that is not named still costs, or one that is does more than it says.
enum class Leak {
    none,
    field,        // its field is always allocated
    pass,         // its pass always runs, and is timed
    work,         // its work is always done, inside another pass
    allocation,   // with it, every step allocates
    hidden,       // it holds memory that it does not tell of
    other_bits,   // it changes numbers at strength zero
    other_field,  // it brings a field that it did not ask for
};

class LeakySolver final : public Solver {
public:
    LeakySolver(const scene::Scene& scene, Leak leak) : leak_(leak), cells_(1) {
        for (const double n : scene.root().numbers("grid.cells")) cells_ *= static_cast<std::size_t>(n);
        u_.assign(cells_, 1.0);
        const auto* extra = scene.effect("extra");
        if (extra) strength_ = extra->number("strength");
        named_ = extra != nullptr;
        if (named_ || leak == Leak::field) heat_.assign(cells_, 0.0);
        if (named_ && leak == Leak::hidden) hidden_.assign(cells_, 0.0);
        if (named_ && leak == Leak::other_field) other_.assign(cells_, 0.0);
    }
    StepReport step(real dt) override {
        {
            const auto timed = passes_.time("move");
            for (real& u : u_) u = u * (1 - 0.1 * dt);
            if (leak_ == Leak::work && !named_) work(dt);
        }
        if (!heat_.empty()) {
            const auto timed = passes_.time("advect fields");
            for (real& T : heat_) T *= 1 - 0.1 * dt;
        }
        if (named_ || leak_ == Leak::pass) {
            const auto timed = passes_.time("effect extra");
            work(dt);
        }
        if (named_ && leak_ == Leak::allocation) passing_ = std::make_unique<real>(dt);
        time_ += dt;
        return {.dt = dt};
    }
    real advised_dt() const override { return 0.01; }
    FieldSet fields() const override {
        FieldSet set;
        set.fields = {{"velocity", "m/s", Where::cell, "", {u_}}};
        if (!heat_.empty()) set.fields.push_back({"heat", "K", Where::cell, "", {heat_}});
        if (!other_.empty()) set.fields.push_back({"other", "1", Where::cell, "", {other_}});
        return set;
    }
    std::vector<Integral> integrals() const override { return {}; }
    real time() const override { return time_; }
    void save(Checkpoint&) const override {}
    void restore(const Checkpoint&) override {}
    const Passes& passes() const override { return passes_; }
    Passes& passes() override { return passes_; }
    std::size_t bytes() const override { return (u_.size() + heat_.size() + other_.size()) * sizeof(real); }
    std::vector<EffectPlan> effects() const override {
        return named_ ? std::vector<EffectPlan>{{.name = "extra", .pass = "effect extra", .fields = {"heat"}}} : std::vector<EffectPlan>{};
    }

private:
    void work(real dt) {
        const real add = strength_ + (leak_ == Leak::other_bits ? 1e-3 : 0);
        for (std::size_t i = 0; i < u_.size(); ++i) {
            u_[i] += dt * add;
            if (!heat_.empty()) heat_[i] += dt;
        }
    }
    Leak leak_;
    std::size_t cells_;
    std::vector<real> u_, heat_, other_, hidden_;
    std::unique_ptr<real> passing_;
    real strength_ = 0, time_ = 0;
    bool named_ = false;
    Passes passes_;
};

inline scene::SolverKind leaky_kind(Leak leak) {
    scene::SolverKind kind;
    kind.schema.name = "leaky";
    kind.schema.doc = "Without physics.";
    kind.schema.effects = {
        {"extra", "Adds to the velocity.", {{.name = "strength", .type = scene::Type::number, .required = true}}, {"strength"}}};
    kind.make = [leak](const scene::Scene& scene, const Partition&) { return std::make_unique<LeakySolver>(scene, leak); };
    kind.plain = {{"velocity"}, {"move"}, ""};
    return kind;
}

}  // namespace weir::test
