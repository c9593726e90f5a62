// Every scene of every case, described in other ways, gives the same physics.
#include "metamorphic/properties.hpp"
#include "metamorphic/small_scenes.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

using namespace weir;
using namespace weir::metamorphic;

TEST("what must not change does not") {
    const char* only = std::getenv("WEIR_METAMORPHIC");
    const auto clock = [] { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); };
    const double t0 = clock();
    const auto scenes = small_scenes(std::filesystem::path(WEIR_SOURCE_DIR) / "cases");
    fmt::print("{} scenes, {:.1f} s\n", scenes.size(), clock() - t0);
    int checked = 0, skipped = 0, violated = 0;
    for (const auto& [name, scene] : scenes) {
        if (only && name.find(only) == std::string::npos) continue;
        const double t1 = clock();
        Simulation simulation(scene);
        const int steps = 10;
        const Base base{scene, simulation.scene(), run_steps(simulation, steps), steps};
        const double t2 = clock();
        std::string line;
        for (const Property& p : properties()) {
            try {
                const Outcome o = p.check(base);
                const real bound = p.bound(base);
                ++checked;
                const bool bad = !(o.equal.value <= bound) && !(o.alike && o.alike->value <= alike_bound);
                violated += bad;
                line += fmt::format("  {:12} {} {:9.2e} {}", p.name, bad ? "VIOLATED" : "ok      ", o.equal.value, o.equal.what);
                line += o.alike ? fmt::format("; alike {:9.2e} {}\n", o.alike->value, o.alike->what) : "\n";
            } catch (const Untransformable& why) {
                ++skipped;
                if (only) line += fmt::format("  {:12} skipped  {}\n", p.name, why.what());
            } catch (const std::exception& e) {
                ++violated;
                line += fmt::format("  {:12} THROWS {}\n", p.name, e.what());
            }
        }
        fmt::print("{} {} base {:.3f} s all {:.3f} s\n{}", name, scene.solver(), t2 - t1, clock() - t1, line);
        std::fflush(stdout);
    }
    fmt::print("{} checked, {} skipped, {} violated, {:.1f} s\n", checked, skipped, violated, clock() - t0);
    EXPECT_EQ(violated, 0);
}
