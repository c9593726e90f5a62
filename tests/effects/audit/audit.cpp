#include "effects/audit/audit.hpp"

#include "effects/audit/heap.hpp"
#include "parallel/partition.hpp"
#include "validation/cost/effect_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace weir::test {
namespace {

using validation::negligible;
using validation::plain_scene;
using validation::scene_with;
using Names = std::set<std::string>;

constexpr int warm_up = 2;
constexpr int cells_along(int dim) { return dim == 2 ? 24 : 14; }
// names, small objects and what the allocator rounds up; the smallest of these scenes holds 4608 bytes in one field
constexpr long small_change = 4000;

/// A solver after a few steps, and what was seen of it.
struct Watched {
    scene::Scene scene;
    std::unique_ptr<Solver> solver;
    long held = 0;         // bytes of the heap, after the warm-up
    long allocations = 0;  // of the step after it
    Names fields, passes;

    Watched(const scene::SolverKind& kind, scene::Scene what, real dt) : scene(std::move(what)) {
        const long before = bytes_held();
        solver = kind.make(scene, {});
        for (int i = 0; i < warm_up; ++i) solver->step(dt);
        held = bytes_held() - before;
        const long count = allocations_so_far();
        solver->step(dt);
        allocations = allocations_so_far() - count;
        for (const FieldView& field : fields_of().fields) fields.insert(field.name);
        for (const Pass& pass : static_cast<const Solver&>(*solver).passes().list())
            if (pass.calls > 0) passes.insert(pass.name);
    }
    FieldSet fields_of() const { return static_cast<const Solver&>(*solver).fields(); }
    static long allocations_so_far() { return test::allocations(); }
};

Names set_of(const std::vector<std::string>& list) { return {list.begin(), list.end()}; }
Names minus(const Names& a, const Names& b) {
    Names left;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(left, left.end()));
    return left;
}
std::string text(const Names& names) { return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")); }

/// Small enough for the plain scene and for every effect at negligible strength.
real common_dt(const scene::SolverKind& kind, const scene::Scene& plain) {
    return 0.2 * std::min(kind.make(plain, {})->advised_dt(), 1.0);  // some solvers are stable for any
}

/// Whether the fields that both have hold the same numbers; +0 and -0 are the same number.
bool same_numbers(const Watched& a, const Watched& b) {
    const FieldSet left = a.fields_of(), right = b.fields_of();
    for (const FieldView& field : left.fields) {
        const FieldView* other = right.find(field.set, field.name);
        for (std::size_t c = 0; other && c < field.data.size(); ++c)
            if (!std::equal(field.data[c].begin(), field.data[c].end(), other->data[c].begin(), other->data[c].end())) return false;
    }
    return true;
}

class Audit {
public:
    explicit Audit(std::string what) : what_(std::move(what)) {}
    template <class... Args>
    void check(bool holds, fmt::format_string<Args...> says, Args&&... args) {
        if (!holds) findings_.push_back(what_ + ": " + fmt::format(says, std::forward<Args>(args)...));
    }
    void same(const char* of, const Names& found, const Names& declared) {
        check(found == declared, "{}: found {}; declared {}", of, text(found), text(declared));
    }
    Findings findings() const { return findings_; }

private:
    std::string what_;
    Findings findings_;
};

/// Visible fields and passes that the declared plans bring to a step. A first carried field brings the pass that carries fields.
Names fields_of(const std::vector<EffectPlan>& plans) {
    Names names;
    for (const EffectPlan& p : plans)
        for (const auto* list : {&p.fields, &p.shown}) names.insert(list->begin(), list->end());
    return names;
}
Names passes_of(const std::vector<EffectPlan>& plans) {
    Names names;
    for (const EffectPlan& p : plans) {
        if (!p.pass.empty()) names.insert(p.pass);
        if (!p.fields.empty()) names.insert("advect fields");
    }
    return names;
}

void check_memory(Audit& audit, const Watched& with, const Watched& without, const EffectPlan& plan) {
    const long told = static_cast<long>(with.solver->bytes()) - static_cast<long>(without.solver->bytes());
    const long held = with.held - without.held;
    const std::size_t shared = plan.fields.size() + plan.scratch.size();
    if (shared == 0)
        audit.check(told == static_cast<long>(plan.bytes), "the solver tells of {} bytes more, the effect declares {}", told, plan.bytes);
    else
        audit.check(told > static_cast<long>(plan.bytes), "the effect asks for {} fields, the solver tells of {} bytes more", shared, told);
    audit.check(std::abs(held - told) < small_change, "the heap holds {} bytes more, the solver tells of {}", held, told);
}

/// At strength zero, where that is allowed: a warning, and the same numbers.
void check_zero(Audit& audit, const scene::SolverKind& kind, int dim, const scene::Variant& effect, const Watched& without, real dt) {
    if (effect.strength.empty()) return;
    try {
        const Watched zero(kind, scene_with(kind, dim, cells_along(dim), {effect.name}, 0), dt);
        audit.check(scene::idle_effects(zero.scene, kind.schema) == std::vector<std::string>{effect.name}, "strength zero goes unremarked");
        // without.scene has another fluid.viscosity where that is the strength: nothing there may read it
        audit.check(same_numbers(without, zero), "strength zero changes numbers");
    } catch (const scene::BadScene& refused) {
        audit.check(std::string(refused.what()).find("greater than 0") != std::string::npos, "{}", refused.what());
    }
}

/// All other effects at once: nothing of this one is there.
void check_among_others(Audit& audit, const scene::SolverKind& kind, int dim, const std::string& effect, real dt) {
    std::vector<std::string> others;
    for (const scene::Variant& v : kind.schema.effects)
        if (v.name != effect) others.push_back(v.name);
    if (others.empty()) return;
    const Watched rest(kind, scene_with(kind, dim, cells_along(dim), others, negligible), dt);
    const auto plans = rest.solver->effects();
    audit.check(std::none_of(plans.begin(), plans.end(), [&](const EffectPlan& p) { return p.name == effect; }),
                "built though only others are named");
    audit.same("fields of all others", minus(rest.fields, set_of(kind.plain.fields)), fields_of(plans));
    audit.same("passes of all others", minus(rest.passes, set_of(kind.plain.passes)), passes_of(plans));
}

}  // namespace

Findings audit_plain(const scene::SolverKind& kind, int dim) {
    Audit audit(fmt::format("{} {}D", kind.schema.name, dim));
    const scene::Scene scene = plain_scene(kind, dim, cells_along(dim));
    const Watched plain(kind, scene, common_dt(kind, scene));
    audit.same("fields", plain.fields, set_of(kind.plain.fields));
    audit.same("passes", plain.passes, set_of(kind.plain.passes));
    audit.check(plain.solver->effects().empty(), "effects are built that no scene names");
    return audit.findings();
}

Findings audit_effect(const scene::SolverKind& kind, int dim, const std::string& name) {
    Audit audit(fmt::format("{} {}D, effect {}", kind.schema.name, dim, name));
    const auto effect =
        *std::find_if(kind.schema.effects.begin(), kind.schema.effects.end(), [&](const auto& v) { return v.name == name; });
    const scene::Scene scene = plain_scene(kind, dim, cells_along(dim), {name});
    const real dt = common_dt(kind, scene);
    const Watched without(kind, scene, dt), with(kind, scene_with(kind, dim, cells_along(dim), {name}, negligible), dt);

    const auto plans = with.solver->effects();
    audit.check(plans.size() == 1 && plans[0].name == name, "named, but the solver built {} effects", plans.size());
    if (plans.size() != 1) return audit.findings();
    audit.check(plans[0].pass.empty() != plans[0].inside.empty(), "an effect is a pass or a term of one");
    audit.same("fields", minus(with.fields, without.fields), fields_of(plans));
    audit.same("passes", minus(with.passes, without.passes), passes_of(plans));
    audit.check(without.fields == set_of(kind.plain.fields), "not named, the fields are {}", text(without.fields));
    audit.check(without.passes == set_of(kind.plain.passes), "not named, the passes are {}", text(without.passes));
    audit.check(with.allocations <= without.allocations, "a step allocates {} times, {} without it", with.allocations, without.allocations);
    check_memory(audit, with, without, plans[0]);
    check_zero(audit, kind, dim, effect, without, dt);
    check_among_others(audit, kind, dim, name, dt);

    const Watched again(kind, scene, dt);  // nothing stays behind of an effect that was used before
    audit.check(
        again.solver->bytes() == without.solver->bytes() && again.allocations == without.allocations && same_numbers(again, without),
        "a scene without it is another after one with it");
    return audit.findings();
}

}  // namespace weir::test
