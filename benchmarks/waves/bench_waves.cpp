// Milliseconds a frame of an ocean of 512 x 512 points, from its waves to its surface, on one thread and two; and what each part of it
// costs.
//   bench_waves [--cells N] [--frames N]
#include "core/parallel.hpp"
#include "waves/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

using namespace weir;

namespace {

struct Ocean {
    const char* name;
    const char* waves;
    const char* effects;
};
constexpr Ocean oceans[] = {{"height", "velocity = false", ""},
                            {"height and velocity", "velocity = true", ""},
                            {"choppy, with its Jacobian", "velocity = false, choppiness = 1.0", ""},
                            {"choppy, with foam", "velocity = false, choppiness = 1.0", "effects.foam = {}\n"},
                            {"all of it", "velocity = true, choppiness = 1.0", "effects.foam = {}\n"},
                            {"all of it, 50 m deep", "velocity = true, choppiness = 1.0, depth = 50.0", "effects.foam = {}\n"}};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median_ms(Solver& solver, int frames) {
    std::vector<double> times;
    for (int f = 0; f < frames; ++f) {
        const double start = now();
        solver.step(1.0 / 24);
        times.push_back(1e3 * (now() - start));
    }
    std::nth_element(times.begin(), times.begin() + frames / 2, times.end());
    return times[static_cast<std::size_t>(frames / 2)];
}

int value_of(int argc, char** argv, const char* option, int fallback) {
    for (int i = 1; i + 1 < argc; ++i)
        if (std::strcmp(argv[i], option) == 0) return std::max(1, std::atoi(argv[i + 1]));
    return fallback;
}

}  // namespace

int main(int argc, char** argv) {
    const int cells = value_of(argc, argv, "--cells", 512), frames = value_of(argc, argv, "--frames", 30);
    const auto kind = waves::kind();
    const std::vector<scene::SolverSchema> schemas{kind.schema};
    fmt::print("an ocean of {0} x {0} points: median milliseconds of {1} frames\n", cells, frames);
    fmt::print("{:<28} {:>10} {:>10} {:>10} {:>12} {:>12}\n", "", "making it", "1 thread", "2 threads", "MB", "bytes/point");
    for (const Ocean& ocean : oceans) {
        const std::string text = fmt::format(
            "solver = \"waves\"\ndim = 3\ngrid = {{ cells = [{0}, 1, {0}], size = [500.0, 20.0, 500.0], origin = [0.0, -10.0, 0.0] }}\n"
            "time = {{ end = 100.0 }}\neffects.gravity = {{ g = [0.0, -9.81, 0.0] }}\n{2}waves = {{ model = \"spectrum\", spectrum = {{ "
            "kind "
            "= \"pierson_moskowitz\", wind = 12.0 }}, {1} }}\n",
            cells, ocean.waves, ocean.effects);
        const double start = now();
        const auto solver = kind.make(scene::parse(text, ocean.name, schemas), {});
        const double made = 1e3 * (now() - start);
        std::vector<double> ms;
        for (const int count : {1, 2}) {
            set_threads(count);
            ms.push_back(median_ms(*solver, frames));
        }
        set_threads(0);
        const auto bytes = static_cast<double>(solver->bytes());
        fmt::print("{:<28} {:>10.0f} {:>10.2f} {:>10.2f} {:>12.1f} {:>12.0f}\n", ocean.name, made, ms[0], ms[1], 1e-6 * bytes,
                   bytes / cells / cells);
    }
}
