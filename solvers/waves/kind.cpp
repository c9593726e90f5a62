// The schema of the solver "waves".
#include "scene/gravity.hpp"
#include "waves/fourier.hpp"
#include "waves/solver.hpp"

namespace weir::waves {

namespace {

using scene::Key;
using scene::Type;
using scene::Variant;

Key positive(const char* name, const char* doc, const char* unit) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = true, .min = 0, .min_open = true};
}
Key optional(const char* name, const char* doc, const char* unit) {
    Key key = positive(name, doc, unit);
    key.required = false;
    return key;
}
Key number(const char* name, const char* doc, const char* unit, double fallback) {
    return {.name = name, .type = Type::number, .doc = doc, .unit = unit, .fallback = fallback};
}
Key heading(const char* whose) {
    Key key = number("heading", "", "rad", 0.0);
    key.doc = std::string("Where ") + whose + " to, from x towards z; in 2D 0 or pi.";
    return key;
}
Key wind(const char* doc) { return positive("wind", doc, "m/s"); }

Key trains() {
    return {.name = "trains",
            .type = Type::tables,
            .doc = "Trains of waves.",
            .required = true,
            .keys = {positive("amplitude", "Amplitude: half the height from trough to crest; over a bed that in deep water.", "m"),
                     positive("wavelength", "Wavelength; over a bed that in deep water.", "m"), heading("it travels"),
                     number("phase", "Phase at the origin of coordinates at t = 0; 0: a crest.", "rad", 0.0)},
            .example = "trains = [ { amplitude = 0.5, wavelength = 20.0 } ]"};
}

Key bed() {
    const auto list = [](const char* name, const char* doc) {
        return Key{.name = name, .type = Type::numbers, .doc = doc, .unit = "m", .required = true};
    };
    return {.name = "bed",
            .type = Type::table,
            .doc =
                "A bed whose depth changes along x: waves come from deep water and are refracted and amplified by the exact dispersion "
                "relation.",
            .keys = {list("x", "Positions, in increasing order."),
                     list("depth", "Depth at each, greater than 0; straight lines between them.")},
            .example = "bed = { x = [0.0, 100.0], depth = [20.0, 2.0] }"};
}

Key spectrum() {
    return {
        .name = "spectrum",
        .type = Type::table,
        .doc = "Spectrum: variance of the surface per frequency.",
        .required = true,
        .selector = "kind",
        .variants = {{"pierson_moskowitz",
                      "A fully developed sea (Pierson & Moskowitz 1964): significant height 0.209 wind^2/g.",
                      {wind("Wind speed at 19.5 m above the sea.")}},
                     {"jonswap",
                      "A fetch-limited sea, JONSWAP (Hasselmann et al. 1973).",
                      {wind("Wind speed at 10 m above the sea."),
                       positive("fetch", "Fetch of the wind.", "m"),
                       {.name = "gamma",
                        .type = Type::number,
                        .doc = "Peak enhancement over Pierson and Moskowitz's spectrum; measured: 1 to 7.",
                        .fallback = 3.3,
                        .min = 1,
                        .max = 7}}},
                     {"phillips",
                      "(alpha/2) k^-3 exp(-1/(k L)^2), L = wind^2/g (Phillips 1958; Tessendorf 2001): significant height 2 sqrt(alpha) L.",
                      {wind("Wind speed."),
                       {.name = "alpha",
                        .type = Type::number,
                        .doc = "Level of the spectrum's tail.",
                        .fallback = 8.1e-3,
                        .min = 0,
                        .max = 0.1,
                        .min_open = true}}}},
        .example = "spectrum = { kind = \"pierson_moskowitz\", wind = 12.0 }"};
}

/// One list: its entries are data, not steps.
std::vector<Variant> models() {
    return {
        {"sines", "A sum of sines, each exact to linear theory (Airy).", {trains()}},
        {"gerstner",
         "Trochoids: particles go round circles (Gerstner 1802). One train in deep water is exact; over a bed, and with wind, the ocean of "
         "Fournier and Reeves (1986).",
         {trains(),
          bed(),
          {.name = "lean",
           .type = Type::number,
           .doc = "Forward lean of crests by the wind: phase per metre of height.",
           .unit = "rad/m",
           .fallback = 0.0,
           .min = 0},
          {.name = "flatten",
           .type = Type::number,
           .doc = "f in the longer axis of orbits near the shore, 1/(1 - e^(-f k h)).",
           .fallback = 2.0,
           .min = 0,
           .min_open = true},
          {.name = "tilt",
           .type = Type::number,
           .doc = "Inclination of orbits near the shore along the bed: 0 horizontal, 1 as in the paper.",
           .fallback = 1.0,
           .min = 0,
           .max = 1}}},
        {"spectrum",
         "A wind sea on a tile that repeats, by FFT: the grid's horizontal size is the tile, its cells limit the shortest wave.",
         {spectrum(),
          heading("the wind blows"),
          {.name = "spread",
           .type = Type::number,
           .doc = "s in cos^2s(angle/2), the spreading over directions (3D).",
           .fallback = 4.0,
           .min = 0,
           .max = 200,
           .only_dim = 3},
          {.name = "choppiness",
           .type = Type::number,
           .doc = "Horizontal displacement of points in linear orbits: 0 none, 1 as in water.",
           .fallback = 0.0,
           .min = 0},
          {.name = "shortest", .type = Type::number, .doc = "Waves shorter than this are omitted.", .unit = "m", .fallback = 0.0, .min = 0},
          {.name = "seed", .type = Type::integer, .doc = "Seed of the phases.", .fallback = std::int64_t{1}, .min = 0},
          {.name = "amplitudes",
           .type = Type::choice,
           .doc =
               "fixed: each wave as high as the spectrum says, so that every sea has its significant height; gaussian: random about that.",
           .fallback = std::string("fixed"),
           .choices = {"fixed", "gaussian"}}}},
        {"stokes",
         "A steady train by Stokes's expansion (Fenton 1985).",
         {positive("height", "Height from trough to crest.", "m"),
          positive("wavelength", "Distance between crests.", "m"),
          heading("it travels"),
          number("phase", "Phase at the origin of coordinates at t = 0; 0: a crest.", "rad", 0.0),
          {.name = "order",
           .type = Type::integer,
           .doc = "Order of the expansion in k H/2.",
           .fallback = std::int64_t{5},
           .min = 1,
           .max = 5}}},
        {"basin",
         "Water in a box with vertical walls, released from rest with the surface of the scene's `liquid`: its linear waves, mode by mode.",
         {}},
    };
}

Key waves() {
    Key key{.name = "waves",
            .type = Type::table,
            .doc = "Wave model.",
            .required = true,
            .keys = {{.name = "level", .type = Type::number, .doc = "Height of the surface at rest.", .unit = "m"},
                     optional("depth", "Depth of the water below the level; absent: deep water. The floor of a basin is that of the grid.",
                              "m"),
                     {.name = "velocity", .type = Type::flag, .doc = "Computes velocities, too.", .fallback = true}},
            .selector = "model",
            .example = "waves = { model = \"sines\", trains = [ { amplitude = 0.5, wavelength = 20.0 } ] }"};
    key.variants = models();
    return key;
}

std::vector<Variant> effects() {
    return {scene::gravity_effect("Gravity, the restoring force of waves; it points down, against y."),
            {"surface_tension",
             "Surface tension, the restoring force of ripples: omega^2 = (g k + sigma k^3/rho) tanh(k d).",
             {{.name = "sigma", .type = Type::number, .doc = "Surface tension.", .unit = "N/m", .required = true, .min = 0}},
             {"sigma"}},
            {"foam",
             "1 - J/below, between 0 and 1, where the surface is compressed: J is the ratio of a patch's area to its original area.",
             {{.name = "below",
               .type = Type::number,
               .doc = "Area ratio below which a patch has foam; 0: no foam.",
               .fallback = 0.3,
               .min = 0,
               .max = 1}},
             {"below"}}};
}

/// Everything is distributed.
void check_parallel(const scene::Scene&) {}

}  // namespace

scene::SolverKind kind() {
    scene::SolverSchema schema;
    schema.name = "waves";
    schema.doc = "Procedural waves: the surface is a formula of place and time, from one sine to a wind sea of half a million waves.";
    schema.keys = {waves()};
    schema.effects = effects();
    schema.without = {"time.cfl", "time.stop_when_steady", "grid.periodic", "fluid.viscosity", "sides", "solids", "emitters", "initial"};
    schema.why_without =
        "procedural waves are formulas: they take no steps, meet no walls, bodies or sources, and do not overturn; \"mac_water\", \"sph\" "
        "and \"pbf\" are liquids that do";
    return {schema,
            [](const scene::Scene& scene, const Partition& partition) { return std::make_unique<Waves>(scene, partition); },
            {{"level_set", "velocity", "position", "jacobian"},
             {"surface", "water"},
             "waves = { model = \"gerstner\", trains = [ { amplitude = 0.02, wavelength = 0.5 } ] }"},
            {.check = check_parallel,
             .replicated_work =
                 [](const scene::Scene& scene, const Partition&) {
                     return scene.dim() == 2 ? scene::ReplicatedWorks{scene::ReplicatedWork::surface_row} : scene::ReplicatedWorks{};
                 },
             .distributed_storage = holds_own_planes,
             .partition = [](const scene::Scene& scene, int ranks) { return partition_of_box(Box(scene), ranks); }}};
}

}  // namespace weir::waves
