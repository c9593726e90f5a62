#include "heightfield/raster.hpp"

#include "core/error.hpp"
#include "fuzz/scratch.hpp"
#include "fuzz/targets.hpp"

#include <cmath>
#include <cstdlib>

/// What is accepted has a finite height everywhere, far beyond its sides too.
bool weir::fuzz::raster(std::string_view bytes) {
    if (bytes.empty()) return false;
    const bool image = bytes[0] == 'p', filled = bytes[0] == 'f';
    bytes.remove_prefix(1);
    try {
        using namespace heightfield;
        const Raster raster = image ? read_pgm(written("terrain.pgm", bytes))
                                    : read_asc(written("terrain.asc", bytes), filled ? std::optional<real>(-1.0) : std::nullopt);
        for (const real x : {raster.x0 - 1, 0.5 * (raster.x0 + raster.x1()), raster.x1() + 1e9})
            for (const real z : {raster.z0 - 1e9, 0.5 * (raster.z0 + raster.z1()), raster.z1()})
                if (!std::isfinite(raster(x, z))) std::abort();
        return true;
    } catch (const BadInput&) {
        return false;
    }
}
