#include "geometry/mesh/mesh.hpp"

#include "core/error.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/targets.hpp"

#include <cmath>
#include <cstdlib>

/// A mesh that is accepted has a volume, and is inside its box.
bool weir::fuzz::mesh(std::string_view bytes) {
    if (bytes.empty()) return false;
    const char* ending = bytes[0] == 's' ? ".stl" : bytes[0] == 'o' ? ".obj" : ".ply";
    bytes.remove_prefix(1);
    try {
        const geometry::Mesh mesh(geometry::read_triangles(written(std::string("mesh") + ending, bytes)), 8, "mesh");
        if (!(mesh.volume() > 0) || !std::isfinite(mesh.distance(mesh.centre())) ||
            !(mesh.distance(mesh.max() + (mesh.max() - mesh.min())) > 0))
            std::abort();
        return true;
    } catch (const BadInput&) {
        return false;
    }
}
