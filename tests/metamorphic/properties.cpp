#include "metamorphic/properties.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::metamorphic {
namespace {

using scene::Table;

std::size_t at(int a) { return static_cast<std::size_t>(a); }

bool has_particles(const scene::Scene& s) { return s.solver() == "sph" || s.solver() == "pbf"; }

std::vector<double> widths(const scene::Scene& s) {
    const auto &n = s.root().numbers("grid.cells"), &size = s.root().numbers("grid.size");
    std::vector<double> h;
    for (std::size_t a = 0; a < size.size(); ++a) h.push_back(size[a] / n[a]);
    return h;
}

Snapshot run(const scene::Scene& scene, int steps) {
    Simulation simulation(scene);
    return run_steps(simulation, steps);
}

/// A pressure after so many iterations, converged or not, depends on the order in which a method visits cells.
bool stops_early(const scene::Scene& s) { return s.has("scheme.poisson.fixed") && s.root().flag("scheme.poisson.fixed"); }
bool has_bodies(const scene::Scene& s) { return s.has("bodies") && !s.root().tables("bodies").empty(); }

// Two descriptions of the same numbers differ in the last bits, and a step carries that on: through the pressure, solved to 1e-12; through
// the turns of bodies and pressure, which end at a hundredth of a change; through single-precision pairs of particles. Ten steps multiply
// it by less than a thousand in any scene that is not at a threshold.
real round_off(const Base& b) { return has_particles(b.scene) ? 2e-3 : has_bodies(b.scene) ? 1e-4 : 1e-6; }

// A power of two changes exponents only: every operation of a homogeneous formula gives the same digits, square roots too where masses
// become a power of four, and cube roots of lengths where these become a power of eight.
constexpr real no_digit = 1e-13;

// Of energy, forces and speeds: three times what another seed of the markers makes of them, and a fiftieth where that is nothing.
real likeness(const Base& b, real least = 0.02) { return std::max(least, 3 * b.noise); }

Outcome against_image(const Base& base, const Transformation& by) {
    const Snapshot expected = image(base.state, by), actual = run(transformed(base.read, by), base.steps);
    Outcome outcome{.equal_bound = round_off(base), .equal = difference(expected, actual, by), .alike_bound = {}, .alike = {}};
    const bool thresholds = base.scene.solver() == "mac_water" || has_particles(base.scene) || stops_early(base.scene);
    if (thresholds) outcome.alike_bound = likeness(base), outcome.alike = statistics(expected, actual, by);
    return outcome;
}

Outcome alike(const Snapshot& expected, const Snapshot& actual, real bound, bool same_domain = true) {
    return {.equal_bound = {}, .equal = {}, .alike_bound = bound, .alike = statistics(expected, actual, {}, same_domain)};
}

/// Everything goes elsewhere by whole cells, the domain too.
Outcome moved(const Base& base) {
    Transformation by;
    const auto h = widths(base.scene);
    for (std::size_t a = 0; a < h.size(); ++a) by.shift[a] = (a == 1 ? 24 : -40) * h[a];
    return against_image(base, by);
}

Outcome mirrored(const Base& base, int a) {
    if (a >= base.state.dim) throw Untransformable("it has two dimensions");
    return against_image(base, Transformation::mirror(a));
}

Outcome exchanged(const Base& base) {
    if (base.scene.solver() == "heightfield" || base.scene.solver() == "tallcell") {
        if (base.state.dim == 2) throw Untransformable("columns stand along y");
        return against_image(base, Transformation::exchange(0, 2));
    }
    return against_image(base, base.state.dim == 2 ? Transformation::exchange(0, 1) : Transformation::cycle());
}

Outcome in_units(const Base& base, UnitScale scale) {
    Transformation by;
    by.scale = scale;
    return {.equal_bound = no_digit,
            .equal = difference(image(base.state, by), run(transformed(base.read, by), base.steps), by),
            .alike_bound = {},
            .alike = {}};
}

/// A shape together with its images one period away on both sides, as one.
Table with_images(const Table& shape, const Table& before, const Table& after) {
    const auto parts = [](const Table& t, bool of_shape) {
        const auto& variant = *std::find_if(scene::shapes().begin(), scene::shapes().end(),
                                            [&](const scene::Variant& v) { return v.name == std::get<std::string>(*t.find("shape")); });
        Table out;
        for (const auto& key : t.keys())
            if ((key == "shape" || scene::find_key(variant.keys, key)) == of_shape) out.set(key, *t.find(key), t.place(key));
        return out;
    };
    Table all = parts(shape, false);
    all.set("shape", std::string("union"), {1, 1});
    all.set("of", std::vector<Table>{parts(shape, true), parts(before, true), parts(after, true)}, {1, 1});
    return all;
}

/// The origin lies a few cells further along every periodic axis; shapes have their images there.
Outcome rolled_along(const Base& base) {
    if (base.scene.root().tables("bodies").size() > 0) throw Untransformable("bodies do not wrap");
    std::array<int, 3> cells{0, 0, 0};
    for (int a = 0; a < base.state.dim; ++a)
        if (base.state.periodic[at(a)]) cells[at(a)] = std::min(3, base.state.cells[at(a)] - 1);
    if (cells == std::array<int, 3>{0, 0, 0}) throw Untransformable("no periodic axis");
    Table root = base.read.root();
    for (int a = 0; a < base.state.dim; ++a) {
        if (!cells[at(a)]) continue;
        Transformation back, forth;
        back.shift[at(a)] = -base.state.size[at(a)], forth.shift[at(a)] = base.state.size[at(a)];
        const scene::Scene current = scene_of_table(root, base.scene.file());
        const Table before = transformed_table(current, back, false), after = transformed_table(current, forth, false);
        for (const char* key : {"liquid", "solids", "emitters"}) {
            std::vector<Table> all;
            for (std::size_t i = 0; root.has(key) && i < root.tables(key).size(); ++i)
                all.push_back(with_images(root.tables(key)[i], before.tables(key)[i], after.tables(key)[i]));
            if (!all.empty()) root.set(key, all, {1, 1});
        }
    }
    auto origin = root.numbers("grid.origin");
    for (int a = 0; a < base.state.dim; ++a) origin[at(a)] += cells[at(a)] * widths(base.scene)[at(a)];
    root.find_table("grid")->set("origin", origin, {1, 1});
    const Snapshot expected = rolled(base.state, cells), actual = run(scene_of_table(root, base.scene.file()), base.steps);
    return {.equal_bound = round_off(base),
            .equal = difference(expected, actual, {}),
            .alike_bound = likeness(base),
            .alike = statistics(expected, actual)};
}

/// Everything but the domain goes elsewhere by a part of a cell.
Outcome nudged(const Base& base, double part) {
    if (has_particles(base.scene)) throw Untransformable("particles begin on the lattice of the domain");
    Transformation by;
    const auto h = widths(base.scene);
    const bool level = base.scene.solver() == "tallcell" || base.scene.solver() == "heightfield";
    for (std::size_t a = 0; a < h.size(); ++a)
        if (!base.state.periodic[a] && !(level && a == 1)) by.shift[a] = (a == 1 ? -part : part) * h[a];
    try {
        // By half a cell another body cuts other cells: of small scenes what moves is then not the same, what is kept is.
        return alike(base.state, run(transformed(base.read, by, false), base.steps), part < 0.1 ? likeness(base, 0.1) : infinity);
    } catch (const scene::BadScene&) {
        throw Untransformable("a part of it would leave the domain");
    }
}

/// Frames and probes are asked for, and the state at the end is the same.
Outcome watched(const Base& base, int frames) {
    Table root = base.read.root();
    const double end = base.state.time;
    root.find_table("time")->set("end", end, {1, 1});
    const auto until_end = [&](const Table& table) {
        Simulation simulation(scene_of_table(table, base.scene.file()));
        const auto start = simulation.solver().integrals();
        while (!simulation.finished()) simulation.step();
        return snapshot(simulation, start);
    };
    const Snapshot alone = until_end(root);
    if (Table* output = root.find_table("output")) output->set("every", end / frames, {1, 1});
    return {.equal_bound = 0, .equal = difference(alone, until_end(root), {}), .alike_bound = {}, .alike = {}};
}

constexpr int gained = 3;  // cells

/// Walls of the domain become solids: it is larger by some cells beyond each wall, and a box of the same slip fills what it gained.
Outcome with_solid_walls(const Base& base) {
    const std::string& solver = base.scene.solver();
    if (solver != "mac" && solver != "mac_water" && solver != "two_phase" && solver != "tallcell" && !has_particles(base.scene))
        throw Untransformable("walls of " + solver + " are its sides");
    if (solver == "two_phase" && base.scene.effect("surface_tension")) throw Untransformable("two_phase has no tension beside solids");
    if (base.scene.has("substance")) throw Untransformable("heat passes solids");
    Table root = base.read.root();
    Table& grid = *root.find_table("grid");
    auto cells = grid.numbers("cells"), size = grid.numbers("size"), origin = grid.numbers("origin");
    const auto h = widths(base.scene);
    std::vector<Table> solids = root.tables("solids");
    const auto inner = origin, outer = size;
    int walls = 0;
    for (int a = 0; a < base.state.dim; ++a)
        for (const bool upper : {false, true}) {
            const std::string name = std::string(1, "xyz"[a]) + (upper ? "_max" : "_min");
            const Table& side = root.table("sides").table(name);
            if (base.state.periodic[at(a)] || side.text("kind") == "periodic") continue;
            if (side.text("kind") != "wall") throw Untransformable("a side is not a wall");
            size[at(a)] += gained * h[at(a)], cells[at(a)] += gained;
            if (!upper) origin[at(a)] -= gained * h[at(a)];
            std::vector<double> low, high;
            for (int d = 0; d < base.state.dim; ++d) {
                const double reach = (gained + 1) * h[at(d)];
                low.push_back(d == a && upper ? inner[at(d)] + outer[at(d)] : inner[at(d)] - reach);
                high.push_back(d == a && !upper ? inner[at(d)] : inner[at(d)] + outer[at(d)] + reach);
            }
            Table box;
            box.set("shape", std::string("box"), {1, 1}), box.set("min", low, {1, 1}), box.set("max", high, {1, 1});
            if (side.text("slip") == "no") box.set("slip", std::string("no"), {1, 1});
            solids.push_back(box), ++walls;
        }
    if (!walls) throw Untransformable("no walls");
    grid.set("cells", cells, {1, 1}), grid.set("size", size, {1, 1}), grid.set("origin", origin, {1, 1});
    root.set("solids", solids, {1, 1});
    // Walls on lines of the grid are the same walls; particles feel a solid by its distance and a side by its plane.
    const real bound = likeness(base, has_particles(base.scene) ? 0.1 : 0.02);
    return alike(base.state, run(scene_of_table(root, base.scene.file()), base.steps), bound, false);
}

}  // namespace

Snapshot run_steps(Simulation& simulation, int steps) {
    const auto start = simulation.solver().integrals();
    for (int i = 0; i < steps; ++i) simulation.step_until(infinity);
    return snapshot(simulation, start);
}

real noise_of(const Base& base) {
    const bool seeded = base.scene.solver() == "mac_water" && base.scene.text("scheme.transfer") != "grid";
    Table root = base.read.root();
    if (seeded) root.find_table("scheme")->set("seed", std::int64_t{7}, {1, 1});
    Transformation odd;
    odd.scale.length = 3;  // no power of two: rounding differs
    real noise = 0;
    try {
        const Statistics s = statistics(image(base.state, odd), run(transformed(base.read, odd), base.steps), odd);
        noise = s.moved.value;
    } catch (const Untransformable&) {
    }
    if (seeded) noise = std::max(noise, statistics(base.state, run(scene_of_table(root, base.scene.file()), base.steps)).moved.value);
    return noise;
}

const std::vector<Property>& properties() {
    static const std::vector<Property> list = {
        {"moved", "all of the scene by whole cells", moved},
        {"rolled", "the origin of periodic axes by whole cells", rolled_along},
        {"nudged 0.01", "all but the domain by a hundredth of a cell", [](const Base& b) { return nudged(b, 0.01); }},
        {"nudged 0.5", "all but the domain by half a cell", [](const Base& b) { return nudged(b, 0.5); }},
        {"mirror x", "x against -x", [](const Base& b) { return mirrored(b, 0); }},
        {"mirror y", "y against -y", [](const Base& b) { return mirrored(b, 1); }},
        {"mirror z", "z against -z", [](const Base& b) { return mirrored(b, 2); }},
        {"exchange", "axes change places", exchanged},
        {"lengths x 64", "units of length",
         [](const Base& b) {
             return in_units(b, {64, 1, 1});
         }},
        {"times x 4", "units of time",
         [](const Base& b) {
             return in_units(b, {1, 4, 1});
         }},
        {"masses x 4", "units of mass",
         [](const Base& b) {
             return in_units(b, {1, 1, 4});
         }},
        {"watched x 3", "three frames in place of one", [](const Base& b) { return watched(b, 3); }},
        {"watched x 7", "seven frames in place of one", [](const Base& b) { return watched(b, 7); }},
        {"solid walls", "walls of the domain by solids", with_solid_walls},
    };
    return list;
}

}  // namespace weir::metamorphic
