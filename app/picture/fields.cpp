// Scalars to be shown, made from a frame.
#include "app/picture/view.hpp"
#include "core/error.hpp"
#include "sim/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace weir::picture {

namespace {

std::vector<real> magnitude(const output::Components& u) {
    std::vector<real> speed(u[0].size());
    for (std::size_t i = 0; i < speed.size(); ++i) {
        real sum = 0;
        for (const auto& component : u) sum += component[i] * component[i];
        speed[i] = std::sqrt(sum);
    }
    return speed;
}

/// dv/dx - du/dy by central differences of the values at cell centres, one-sided at the border [1/s].
std::vector<real> vorticity(const GridView& grid, const output::Components& u) {
    const int nx = grid.cells[0], ny = grid.cells[1];
    const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) + static_cast<std::size_t>(x); };
    std::vector<real> omega(u[0].size());
    for (int y = 0; y < ny; ++y)
        for (int x = 0; x < nx; ++x) {
            const int x0 = std::max(x - 1, 0), x1 = std::min(x + 1, nx - 1), y0 = std::max(y - 1, 0), y1 = std::min(y + 1, ny - 1);
            omega[at(x, y)] = (u[1][at(x1, y)] - u[1][at(x0, y)]) / (std::max(x1 - x0, 1) * grid.spacing[0]) -
                              (u[0][at(x, y1)] - u[0][at(x, y0)]) / (std::max(y1 - y0, 1) * grid.spacing[1]);
        }
    return omega;
}

}  // namespace

void particles_as_markers(output::FrameData& frame, const scene::Scene& scene) {
    const auto set = frame.particles.find("particles");
    if (frame.grid.dim != 0 || set == frame.particles.end()) return;
    frame.particles["markers"] = std::move(set->second);
    frame.grid.dim = scene.dim();
    const auto cells = scene.root().numbers("grid.cells"), size = scene.root().numbers("grid.size"),
               origin = scene.root().numbers("grid.origin");
    for (std::size_t a = 0; a < static_cast<std::size_t>(scene.dim()); ++a) {
        frame.grid.cells[a] = std::max(1, static_cast<int>(std::lround(cells[a] / 2)));  // a cell of the scene is one particle
        frame.grid.origin[a] = origin[a];
        frame.grid.spacing[a] = size[a] / frame.grid.cells[a];
    }
}

void level_set_as_markers(output::FrameData& frame) {
    const auto phi = frame.cells.find(level_set_name);
    if (phi == frame.cells.end() || frame.particles.count("markers") > 0) return;
    const auto lattice = sim::Lattice::of_cells(frame.grid);
    const auto& n = frame.grid.cells;
    output::Components x(3);
    std::array<int, 3> I;
    for (I[2] = 0; I[2] < n[2]; ++I[2])
        for (I[1] = 0; I[1] < n[1]; ++I[1])
            for (I[0] = 0; I[0] < n[0]; ++I[0])
                for (int part = 0; part < 1 << frame.grid.dim; ++part) {
                    std::array<real, 3> at{};
                    for (std::size_t a = 0; a < static_cast<std::size_t>(frame.grid.dim); ++a)
                        at[a] = frame.grid.origin[a] + frame.grid.spacing[a] * (I[a] + (part >> a & 1 ? 0.75 : 0.25));
                    if (sim::sample(phi->second[0], lattice, {{at[0], at[1], at[2]}}) >= 0) continue;
                    for (std::size_t a = 0; a < 3; ++a) x[a].push_back(at[a]);
                }
    frame.particles["markers"]["position"] = std::move(x);
    frame.particles["markers"][from_level_set] = {};
}

std::string best_field(const output::FrameData& frame) {
    if (frame.particles.count("markers") || frame.particles.count(surface_set_name) || is_of_columns(frame)) return "water";
    for (const char* name : {"smoke", "temperature"})
        if (frame.cells.count(name)) return name;
    return frame.cells.count("velocity") ? "speed" : frame.cells.empty() ? "" : frame.cells.begin()->first;
}

std::vector<real> scalar_field(const output::FrameData& frame, const std::string& name) {
    const auto velocity = frame.cells.find("velocity");
    if (const auto found = frame.cells.find(name); found != frame.cells.end())
        return found->second.size() == 1 ? found->second[0] : magnitude(found->second);
    if (name == "speed" && velocity != frame.cells.end()) return magnitude(velocity->second);
    if (name == "vorticity" && velocity != frame.cells.end() && frame.grid.dim == 2) return vorticity(frame.grid, velocity->second);
    std::string known = velocity != frame.cells.end() ? "speed" : "";
    if (const auto markers = frame.particles.find("markers"); markers != frame.particles.end() && frame.grid.dim == 2)
        for (const auto& [field, values] : markers->second)
            if (values.size() == 1) known += (known.empty() ? "" : ", ") + field;
    for (const auto& [field, values] : frame.cells) known += (known.empty() ? "" : ", ") + field;
    throw BadInput("this frame has no field \"" + name + "\"; known: " + known);
}

const std::vector<real>* marker_field(const output::FrameData& frame, const std::string& name) {
    const auto markers = frame.particles.find("markers");
    if (markers == frame.particles.end()) return nullptr;
    const auto found = markers->second.find(name);
    return found != markers->second.end() && found->second.size() == 1 ? &found->second[0] : nullptr;
}

std::vector<real> marker_speeds(const output::FrameData& frame) {
    const auto& markers = frame.particles.at("markers");
    if (const auto own = markers.find("velocity"); own != markers.end()) return magnitude(own->second);
    const auto& x = markers.at("position");
    std::vector<real> speeds(x[0].size(), 0);
    if (!frame.cells.count("velocity")) return speeds;
    const auto speed = scalar_field(frame, "speed");
    const auto lattice = sim::Lattice::of_cells(frame.grid);
    for (std::size_t i = 0; i < speeds.size(); ++i) speeds[i] = sim::sample(speed, lattice, {{x[0][i], x[1][i], x[2][i]}});
    return speeds;
}

}  // namespace weir::picture
