#include "mac/grid/initial.hpp"

#include "mac/grid/inflow.hpp"
#include "mac/grid/random_flow.hpp"
#include "scene/formula.hpp"
#include "scene/names.hpp"

#include <algorithm>
#include <stdexcept>

namespace weir::mac {

namespace {

using scene::Key;
using scene::Type;
using scene::Variant;

Key number(const char* name, const char* doc, const char* unit, std::optional<double> fallback) {
    Key key{.name = name, .type = Type::number, .doc = doc, .unit = unit, .required = !fallback};
    if (fallback) key.fallback = *fallback;
    return key;
}
Key point(const char* name, const char* doc) {
    return {.name = name, .type = Type::numbers, .doc = doc, .unit = "m", .required = true, .length = -1};
}

std::vector<Variant> velocity_variants() {
    return {{"rest", "No motion.", {}},
            {"taylor_green",
             "U (sin kx cos ky [cos kz], -cos kx sin ky [cos kz], 0): Taylor & Green 1937.",
             {number("speed", "U.", "m/s", 1), number("wavenumber", "k.", "1/m", 1)}},
            {"kovasznay", "Kovasznay's wake behind a grid (1948) at Re = 1 / viscosity.", {}},
            {"shear_layer",
             "Two rolled-up shear layers: U tanh((y - 1/4) / w), U tanh((3/4 - y) / w), stirred by d sin 2 pi x (Brown & Minion 1995); "
             "lengths in units of the unit square.",
             {number("speed", "U.", "m/s", 1), number("width", "w.", "m", 1.0 / 30), number("stir", "d.", "m/s", 0.05)}},
            {"random",
             "Solenoidal noise: the curl of random potentials on corners or edges.",
             {number("speed", "Largest potential difference over a cell size.", "m/s", 1),
              Key{.name = "seed", .type = Type::integer, .doc = "Seed of the noise.", .fallback = std::int64_t{1}}}}};
}

std::vector<Variant> field_variants() {
    const Key inside = number("value", "Inside.", "", 1), outside = number("outside", "Outside.", "", 0);
    return {{"ball",
             "One value in a ball, another outside.",
             {point("centre", "Centre."), number("radius", "Radius.", "m", {}), inside, outside}},
            {"distance",
             "Signed distance to a sphere (circle), negative inside.",
             {point("centre", "Centre."), number("radius", "Radius.", "m", {})}},
            {"slotted_disk",
             "Signed distance to Zalesak's slotted disk (1979), negative inside.",
             {point("centre", "Centre of the disk."), number("radius", "Radius.", "m", 0.15),
              number("slot", "Width of the slot.", "m", 0.05), number("top", "Height of the slot's end above the centre.", "m", 0.1)}},
            scene::formula_variant("")};
}

Key field_key(const std::string& name) {
    Key key{.name = name, .type = Type::table, .doc = "Field \"" + name + "\" at t = 0.", .selector = "name"};
    key.variants = field_variants();
    return key;
}

template <int D>
Vec<D> taylor_green(const Vec<D>& x, real speed, real k) {
    Vec<D> u{};
    real depth = speed;
    if constexpr (D == 3) depth *= std::cos(k * x[2]);
    u[0] = depth * std::sin(k * x[0]) * std::cos(k * x[1]);
    u[1] = -depth * std::cos(k * x[0]) * std::sin(k * x[1]);
    return u;
}

/// Distance to the segment from a to b.
real to_segment(const Vec<2>& x, const Vec<2>& a, const Vec<2>& b) {
    const Vec<2> ab = b - a;
    const real s = std::clamp(dot(x - a, ab) / dot(ab, ab), 0.0, 1.0);
    return norm(x - (a + s * ab));
}

/// Signed distance to a disk with a vertical slot cut from below, exact: the boundary is an arc and three segments.
real slotted_disk(const Vec<2>& y, real radius, real width, real top) {
    const real w = width / 2, foot = -std::sqrt(radius * radius - w * w);
    const bool in_slot = std::abs(y[0]) < w && y[1] < top;
    const bool inside = norm(y) < radius && !in_slot;
    real d = std::min(
        {to_segment(y, {{-w, foot}}, {{-w, top}}), to_segment(y, {{w, foot}}, {{w, top}}), to_segment(y, {{-w, top}}, {{w, top}})});
    const real r = norm(y);
    const bool arc_is_near = r == 0 || !(y[1] / r * radius < foot);  // the closest point of the circle is not in the slot's mouth
    if (arc_is_near) d = std::min(d, std::abs(r - radius));
    return inside ? -d : d;
}

}  // namespace

Key initial_keys(const std::vector<std::string>& extra_fields) {
    Key velocity{.name = "velocity", .type = Type::table, .selector = "name"};
    velocity.variants = velocity_variants();
    Key initial{.name = "initial", .type = Type::table, .keys = {velocity, field_key("temperature"), field_key("smoke")}};
    for (const auto& name : extra_fields) {
        Key key = field_key(name);
        for (const auto& common : scene::common_keys())  // a new field also accepts the common shapes
            if (const Key* smoke = common.name == "initial" ? scene::find_key(common.keys, "smoke") : nullptr)
                for (const auto& variant : scene::variants_of(*smoke)) key.variants.push_back(variant);
        initial.keys.push_back(key);
    }
    return initial;
}

std::vector<std::string> initial_fields(const scene::Scene& scene) {
    std::vector<std::string> names;
    if (!scene.has("initial")) return names;
    for (const auto& key : scene.root().table("initial").keys())
        if (key != "velocity" && scene.has("initial." + key)) names.push_back(key);
    return names;
}

template <int D>
std::function<Vec<D>(const Vec<D>&)> velocity_function(const scene::Table& table, real nu) {
    const std::string& name = table.text("name");
    if (name == "rest") return [](const Vec<D>&) { return Vec<D>{}; };
    if (name == "constant") return [u = table.vec<D>("value")](const Vec<D>&) { return u; };
    if (name == "taylor_green")
        return [speed = table.number("speed"), k = table.number("wavenumber")](const Vec<D>& x) { return taylor_green(x, speed, k); };
    if (name == "kovasznay") return [nu](const Vec<D>& x) { return kovasznay(x, nu); };
    if (name == "shear_layer")
        return [speed = table.number("speed"), width = table.number("width"), stir = table.number("stir")](const Vec<D>& x) {
            Vec<D> u{};
            u[0] = speed * std::tanh((x[1] < 0.5 ? x[1] - 0.25 : 0.75 - x[1]) / width);
            u[1] = stir * std::sin(2 * pi * x[0]);
            return u;
        };
    throw std::logic_error("initial velocity \"" + name + "\" is in the schema but has no meaning");
}

template <int D>
std::function<real(const Vec<D>&)> field_function(const scene::Table& table) {
    const std::string& name = table.text("name");
    if (name == "constant") return [value = table.number("value")](const Vec<D>&) { return value; };
    if (name == "linear")
        return [value = table.number("value"), slope = table.vec<D>("gradient"), at = table.vec<D>("at")](const Vec<D>& x) {
            return value + dot(slope, x - at);
        };
    const auto centre = table.vec<D>("centre");
    if (name == "gaussian")
        return [centre, base = table.number("base"), height = table.number("amplitude"), w = table.number("width")](const Vec<D>& x) {
            return base + height * std::exp(-dot(x - centre, x - centre) / (2 * w * w));
        };
    if (name == "slotted_disk")
        return [centre, r = table.number("radius"), slot = table.number("slot"), top = table.number("top")](const Vec<D>& x) {
            return slotted_disk({{x[0] - centre[0], x[1] - centre[1]}}, r, slot, top);
        };
    const real radius = table.number("radius");
    if (name == "distance") return [centre, radius](const Vec<D>& x) { return norm(x - centre) - radius; };
    if (name == "ball")
        return [centre, radius, in = table.number("value"), out = table.number("outside")](const Vec<D>& x) {
            return norm(x - centre) < radius ? in : out;
        };
    throw std::logic_error("initial field \"" + name + "\" is in the schema but has no meaning");
}

template <int D>
void set_initial_velocity(MacState<D>& s, const scene::Scene& scene) {
    if (scene.has("initial.velocity.name")) {
        const auto& table = scene.root().table("initial.velocity");
        if (table.text("name") == "random") {
            set_random_flow(s.u, table.number("speed"), static_cast<std::uint64_t>(table.integer("seed")));
        } else {
            const auto velocity = velocity_function<D>(table, s.nu);
            for (int a = 0; a < D; ++a)
                for_each_cell(s.u[a].extent(), [&](const Index<D>& I) { s.u[a](I) = velocity(s.u.face_centre(a, I))[a]; });
        }
    }
    set_side_faces(s.u, s.sides, s.nu);
    sync_periodic(s.u, s.sides);
}

/// Serial over cells, because threads evaluating a formula would wait for one another. Throws on all ranks where a formula has no value.
template <int D>
static void set_by_formula(Grid<real, D>& q, const MacVelocity<D>& grid, const scene::Scene& scene, const std::string& path) {
    const auto value = scene::formula_of_place<D>(scene, path);
    for (std::size_t c = 0; c < product(q.extent()); ++c) {
        const Index<D> I = index_of<D>(q.extent(), c);
        const Vec<D> x = grid.cell_centre(I);
        const real here = value(x);
        if (q.store().holds(I[D - 1])) q[c] = here;
        if (std::isfinite(here)) continue;
        std::string place;
        for (int a = 0; a < D; ++a) place += (a == 0 ? "" : ", ") + std::string(1, "xyz"[a]) + " = " + scene::number_text(x[a]);
        scene.refuse(path, path + " has no value at " + place);
    }
}

template <int D>
void set_initial_field(Grid<real, D>& q, const MacVelocity<D>& grid, const scene::Scene& scene, const std::string& name) {
    const std::string path = "initial." + name;
    if (!scene.has(path)) return;
    if (scene.text(path + ".name") == "formula") return set_by_formula(q, grid, scene, path + ".value");
    const auto value = field_function<D>(scene.root().table(path));
    for_each_cell(q.extent(), [&](const Index<D>& I) { q(I) = value(grid.cell_centre(I)); });
}

template std::function<Vec<2>(const Vec<2>&)> velocity_function(const scene::Table&, real);
template std::function<Vec<3>(const Vec<3>&)> velocity_function(const scene::Table&, real);
template std::function<real(const Vec<2>&)> field_function(const scene::Table&);
template std::function<real(const Vec<3>&)> field_function(const scene::Table&);
template void set_initial_velocity(MacState<2>&, const scene::Scene&);
template void set_initial_velocity(MacState<3>&, const scene::Scene&);
template void set_initial_field(Grid<real, 2>&, const MacVelocity<2>&, const scene::Scene&, const std::string&);
template void set_initial_field(Grid<real, 3>&, const MacVelocity<3>&, const scene::Scene&, const std::string&);

}  // namespace weir::mac
