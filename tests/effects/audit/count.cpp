// Instructions of a step with and without each effect of each solver in the registry, by callgrind (count.sh runs this program under it).
// A step without an effect executes no more than one with it does outside the effect's own passes, within a thousandth: what is left is the
// plain solver's step; an effect that takes the place of a part of the plain step is compared beside another that does. An effect that is a
// term of another pass must make that pass more expensive where it is named; one that changes numbers which are found as the scene is read
// must not. A plain step costs the same after every effect has been used as before. Not covered: what an effect does to others by moving
// the fluid: steps are too short for that.
#include "core/parallel.hpp"
#include "effects/audit/instructions.hpp"
#include "effects/audit/leaks.hpp"
#include "parallel/partition.hpp"
#include "sim/registry.hpp"
#include "validation/cost/effect_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstring>

namespace {

using namespace weir;
using test::Instructions;
using test::total;

constexpr real tolerance = 1e-3;  // a test once a pass whether an effect is there is far below it, work for each cell far above
constexpr int warm_up = 2;
/// Of the step that a solver advises. What others have to do depends on where the fluid is: volume control, in a fifth of that step, moves
/// the surface of this coarse water so far that a hundredth fewer faces are carried.
constexpr real part_of_step = 0.002;
constexpr int cells_along(int dim) { return dim == 2 ? 24 : 8; }

struct Step {
    Instructions counts;
    std::vector<EffectPlan> plans;
};

Step counted_step(const scene::SolverKind& kind, const scene::Scene& scene, real dt) {
    const auto solver = kind.make(scene, {});
    for (int i = 0; i < warm_up; ++i) solver->step(dt);
    auto plans = solver->effects();
    return {test::instructions_of_step(*solver, dt), std::move(plans)};
}

real short_step(const scene::SolverKind& kind, const scene::Scene& plain) {
    return part_of_step * std::min(kind.make(plain, {})->advised_dt(), 1.0);
}

long within(const Instructions& counts, const std::string& pass) { return counts.count(pass) ? counts.at(pass) : 0; }

struct Finding {
    long plain = 0, with = 0, own = 0;
    std::string what;  // empty: none
};

Finding compare(const Step& without, const Step& with, const EffectPlan& plan) {
    Finding f{total(without.counts), total(with.counts), 0, ""};
    if (!plan.pass.empty()) {
        f.own = within(with.counts, plan.pass) - within(without.counts, plan.pass);
        if (!plan.fields.empty()) f.own += within(with.counts, "advect fields") - within(without.counts, "advect fields");
        const long rest = f.with - f.own;
        if (static_cast<real>(f.plain - rest) > tolerance * static_cast<real>(f.plain))
            f.what = fmt::format("a step without it executes {}, one with it only {} outside its own passes", f.plain, rest);
        else if (f.own <= 0)
            f.what = "its own pass executes nothing more";
    } else {
        f.own = within(with.counts, plan.inside) - within(without.counts, plan.inside);
        if (plan.at_start) {
            if (static_cast<real>(std::abs(f.with - f.plain)) > tolerance * static_cast<real>(f.plain))
                f.what = fmt::format("a step without it executes {}, one with it {}, and it is to change numbers alone", f.plain, f.with);
        } else if (f.own <= 0)
            f.what = fmt::format("pass {} executes as much without it", plan.inside);
    }
    return f;
}

/// The passes that execute otherwise beside an effect, to look into a finding.
void show_passes(const Step& without, const Step& with) {
    for (const auto& [pass, n] : with.counts)
        if (n != within(without.counts, pass)) std::printf("    %-26s %20ld %10ld\n", pass.c_str(), within(without.counts, pass), n);
}

/// Effects that take the place of something that a plain step has: in mac_water both end the conserved volume fractions of cells, so that a
/// step with one of them executes less than a plain one. Each is compared beside the other, where neither step has the fractions.
std::vector<std::string> beside(const std::string& solver, const std::string& effect) {
    if (solver != "mac_water") return {};
    if (effect == "surface_tension") return {"volume_control"};
    if (effect == "volume_control") return {"surface_tension"};
    return {};
}

/// The effect's comparison with a step of the same scene without it.
Finding compare(const scene::SolverKind& kind, int dim, const std::string& effect, Step& without, Step& with) {
    std::vector<std::string> others = beside(kind.schema.name, effect), both = others;
    both.push_back(effect);
    const auto plain = others.empty() ? validation::plain_scene(kind, dim, cells_along(dim), {effect})
                                      : validation::scene_with(kind, dim, cells_along(dim), others, validation::negligible);
    const real dt = short_step(kind, plain);
    without = counted_step(kind, plain, dt);
    with = counted_step(kind, validation::scene_with(kind, dim, cells_along(dim), both, validation::negligible), dt);
    const auto plan = std::find_if(with.plans.begin(), with.plans.end(), [&](const EffectPlan& p) { return p.name == effect; });
    if (with.plans.size() != both.size() || plan == with.plans.end()) return {0, 0, 0, "is not built alone"};
    return compare(without, with, *plan);
}

/// Findings of one solver; each line of the table is printed.
int audit(const scene::SolverKind& kind, int dim) {
    int findings = 0;
    std::vector<std::string> all;
    for (const auto& effect : kind.schema.effects) {
        all.push_back(effect.name);
        Step without, with;
        const Finding f = compare(kind, dim, effect.name, without, with);
        std::printf("%-10s %dD %-20s %10ld %10ld %10ld  %s\n", kind.schema.name.c_str(), dim, effect.name.c_str(), f.plain, f.with, f.own,
                    f.what.empty() ? "holds" : f.what.c_str());
        if (!f.what.empty()) show_passes(without, with);
        findings += !f.what.empty();
    }
    // a plain step again, after every effect has been used in this program
    const auto plain = validation::plain_scene(kind, dim, cells_along(dim));
    const real dt = short_step(kind, plain);
    const long before = total(counted_step(kind, plain, dt).counts);
    {
        const auto used = kind.make(validation::scene_with(kind, dim, cells_along(dim), all, validation::negligible), {});
        used->step(0.01 * dt);
    }
    const long after = total(counted_step(kind, plain, dt).counts);
    const bool same = std::abs(after - before) <= tolerance * static_cast<real>(before);
    std::printf("%-10s %dD %-20s %10ld %10ld %10d  %s\n", kind.schema.name.c_str(), dim, "(after all)", before, after, 0,
                same ? "holds" : "a plain step executes more once effects were used");
    return findings + !same;
}

/// The count must be able to find what it is for.
int show_that_it_can_fail() {
    const int none = audit(test::leaky_kind(test::Leak::none), 2), work = audit(test::leaky_kind(test::Leak::work), 2);
    const bool shown = none == 0 && work > 0;
    std::printf("%s\n", shown ? "an honest effect passes, one whose work is always done is found: as it must be"
                              : "MISTAKE: the count does not tell an honest effect from one whose work is always done");
    return !shown;
}

}  // namespace

int main() {
    if (!test::counted()) {
        std::fprintf(stderr, "runs under callgrind only: tests/effects/audit/count.sh\n");
        return 2;
    }
    set_threads(1);
    std::printf("%-10s %-2s %-20s %10s %10s %10s\n", "solver", "", "effect", "without", "with", "its own");
    int findings = show_that_it_can_fail();
    for (const int dim : {2, 3})
        for (const auto& kind : sim::registry())
            if (std::count(kind.schema.dims.begin(), kind.schema.dims.end(), dim) > 0 && !kind.schema.effects.empty())
                findings += audit(kind, dim);
    std::printf("%d findings\n", findings);
    return findings > 0;
}
