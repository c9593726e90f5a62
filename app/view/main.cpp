// weir-view: the program behind `weir view`. A program of its own, so that a run without a window loads no window system.
#include "app/run_folder.hpp"
#include "app/view/display.hpp"
#include "app/view/viewer.hpp"
#include "core/error.hpp"

#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

namespace {

struct Arguments {
    std::string result, png, field;
    double time = -1;
    weir::view::Options options;
};

int view(const Arguments& arguments) {
    weir::view::Options options = arguments.options;
    weir::view::Series series(arguments.result);
    auto scene = weir::app::scene_of_run(arguments.result);
    options.field = arguments.field;
    options.offscreen = !arguments.png.empty();
    options.grabs = arguments.result;
    if (options.offscreen || arguments.time >= 0) options.first = weir::app::frame_at(series.times(), arguments.time);
    weir::view::need_display();
    weir::view::Viewer viewer(std::move(series), std::move(scene), options);
    if (!options.offscreen) {
        viewer.interact();
        return weir::exit_success;
    }
    viewer.write(arguments.png);
    std::printf("%s\n", arguments.png.c_str());
    return weir::exit_success;
}

}  // namespace

int main(int argc, char** argv) {
    Arguments arguments;
    CLI::App app(
        "Show the frames of a run in a window: space plays, arrows step, c selects the next field, w shows particles, grid or both, a fits "
        "the colour scale, r resets the camera, g saves a picture, q closes",
        "weir view");
    app.add_option("result", arguments.result, "Output folder of a run")->required();
    app.add_option("--png", arguments.png, "Draw one frame into this file and open no window");
    app.add_option("--field", arguments.field, "speed, smoke, pressure, density, ... (default: chosen by the solver)");
    app.add_option("--time", arguments.time, "Time of the first frame [s] (default: the first; with --png the last)");
    app.add_option("--width", arguments.options.width, "Pixels")->check(CLI::Range(64, 8192));
    app.add_option("--height", arguments.options.height, "Pixels")->check(CLI::Range(64, 8192));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? weir::exit_success : weir::exit_bad_input;
    }
    try {
        return view(arguments);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return weir::exit_bad_input;
    }
}
