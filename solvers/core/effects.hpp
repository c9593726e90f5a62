// Effects: each is one term of one paper, selected by name in the scene. An effect that the scene does not name allocates no field and runs
// no pass.
#pragma once
#include "core/passes.hpp"
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace weir {

/// The stages of a step at which physics may act: source (emitters, heaters), force (explicit rates, u += dt f), carried (changes of
/// advected fields before they act on the flow), implicit (linear solves after all explicit rates), finish (after the projection).
enum class Stage { source, force, carried, implicit, finish };
inline constexpr int stage_count = 5;
inline constexpr std::array<const char*, stage_count> stage_names{"source", "force", "carried", "implicit", "finish"};  ///< by Stage

/// The fields that effects request, by name. Two effects that need the same field share it.
class FieldPlan {
public:
    /// A cell field advected by the flow.
    FieldPlan& advected(std::string_view name) { return add(advected_, name); }
    /// A cell field that an effect needs as scratch; not advected.
    FieldPlan& scratch(std::string_view name) { return add(scratch_, name); }
    const std::vector<std::string>& advected_fields() const { return advected_; }
    const std::vector<std::string>& scratch_fields() const { return scratch_; }

private:
    FieldPlan& add(std::vector<std::string>& list, std::string_view name) {
        if (std::find(list.begin(), list.end(), name) == list.end()) list.emplace_back(name);
        return *this;
    }
    std::vector<std::string> advected_, scratch_;
};

/// What a solver built for one effect named by its scene.
struct EffectPlan {
    std::string name;
    std::string pass{};  // name under which it is timed; empty: it is a term of the pass `inside`
    std::string inside{};
    bool at_start = false;               // it changes values computed when the scene is read: a step costs the same with it as without
    std::vector<std::string> fields{};   // cell fields advected by the flow, shared with every other effect that requests them
    std::vector<std::string> scratch{};  // other cell fields, also shared
    std::size_t bytes = 0;               // that it allocates for itself alone
    std::vector<std::string> shown{};    // fields that it computes for output; the flow does not advect them
};

/// The name of the pass under which an effect is timed.
inline std::string effect_pass(std::string_view name) { return "effect " + std::string(name); }

/// One physical term acting on a solver's State.
template <class State>
struct Effect {
    virtual ~Effect() = default;
    virtual Stage stage() const = 0;
    virtual void needs(FieldPlan&) const {}     // names fields; allocates nothing
    virtual void apply(State& s, real dt) = 0;  // one pass: one virtual call per pass, none per cell
    /// The explicit half (over dt) of a trapezoidal step along trajectories; it acts at the departure points. The other half is apply's.
    virtual void apply_before_advection(State& s, real dt) {
        if (stage() == Stage::force) apply(s, dt);
    }
    virtual real max_dt(const State&) const { return infinity; }  // its own stability limit [s]
    virtual std::size_t bytes() const { return 0; }               // allocated for itself, beyond the fields it needs
};

/// The effects of one scene, in registry order, so that the scene's order never matters.
template <class State>
class Effects {
public:
    /// `runs`: the stages of the solver's step. An effect of another stage would never act.
    Effects(std::string_view solver, std::vector<Stage> runs) : solver_(solver), runs_(std::move(runs)) {}

    /// Throws std::logic_error for an effect whose stage the solver does not run.
    void add(std::string_view name, std::unique_ptr<Effect<State>> effect) {
        if (std::find(runs_.begin(), runs_.end(), effect->stage()) == runs_.end()) refuse(name, effect->stage());
        auto& list = at_[static_cast<std::size_t>(effect->stage())];
        list.push_back({std::string(name), effect_pass(name), std::move(effect)});
    }
    /// Registers an effect that the solver applies itself: as a pass of its own, or as a term of an existing pass.
    void declare(EffectPlan plan) { declared_.push_back(std::move(plan)); }

    FieldPlan plan() const {
        FieldPlan fields;
        each([&](const Entry& e) { e.effect->needs(fields); });
        return fields;
    }
    /// One entry per effect.
    std::vector<EffectPlan> plans() const {
        std::vector<EffectPlan> list = declared_;
        each([&](const Entry& e) {
            FieldPlan fields;
            e.effect->needs(fields);
            list.push_back({.name = e.name,
                            .pass = e.pass,
                            .fields = fields.advected_fields(),
                            .scratch = fields.scratch_fields(),
                            .bytes = e.effect->bytes()});
        });
        return list;
    }
    std::size_t bytes() const {
        std::size_t total = 0;
        each([&](const Entry& e) { total += e.effect->bytes(); });
        return total;
    }
    bool empty(Stage stage) const { return at_[static_cast<std::size_t>(stage)].empty(); }
    /// Applies each effect of the stage, timed under its own name.
    void apply(Stage stage, State& s, real dt, Passes& passes) const {
        for (const Entry& e : at_[static_cast<std::size_t>(stage)]) {
            const auto timed = passes.time(e.pass);
            e.effect->apply(s, dt);
        }
    }
    /// Runs in the reverse order: apply_before_advection followed by apply is then symmetric in time.
    void apply_before_advection(Stage stage, State& s, real dt, Passes& passes) const {
        const auto& list = at_[static_cast<std::size_t>(stage)];
        for (auto e = list.rbegin(); e != list.rend(); ++e) {
            const auto timed = passes.time(e->pass);
            e->effect->apply_before_advection(s, dt);
        }
    }
    real max_dt(const State& s) const {
        real smallest = infinity;
        each([&](const Entry& e) { smallest = std::min(smallest, e.effect->max_dt(s)); });
        return smallest;
    }

private:
    struct Entry {
        std::string name, pass;
        std::unique_ptr<Effect<State>> effect;
    };
    template <class F>
    void each(F&& f) const {
        for (const auto& list : at_)
            for (const Entry& e : list) f(e);
    }
    [[noreturn]] void refuse(std::string_view name, Stage stage) const {
        std::string list;
        for (const Stage s : runs_) list += (list.empty() ? "" : ", ") + std::string(stage_names[static_cast<std::size_t>(s)]);
        throw std::logic_error("effect \"" + std::string(name) + "\" acts at stage \"" + stage_names[static_cast<std::size_t>(stage)] +
                               "\", which solver \"" + solver_ + "\" does not run; its stages: " + list);
    }
    std::string solver_;
    std::vector<Stage> runs_;
    std::array<std::vector<Entry>, stage_count> at_;
    std::vector<EffectPlan> declared_;
};

}  // namespace weir
