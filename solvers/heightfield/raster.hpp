// Heights on a raster, read from files: ESRI ASCII grids (.asc), whose header gives their position, and grey images (PGM, P2 and P5 of 8 or
// 16 bits). Errors in a file are reported with line and column.
#pragma once
#include "core/types.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace weir::heightfield {

/// Values at the centres of cells, the first row at the smallest z.
struct Raster {
    int nx = 0, nz = 0;
    real x0 = 0, z0 = 0, dx = 1, dz = 1;  // lower corner, cell [m]
    std::vector<real> value{};
    real x1() const { return x0 + nx * dx; }
    real z1() const { return z0 + nz * dz; }
    /// Bilinear between centres; constant beyond the outermost ones.
    real operator()(real x, real z) const;
};

/// ESRI ASCII grid. Cells without data get `nodata`; without it they are rejected. Throws BadInput.
Raster read_asc(const std::filesystem::path& path, std::optional<real> nodata);
/// A portable grey map: 0 is black and 1 is white; the top row of the picture is at the smallest z, as seen from above.
Raster read_pgm(const std::filesystem::path& path);

}  // namespace weir::heightfield
