#include "scene/surface_keys.hpp"

namespace weir::scene {

namespace {

Key surface_cell_key() {
    return {.name = "cell",
            .type = Type::number,
            .doc = "Distance between the samples whose zero is the surface, in particle spacings.",
            .fallback = 1.0,
            .min = 0.25,
            .max = 2};
}

/// Default number of smoothing passes, which remove the bumps of single particles from samples one spacing apart.
constexpr std::int64_t usual_smoothing = 5;

std::vector<Variant> surfaces_of_particles() {
    return {{"zhu_bridson", "Distance to the weighted mean of the particles near (Zhu & Bridson 2005).", {surface_cell_key()}},
            {"anisotropic", "Kernels stretched along the surface, flat across it (Yu & Turk 2013).", {surface_cell_key()}},
            {"density",
             "An isosurface of the particles' density, with the mesh smoothed where particles are dense (Loeschner et al. 2023).",
             {surface_cell_key(),
              {.name = "smoothing",
               .type = Type::integer,
               .doc = "Passes over the mesh; none with 0.",
               .fallback = usual_smoothing,
               .min = 0,
               .max = 1000}}}};
}

Key output_with(std::vector<Variant> methods) {
    return {.name = "output",
            .type = Type::table,
            .keys = {{.name = "surface",
                      .type = Type::table,
                      .doc = "Write the liquid's surface as triangles, in 2D as lines, beside the frames (series liquid_surface), with "
                             "normals, velocity and thickness of the liquid below. It is closed, also at walls, solids and open sides.",
                      .selector = "method",
                      .variants = std::move(methods)}}};
}

}  // namespace

Key surface_key_of_particles() { return output_with(surfaces_of_particles()); }

Key surface_key_of_level_set(bool markers) {
    std::vector<Variant> methods;
    if (markers) methods = surfaces_of_particles();
    methods.insert(methods.begin(), {"level_set", "The zero of the level set, on the cells of the grid.", {}});
    return output_with(std::move(methods));
}

}  // namespace weir::scene
