// Bytes of a run, of its frames and of its ranks, extrapolated from small copies that take one step.
#include "sim/memory_estimate.hpp"

#include "core/error.hpp"
#include "geometry/liquid_fraction.hpp"
#include "output/frame_format.hpp"
#include "parallel/communicator.hpp"
#include "scene/steer.hpp"
#include "sim/registry.hpp"
#include "sim/shares.hpp"
#include "sim/small_copy.hpp"
#include "surfaces/contour.hpp"
#include "surfaces/reconstruction.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <numeric>

namespace weir::sim {
namespace {

constexpr double particles_of_copy = 16384;   // in a copy made of particles, whose steps take longest
constexpr double most_bytes_per_cell = 8000;  // upper bound for any solver: SPH's neighbours at three spacings take half of it

struct Held {
    std::vector<double> cells;
    double bytes = 0, particles = 0;
    FieldSet fields{};
    std::unique_ptr<Solver> solver{};
};

double particles_in(const FieldSet& fields) {
    for (const FieldView& f : fields.fields) {
        if (f.where != Where::particle) continue;
        const std::size_t here = f.data[0].size();
        return static_cast<double>(fields.particles_in_parts ? begins_of_ranks(here).back() : here);
    }
    return 0;
}

/// Scope in which particles belong to this rank alone.
class BuildsSerial {
public:
    BuildsSerial() { communicator().build_serial(true); }
    ~BuildsSerial() { communicator().build_serial(false); }
    BuildsSerial(const BuildsSerial&) = delete;
    BuildsSerial& operator=(const BuildsSerial&) = delete;
};

std::unique_ptr<Solver> solver_of(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    return kind_named(scene.solver(), kinds).make(scene, {});
}

/// Builds a scene and takes one step of it, as long as its first.
Held hold(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    const BuildsSerial serial;  // in parallel too: what one process would allocate
    Held held{.cells = scene.root().numbers("grid.cells"), .solver = solver_of(scene, kinds)};
    Solver& solver = *held.solver;
    held.fields = static_cast<const Solver&>(solver).fields();
    held.particles = particles_in(held.fields);
    try {
        const real advised = scene.has("time.dt") ? scene.number("time.dt") : solver.advised_dt();
        solver.step(std::min({advised, scene.root().number_or("time.max_dt", infinity), scene.number("time.end")}));
    } catch (const NumericalFailure&) {  // a copy may fail where the scene does not; its memory is allocated by then
    }
    held.bytes = static_cast<double>(solver.bytes());
    return held;
}

/// Determined from a copy of a few cells, or of more where so few make no valid scene.
bool consists_of_particles(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    for (const double few : {1024.0, 16384.0}) try {
            const auto solver = solver_of(small_copy(scene, kinds, few, Copy::similar), kinds);
            return static_cast<const Solver&>(*solver).fields().find(particle_set_name, "position") != nullptr;
        } catch (const BadInput&) {
        }
    return false;
}

/// Extrapolates bytes from two copies: bytes per cell plus bytes per boundary face.
double grown(const std::vector<double>& cells, const Held& fine, const Held& coarse) {
    const double n = number_of_cells(cells), s = number_of_boundary_faces(cells);
    const double n0 = number_of_cells(fine.cells), s0 = number_of_boundary_faces(fine.cells), n1 = number_of_cells(coarse.cells),
                 s1 = number_of_boundary_faces(coarse.cells);
    const double b = (coarse.bytes / n1 - fine.bytes / n0) / (s1 / n1 - s0 / n0);
    const double a = fine.bytes / n0 - b * s0 / n0;
    if (!std::isfinite(b) || b < 0 || a <= 0) return fine.bytes / n0 * n;
    return a * n + b * s;
}

/// A factorization grows faster than the cells: with the exponent fitted to two copies.
double filled(const std::vector<double>& cells, const Held& fine, const Held& coarse) {
    const double n0 = number_of_cells(fine.cells), n1 = number_of_cells(coarse.cells);
    const double power = std::log(fine.bytes / coarse.bytes) / std::log(n0 / n1);
    return fine.bytes * std::pow(number_of_cells(cells) / n0, std::clamp(power, 1.0, 2.0));
}

/// The part of a scene's memory that scales with the liquid: the difference to a pool of half the height.
double part_of_liquid(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    const auto& root = scene.root();
    const auto pool = [&](double part) {
        auto overrides = scene.overrides();
        overrides.push_back(
            {"liquid", pool_text(root.numbers("grid.origin"), root.numbers("grid.size"), root.numbers("grid.cells"), part)});
        return hold(scene::parse(scene.source(), scene.file(), scene::schemas_of(kinds), overrides), kinds).bytes;
    };
    const double wet = liquid_fraction(scene), all = pool(wet);
    return std::clamp(2 * (all - pool(0.5 * wet)) / all, 0.0, 1.0);
}

bool factorises(const scene::Scene& scene) {
    return scene.has("scheme.poisson.method") && scene.text("scheme.poisson.method") == "cholmod";
}

std::vector<EstimatedField> fields_of(const FieldSet& set, const std::vector<double>& cells, double particles) {
    std::vector<EstimatedField> list;
    for (const FieldView& f : set.fields) {
        const double n = number_of_cells(cells), parts = f.components();
        const double values = f.where == Where::cell   ? parts * n
                              : f.where == Where::face ? parts * n + number_of_boundary_faces(cells)
                                                       : parts * particles;
        list.push_back({f.name, f.unit, f.where, f.components(), values});
    }
    return list;
}

}  // namespace

/// Memory for the scene's surface mesh, extrapolated from a copy per particle, or per cell of a level set.
double surface_bytes(const scene::Scene& scene, const Held& copy, const MemoryEstimate& f) {
    const auto surface = surfaces::can_contour() ? surfaces::reconstruction_of(scene) : nullptr;
    if (!surface) return 0;
    surface->make(static_cast<const Solver&>(*copy.solver).fields(), 0);
    const double times = copy.particles > 0 ? f.particles / copy.particles : f.cells / number_of_cells(copy.cells);
    return times * static_cast<double>(surface->bytes());
}

MemoryEstimate estimate_memory(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, double copy_cells) {
    const auto cells = scene.root().numbers("grid.cells");
    const bool small = number_of_cells(cells) <= copy_cells;
    MemoryEstimate f{.cells = number_of_cells(cells), .particle_solver = consists_of_particles(scene, kinds)};
    const double wet = f.particle_solver ? liquid_fraction(scene) : 0;
    const double enough = f.particle_solver && wet > 0 ? particles_of_copy / wet : copy_cells;
    const double least = number_of_cells(cells) / std::pow(widest_copy, static_cast<double>(cells.size() - 1));
    const bool by_columns = kind_named(scene.solver(), kinds).schema.whole_columns && least <= 8 * copy_cells;
    const Copy how = f.particle_solver ? Copy::similar : by_columns ? Copy::like_columns : Copy::like_rows;
    const bool whole = how == Copy::like_columns;
    const Held fine = hold(small ? scene : small_copy(scene, kinds, enough, how), kinds);
    f.exact = number_of_cells(fine.cells) == f.cells;
    f.particles = f.exact ? fine.particles : wet > 0 ? wet * f.cells : fine.particles / number_of_cells(fine.cells) * f.cells;
    f.fields = fields_of(fine.fields, cells, f.particles);
    f.surface_bytes = surface_bytes(small ? scene : small_copy(scene, kinds, enough, how), fine, f);
    f.effects = fine.solver->effects();
    if (f.exact || f.particle_solver) {
        const double times = f.exact ? 1 : fine.particles > 0 ? f.particles / fine.particles : f.cells / number_of_cells(fine.cells);
        f.bytes = times * fine.bytes;
        return f;
    }
    if (whole) {  // whole columns, but wider: a quarter as many would be too flat
        f.bytes = fine.bytes / number_of_cells(fine.cells) * f.cells;
        return f;
    }
    const Held coarse = hold(small_copy(scene, kinds, copy_cells / 4, how), kinds);
    f.bytes = factorises(scene) ? filled(cells, fine, coarse) : grown(cells, fine, coarse);
    return f;
}

namespace {

/// Where no copy can be built: the minimum of any solver, about ten numbers per cell.
MemoryEstimate estimate_or_least(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    constexpr double least = 80;
    try {
        return estimate_memory(scene, kinds);
    } catch (const BadInput&) {
        const double cells = number_of_cells(scene.root().numbers("grid.cells"));
        return {.bytes = least * cells, .cells = cells};
    }
}

}  // namespace

double available_memory() {
    std::ifstream info("/proc/meminfo");
    std::string key, unit;
    for (double kilobytes = 0; info >> key >> kilobytes; std::getline(info, unit))
        if (key == "MemAvailable:") return 1024 * kilobytes;
    return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
}

OutputEstimate estimate_output(const scene::Scene& scene, const MemoryEstimate& estimate) {
    const auto names = scene.root().texts("output.fields");
    const double per_value = output::frame_format(scene.text("output.format")).bytes_per_value;
    const double number = per_value > 0 ? per_value : scene.text("output.precision") == "single" ? 4 : 8;
    const double end = scene::end_after(scene.number("time.end"), scene::changes_of(scene.root()));
    const double every = scene.root().number_or("output.every", infinity);
    OutputEstimate output;
    output.frames = 1 + (every < end ? std::ceil(end / every - 1e-9) : 1);
    for (const EstimatedField& f : estimate.fields) {
        const bool position = f.where == Where::particle && f.name == "position";
        if (!position && !names.empty() && std::find(names.begin(), names.end(), f.name) == names.end()) continue;
        const double places = f.where == Where::particle ? estimate.particles : estimate.cells;
        const double array = number * places * (f.components == 1 ? 1 : 3);  // vectors are written with three components
        output.bytes_of_frame += array;
        output.bytes_of_array = std::max(output.bytes_of_array, array);
        if (position) output.bytes_of_frame += 16 * places;  // its connectivity: two numbers of eight bytes
        if (f.where == Where::face && scene.flag("output.faces")) output.bytes_of_frame += number * f.values;
    }
    return output;
}

OutputEstimate estimate_output(const scene::Scene& scene, const FieldSet& fields) {
    const auto cells = scene.root().numbers("grid.cells");
    const double particles = particles_in(fields);
    return estimate_output(scene, {.cells = number_of_cells(cells), .particles = particles, .fields = fields_of(fields, cells, particles)});
}

double bytes_of_run(const scene::Scene& scene, const MemoryEstimate& estimate, bool frames) {
    double state = 0;
    for (const EstimatedField& f : estimate.fields) state += f.values * sizeof(real);
    return estimate.bytes + state + (frames ? estimate_output(scene, estimate).bytes_of_array + estimate.surface_bytes : 0);
}

std::vector<double> parts_of_planes(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds) {
    if (!kind_named(scene.solver(), kinds).parallel.work_of_planes) return {};
    const auto wet = scene.dim() == 2 ? geometry::liquid_in_planes<2>(scene, 0) : geometry::liquid_in_planes<3>(scene, 0);
    double liquid = 0;
    for (const auto& plane : wet) liquid += plane.wet;
    const double part = liquid > 0 ? part_of_liquid(small_copy(scene, kinds, cells_of_copy, Copy::like_rows), kinds) : 0;
    std::vector<double> parts;
    for (const auto& plane : wet)
        parts.push_back((1 - part) / static_cast<double>(wet.size()) + (liquid > 0 ? part * plane.wet / liquid : 0));
    return parts;
}

double bytes_of_rank(double bytes, const Partition& cut, int rank, const std::vector<double>& parts) {
    const bool first = rank == 0, last = rank + 1 == cut.ranks();
    constexpr int near = static_cast<int>(planes_near_cuts), more = (near + 1) / 2;
    const int begin = std::max(0, cut.begin(rank) - (first ? 0 : last ? more : near - more));
    const int end = std::min(cut.planes(), cut.end(rank, cut.planes()) + (last ? 0 : more));
    if (parts.empty()) return bytes * (end - begin) / cut.planes();
    return bytes * std::accumulate(parts.begin() + begin, parts.begin() + end, 0.0);
}

double surface_bytes_of_rank(const scene::Scene& scene, const MemoryEstimate& estimate, int rank, int ranks) {
    const auto options = surfaces::options_of(scene);
    if (!options) return 0;
    constexpr double samples_beside = 2, markers_per_cell = 2;
    const double planes = scene.root().numbers("grid.cells").back(), cuts = rank == 0 || rank + 1 == ranks ? 1 : 2;
    const double beside = options->method == surfaces::Method::level_set
                              ? samples_beside
                              : surfaces::read_beside(*options) / (estimate.particle_solver ? 1 : markers_per_cell);
    return estimate.surface_bytes * std::min(1.0, 1.0 / ranks + (ranks > 1 ? cuts * beside / planes : 0));
}

void require_memory(const scene::Scene& scene, const std::vector<scene::SolverKind>& kinds, Use use, double available) {
    const double cells = number_of_cells(scene.root().numbers("grid.cells"));
    if (cells <= cells_of_copy || (cells * most_bytes_per_cell <= available && !factorises(scene))) return;
    const MemoryEstimate f = estimate_or_least(scene, kinds);
    const double needed = use == Use::solver ? f.bytes : bytes_of_run(scene, f, use == Use::run_with_frames);
    if (needed <= available) return;
    constexpr double gigabyte = 1e9;
    std::string count = fmt::format("{:.3g} cells", cells);
    if (f.particles > 0) count += fmt::format(" and {:.3g} particles", f.particles);
    scene.refuse("grid.cells",
                 fmt::format("{} require {:.3g} GB of memory; {:.3g} GB are available on this machine", count, needed / gigabyte,
                             available / gigabyte),
                 fmt::format("{:.0f} bytes per cell, estimated from coarser copies of this scene", f.bytes / cells));
}

}  // namespace weir::sim
