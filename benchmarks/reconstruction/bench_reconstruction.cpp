// The surface of a block or a ball of particles by each reconstruction: milliseconds and processor time of each stage, triangles, bytes,
// and the error of the volume.
//   bench_reconstruction [--particles N] [--threads N] [--repeats N] [--cell C] [--shape block|ball|splash]
#include "core/parallel.hpp"
#include "sim/registry.hpp"
#include "surfaces/measure.hpp"
#include "surfaces/reconstruction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <string>

using namespace weir;
using namespace weir::surfaces;

namespace {

struct Arguments {
    int particles = 1000000, threads = 2, repeats = 3;
    real cell = 1;
    std::string shape = "block";
};

Arguments read(int count, char** words) {
    Arguments a;
    for (int i = 1; i + 1 < count; i += 2) {
        const std::string key = words[i], value = words[i + 1];
        if (key == "--particles") a.particles = std::stoi(value);
        if (key == "--threads") a.threads = std::stoi(value);
        if (key == "--repeats") a.repeats = std::stoi(value);
        if (key == "--cell") a.cell = std::stod(value);
        if (key == "--shape") a.shape = value;
    }
    return a;
}

/// Particles on a lattice of spacing 1, or, for a splash, half of them in a block and half scattered as drops and sheets of a wave.
struct Particles {
    std::array<std::vector<real>, 3> x, v;
    real volume = 0;
    int domain = 0;
};

Particles make(const Arguments& a) {
    Particles p;
    const real radius = std::cbrt(3.0 * a.particles / (4 * std::numbers::pi));
    const int n = static_cast<int>(std::lround(std::cbrt(a.particles)));
    p.domain = (a.shape == "ball" ? 2 * static_cast<int>(radius) + 1 : n) + 16;
    const real middle = 0.5 * p.domain;
    const auto put = [&](real x, real y, real z) {
        p.x[0].push_back(x), p.x[1].push_back(y), p.x[2].push_back(z);
        p.v[0].push_back(y), p.v[1].push_back(-x), p.v[2].push_back(0);
    };
    const bool ball = a.shape == "ball", splash = a.shape == "splash";
    for (int k = 0; k < p.domain; ++k)
        for (int j = 0; j < p.domain; ++j)
            for (int i = 0; i < p.domain; ++i) {
                const real x = i + 0.5, y = j + 0.5, z = k + 0.5;
                const real r = std::hypot(x - middle, y - middle, z - middle);
                const bool in_block = i >= 8 && i < 8 + n && j >= 8 && j < 8 + n && k >= 8 && k < 8 + n;
                const bool in_waves = y < middle + 0.25 * n * std::sin(0.4 * x) * std::cos(0.3 * z);
                if (ball ? r < radius : splash ? in_block && in_waves : in_block) put(x, y, z);
            }
    p.volume = ball ? 4 * std::numbers::pi / 3 * radius * radius * radius : splash ? 0 : real(n) * n * n;
    return p;
}

void measure(const Arguments& a, const Particles& p, const std::string& method) {
    const std::string text = fmt::format(
        "solver = \"pbf\"\ndim = 3\ngrid = {{ cells = [{0}, {0}, {0}], size = [{0}, {0}, {0}] }}\ntime = {{ end = 1.0 }}\n", p.domain);
    const scene::Scene scene = scene::parse(text, "bench", sim::schemas());
    Options options{method_named(method), a.cell, method == "density" ? 5 : 0};
    Reconstruction made(options, scene);
    FieldSet fields;
    fields.grid = {3, {p.domain, p.domain, p.domain}, {0, 0, 0}, {1, 1, 1}};
    fields.fields = {{"position", "m", Where::particle, particle_set_name, {p.x[0], p.x[1], p.x[2]}},
                     {"velocity", "m/s", Where::particle, particle_set_name, {p.v[0], p.v[1], p.v[2]}}};
    made.make(fields, 0);  // grows what it holds
    std::map<std::string, real> before;
    for (const Pass& pass : made.passes().list()) before[pass.name] = pass.seconds;
    const auto start = std::clock();
    for (int i = 0; i < a.repeats; ++i) made.make(fields, 0);
    const real processor = static_cast<real>(std::clock() - start) / CLOCKS_PER_SEC / a.repeats;
    real whole = 0;
    for (const Pass& pass : made.passes().list()) {
        const real ms = 1e3 * (pass.seconds - before[pass.name]) / a.repeats;
        whole += ms;
        fmt::print("{:12} {:24} {:9.1f} ms\n", method, pass.name, ms);
    }
    const real off = p.volume > 0 ? volume(made.mesh()) / p.volume - 1 : 0;
    fmt::print("{:12} {:24} {:9.1f} ms; processor {:.1f} ms; {} triangles, {:.0f} MB, volume off by {:.3f}%\n", method, "whole", whole,
               1e3 * processor, made.mesh().corners.size(), real(made.bytes()) / 1e6, 100 * off);
}

}  // namespace

int main(int count, char** words) {
    const Arguments a = read(count, words);
    set_threads(a.threads);
    const Particles p = make(a);
    fmt::print("{} particles, {} threads, {} spacings between samples\n", p.x[0].size(), a.threads, a.cell);
    for (const char* method : {"zhu_bridson", "anisotropic", "density"}) measure(a, p, method);
}
