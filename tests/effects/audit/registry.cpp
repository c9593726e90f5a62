// Only what a scene calls for, for every effect of every solver in the registry. A new one is audited by being registered.
// Not covered: work that a plain step does for the sake of an effect inside a pass of its own, with no field, byte or allocation for it:
// count.cpp sees that.
#include "sim/registry.hpp"
#include "core/parallel.hpp"
#include "effects/audit/audit.hpp"
#include "effects/audit/heap.hpp"
#include "effects/audit/leaks.hpp"
#include "parallel/partition.hpp"
#include "support/test.hpp"
#include "validation/cost/effect_scene.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace weir::test {
namespace {

std::string lines(const Findings& findings) { return fmt::format("{}", fmt::join(findings, "\n")); }

std::string leak_found(Leak leak) {
    const auto kind = leaky_kind(leak);
    return lines(audit_plain(kind, 2)) + lines(audit_effect(kind, 2, "extra"));
}

std::vector<scene::SolverKind> with_effects(int dim) {
    std::vector<scene::SolverKind> kinds;
    for (const auto& kind : sim::registry())
        if (std::count(kind.schema.dims.begin(), kind.schema.dims.end(), dim) > 0 && !kind.schema.effects.empty()) kinds.push_back(kind);
    return kinds;
}

/// So many along each axis that a scene holds a megabyte; columns have one along y.
int cells_of(const scene::SolverKind& kind, int dim) {
    if (kind.schema.columns) return dim == 2 ? 16384 : 128;
    return dim == 2 ? 192 : 32;
}

}  // namespace

TEST_IN_2D_AND_3D("a step without effects is what the solver registers as plain") {
    set_threads(1);  // OpenMP's runtime allocates when it makes its threads
    for (const auto& kind : with_effects(D)) EXPECT_EQ(lines(audit_plain(kind, D)), "");
}

TEST_IN_2D_AND_3D("every effect costs nothing where it is not named, and is what it declares where it is") {
    set_threads(1);
    for (const auto& kind : with_effects(D))
        for (const auto& effect : kind.schema.effects) EXPECT_EQ(lines(audit_effect(kind, D, effect.name)), "");
}

// The audit of an effect compares two solvers, in which what both hold cancels: here every byte of the heap has to be told of. Names, small
// objects and what the allocator rounds up are left out, a hundredth of scenes that hold a megabyte and more.
TEST_IN_2D_AND_3D("a solver tells of every byte that it holds, with each effect and without") {
    set_threads(1);
    for (const auto& kind : with_effects(D)) {
        std::vector<std::vector<std::string>> scenes{{}};
        for (const auto& effect : kind.schema.effects) scenes.push_back({effect.name});
        for (const auto& effects : scenes) {
            const scene::Scene scene = validation::scene_with(kind, D, cells_of(kind, D), effects, validation::negligible);
            const long before = bytes_held();
            const auto solver = kind.make(scene, {});
            for (int s = 0; s < 2; ++s) solver->step(std::min(solver->advised_dt(), 1e-3));
            const long held = bytes_held() - before, told = static_cast<long>(solver->bytes());
            EXPECT_LT(std::abs(held - told), held / 100) << kind.schema.name << " with " << fmt::format("{}", fmt::join(effects, ", "))
                                                         << " holds " << held << " bytes and tells of " << told;
        }
    }
}

TEST("an honest effect passes the audit") { EXPECT_EQ(leak_found(Leak::none), ""); }

TEST("each way to leak is found, and said") {
    EXPECT_NE(leak_found(Leak::field).find("fields: found heat, velocity; declared velocity"), std::string::npos);
    EXPECT_NE(leak_found(Leak::pass).find("passes: found effect extra, move; declared move"), std::string::npos);
    EXPECT_NE(leak_found(Leak::allocation).find("a step allocates 1 times, 0 without it"), std::string::npos);
    EXPECT_NE(leak_found(Leak::hidden).find("the heap holds"), std::string::npos);
    EXPECT_NE(leak_found(Leak::other_bits).find("strength zero changes numbers"), std::string::npos);
    EXPECT_NE(leak_found(Leak::other_field).find("fields: found heat, other; declared heat"), std::string::npos);
}

TEST("an effect that a solver does not have is refused, and the solvers that have it are named") {
    for (const auto& kind : sim::registry())
        for (const auto& other : sim::registry())
            for (const auto& effect : other.schema.effects) {
                const auto& own = kind.schema.effects;
                if (std::any_of(own.begin(), own.end(), [&](const auto& v) { return v.name == effect.name; })) continue;
                try {
                    (void)scene::parse(fmt::format("solver = \"{}\"\neffects.{} = {{}}\n", kind.schema.name, effect.name), "scene.toml",
                                       sim::schemas());
                    ADD_FAILURE() << kind.schema.name << " takes " << effect.name;
                } catch (const scene::BadScene& refused) {
                    const std::string text = refused.what();
                    const auto said = text.find(fmt::format("solver \"{}\" has no effect \"{}\"; solver", kind.schema.name, effect.name));
                    ASSERT_NE(said, std::string::npos) << text;
                    EXPECT_NE(text.find('"' + other.schema.name + '"', said + 20 + kind.schema.name.size()), std::string::npos) << text;
                }
            }
}

}  // namespace weir::test
