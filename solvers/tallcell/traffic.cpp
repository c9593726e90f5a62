// Estimate of what a rank sends in a step of the solver "tallcell": the exchanges of solver.cpp and of surface/, pass by pass.
#include "parallel/traffic.hpp"
#include "free_surface/traffic.hpp"
#include "geometry/liquid_fraction.hpp"
#include "tallcell/solver.hpp"

#include <cmath>
#include <set>

namespace weir::tallcell {

namespace {

/// Rows of the knots of a column whose lowest `wet` cells are liquid below a flat surface, with `layers` layers of the band.
void add_knots(const Shape& shape, int layers, int wet, std::set<int>& rows) {
    const int top = wet - std::max(shape.depth, layers);
    std::array<int, 64> list;
    const int count = shape.division == Division::uniform || top <= 2 ? 0 : divide(shape.division, 0, top - 1, wet, list);
    rows.insert(list.begin(), list.begin() + count);
    for (int row = count > 0 ? list[static_cast<std::size_t>(count) - 1] : 0; row < wet; ++row) rows.insert(row);
}

/// Setup of the levels, and a solve of `iterations` iterations (levels.cpp, multigrid.cpp, conjugate_gradients.cpp).
void tally_pressure(const ColumnPlaces& finest, int sweeps, int iterations, Tally& tally) {
    const auto ranks = static_cast<std::size_t>(tally.cut().ranks());
    const auto line_of = [](const ColumnPlaces& places, std::size_t bytes) {
        return PlaneSize{bytes * static_cast<std::size_t>(places.line_stride()), places.n[1]};
    };
    for (ColumnPlaces level = finest;;) {
        const std::size_t looks = ColumnMatrix::bytes_of_look() * static_cast<std::size_t>(level.rows);
        tally.everywhere(looks, 1, looks * ranks);
        const int colours = level.joint(1) ? 4 : 2, unread = level.n == finest.n ? 1 : 0;  // the last colour of a cycle
        const PlaneSize x = line_of(level, sizeof(float));
        tally.refresh(level.cut, level.periodic[1], std::span(&x, 1), 1, std::int64_t{2 * sweeps * colours - unread} * iterations);
        for (int& n : level.n) n = (n + 1) / 2;
        level.cut = halved(level.cut);
        if (worth_sharing(level, level.cut)) continue;
        tally.gather(level.cut, line_of(level, sizeof(std::uint8_t)), 1);
        tally.gather(level.cut, line_of(level, sizeof(real)), 8);  // T, lids, sinks, W
        tally.gather(level.cut, line_of(level, sizeof(float)), iterations);
        break;
    }
    const auto numbers = [&](std::size_t count) { return PlaneSize{sizeof(real) * count, finest.n[1]}; };
    const auto blocks = static_cast<std::size_t>(finest.blocks_of_line());
    tally.refresh({line_of(finest, sizeof(real))}, 1, 2 + iterations);  // x of both true residuals, and search directions
    tally.gather(numbers(1), 2 + iterations);                           // their inner products
    tally.gather(numbers(4 * blocks), 2);                               // residuals and right-hand side
    tally.gather(numbers(2 * blocks), 2 * iterations);                  // z·r and z·Ap, and residuals
}

/// Keys whose messages the estimate does not include.
std::vector<std::string> not_counted(const scene::Scene& scene) {
    std::vector<std::string> keys;
    for (const char* key : {"solids", "probes"})
        if (scene.has(key) && !scene.root().tables(key).empty()) keys.emplace_back(key);
    if (scene.effect("volume_control")) keys.emplace_back("effects.volume_control");
    if (scene.root().number_or("time.stop_when_steady", 0) > 0) keys.emplace_back("time.stop_when_steady");
    return keys;
}

}  // namespace

StepTraffic traffic_of_step(const scene::Scene& scene, const RankOf& of, const StepShape& shape) {
    const Partition cut = partition_of_columns(scene, of.ranks);
    if (cut.empty()) {  // replicated work
        Tally tally(of.cut, of.rank);
        tally_run(tally);
        return tally.sent();
    }
    const TallOptions options(scene);
    const geometry::Sides<3> sides(scene);
    const mac::Lattice<3> lattice(scene);
    const Index<3>& n = lattice.cells;
    const free_surface::SurfaceTally<3> surface(n, lattice.h, scene.number("time.cfl"), sides.periodic(2));
    const auto &cells = surface.cells, &across = surface.faces[2];
    Tally tally(cut, of.rank, sides.periodic(2));
    const int up = up_axis<3>(gravity_of<3>(scene));
    const int reach = std::min(n[2], shape.cells_crossed + 3);
    tally.gather({sizeof(real), across.count});  // the largest displacement
    tally.refresh(surface.faces, reach);
    tally.refresh({cells}, reach, 2);  // the level set, before and after it moves
    surface.liquid_parts(tally);
    surface.distance(tally);
    const std::size_t told = sizeof(int) * static_cast<std::size_t>(n[up] + 2);  // flags of lattice rows, after knots are placed
    tally.everywhere(told, 1, told * static_cast<std::size_t>(of.ranks));
    if (options.maccormack) {
        tally.refresh({across}, 1);  // predicted values
        tally.refresh(surface.faces, reach);
    }
    tally.refresh({across}, 1, 3);  // the velocity after advection, before walls and after
    std::set<int> rows;
    for (int z = 0; z < n[2]; ++z)
        add_knots(options.shape, surface.layers, static_cast<int>(std::lround(geometry::liquid_fraction_of_plane<3>(scene, z) * n[up])),
                  rows);
    ColumnPlaces finest;
    finest.n = {up == 0 ? n[1] : n[0], n[2]};
    finest.periodic = {sides.periodic(up == 0 ? 1 : 0), sides.periodic(2)};
    finest.rows = static_cast<int>(rows.size());
    finest.cut = cut;
    tally_pressure(finest, ColumnMultigrid::usual_sweeps, shape.iterations, tally);
    tally.everywhere(sizeof(real), 2, sizeof(real) * static_cast<std::size_t>(of.ranks));  // the fastest run, the maximum divergence
    tally.refresh({across}, 1);
    surface.continue_velocity(tally, surface.layers - 1);
    tally.refresh({across}, 1);
    for (const PlaneSize& component : surface.faces) tally.gather({sizeof(real), component.count});  // the maximum speed
    tally_run(tally);
    tally.sent().besides = not_counted(scene);
    return tally.sent();
}

}  // namespace weir::tallcell
