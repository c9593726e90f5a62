// Steers a run: builds a scene in code, observes frames and every fifth step, changes a key, edits a field and markers, and reads a probe
// as an array.
#include <weir/sim/registry.hpp>
#include <weir/sim/simulation.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using weir::scene::Builder;

int main() try {
    // A pond, equivalent to a scene file and checked by the same schema.
    Builder scene;
    scene.set("solver", "mac_water").set("dim", std::int64_t{2}).set("grid.cells", {48, 48}).set("grid.size", {1, 1}).set("time.end", 0.6);
    scene.set("effects.gravity.g", {0, -9.81}).set("output.every", 0.1);
    scene.add("liquid", Builder().set("shape", "box").set("min", {0, 0}).set("max", {1, 0.3}));
    scene.add("probes", Builder().set("name", "level").set("kind", "gauge").set("at", {0.5, 0}));
    weir::Simulation simulation(scene.scene(weir::sim::schemas()));

    // At frame 1 adds a drop, at frame 2 accelerates the water to the right, at frame 3 sets the gravity of the moon.
    simulation.observe_frames([](weir::Simulation& run, const weir::StepReport& last) {
        std::printf("t = %.1f s, step %lld, dt = %.2g s\n", run.time(), static_cast<long long>(run.steps()), last.dt);
        if (run.frame() == 1) {
            std::vector<weir::Vec<3>> at, velocity;  // four markers are a cell of liquid [m], [m/s]
            for (int i = 0; i < 8; ++i)
                for (int j = 0; j < 8; ++j) at.push_back({{0.45 + i / 96.0, 0.6 + j / 96.0, 0}}), velocity.push_back({{0, -1, 0}});
            run.add_particles("markers", at, velocity);
        }
        if (run.frame() == 2)
            run.edit("velocity", [](weir::FieldEdit& u) {  // faces: one more along x, x fastest [m/s]
                for (double& along_x : u.data[0]) along_x += 0.2;
            });
        if (run.frame() == 3) run.set("effects.gravity.g", std::vector<double>{0, -1.6});
    });
    double longest = 0;
    simulation.observe_steps([&](weir::Simulation&, const weir::StepReport& last) { longest = std::max(longest, last.dt); }, 5);
    simulation.run_until(simulation.end_time());

    const std::vector<double> level = simulation.probe_series("level").column("height");  // [m], at probe_series("level").times
    const auto [low, high] = std::minmax_element(level.begin(), level.end());
    std::printf("the level was between %.3f m and %.3f m in %zu samples; the longest step seen took %.2g s\n", *low, *high, level.size(),
                longest);
    try {
        simulation.set("grid.cells", std::vector<double>{8, 8});
    } catch (const weir::BadInput& why) {
        std::printf("refused: %s\n", why.what());
    }
} catch (const weir::BadInput& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
