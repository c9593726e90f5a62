// The cost of PBF on an OpenCL device: milliseconds of each kernel by the device's own clock, for dam breaks in 2D and 3D from 8 thousand
// to 8 million particles, beside the copy bandwidth measured in the same run; two ways to sort them, a neighbour list beside cells, and
// sizes of work groups. Needs no scene, no VTK, no SuiteSparse: build.sh compiles it with a C++ compiler and OpenCL headers alone.
#include "benchmarks/gpu_particles/compare_pairs.hpp"
#include "benchmarks/gpu_particles/sorts.hpp"
#include "pbf/device_solver.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

using namespace weir;
using bench::Csv;

struct Arguments {
    int device = 0, steps = 20, warm_up = 5;
    std::vector<int> dims{2, 3}, iterations{4, 8};
    std::vector<double> particles{8e3, 128e3, 1e6, 8e6};
    std::vector<std::size_t> groups;  // sizes of work groups that the passes over pairs are repeated with
    double max_seconds = 120;         // a size that would take longer is skipped
    std::string csv = "gpu_particles.csv", command;
};

/// Seconds of one particle in one step, by the size measured before: what a larger one will take at least.
struct Pace {
    double seconds = 0, pairs = 0;  // of a step; of all that is done with the passes over pairs
    double estimate(const Arguments& a, double particles) const { return particles * (seconds * (a.steps + a.warm_up) + pairs); }
};

/// A block of liquid, two spacings wide for each high (in 3D as deep as high), in a closed box of three times its width and twice its
/// height.
template <int D>
particles::Fluid<D> dam_break(double wanted) {
    const int high = static_cast<int>(std::lround(D == 2 ? std::sqrt(wanted / 2) : std::cbrt(wanted / 2)));
    const real d = 1.0 / high;
    particles::Fluid<D> fluid;
    auto& box = fluid.domain;
    const Vec<D> size = D == 2 ? Vec<D>{6, 2} : [] {
        Vec<D> s{6, 2};
        s[D - 1] = D == 2 ? 2 : 1;
        return s;
    }();
    box.hi = size;
    box.spacing = d;
    box.margin = 1e-3 * d;
    for (int a = 0; a < D; ++a) box.keep_lo[a] = box.margin, box.keep_hi[a] = size[a] - box.margin;
    fluid.gravity[1] = -9.81;
    fluid.rho0 = 1000;
    fluid.mass = fluid.rho0 * particles::cell_volume<D>(d);
    for (int z = 0; z < (D == 2 ? 1 : high); ++z)
        for (int y = 0; y < high; ++y)
            for (int x = 0; x < 2 * high; ++x) {
                const int at[3] = {x, y, z};
                Vec<D> place{};
                for (int a = 0; a < D; ++a) place[a] = (at[a] + 0.5) * d;
                fluid.add(place, Vec<D>{});
            }
    return fluid;
}

/// Bytes that a kernel moves at least, of one particle: its own arrays once, neighbours once (they are shared by the cache), the list once.
/// n: the mean number of neighbours.
double bytes_of(const std::string& kernel, int dim, double n) {
    const double state = 8.0 * dim, list = 4 * n, four = 16;
    if (kernel == "predict") return 4 * state;
    if (kernel == "range") return state;
    if (kernel == "find_cells") return state + 8;
    if (kernel == "scatter") return 12;
    if (kernel == "sort_cells") return 8;
    if (kernel == "load_sorted") return 4 + state + 4 + four + 4;
    if (kernel == "find_neighbours") return four + 8 + list;
    if (kernel == "start_multipliers") return 4 + 8 + 2 * four + 4;
    if (kernel == "lambda") return list + 4 + 2 * four + 12;
    if (kernel == "correct") return list + 4 + 2 * four;
    if (kernel == "densities") return list + 4 + four + 4;
    if (kernel == "update") return 4 + four + 8 + 4 * state + 16;
    if (kernel == "pbf_compressions") return 4;
    if (kernel == "speeds") return 2 * state;
    return 0;
}

/// Bytes a second of reading and writing, of a kernel that copies.
double copy_bandwidth(int index) {
    const auto device = backend::open_device(index);
    device->compile(
        "__kernel void copy(__global const float4* from, __global float4* to) { to[get_global_id(0)] = from[get_global_id(0)]; }",
        "-cl-std=CL1.2");
    const std::size_t bytes = std::min<std::size_t>(std::size_t{256} << 20, device->info().largest / 4), items = bytes / 16;
    const auto from = device->alloc(bytes), to = device->alloc(bytes);
    device->fill_zero(from, bytes);
    device->fill_zero(to, bytes);
    double best = 0;
    for (int run = 0; run < 10; ++run) {
        device->launch("copy", items, 128, {from, to});
        best = std::max(best, 2.0 * static_cast<double>(bytes) / device->timings().front().seconds);
    }
    return best;
}

/// Steps of the solver: its passes by the device's clock, steps by the wall's. Returns the particles as they are then.
template <int D>
particles::Fluid<D> measure_steps(const Arguments& arguments, const pbf::Options& options, const particles::Fluid<D>& start, real dt,
                                  double bandwidth, Csv& csv, Pace& pace) {
    particles::DeviceEffects<D> effects;
    effects.gravity = true;
    effects.g = start.gravity;
    pbf::DevicePbfSolver<D> solver(options, start, effects);
    for (int s = 0; s < arguments.warm_up; ++s) solver.step(dt);
    solver.passes().reset();
    std::vector<double> ms;
    for (int s = 0; s < arguments.steps; ++s) {
        const auto begin = std::chrono::steady_clock::now();
        solver.step(dt);
        ms.push_back(1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    std::sort(ms.begin(), ms.end());
    const auto& device = solver.on_device();
    const double n = device.neighbour_counts().mean, count = device.count();
    csv.particles = count;
    double kernels = 0, moved = 0;
    for (const Pass& p : solver.passes().list()) {
        const double each = bytes_of(p.name, D, n) * count * static_cast<double>(p.calls), rate = p.seconds > 0 ? each / p.seconds : 0;
        const double time = 1e3 * p.seconds / arguments.steps;
        csv.row(p.name, static_cast<double>(p.calls) / arguments.steps, time, each / arguments.steps, rate / bandwidth);
        kernels += time, moved += each / arguments.steps;
    }
    const double median = ms[ms.size() / 2];
    pace.seconds = 1e-3 * median / count;
    csv.row("step", 1, median, moved, moved / (1e-3 * median) / bandwidth);
    std::printf(
        "%dD %9.0f particles %2d iterations: %9.3f ms a step (kernels %9.3f), %8.3g particles x iterations a second, %5.1f neighbours, "
        "%4zu bytes per particle, %4.1f%% of copy bandwidth\n",
        D, count, csv.iterations, median, kernels, count * csv.iterations / (1e-3 * median), n, device.plan().bytes_per_particle(),
        100 * moved / (1e-3 * median) / bandwidth);
    std::fflush(stdout);
    return device.host();
}

template <int D>
void measure(const Arguments& arguments, double wanted, int iterations, double bandwidth, std::FILE* file, Pace& pace) {
    if (pace.estimate(arguments, wanted) > arguments.max_seconds) {
        std::printf("%dD %9.0f particles %2d iterations: skipped, %.0f s at the pace of the size before, more than --max-seconds %g\n", D,
                    wanted, iterations, pace.estimate(arguments, wanted), arguments.max_seconds);
        return;
    }
    const auto start = dam_break<D>(wanted);
    pbf::Options options;
    options.backend.device = arguments.device;
    options.iterations = iterations;
    options.settle = 0;
    const real dt = 0.05 * start.domain.spacing;
    Csv csv{file, D, iterations, static_cast<double>(start.count())};
    const auto moved = measure_steps<D>(arguments, options, start, dt, bandwidth, csv, pace);
    pace.pairs = bench::compare_pairs<D>(arguments.groups, options, moved, dt, csv) / csv.particles;
}

void measure_sorts(const Arguments& arguments, std::FILE* file) {
    for (const double n : arguments.particles) {
        if (n > 2e6) continue;  // what it shows is shown
        const auto t = bench::compare_sorts(arguments.device, static_cast<int>(n));
        std::printf("sort %9.0f particles: bitonic %9.3f ms in %d launches, counting %9.3f ms\n", n, t.bitonic, t.launches, t.counting);
        const Csv csv{file, 0, 0, n};
        csv.row("bitonic_sort", t.launches, t.bitonic);
        csv.row("counting_sort", 1, t.counting);
    }
}

template <class T>
std::vector<T> numbers(const char* text) {
    std::vector<T> list;
    for (char* end = nullptr; *text; text = *end ? end + 1 : end) {
        list.push_back(static_cast<T>(std::strtod(text, &end)));
        if (end == text) break;
    }
    return list;
}

Arguments read(int argc, char** argv) {
    Arguments a;
    for (int i = 0; i < argc; ++i) a.command += (i ? " " : "") + std::string(i ? argv[i] : "gpu_particles");
    if (argc % 2 == 0) std::fprintf(stderr, "option %s needs a value\n", argv[argc - 1]), std::exit(2);
    for (int i = 1; i + 1 < argc; i += 2) {
        const std::string key = argv[i];
        const char* value = argv[i + 1];
        if (key == "--device")
            a.device = std::atoi(value);
        else if (key == "--steps")
            a.steps = std::max(1, std::atoi(value));
        else if (key == "--dims")
            a.dims = numbers<int>(value);
        else if (key == "--iterations")
            a.iterations = numbers<int>(value);
        else if (key == "--particles")
            a.particles = numbers<double>(value);
        else if (key == "--groups")
            a.groups = numbers<std::size_t>(value);
        else if (key == "--max-seconds")
            a.max_seconds = std::atof(value);
        else if (key == "--csv")
            a.csv = value;
        else
            std::fprintf(stderr, "unknown option %s\n", argv[i]), std::exit(2);
    }
    return a;
}

}  // namespace

int main(int argc, char** argv) try {
    const Arguments arguments = read(argc, argv);
    const auto devices = backend::devices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        std::printf("%c opencl:%zu %s, %s, driver %s, %d units, %zu MiB\n", static_cast<int>(i) == arguments.device ? '*' : ' ', i,
                    devices[i].name.c_str(), devices[i].version.c_str(), devices[i].driver.c_str(), devices[i].units,
                    devices[i].memory >> 20);
    const double bandwidth = copy_bandwidth(arguments.device);
    std::printf("copy: %.1f GB/s read and written\n", 1e-9 * bandwidth);
    std::FILE* csv = std::fopen(arguments.csv.c_str(), "w");
    if (!csv) return std::fprintf(stderr, "cannot write %s\n", arguments.csv.c_str()), 2;
    const auto& device = devices[static_cast<std::size_t>(arguments.device)];
    std::fprintf(csv, "# %s\n# %s, %s, driver %s, copy %.1f GB/s\n", arguments.command.c_str(), device.name.c_str(), device.version.c_str(),
                 device.driver.c_str(), 1e-9 * bandwidth);
    std::fprintf(csv, "dim,particles,iterations,kernel,calls_a_step,ms_a_step,bytes_a_step,fraction_of_copy,group\n");
    measure_sorts(arguments, csv);
    for (const int dim : arguments.dims)
        for (const int it : arguments.iterations) {
            Pace pace;
            for (const double n : arguments.particles) try {
                    dim == 2 ? measure<2>(arguments, n, it, bandwidth, csv, pace) : measure<3>(arguments, n, it, bandwidth, csv, pace);
                } catch (const BadInput& refused) {
                    std::printf("%dD %.0f particles: %s\n", dim, n, refused.what());
                }
        }
    std::fclose(csv);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
