// Heights on a raster, from files that others make: ESRI ASCII grids (.asc), whose header says where they lie, and grey images (PGM, P2 and
// P5 of 8 or 16 bits). What is wrong with a file is refused with its line and column.
#pragma once
#include "core/types.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace weir::heightfield {

/// Values at the centres of cells, the first row at the least z.
struct Raster {
    int nx = 0, nz = 0;
    real x0 = 0, z0 = 0, dx = 1, dz = 1;  // lower corner, cell [m]
    std::vector<real> value{};
    real x1() const { return x0 + nx * dx; }
    real z1() const { return z0 + nz * dz; }
    /// Bilinear between centres; that of the nearest centre beyond the outermost.
    real operator()(real x, real z) const;
};

/// ESRI ASCII grid. Cells without data take `nodata`; without it they are refused. Throws BadInput.
Raster read_asc(const std::filesystem::path& path, std::optional<real> nodata);
/// A portable grey map: 0 is black and 1 is white, and the uppermost row of the picture is at the least z, as seen from above.
Raster read_pgm(const std::filesystem::path& path);

}  // namespace weir::heightfield
