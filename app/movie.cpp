// weir movie RESULT: every frame of a run as a picture, and the pictures as a film by ffmpeg, with a poster beside it. Of a scene the run
// is made first.
#include "app/commands.hpp"
#include "app/interrupt.hpp"
#include "app/picture/draw.hpp"
#include "app/run_folder.hpp"
#include "core/error.hpp"
#include "core/programs.hpp"
#include "output/atomic_file.hpp"
#include "output/image_file.hpp"
#include "output/read_frame.hpp"
#include "sim/registry.hpp"
#include "sim/run_id.hpp"
#include "validation/report/command.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include <stdlib.h>  // mkdtemp
#include <unistd.h>

namespace weir::app {

namespace {

struct MovieArguments {
    std::string result, out, range;
    std::vector<std::string> set;
    picture::Options options;
    int rate = 0;
    bool quiet = false;
};

/// Runs it; throws with its exit code where it fails.
void run_or_refuse(const std::vector<std::string>& words) {
    if (const int code = run_program(words); code != 0) throw OutputError(words[0] + " failed with exit code " + std::to_string(code));
}

/// A name within a pattern of names, where % begins a number.
std::string in_pattern(const std::string& name) {
    std::string all;
    for (const char c : name) all += c == '%' ? "%%" : std::string(1, c);
    return all;
}

/// VP9 for .webm, H.264 for everything else; both as every browser plays them, in even sizes.
std::vector<std::string> encoder(const std::filesystem::path& pictures, int rate, const std::filesystem::path& film) {
    std::vector<std::string> words{"ffmpeg",
                                   "-nostdin",
                                   "-loglevel",
                                   "error",
                                   "-y",
                                   "-framerate",
                                   std::to_string(rate),
                                   "-pattern_type",
                                   "sequence",
                                   "-i",
                                   "file:" + in_pattern(pictures.string()) + "/%06d.png",  // whatever it begins with, it is a file
                                   "-vf",
                                   "pad=ceil(iw/2)*2:ceil(ih/2)*2,scale=out_color_matrix=bt709:out_range=tv",
                                   "-pix_fmt",
                                   "yuv420p",
                                   "-colorspace",  // said, and not left to players to guess by the size
                                   "bt709",
                                   "-color_primaries",
                                   "bt709",
                                   "-color_trc",
                                   "iec61966-2-1",
                                   "-color_range",
                                   "tv"};
    const std::vector<std::string> vp9{"-c:v", "libvpx-vp9", "-crf", "30", "-b:v", "0"};
    const std::vector<std::string> h264{"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"};
    const auto& codec = film.extension() == ".webm" ? vp9 : h264;
    words.insert(words.end(), codec.begin(), codec.end());
    words.push_back("file:" + film.string());
    return words;
}

/// As fast as the water itself where that is a film at all: between 10 and 30 frames a second.
int usual_rate(const std::vector<real>& times) {
    const real interval = times.size() > 1 ? (times.back() - times.front()) / real(times.size() - 1) : 0;
    return interval > 0 ? static_cast<int>(std::clamp(1 / interval, 10.0, 30.0)) : 10;
}

/// The pictures of a film in the making and the film, in a new folder beside it: gone when it is made or has failed.
class Workshop {
public:
    explicit Workshop(const std::filesystem::path& film) : ending_(film.extension()) {
        std::string pattern = film.string() + ".XXXXXX";
        if (!mkdtemp(pattern.data())) throw OutputError("cannot create a folder beside " + film.string() + ": " + std::strerror(errno));
        folder_ = pattern;
    }
    ~Workshop() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;
    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path film() const { return folder_ / ("film" + ending_.string()); }
    std::filesystem::path picture(std::size_t frame) const {
        char name[32];
        std::snprintf(name, sizeof name, "%06zu.png", frame);
        return folder_ / name;
    }

private:
    std::filesystem::path folder_, ending_;
};

/// It takes its name when it is whole.
void move_to(const std::filesystem::path& made, const std::filesystem::path& name) {
    std::error_code failed;
    const auto target = std::filesystem::is_symlink(name, failed) ? std::filesystem::weakly_canonical(name, failed) : name;
    std::filesystem::rename(made, target, failed);
    if (failed == std::errc::cross_device_link) {  // the link leads there
        failed.clear();
        std::filesystem::copy_file(made, target, std::filesystem::copy_options::overwrite_existing, failed);
    }
    if (failed) throw OutputError("cannot write " + name.string() + ": " + failed.message());
}

constexpr const char* of_a_film = "weir movie";  // in the pictures of a film: its poster is one of them

/// The poster's name follows from the film's, which the user gave: what stands there already may be the user's.
std::filesystem::path poster_of(const std::filesystem::path& film) {
    std::filesystem::path poster = film;
    return poster.replace_extension(".png");
}
void refuse_foreign_poster(const std::filesystem::path& film) {
    const auto poster = poster_of(film);
    std::error_code ignored;
    if (std::filesystem::symlink_status(poster, ignored).type() == std::filesystem::file_type::not_found) return;
    if (std::filesystem::is_directory(poster, ignored) || output::was_made_as(poster, of_a_film)) return;
    throw BadInput(
        poster.string() + ": the poster of " + film.string() +
        " would overwrite this file, which is not the poster of an earlier movie: give the movie another name, or move the file");
}

void refuse_folder(const std::filesystem::path& file) {
    if (std::filesystem::is_directory(file)) throw BadInput(file.string() + ": this is a folder; give the name of a file");
}

void show(std::size_t done, std::size_t all, bool quiet) {
    if (quiet || !isatty(STDERR_FILENO)) return;
    constexpr int width = 30;
    const int filled = static_cast<int>(width * done / all);
    std::fprintf(stderr, "\r[%s%s] %zu of %zu frames", std::string(static_cast<std::size_t>(filled), '#').c_str(),
                 std::string(static_cast<std::size_t>(width - filled), '.').c_str(), done, all);
    if (done == all) std::fprintf(stderr, "\n");
}

/// The folder of a run, as it is named; where a scene is, or a case, that of its run, which is made before.
std::filesystem::path run_of(const MovieArguments& arguments) {
    const std::filesystem::path named = arguments.result;
    const bool is_scene = std::filesystem::is_regular_file(named) || std::filesystem::exists(named / "scene.toml");
    if (std::filesystem::exists(named) && (std::filesystem::exists(named / "run.json") || !is_scene)) {
        if (!arguments.set.empty()) throw BadInput("--set applies to a scene; " + named.string() + " is the folder of a run");
        return named;
    }
    const auto scene = validation::scene_named(arguments.result);
    const auto folder = std::filesystem::path("out") / sim::scene_name(scene::read(scene, sim::schemas(), {}));
    std::vector<std::string> words{std::filesystem::read_symlink("/proc/self/exe").string(), "run", file_argument(scene),
                                   "--out=" + folder.string()};
    for (const auto& change : arguments.set) words.push_back("--set=" + change);
    if (arguments.quiet) words.push_back("--quiet");
    run_or_refuse(words);
    return folder;
}

int film(const MovieArguments& arguments) {
    if (!has_program("ffmpeg"))
        throw BadInput("weir movie requires ffmpeg, which is not on the PATH: install it (Debian, Ubuntu: apt install ffmpeg)");
    const auto ending = std::filesystem::path(arguments.out).extension();
    if (!arguments.out.empty() && ending != ".mp4" && ending != ".webm")
        throw BadInput("--out " + arguments.out + ": expected a name that ends in .mp4 or .webm");
    if (!arguments.out.empty()) refuse_foreign_poster(arguments.out);
    const std::filesystem::path folder = run_of(arguments);
    const scene::Scene scene = scene_of_run(folder);
    const std::vector<real> times = output::frame_times(folder);
    const std::filesystem::path out = arguments.out.empty() ? folder / "movie.mp4" : std::filesystem::path(arguments.out);
    const std::filesystem::path poster = poster_of(out);
    refuse_folder(out), refuse_folder(poster);
    output::require_writable(out.has_parent_path() ? out.parent_path() : ".");
    catch_interrupts();
    const Workshop workshop(out);
    for (std::size_t frame = 0; frame < times.size(); ++frame) {
        if (interruptions() > 0) return exit_interrupted();
        show(frame, times.size(), arguments.quiet);
        picture::draw_frame(folder, scene, frame, arguments.options).write(workshop.picture(frame), of_a_film);
    }
    show(times.size(), times.size(), arguments.quiet);
    run_or_refuse(encoder(workshop.folder(), arguments.rate > 0 ? arguments.rate : usual_rate(times), workshop.film()));
    move_to(workshop.film(), out);
    move_to(workshop.picture(2 * (times.size() - 1) / 3), poster);  // two thirds through, when most is going on
    std::printf("%s\n%s\n", out.c_str(), poster.c_str());
    return exit_success;
}

}  // namespace

void add_movie(CLI::App& app, int& exit_code) {
    auto arguments = std::make_shared<MovieArguments>();
    CLI::App* movie = app.add_subcommand("movie", "Write all frames of a run as a movie (MP4 or WebM, by ffmpeg), with a poster");
    movie->add_option("result", arguments->result, "Output folder of a run; or a scene or a case, which is run first into out/<its name>")
        ->required();
    movie->add_option("--set", arguments->set, "For a scene: override a key")->type_name("KEY=VALUE")->allow_extra_args(false);
    movie->add_option(
        "--out", arguments->out,
        "File to write: .mp4 or .webm (default: RESULT/movie.mp4); the poster is written beside it unless another file has its name");
    movie->add_option("--field", arguments->options.field, "Field shown, as in weir picture");
    movie->add_option("--range", arguments->range,
                      "HIGH or LOW,HIGH: values of the highest and the lowest colour (default: each frame's own)");
    movie
        ->add_option("--surface", arguments->options.surface,
                     "Surface reconstruction of a liquid, with --quality or in 2D (default: that of the scene)")
        ->check(CLI::IsMember({"zhu_bridson", "anisotropic", "density", "level_set"}));
    movie->add_option("--size", arguments->options.size, "Pixels of the longer side (default: 900; 1280 with --quality)")
        ->check(CLI::Range(32, 8192));
    movie->add_flag("--quality", arguments->options.quality, "Ray-traced, as weir picture --quality");
    movie->add_option("--rate", arguments->rate, "Frames per second (default: the speed of the run, from 10 to 30)")
        ->check(CLI::Range(1, 120));
    movie->add_flag("--quiet", arguments->quiet, "No progress bar");
    movie->callback([arguments, &exit_code] {
        if (!arguments->range.empty()) arguments->options.range = picture::range_of(arguments->range);
        exit_code = film(*arguments);
    });
}

}  // namespace weir::app
