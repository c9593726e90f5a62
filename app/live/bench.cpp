#include "app/live/bench.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"

#include <charconv>
#include <cstdio>

#include <fmt/format.h>

namespace weir::live {

namespace {

struct Row {
    std::string name, scene;
    std::vector<scene::Override> set;
};

double seconds_of(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string_view unit(end, static_cast<std::size_t>(text.data() + text.size() - end));
    if (error != std::errc() || !(value > 0) || (unit != "s" && !unit.empty()))
        throw BadInput(fmt::format("--bench {}: expected a time with its unit, such as 10s", text));
    return value;
}

/// The sizes that the report tells of, and what larger blocks in 3D reach.
std::vector<Row> rows_of_report(const std::string& folder) {
    const auto block = [](int x, int y) { return fmt::format("[{{ shape = \"box\", min = [0, 0], max = [{}, {}] }}]", x, y); };
    const auto cube = [](int n) {
        return std::vector<scene::Override>{
            {"grid.cells", fmt::format("[{}, {}, {}]", 3 * n, 2 * n, n)},
            {"grid.size", fmt::format("[{}, {}, {}]", 3 * n, 2 * n, n)},
            {"liquid", fmt::format("[{{ shape = \"box\", min = [0, 0, 0], max = [{}, {}, {}] }}]", n, n, n)}};
    };
    return {{"PBF 2D, 400 particles", folder + "/pbf.toml", {}},
            {"PBF 2D, 800 particles", folder + "/pbf.toml", {{"liquid", block(20, 40)}}},
            {"PBF 2D, 8,000 particles",
             folder + "/pbf.toml",
             {{"grid.cells", "[300, 80]"}, {"grid.size", "[300, 80]"}, {"liquid", block(100, 80)}}},
            {"PBF 3D, 4,000 particles, 8 iterations", folder + "/pbf_3d.toml", {}},
            {"PBF 3D, 32,768 particles, 8 iterations", folder + "/pbf_3d.toml", cube(32)},
            {"PBF 3D, 125,000 particles, 8 iterations", folder + "/pbf_3d.toml", cube(50)},
            {"smoke, 200 x 100 cells", folder + "/smoke.toml", {{"grid.cells", "[200, 100]"}}},
            {"water, 128 x 64 cells", folder + "/water.toml", {{"grid.cells", "[128, 64]"}, {"grid.size", "[2, 1]"}}}};
}

void measure(const Row& row, double seconds, WindowOptions options, bool json) {
    options.warm_up = 1;  // shaders are compiled, the window is shown

    Session session(endless(row.scene, row.set), "out/bench_live");

    Window window(session, options);
    window.interact(options.warm_up + seconds);
    window.stop();
    const FrameCosts& c = window.costs();
    const double frames = std::max(1, c.frames);
    if (json) {
        std::printf("{\"frames_a_second\": %.6g, \"steps_a_second\": %.6g, \"step_ms\": %.6g, \"copy_ms\": %.6g, \"draw_ms\": %.6g}\n",
                    c.frames / c.seconds, static_cast<double>(c.steps) / c.seconds, c.step_ms / frames, c.transfer_ms / frames,
                    c.drawing_ms / frames);
        return;
    }
    std::printf("%-42s %9.1f %9.1f %10.2f %10.2f %10.2f %10.2f %9.2f\n", row.name.c_str(), c.frames / c.seconds,
                static_cast<double>(c.steps) / c.seconds, c.step_ms / frames, c.transfer_ms / frames, c.drawing_ms / frames,
                1e3 * c.cpu_seconds / frames, c.simulated / c.seconds);
    std::fflush(stdout);
}

}  // namespace

int bench(const std::string& time, const std::string& scene, const std::vector<scene::Override>& set, const std::string& report_table,
          const WindowOptions& options, bool json) {
    const double seconds = seconds_of(time);
    if (scene.empty() && report_table.empty())
        throw BadInput("weir live --bench requires a scene: the folder of the report's scenes was not found");
    const auto rows = scene.empty() ? rows_of_report(report_table) : std::vector<Row>{{scene, scene, set}};
    if (json && scene.empty()) throw BadInput("weir live --bench --json requires a scene");
    if (json) return measure(rows.front(), seconds, options, json), exit_success;
    std::printf("%d x %d pixels, simulation on %d threads, %s\n", options.width, options.height, threads(),
                options.real_time ? "at most in real time" : "as fast as possible");
    std::printf("%-42s %9s %9s %10s %10s %10s %10s %9s\n", "scene", "frames/s", "steps/s", "step [ms]", "copy [ms]", "draw [ms]",
                "CPU [ms]", "real time");
    for (const Row& row : rows) measure(row, seconds, options, json);
    return exit_success;
}

}  // namespace weir::live
