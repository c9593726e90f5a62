// What a rank sends in a step of the solver "tallcell": the exchanges of solver.cpp and of what stands in surface/, pass by pass.
#include "core/traffic.hpp"
#include "geometry/wet_part.hpp"
#include "surface/traffic.hpp"
#include "tallcell/solver.hpp"

#include <cmath>

namespace weir::tallcell {

namespace {

/// Knots of a column whose lowest `rows` cells are liquid below a flat surface, with a band of so many layers.
std::size_t knots_of(const Shape& shape, int layers, int rows) {
    const int top = rows - std::max(shape.depth, layers);
    if (shape.division == Division::uniform || top <= 2) return static_cast<std::size_t>(rows);
    std::array<int, 64> list;
    const int count = divide(shape.division, 0, top - 1, rows, list);
    const int above = count > 0 ? rows - 1 - list[static_cast<std::size_t>(count) - 1] : rows;
    return static_cast<std::size_t>(count + above);
}

/// What the formula does not know the messages of.
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
    const Cut cut = cut_of_columns(scene, of.ranks);
    if (cut.empty()) {  // every rank does all
        Tally tally(of.cut, of.rank);
        tally_run(tally);
        return tally.sent();
    }
    const TallOptions options(scene);
    const geometry::Sides<3> sides(scene);
    const staggered::Lattice<3> lattice(scene);
    const Index<3>& n = lattice.cells;
    const surface::SurfaceTally<3> surface(n, lattice.h, scene.number("time.cfl"), sides.periodic(2));
    const auto &cells = surface.cells, &across = surface.faces[2];
    Tally tally(cut, of.rank, sides.periodic(2));
    const int reach = std::min(n[2], shape.cells_crossed + 3);
    tally.gather({sizeof(real), across.count});  // how far anything moves
    tally.refresh(surface.faces, reach);
    tally.refresh({cells}, reach, 2);  // the level set, before and after it moves
    surface.distance(tally);
    tally.gather(cells);  // to place the knots
    tally.gather(surface::plane_of<3>(n, sizeof(std::uint8_t)));
    if (options.maccormack) {
        tally.refresh({across}, 1);  // what is predicted
        tally.refresh(surface.faces, reach);
    }
    tally.refresh({across}, 1, 3);  // the velocity after motion, before walls and after
    const int up = up_axis<3>(gravity_of<3>(scene)), columns = n[0];
    std::size_t own = 0, all = 0;
    for (int z = 0; z < n[2]; ++z) {
        const auto rows = static_cast<int>(std::lround(geometry::wet_part_of_plane<3>(scene, z) * n[up]));
        const std::size_t knots = static_cast<std::size_t>(up == 0 ? n[1] : columns) * knots_of(options.shape, surface.layers, rows);
        all += knots;
        if (z >= cut.begin(of.rank) && z < cut.end(of.rank, n[2])) own += knots;
    }
    tally.everywhere(sizeof(real) * own, 2, sizeof(real) * all);  // right-hand side and guess: each solves for itself
    tally.everywhere(sizeof(real), 2, sizeof(real) * static_cast<std::size_t>(of.ranks));  // the fastest run, what diverges
    tally.refresh({across}, 1);
    surface.continue_velocity(tally, surface.layers - 1);
    tally.refresh({across}, 1);
    for (const PlaneSize& component : surface.faces) tally.gather({sizeof(real), component.count});  // the fastest flow
    tally_run(tally);
    tally.sent().besides = not_counted(scene);
    return tally.sent();
}

}  // namespace weir::tallcell
