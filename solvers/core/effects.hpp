// Effects: one term of one paper each, chosen by the scene by name. What the scene does not name allocates no field, runs no pass.
#pragma once
#include "core/types.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace weir {

/// The places in a step where physics may act: source (emitters, heaters), force (explicit rates, u += dt f), implicit (linear solves
/// after all explicit rates are in), finish (after the projection).
enum class Stage { source, force, implicit, finish };
inline constexpr int stage_count = 4;

/// The fields that effects asked for, by name. Two effects that need the same field share it.
class FieldPlan {
public:
    /// A cell field carried by the flow.
    FieldPlan& advected(std::string_view name) { return add(advected_, name); }
    /// A cell field that an effect needs as scratch; not carried.
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

/// One physical term acting on a solver's State.
template <class State>
struct Effect {
    virtual ~Effect() = default;
    virtual Stage stage() const = 0;
    virtual void needs(FieldPlan&) const {}                       // names fields; allocates nothing
    virtual void apply(State& s, real dt) = 0;                    // one pass: one virtual call a pass, none a cell
    virtual real max_dt(const State&) const { return infinity; }  // its own stability limit [s]
};

/// The effects of one scene, in registry order, so that the scene's order never matters.
template <class State>
class Effects {
public:
    void add(std::unique_ptr<Effect<State>> effect) {
        auto& list = at_[static_cast<std::size_t>(effect->stage())];
        list.push_back(std::move(effect));
    }
    FieldPlan plan() const {
        FieldPlan fields;
        for (const auto& list : at_)
            for (const auto& effect : list) effect->needs(fields);
        return fields;
    }
    bool empty(Stage stage) const { return at_[static_cast<std::size_t>(stage)].empty(); }
    void apply(Stage stage, State& s, real dt) const {
        for (const auto& effect : at_[static_cast<std::size_t>(stage)]) effect->apply(s, dt);
    }
    real max_dt(const State& s) const {
        real smallest = infinity;
        for (const auto& list : at_)
            for (const auto& effect : list) smallest = std::min(smallest, effect->max_dt(s));
        return smallest;
    }

private:
    std::array<std::vector<std::unique_ptr<Effect<State>>>, stage_count> at_;
};

}  // namespace weir
