// weir-live: the program behind `weir live`. A program of its own, so that a run without a window loads no window system.
#include "app/live/bench.hpp"
#include "app/live/window.hpp"
#include "app/view/display.hpp"
#include "core/error.hpp"
#include "core/parallel.hpp"
#include "output/atomic_file.hpp"
#include "output/folder_lock.hpp"
#include "sim/registry.hpp"

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

namespace {

struct Arguments {
    std::string scene, out, bench, report_table;
    std::vector<std::string> set;
    int threads = 0;
    weir::live::WindowOptions window;
    bool fast = false, json = false;
};

/// "cases/plume" and "cases/plume/scene.toml" are both called plume.
std::filesystem::path folder_of(const Arguments& arguments, const weir::scene::Scene& scene) {
    if (!arguments.out.empty()) return arguments.out;
    const std::filesystem::path path = std::filesystem::path(scene.file()).lexically_normal();
    const auto name = path.stem() == "scene" && path.has_parent_path() ? path.parent_path().filename() : path.stem();
    return std::filesystem::path("out") / (name.string() + "_live");
}

int live(Arguments arguments) {
    if (arguments.threads > 0) weir::set_threads(arguments.threads);
    std::vector<weir::scene::Override> overrides;
    for (const auto& text : arguments.set) overrides.push_back(weir::scene::to_override(text));
    weir::view::need_display("weir live");
    arguments.window.real_time = !arguments.fast;
    if (!arguments.bench.empty())
        return weir::live::bench(arguments.bench, arguments.scene, overrides, arguments.report_table, arguments.window, arguments.json);
    if (arguments.scene.empty())
        throw weir::BadInput("weir live requires a scene (a file, a folder with a scene.toml, or the name of a case)");
    const auto scene = weir::live::endless(arguments.scene, overrides);
    const auto folder = folder_of(arguments, scene);
    weir::output::require_writable(folder);
    const weir::output::FolderLock lock(folder);
    weir::live::Session session(scene, folder);
    weir::live::Window window(session, arguments.window);
    window.interact();
    window.stop();
    const auto file = session.finish();
    std::printf("%s\nto repeat it without a window: weir run %s\n", file.c_str(), file.c_str());
    return weir::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app(
        "Run a scene in a window and apply forces to the fluid with the mouse (interactive forcing). F1 shows the keys. The session is "
        "saved as a scene.",
        "weir live");
    app.add_option("scene", arguments.scene, "A scene file, a folder with a scene.toml, or the name of a case");
    app.add_option("--out", arguments.out, "Folder of session.toml, checkpoints and pictures (default: out/<name of the scene>_live)");
    app.add_option("--set", arguments.set, "Override a key: --set grid.cells=[64,64]; may be repeated")->allow_extra_args(false);
    app.add_option("--threads", arguments.threads, "Number of threads of the simulation")->check(CLI::Range(1, 1024));
    app.add_option("--field", arguments.window.field, "Field shown as colour: speed, smoke, pressure, ...");
    app.add_flag("--paused", arguments.window.paused, "Start paused");
    app.add_flag("--fast", arguments.fast, "Run as fast as possible instead of at most in real time");
    app.add_option("--bench", arguments.bench,
                   "Measure frames per second for this time, such as 10s, of the scene or of the earlier report's scenes");
    app.add_flag("--json", arguments.json, "With --bench and a scene: print the values as JSON");
    app.add_option("--report-table", arguments.report_table, "Folder of the earlier report's scenes")->group("");
    app.add_option("--width", arguments.window.width, "Pixels")->check(CLI::Range(64, 8192));
    app.add_option("--height", arguments.window.height, "Pixels")->check(CLI::Range(64, 8192));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? weir::exit_success : weir::exit_bad_input;
    }
    try {
        return live(arguments);
    } catch (const weir::NumericalFailure& failure) {
        std::fprintf(stderr, "%s\n", failure.what());
        return weir::exit_numerical_failure;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return weir::exit_bad_input;
    }
}
