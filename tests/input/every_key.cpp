// Nothing that a scene may say is ignored. A scene is refused where it gives a key that no reader reads; and here small scenes give, solver
// by solver, every key that the schema allows: a key that no solver reads makes the test fail.
#include "scene/given.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <map>
#include <regex>
#include <set>

using namespace weir;

namespace {

/// What a solver cannot do without, and lines of which each makes another scene; it takes the place of the line above that begins with the
/// same word. Those of `refused` are refused by their own message, because what they ask for is not there.
struct Said {
    std::vector<std::string> least, lines, refused{}, in_3d{};
};

const std::vector<std::string> of_the_run{
    "title = \"a\"",
    "grid.origin = [0, 0]",
    "time.dt = 0.001",
    "time.max_dt = 0.001\ntime.guard = \"off\"",
    "changes = [ { time = 0.5, key = \"time.max_dt\", value = 0.1 } ]",
    "output = { every = 0.5, at = \"exact\", format = \"vtk\", fields = [], faces = true, precision = \"single\", compression = \"none\" }",
};
const std::string hand =
    "effects.hand = { rate = 10, keyframes = [ { time = 0, kind = \"push\", centre = [0.5, 0.5], radius = 0.1, velocity = [1, 0], speed = "
    "0, temperature = 300, body = 0 } ] }";
const std::string rolls =
    "effects.rotating_frame = { centre = [0, 0], axis = \"z\", amplitude = 0.1, period = 1, phase = 0.1, ramp = 0.1, rate = 0.1 }";
/// With `field` as one that the solver has.
std::vector<std::string> probes(const std::string& field) {
    const std::string of = ", field = \"" + field + "\"";
    return {"probes = [ { name = \"a\", every = 0.1, kind = \"point\", at = [0.4, 0.4]" + of + " } ]",
            "probes = [ { name = \"a\", kind = \"line\", from = [0.1, 0.1], to = [0.9, 0.9], count = 9" + of + " } ]",
            "probes = [ { name = \"a\", kind = \"integral\"" + of + " } ]"};
}
const std::vector<std::string> of_the_surface{"probes = [ { name = \"a\", kind = \"gauge\", axis = \"y\", at = [0.5, 0.5] } ]",
                                              "probes = [ { name = \"a\", kind = \"front\", axis = \"x\" } ]"};
const std::string in_space = "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [0.5, 0.5, 0.5] } ]\noutput.surface = ";
const std::vector<std::string> of_surfaces{in_space + "{ method = \"zhu_bridson\", cell = 0.5 }",
                                           in_space + "{ method = \"anisotropic\", cell = 0.5 }",
                                           in_space + "{ method = \"density\", cell = 0.5, smoothing = 3 }"};
const std::string of_level_set = in_space + "\"level_set\"";
const std::string at_the_wall = "probes = [ { name = \"a\", kind = \"wall_pressure\", at = [0.0, 0.4] } ]";
const std::vector<std::string> solids{
    "solids = [ { shape = \"box\", min = [0.7, 0.7], max = [0.9, 0.9], slip = \"free\", motion = { kind = \"constant\", velocity = [0.1, "
    "0] } "
    "} ]",
    "solids = [ { shape = \"sphere\", centre = [0.7, 0.7], radius = 0.1, motion = { kind = \"sinusoidal\", amplitude = [0.1, 0], "
    "frequency = 1, phase = 1 } } ]",
    "solids = [ { shape = \"capsule\", from = [0.7, 0.7], to = [0.8, 0.7], radius = 0.1, motion = { kind = \"rotation\", centre = [0.7, "
    "0.7], rate = 1 } } ]",
    "solids = [ { shape = \"plane\", point = [0.8, 0.8], normal = [-1, -1], motion = { kind = \"keyframes\", centre = [0.8, 0.8], frames = "
    "[ { t = 0, "
    "offset = [0, 0], angle = 0 }, { t = 1, offset = [0, 0], angle = 0 } ] } } ]",
    "solids = [ { shape = \"union\", of = [ { shape = \"box\", min = [0.7, 0.7], max = [0.9, 0.9] } ] } ]",
    "solids = [ { shape = \"difference\", from = { shape = \"box\", min = [0.7, 0.7], max = [0.9, 0.9] }, minus = [ { shape = "
    "\"sphere\", centre = [0.7, 0.7], radius = 0.05 } ] } ]",
};
/// The same solids without motion.
std::vector<std::string> at_rest(std::vector<std::string> list) {
    for (auto& line : list) line = std::regex_replace(line, std::regex(", motion = \\{.*\\} *\\} *\\]$"), " } ]");
    return list;
}
const std::string body = "bodies = [ { density = 2, ", body_probe = "probes = [ { name = \"a\", kind = \"body\", body = \"b\" } ]";
const std::vector<std::string> bodies{
    body +
        "shape = \"box\", min = [0.6, 0.6], max = [0.8, 0.8], name = \"b\", centre_of_mass = [0.7, 0.7], velocity = [0, 0], spin = [0], "
        "fixed = [\"x\"], slip = \"free\", friction = 0.1, restitution = 0.1 } ]\n" +
        body_probe,
    "bodies = [ { mass = 2, shape = \"sphere\", centre = [0.7, 0.7], radius = 0.1 } ]",
    body + "shape = \"capsule\", from = [0.7, 0.7], to = [0.8, 0.7], radius = 0.1 } ]",
    body + "shape = \"cylinder\", from = [0.7, 0.7], to = [0.8, 0.7], radius = 0.1 } ]",
    body + "shape = \"union\", of = [ { shape = \"box\", min = [0.6, 0.6], max = [0.8, 0.8] } ] } ]",
    body +
        "shape = \"difference\", from = { shape = \"box\", min = [0.6, 0.6], max = [0.8, 0.8] }, minus = [ { shape = \"sphere\", centre = "
        "[0.7, 0.7], radius = 0.05 } ] } ]",
};
const std::string two_bodies =
    "bodies = [ { name = \"a\", mass = 2, shape = \"sphere\", centre = [0.7, 0.7], radius = 0.1 }, { name = \"b\", mass = "
    "2, shape = \"sphere\", centre = [0.3, 0.7], radius = 0.1 } ]\njoints = [ { body = \"a\", to = \"b\", kind = ";
const std::vector<std::string> joints{
    two_bodies + "\"hinge\", at = [0.5, 0.7] } ]",
    two_bodies + "\"slider\", at = [0.5, 0.7], axis = [1, 0] } ]",
    two_bodies + "\"mooring\", at = [0.6, 0.7], anchor = [0.4, 0.7], length = 0.1, stiffness = 10, damping = 1 } ]",
};
const std::string mesh_in_space =
    "bodies = [ { mass = 2, shape = \"mesh\", file = \"" + std::string(WEIR_SOURCE_DIR) +
    "/tests/input/bad/meshes/box.obj\", scale = 0.5, at = [0.4, 0.4, 0.4], axis = [0, 0, 1], angle = 1, resolution = 16 } ]\n"
    "joints = [ { kind = \"hinge\", body = \"0\", at = [0.5, 0.5, 0.5], axis = [1, 0, 0] } ]";
const std::string wet_mesh = "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [1, 0.2, 1] } ]\n" + mesh_in_space;
const std::vector<std::string> endless_bodies{body + "shape = \"plane\", point = [0.8, 0.8], normal = [-1, -1] } ]",
                                              body + "shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]"};
const std::vector<std::string> poisson{"scheme.poisson = { method = \"cg\", tolerance = 1e-6, max_iterations = 100, fixed = false }"};
const std::vector<std::string> grid_velocities{
    "initial.velocity = \"rest\"",
    "initial.velocity = { name = \"constant\", value = [0, 0] }",
    "initial.velocity = { name = \"taylor_green\", speed = 1, wavenumber = 1 }",
    "initial.velocity = \"kovasznay\"\nfluid.viscosity = 1",
    "initial.velocity = { name = \"shear_layer\", speed = 1, width = 0.1, stir = 0.1 }",
    "initial.velocity = { name = \"random\", speed = 1, seed = 2 }",
};
const std::vector<std::string> particle_velocities{
    "initial.velocity = { name = \"constant\", value = [0, 0] }",
    "initial.velocity = { name = \"strain\", rate = 1, centre = [0, 0] }",
    "initial.velocity = { name = \"rotation\", omega = 1, centre = [0, 0] }",
};
const std::vector<std::string> walls{"sides.x_min = { kind = \"wall\", slip = \"free\" }",
                                     "sides.x_min = { kind = \"moving_wall\", velocity = [0, 1] }"};
const std::vector<std::string> open_sides{"sides.x_min = \"outflow\"", "sides.x_min = \"open\"",
                                          "sides = { x_min = \"periodic\", x_max = \"periodic\" }", "grid.periodic = [\"x\"]"};
const std::string inflow = "sides = { x_min = { kind = \"inflow\", velocity = [1, 0]";

/// Each function for the field, and each place where a side says its value, if it says one.
std::vector<std::string> of_field(const std::string& field, bool sides) {
    const std::string is = "initial." + field + " = { name = ";
    std::vector<std::string> lines;
    for (const char* function :
         {"\"constant\", value = 1", "\"linear\", value = 1, gradient = [1, 0], at = [0, 0]",
          "\"gaussian\", base = 0, amplitude = 1, centre = [0, 0], width = 1",
          "\"ball\", centre = [0, 0], radius = 1, value = 1, outside = 0", "\"distance\", centre = [0, 0], radius = 1",
          "\"slotted_disk\", centre = [0, 0], radius = 0.2, slot = 0.05, top = 0.1", "\"formula\", value = \"1 + x\""})
        lines.push_back(is + function + " }");
    if (!sides) return lines;
    const std::string given = is + "\"constant\", value = 1 }\n", value = ", " + field + " = 1 }";
    lines.push_back(given + inflow + value + ", x_max = \"outflow\" }");
    if (field == "temperature")
        for (const char* kind : {"\"wall\"", "\"moving_wall\", velocity = [0, 1]", "\"outflow\"", "\"open\""})
            lines.push_back(given + "sides.x_min = { kind = " + kind + value);
    return lines;
}

template <class... Lists>
std::vector<std::string> all(const Lists&... lists) {
    std::vector<std::string> sum;
    (sum.insert(sum.end(), lists.begin(), lists.end()), ...);
    return sum;
}

std::map<std::string, Said> everything() {
    using Lines = std::vector<std::string>;
    std::map<std::string, Said> said;
    const std::string emitter = "emitters = [ { shape = \"box\", min = [0.6, 0.6], max = [0.8, 0.8], start = 0, end = 1, velocity = [1, 0]";
    const Lines particles{emitter + " } ]",
                          "sinks = [ { shape = \"box\", min = [0.6, 0.6], max = [0.8, 0.8] } ]",
                          "effects.gravity.g = [0, -1]",
                          "effects.central_force = { omega = 1, centre = [0, 0] }",
                          "effects.xsph.c = 0.1",
                          "effects.vorticity.epsilon = 0.1",
                          rolls,
                          hand};
    const Lines liquid{"liquid = [ { shape = \"box\", min = [0, 0], max = [0.5, 0.5] } ]"};
    const Lines refused_by_particles{inflow + " } }", "output.fields = [\"vorticity\"]"};
    said["mac"] = {
        {},
        all(of_the_run, probes("pressure"), Lines{at_the_wall}, solids, bodies, joints, poisson, grid_velocities,
            of_field("temperature", true), of_field("smoke", true), walls, open_sides,
            Lines{inflow + ", profile = \"parabolic\" }, x_max = \"outflow\" }", emitter + ", smoke = 1, temperature = 1 } ]",
                  "scheme = { advection = \"maccormack\", interpolation = \"linear\", trace = \"rk2\", limiter = \"clamp\" }",
                  "scheme = { advection = \"conservative\", flux = \"central\" }", "time.cfl = 0.4", "time.stop_when_steady = 0.1",
                  "fluid.density = 2", "effects.gravity.g = [0, -1]", "effects.buoyancy = { alpha = 1, beta = 1, ambient = 0 }",
                  "effects.confinement = { epsilon = 0.1 }", "effects.diffusion = { scheme = \"explicit\", temperature = 1, smoke = 1 }",
                  "effects.cooling = { rate = 1, ambient = 0 }", "effects.decay = { rate = 1 }", hand,
                  "effects.viscosity = { scheme = \"explicit\" }\nfluid.viscosity = 1"}),
        all(of_the_surface, endless_bodies),
        {mesh_in_space,
         "solids = [ { shape = \"cylinder\", from = [0.4, 0.4, 0.4], to = [0.6, 0.4, 0.4], radius = 0.2, motion = { kind = \"rotation\", "
         "centre = [0.5, 0.5, 0.5], axis = [0, 0, 1], rate = 1 } } ]",
         "solids = [ { shape = \"sphere\", centre = [0.4, 0.4, 0.4], radius = 0.2, motion = { kind = \"keyframes\", axis = [0, 0, 1], "
         "frames = [ "
         "{ t = 0, angle = 0 }, { t = 1, angle = 1 } ] } } ]"}};
    said["mac_water"] = {
        liquid,
        all(of_the_run, probes("pressure"), Lines{at_the_wall}, of_the_surface, solids, bodies, joints, poisson, grid_velocities, walls,
            open_sides, Lines{"liquid = [ { shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]"},
            Lines{inflow + " } }", emitter + " } ]", "scheme = { transfer = \"flip\", flip_blend = 0.9, trace = \"rk2\" }", hand,
                  "effects.volume_control = {}", rolls, "scheme = { reseed = true, seed = 3 }", "time.cfl = 0.4",
                  "time.stop_when_steady = 0.1", "fluid.density = 2", "effects.gravity.g = [0, -1]", "effects.surface_tension.sigma = 1",
                  "effects.viscosity = { scheme = \"implicit\" }\nfluid.viscosity = 1",
                  "air = \"enclosed\"\nenclosed_gas = { pressure = 1e5, exponent = 1.4 }"}),
        endless_bodies, all(of_surfaces, Lines{of_level_set, wet_mesh})};
    said["two_phase"] = {
        Lines{"gas = { density = 0.1 }", liquid[0]},
        all(of_the_run, probes("pressure"), Lines{at_the_wall}, of_the_surface, at_rest(solids), bodies, joints, poisson, grid_velocities,
            walls, open_sides,
            Lines{"liquid = [ { shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]", "time.cfl = 0.4",
                  "time.stop_when_steady = 0.1", "fluid.density = 2", "effects.gravity.g = [0, -1]", "effects.surface_tension.sigma = 1",
                  "gas = { density = 0.1, viscosity = 1 }\neffects.viscosity = {}\nfluid.viscosity = 1", "initial.liquid_velocity = [1, 0]",
                  rolls, hand, inflow + ", fluid = \"gas\" }, x_max = \"outflow\" }",
                  "sides = { x_min = { kind = \"outflow\", fluid = \"liquid\" }, x_max = { kind = \"open\", fluid = \"gas\" } }"}),
        all(Lines{inflow + " } }"}, endless_bodies), Lines{"gas = { density = 0.1 }\n" + wet_mesh}};
    const std::string both = "density = 2, heat_capacity = 1, conductivity = 1, expansion = 1 }\n";
    const std::string with_heat = "gas = { " + both + "fluid = { " + both + "effects.heat.ambient = 1\ninitial.liquid_temperature = 2\n";
    for (const std::string& line : of_field("temperature", true)) said["two_phase"].lines.push_back(with_heat + line);
    said["tallcell"] = {liquid,
                        all(of_the_run, probes("pressure"), Lines{at_the_wall}, of_the_surface, solids, grid_velocities, Lines{walls[0]},
                            Lines{open_sides[2], open_sides[3], "sides.y_max = \"outflow\"", "effects.volume_control = {}",
                                  "time.cfl = 0.4", "liquid = [ { shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]",
                                  "scheme.poisson = { tolerance = 1e-6, max_iterations = 100, fixed = false }",
                                  "scheme = { columns = \"single\", layers = 9, advection = \"semi_lagrangian\" }",
                                  "time.stop_when_steady = 0.1", "fluid.density = 2", "effects.gravity.g = [0, -1]", rolls, hand}),
                        {inflow + " } }", walls[1], open_sides[0], "grid.periodic = [\"y\"]"},
                        {of_level_set}};
    const Lines flows{"flow = { name = \"constant\", value = [1, 0] }", "flow = { name = \"rotation\", centre = [0, 0], rate = 1 }",
                      "flow = { name = \"single_vortex\", period = 1 }"};
    said["transport"] = {
        {flows[0], "initial.tracer = { name = \"constant\", value = 1 }"},
        all(of_the_run, probes("tracer"), of_field("temperature", true), of_field("smoke", true), of_field("level_set", false),
            of_field("tracer", false), walls, open_sides, flows,
            Lines{inflow + ", profile = \"uniform\" } }", "time.cfl = 0.4",
                  "scheme = { advection = \"maccormack\", interpolation = \"linear\", trace = \"rk2\", limiter = \"clamp\" }",
                  "scheme = { advection = \"conservative\", flux = \"central\" }"}),
        all(of_the_surface, Lines{at_the_wall}),
        {"flow = { name = \"enright\", period = 1 }"}};
    said["poisson"] = {{"problem = \"N1\""}, all(of_the_run, probes("pressure"), poisson, Lines{at_the_wall}), of_the_surface};
    const std::string states =
        "solid = { density = 900, heat_capacity = 2000, conductivity = 0.3 }, liquid = { density = 800, "
        "heat_capacity = 2500, conductivity = 0.2, expansion = 1e-3 }, vapour = { heat_capacity = 1500, "
        "conductivity = 0.02 }";
    const std::string wax =
        "substance = { name = \"own\", triple = [300, 1000], critical = [700, 2e6], fusion = 2e5, vaporisation = 1e6, " + states +
        " }\nfluid.density = 850\ninitial.temperature = { name = \"constant\", value = 310 }\n";
    const std::string fluids[] = {
        "substance = { name = \"ideal_gas\", gas_constant = 287, heat_capacity = 1005, conductivity = 0.026 }",
        "substance = { name = \"van_der_waals\", gas_constant = 461, critical = [647, 2.2e7], liquid = { heat_capacity = 4200, "
        "conductivity = 0.6 }, vapour = { heat_capacity = 2000, conductivity = 0.02 } }"};
    for (const std::string& line :
         {"substance = \"water\"\nfluid.density = 1000\ninitial.temperature = { name = \"constant\", value = 280 }\n" + std::string(),
          wax + "heat = { pressure = 2e3, conduction = \"explicit\", drag = 1e5, lift = 1 }",
          wax + "heat.ambient = { temperature = 310 }\nsides.x_min = { kind = \"wall\", exchange = 5 }",
          wax + "heat.ambient = { keyframes = [ { t = 0, temperature = 310, pressure = 2e3 }, { t = 1, temperature = 320, pressure = 3e3 } "
                "] }",
          wax + "sides.x_min = { kind = \"wall\", heat_flux = 10 }",
          wax + "heaters = [ { shape = \"box\", min = [0.2, 0.2], max = [0.8, 0.8], power = 10, start = 1, end = 2 } ]"})
        said["mac"].lines.push_back(line);
    for (const std::string& line : fluids) said["mac"].refused.push_back(line);
    for (const std::string& line :
         {"substance = \"water\"\nfluid.density = 1000\ninitial.temperature = { name = \"constant\", value = 280 }\n" + std::string(),
          wax + "heat = { pressure = 2e3, drag = 1e5, evaporation = 1e-7, vapour_pressure = 1500 }",
          wax + "heat = { pressure = 2e3, ambient = { temperature = 310 }, surface_exchange = 10 }\nsides.x_min = { kind = \"wall\", "
                "exchange = 5 }",
          wax + "heat = { pressure = 2e3, evaporation = 1e-7, enclosed_vapour = 0.1 }",
          wax + "heat.ambient = { keyframes = [ { t = 0, temperature = 310, pressure = 2e3 }, { t = 1, temperature = 320, pressure = 3e3 } "
                "] }",
          wax + "sides.x_min = { kind = \"wall\", heat_flux = 10 }", wax + "sides.x_min = { kind = \"wall\", temperature = 305 }",
          wax + "heaters = [ { shape = \"box\", min = [0.2, 0.2], max = [0.8, 0.8], power = 10, start = 1, end = 2 } ]"})
        said["mac_water"].lines.push_back(line);
    for (const std::string& line : fluids) said["mac_water"].refused.push_back(line);
    for (const std::string& line : of_field("temperature", true)) said["mac_water"].refused.push_back(line);  // of no substance
    const std::string of_falling = "\nheat.ambient.keyframes = [ { t = 0, pressure = 2e3 }, { t = 1, pressure = 3e3 } ]";
    Lines of_heat{"substance = \"water\"\nfluid.density = 1000\ninitial.temperature = { name = \"constant\", value = 280 }",
                  wax + "heat.pressure = 2e3",
                  wax + "heat.frozen = \"free\"",
                  wax + "sides.x_min = { kind = \"wall\", heat_flux = 10 }",
                  wax + "sides.x_min = { kind = \"wall\", temperature = 320 }",
                  wax + "heat.ambient = { temperature = 310 }\nsides.x_min = { kind = \"wall\", exchange = 5 }",
                  wax +
                      "heat.ambient.keyframes = [ { t = 0, temperature = 310 }, { t = 1, temperature = 320 } ]\nsides.x_min = { kind = "
                      "\"wall\", exchange = 5 }",
                  wax + emitter + ", temperature = 310 } ]",
                  wax + "heaters = [ { shape = \"box\", min = [0.2, 0.2], max = [0.8, 0.8], power = 10, start = 1, end = 2 } ]"};
    for (const char* function :
         {"\"linear\", value = 310, gradient = [1, 0], at = [0, 0]", "\"gaussian\", base = 300, amplitude = 1, centre = [0, 0], width = 1",
          "\"ball\", centre = [0, 0], radius = 1, value = 290, outside = 310", "\"formula\", value = \"300 + x\""})
        of_heat.push_back(wax.substr(0, wax.find("initial")) + "initial.temperature = { name = " + function + " }");
    Lines no_heat{wax + "sides.x_min = { kind = \"outflow\", temperature = 310 }", wax + inflow + ", temperature = 310 } }"};
    no_heat.insert(no_heat.end(), std::begin(fluids), std::end(fluids));
    said["phase_diagram"] = {
        {"substance = \"water\""},
        all(of_the_run, probes("state"),
            Lines{"samples = { temperature = [300], pressure = [1e5] }",
                  "substance = { name = \"own\", triple = [300, 1000], critical = [700, 2e6], fusion = 2e5, vaporisation = 1e6, " + states +
                      " }",
                  fluids[0], fluids[1]}),
        all(of_the_surface, Lines{at_the_wall})};
    const std::string vessel = "vessel = { volume = 2, mass = 10, temperature = 300, transfer = 1e-5";
    said["closed_vessel"] = {
        {"substance = \"water\"", vessel + " }"},
        all(of_the_run, probes("liquid"),
            Lines{vessel + ", vapour = 0.1 }", vessel + ", exchange = 10 }\nheat.ambient.temperature = 310",
                  vessel + " }\nheat = { ambient = { keyframes = [ { t = 0, temperature = 310, pressure = 2e5 } ] } }",
                  vessel + " }\nheat.pressure = 2e5"}),
        all(of_the_surface, Lines{at_the_wall},
            Lines{"substance = { name = \"own\", triple = [300, 1000], critical = [700, 2e6], fusion = 2e5, vaporisation = 1e6, " + states +
                      " }",
                  fluids[0], fluids[1]})};
    said["pbf"] = {
        liquid,
        all(of_the_run, particles, solids, bodies, joints, particle_velocities, of_the_surface, of_heat, Lines{walls[0]}, open_sides,
            Lines{"time.cfl = 0.4", "fluid.density = 2", wax + "heat.vapour = { name = \"own\", density = 600 }" + of_falling,
                  "scheme = { kernel = \"cubic\", support = 2, iterations = 3, cfm = 1, relaxation = 1, warm_start = 0, settle = 1 "
                  "}",
                  "scheme = { tolerance = 0.1, max_iterations = 9, backend = \"threads\" }",
                  "effects.artificial_pressure = { k = 1, dq = 0.1 }"}),
        all(probes("density"),
            Lines{walls[1], at_the_wall, wax + "heat.vapour = \"substance\"",
                  wax + "sides.x_min = { kind = \"moving_wall\", velocity = [0, 1], temperature = 310 }"},
            refused_by_particles, no_heat, endless_bodies),
        all(of_surfaces, Lines{wet_mesh})};
    said["sph"] = {
        liquid,
        all(of_the_run, particles, solids, bodies, joints, particle_velocities, of_the_surface, of_heat, Lines{walls[0], at_the_wall},
            open_sides,
            Lines{"substance = \"water\"\nfluid = { density = 1000, viscosity = 0.01 }\neffects.viscosity = {}\ninitial.temperature = { "
                  "name = \"constant\", value = 280 "
                  "}\nsides.x_min = { kind = \"moving_wall\", velocity = [0, 1], temperature = 310 }"},
            Lines{wax + "scheme.density = \"summation\"\nheat.vapour = \"substance\"",
                  wax + "scheme.density = \"summation\"\nheat.vapour = { name = \"own\", density = 600 }" + of_falling},
            Lines{walls[1] + "\neffects.viscosity = {}\nfluid.viscosity = 0.01", "fluid.density = 2", "initial.surface = [0, 1]",
                  "scheme = { kernel = \"cubic\", support = 2, sound_speed = 10, state = \"tait\", gamma = 7, density = \"delta\" }",
                  "scheme = { backend = \"threads\", tension = true }\neffects.surface_tension.sigma = 1",
                  "effects.viscosity = {}\nfluid.viscosity = 0.01", "effects.density_diffusion.delta = 0.1",
                  "effects.artificial_viscosity.alpha = 0.1", "effects.rest_density = { times = [0], values = [1] }"}),
        all(probes("density"), refused_by_particles, no_heat, endless_bodies), all(of_surfaces, Lines{wet_mesh})};
    const std::string of_input = std::string(WEIR_SOURCE_DIR) + "/tests/input/terrain/", asc = of_input + "hill.asc",
                      pgm = of_input + "hill.pgm";
    const std::string hill = "terrain = { kind = ";
    said["heightfield"] = {
        liquid,
        all(of_the_run, probes("surface"), of_the_surface, open_sides, Lines{walls[0]},
            Lines{"solids = [ { shape = \"box\", min = [0.7, 0.0], max = [0.9, 0.9], slip = \"free\", motion = { kind = \"constant\", "
                  "velocity = "
                  "[0.1, 0] } } ]",
                  "liquid = []\ninitial = { surface = \"0.4 + 0.1*sin(6*x)\", velocity = { name = \"formula\", x = \"0.1\" } }",
                  "liquid = []\ninitial = { surface = \"0.5\", velocity = { name = \"constant\", value = [0.1, 0] } }", inflow + " } }",
                  "sides = { x_min = { kind = \"discharge\", discharge = 0.1 }, x_max = { kind = \"level\", level = 0.5 } }",
                  hill + "\"formula\", height = \"0.1*x\" }", hill + "\"asc\", file = \"" + asc + "\", corner = [0, 0], nodata = 0 }",
                  hill + "\"image\", file = \"" + pgm + "\", black = 0, white = 0.2 }",
                  "scheme = { model = \"shallow_water\", limiter = \"mc\", dry_depth = 1e-5 }", "time.cfl = 0.4",
                  "time.stop_when_steady = 0.1", "fluid.density = 2", "effects.gravity.g = [0, -1]",
                  "effects.friction = { law = \"manning\", n = 0.03 }", "effects.friction = { law = \"quadratic\", c = 0.003 }",
                  "effects.rain = { rate = 0.001, over = [0, 1], start = 0, end = 1 }", "effects.damping.rate = 0.1", hand,
                  "scheme.model = \"columns\"\neffects.gravity.g = [0, -1]\nfloats = [ { size = [0.2, 0.2], at = [0.3, 0.45], density = "
                  "0.5, heave = true, "
                  "motion = { kind = \"constant\", velocity = [0, 0] } } ]"}),
        all(Lines{walls[1], at_the_wall, "liquid = [ { shape = \"sphere\", centre = [0.5, 0.7], radius = 0.1 } ]"}),
        {"liquid = []\ninitial = { surface = \"0.5\", velocity = { name = \"formula\", x = \"0.1\", z = \"0.1\" } }",
         "liquid = [ { shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]"}};
    const std::string falls = "\neffects.gravity.g = [0, -9.81", sea = "waves = { model = \"spectrum\", ", wind = "spectrum = { kind = ";
    const std::string of_sea = sea + "heading = 0, choppiness = 0, shortest = 0.2, seed = 2, amplitudes = \"gaussian\", " + wind;
    const std::string rest = "level = 0.5, depth = 0.5, velocity = true, ", way = "heading = 0, phase = 1", trains = "trains = [ { ",
                      train = trains + "amplitude = 0.01, wavelength = 0.5, " + way + " } ]";
    said["waves"] = {
        {"waves = { model = \"sines\", " + rest + train + " }"},
        all(of_the_run, probes("velocity"), of_the_surface,
            Lines{"fluid.density = 2", "effects.gravity.g = [0, -1]", "effects.surface_tension.sigma = 1",
                  "waves = { model = \"gerstner\", " + rest + train + " }\neffects.foam.below = 0.5",
                  "waves = { model = \"gerstner\", lean = 1, flatten = 2, tilt = 1, bed = { x = [0, 1], depth = [1, 0.5] }, " + train +
                      " }" + falls + "]",
                  of_sea + "\"pierson_moskowitz\", wind = 0.8 } }" + falls + "]",
                  of_sea + "\"jonswap\", wind = 1, fetch = 1000, gamma = 2 } }" + falls + "]",
                  of_sea + "\"phillips\", wind = 1, alpha = 0.001 } }" + falls + "]",
                  "waves = { model = \"stokes\", height = 0.01, wavelength = 0.5, order = 2, " + way + " }" + falls + "]",
                  "waves = \"basin\"\nliquid = [ { shape = \"wave\", level = 0.5, amplitude = 0.1, wavelength = 1 } ]" + falls + "]"}),
        {at_the_wall},
        {sea + "spread = 2, " + wind + "\"pierson_moskowitz\", wind = 0.8 } }" + falls + ", 0]"}};
    said["reconstruction"] = {
        {},
        {},
        {},
        all(of_surfaces,
            Lines{of_surfaces[0] + "\ntitle = \"a\"\ngrid.origin = [0, 0, 0]\njitter = 0.1\ntime.dt = 0.5",
                  of_surfaces[0] +
                      "\ntime.max_dt = 0.5\ntime.guard = \"off\"\noutput.every = 0.5\noutput.at = \"exact\"\noutput.fields = []\n" +
                      "output.format = \"vtk\"\noutput.faces = true\noutput.precision = \"single\"\noutput.compression = \"none\""})};
    return said;
}

/// The same code reads all sides; all fields, whatever their function, once a field is read at all; and shapes and motions of all solvers.
/// "open" is another word for "outflow".
std::string written_once(std::string key, const std::string& solver) {
    static const std::regex side("sides\\.[xyz]_m(in|ax)"),
        field("initial\\.[a-z_]+<(linear|gaussian|ball|distance|slotted_disk|formula)>"), open("<open>");
    key = std::regex_replace(key, side, "sides");
    key = std::regex_replace(key, field, "initial.<$1>");
    key = std::regex_replace(key, open, "<outflow>");
    return key.starts_with('<') ? key : solver + ": " + key;
}

/// What the scene gives counts as read where somebody read it, or where all of it was refused as it should be.
void note_one(const scene::Scene& scene, const scene::SolverSchema& schema, bool refused, const std::string& line,
              std::set<std::string>& read) {
    try {
        const Simulation simulation(scene);
        EXPECT_FALSE(refused) << schema.name << " accepts " << line;
        for (const auto& key : scene::given_keys(simulation.scene(), schema))
            if (key.read) read.insert(written_once(key.schema, schema.name));
    } catch (const BadInput& error) {
        EXPECT_TRUE(refused) << schema.name << ": " << error.what();
        for (const auto& key : scene::given_keys(scene, schema)) read.insert(written_once(key.schema, schema.name));
    }
}

}  // namespace

TEST("every key that a solver's schema allows is read in a scene that names it") {
    const auto said = everything();
    std::set<std::string> read;  // of shapes and motions, by any solver; of others with the solver's name
    for (const auto& schema : sim::schemas()) {
        if (!said.contains(schema.name)) {
            ADD_FAILURE() << "everything() has no lines for solver \"" << schema.name << "\": add lines that give each of its keys";
            continue;
        }
        const auto note = [&](const std::string& line, bool refused, bool flat = true) {
            std::string source =
                "solver = \"" + schema.name + "\"\ntime.end = 1\n" +
                (flat ? "dim = 2\ngrid.cells = [8, 8]\ngrid.size = [1, 1]\n" : "dim = 3\ngrid.cells = [8, 8, 8]\ngrid.size = [1, 1, 1]\n");
            for (const auto& least : said.at(schema.name).least)
                if (!line.starts_with(least.substr(0, least.find(' ')))) source += flat ? least + "\n" : "";
            source += line + "\n";
            if (!flat && schema.name == "transport") source += "initial.tracer = { name = \"constant\", value = 1 }\n";
            try {
                const scene::Scene scene = scene::parse(source, "scene.toml", sim::schemas());
                note_one(scene, schema, refused, line, read);
            } catch (const BadInput& error) {
                ADD_FAILURE() << schema.name << ": " << error.what();
            }
        };
        for (const auto& line : said.at(schema.name).lines) note(line, false);
        for (const auto& line : said.at(schema.name).refused) note(line, true);
        for (const auto& line : said.at(schema.name).in_3d) note(line, false, false);
    }
    for (const auto& schema : sim::schemas()) {
        std::set<std::string> missing;
        for (const auto& key : scene::every_key(schema))
            if (const auto name = written_once(key, schema.name); read.count(name) == 0) missing.insert(name);
        EXPECT_EQ(missing, std::set<std::string>{}) << schema.name;
    }
}
