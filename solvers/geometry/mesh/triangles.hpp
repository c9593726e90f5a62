// Surfaces of triangles out of files that others made: STL, OBJ and PLY, as text and as bytes.
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
    std::vector<Vec<3>> colours;              // of each point: red, green and blue from 0 to 1; empty where the file says none
};

/// More are refused: a grid of distances cannot show what they say (400 cells along a side see 6 x 400^2 squares of a surface), and each
/// triangle costs some microseconds when it is loaded.
inline constexpr std::size_t most_triangles = 1000000;

/// By the ending of the name. Throws BadInput: the file, its line and column where it has lines, what was found and what is allowed.
Triangles read_triangles(const std::filesystem::path& file);

/// Points in the same place become one, and triangles without area go.
void weld(Triangles& mesh);
/// Throws BadInput, with `name` in front, where the surface does not bound a region: open, not manifold, or turned over somewhere, flat.
/// One that is inside out as a whole is turned.
void require_closed(Triangles& mesh, const std::string& name);
/// Six times the volume of the region inside; `products`, where it is given, becomes the sum of what was summed without signs.
real six_volumes(const Triangles& mesh, real* products = nullptr);

}  // namespace weir::geometry
