// Surfaces of triangles read from files: STL, OBJ and PLY, text and binary.
#pragma once
#include "core/types.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace weir::geometry {

struct Triangles {
    std::vector<Vec<3>> points;               // in the file's unit
    std::vector<std::array<int, 3>> corners;  // of each triangle, counterclockwise as seen from outside
    std::vector<Vec<3>> colours;              // of each point: red, green and blue from 0 to 1; empty where the file has none
};

/// Larger meshes are rejected: a distance grid cannot resolve them (400 cells along a side resolve 6 x 400^2 squares of a surface), and
/// each triangle takes some microseconds to load.
inline constexpr std::size_t most_triangles = 1000000;

/// By the file name extension. Throws BadInput: the file, its line and column for text, what was found and what is allowed.
Triangles read_triangles(const std::filesystem::path& file);

/// Merges points at the same position, and removes triangles without area.
void weld(Triangles& mesh);
/// Throws BadInput, prefixed with `name`, where the surface does not bound a region: open, non-manifold, inconsistently oriented, or flat.
/// A wholly inverted surface is reversed.
void require_closed(Triangles& mesh, const std::string& name);
/// Six times the enclosed volume; `products`, if given, is set to the sum of the absolute terms.
real six_volumes(const Triangles& mesh, real* products = nullptr);

}  // namespace weir::geometry
