// weir picture RESULT: one frame, or a row of frames, of a finished (or running) run as PNG.
#include "app/commands.hpp"
#include "app/picture/draw.hpp"
#include "app/run_folder.hpp"
#include "core/error.hpp"
#include "output/read_frame.hpp"

#include <cmath>
#include <memory>

namespace weir::app {

namespace {

struct PictureArguments {
    std::string result, out, range;
    double time = -1;
    int sheet = 1;
    picture::Options options;
};

/// One frame, or `sheet` frames evenly spread over the run's times.
std::vector<std::size_t> frames_of(const std::vector<real>& times, const PictureArguments& arguments) {
    const std::size_t last = frame_at(times, arguments.time);
    if (arguments.sheet <= 1) return {last};
    std::vector<std::size_t> frames;
    for (int i = 0; i < arguments.sheet; ++i)
        frames.push_back(static_cast<std::size_t>(std::lround(static_cast<double>(last) * i / (arguments.sheet - 1))));
    return frames;
}

picture::Canvas row_of(const std::vector<picture::Canvas>& pictures) {
    constexpr int gap = 8;
    int width = -gap, height = 0;
    for (const auto& one : pictures) width += one.width() + gap, height = std::max(height, one.height());
    picture::Canvas row(width, height, picture::hex(0xffffff));
    int x = 0;
    for (const auto& one : pictures) row.paste(one, x, 0), x += one.width() + gap;
    return row;
}

int draw(const PictureArguments& arguments) {
    const std::filesystem::path folder = arguments.result;
    const scene::Scene scene = scene_of_run(folder);
    std::vector<picture::Canvas> pictures;
    for (const std::size_t number : frames_of(output::frame_times(folder), arguments))
        pictures.push_back(picture::draw_frame(folder, scene, number, arguments.options));
    const std::filesystem::path out = arguments.out.empty() ? folder / "picture.png" : std::filesystem::path(arguments.out);
    row_of(pictures).write(out);
    std::printf("%s\n", out.c_str());
    return exit_success;
}

}  // namespace

void add_picture(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<PictureArguments>();
    CLI::App* picture = app.add_subcommand("picture", "Draw a frame of a run as PNG");
    picture->add_option("result", arguments->result, "Output folder of a run")->required();
    picture->add_option("--field", arguments->options.field,
                        "smoke, speed, vorticity (2D), temperature, pressure, ..., or water (default: chosen by the solver)");
    picture->add_option("--time", arguments->time, "Time of the frame [s] (default: the last)");
    picture->add_option("--sheet", arguments->sheet, "Number of frames drawn side by side, from the first to --time")
        ->check(CLI::Range(1, 20));
    picture->add_option("--range", arguments->range,
                        "HIGH or LOW,HIGH: values of the highest and the lowest colour (default: the frame's own)");
    picture
        ->add_option("--surface", arguments->options.surface,
                     "Surface reconstruction of a liquid, with --quality or in 2D (default: that of the scene)")
        ->check(CLI::IsMember({"zhu_bridson", "anisotropic", "density", "level_set"}));
    picture->add_option("--size", arguments->options.size, "Pixels of the longer side (default: 900; 1280 with --quality)")
        ->check(CLI::Range(32, 8192));
    picture->add_flag("--grid", arguments->options.grid, "Draw the cells that contain liquid, tall cells in their true height (2D)");
    picture->add_flag("--quality", arguments->options.quality, "Ray-traced: refraction, reflection, a sky, a floor (3D; 16 to 9)");
    picture->add_option("--out", arguments->out, "File to write (default: RESULT/picture.png)");
    picture->callback([arguments, &exit_code] {
        if (!arguments->range.empty()) arguments->options.range = picture::range_of(arguments->range);
        exit_code = draw(*arguments);
    });
}

}  // namespace weir::app
