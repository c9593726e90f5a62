#include "heightfield/start.hpp"

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "geometry/line.hpp"
#include "heightfield/raster.hpp"
#include "scene/formula.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace weir::heightfield {

namespace {

using scene::Scene;

std::vector<std::string> coordinates(const Plane& plane) {
    return plane.dim == 2 ? std::vector<std::string>{"x"} : std::vector<std::string>{"x", "z"};
}

/// f(i, k) for every column of these rows, threaded over rows.
template <class F>
void for_each_in_rows(const Plane& plane, const std::vector<PlaneRange>& rows, F&& f) {
    for_each_row(rows, [&](int k) {
        for (int i = 0; i < plane.nx; ++i) f(i, k);
    });
}

/// The entry of the first row with a column found; -1 where there is none.
std::int64_t first_of_rows(const Plane& plane, const std::vector<int>& found) {
    std::int64_t first = -1;
    for (int k = plane.nz - 1; k >= 0; --k)
        if (const int i = found[static_cast<std::size_t>(k)]; i >= 0) first = static_cast<std::int64_t>(plane.at(i, k));
    return first_of_ranks(plane, first);
}

/// The formula at `path`, evaluated at the centre of each column; rejected where it has no value.
Field formula_field(const Scene& scene, const std::string& path, const Plane& plane) {
    const scene::Formula f = scene::formula_at(scene, path, coordinates(plane));
    Field values(plane.extent());
    std::int64_t bad = -1;
    for (const PlaneRange& rows : rows_stored(plane))
        for (int k = rows.begin; k < rows.end; ++k)  // serial: threads would wait for one another
            for (int i = 0; i < plane.nx; ++i) {
                const real at[2] = {plane.x(i), plane.z(k)};
                const std::size_t c = plane.at(i, k);
                values[c] = f(at);
                if (bad < 0 && !std::isfinite(values[c])) bad = static_cast<std::int64_t>(c);
            }
    if (bad = first_of_ranks(plane, bad); bad >= 0)
        scene.refuse(path, fmt::format("{} has no value at x = {:g}, z = {:g}", path, plane.x(static_cast<int>(bad % plane.nx)),
                                       plane.z(static_cast<int>(bad / plane.nx))));
    return values;
}

/// Errors of a file reader are reported at the key that names the file.
template <class Read>
Raster raster_at(const Scene& scene, const std::string& path, Read&& read) {
    try {
        return read(scene.root().file(path));
    } catch (const scene::BadScene&) {
        throw;
    } catch (const BadInput& bad) {
        scene.refuse(path, bad.what());
    }
}

Raster read_raster(const Scene& scene, const Plane& plane) {
    const bool image = scene.text("terrain.kind") == "image";
    std::optional<real> nodata;
    if (!image && scene.has("terrain.nodata")) nodata = scene.number("terrain.nodata");
    Raster r = raster_at(scene, "terrain.file", [&](const auto& file) { return image ? read_pgm(file) : read_asc(file, nodata); });
    if (image) {  // it covers the domain
        const real black = scene.number("terrain.black"), white = scene.number("terrain.white");
        for (real& v : r.value) v = black + (white - black) * v;
        r.x0 = plane.x0, r.z0 = plane.z0;
        r.dx = plane.nx * plane.dx / r.nx, r.dz = plane.nz * plane.dz / r.nz;
        return r;
    }
    if (scene.has("terrain.corner")) r.x0 = scene.root().numbers("terrain.corner")[0], r.z0 = scene.root().numbers("terrain.corner")[1];
    const real x1 = plane.x0 + plane.nx * plane.dx, z1 = plane.z0 + plane.nz * plane.dz, slack = 1e-9 * (x1 - plane.x0);
    const bool covers =
        r.x0 <= plane.x0 + slack && r.x1() >= x1 - slack && (plane.dim == 2 || (r.z0 <= plane.z0 + slack && r.z1() >= z1 - slack));
    if (!covers)
        scene.refuse(
            "terrain.file",
            fmt::format(
                "the grid reaches from [{:g}, {:g}] to [{:g}, {:g}] m; it does not contain the domain from [{:g}, {:g}] to [{:g}, {:g}] m",
                r.x0, r.z0, r.x1(), r.z1(), plane.x0, plane.z0, x1, z1),
            "terrain.corner sets the position of the grid's lower corner");
    return r;
}

struct Span {
    real low = 0, high = -1;
    bool gap = false;  // air below it
    bool empty() const { return high < low; }
};

/// Relative to a line's length: largest gap above the bed at which a shape still stands on it.
constexpr int hover_parts = 64;

/// The part of a line from `low` to `high` inside the shape, exact for any thickness, so that a box has the same top over each of its
/// columns. Parts closer than a millionth of the line are joined.
template <int D>
Span span_of(const geometry::Shape<D>& shape, const geometry::Pose<D>& pose, real x, real z, real low, real high) {
    thread_local std::vector<geometry::Interval> inside;
    geometry::Line<D> line{{}, 1, low, high, pose};
    line.x[0] = x;
    if constexpr (D == 3) line.x[2] = z;
    geometry::find_inside(shape, line, inside);
    Span span;
    if (inside.empty()) return span;
    span.low = inside.front().low, span.high = inside.back().high;
    for (std::size_t i = 1; i < inside.size(); ++i) span.gap = span.gap || inside[i].low - inside[i - 1].high > 1e-6 * (high - low);
    return span;
}

template <int D>
void pour(const Scene& scene, State& state) {
    const Plane& plane = state.plane;
    const auto shapes = geometry::make_shapes<D>(scene.root().tables("liquid"));
    const geometry::Pose<D> rest;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        std::vector<int> bad(static_cast<std::size_t>(plane.nz), -1);
        for_each_in_rows(plane, rows_stored(plane), [&](int i, int k) {
            const std::size_t c = plane.at(i, k);
            const real bed = state.bed[c];
            if (!(bed < plane.ceiling)) return;
            const Span water = span_of<D>(*shapes[s], rest, plane.x(i), plane.z(k), bed, plane.ceiling);
            if (water.empty()) return;
            const real slack = (plane.ceiling - bed) / hover_parts;
            if (water.gap || water.low > bed + state.h[c] + slack) bad[static_cast<std::size_t>(k)] = i;
            state.h[c] = std::max(state.h[c], water.high - bed);
        });
        if (const std::int64_t c = first_of_rows(plane, bad); c >= 0)
            scene.refuse(
                fmt::format("liquid[{}]", s),
                fmt::format("this water is above air at x = {:g}, z = {:g}: a height field fills each column from its bed to one surface",
                            plane.x(static_cast<int>(c % plane.nx)), plane.z(static_cast<int>(c / plane.nx))),
                "use solver \"mac_water\", \"pbf\" or \"sph\" for drops and overturning waves");
    }
}

void give_velocity(const Scene& scene, State& state) {
    if (!scene.has("initial.velocity")) return;
    const Plane& plane = state.plane;
    const auto set = [&](Field& q, const auto& u) {
        for_each_column(plane, rows_stored(plane), [&](std::size_t c) { q[c] = state.h[c] > state.dry ? state.h[c] * u(c) : 0; });
    };
    if (scene.text("initial.velocity.name") == "formula") {
        const Field u = formula_field(scene, "initial.velocity.x", plane);
        set(state.qx, [&](std::size_t c) { return u[c]; });
        if (plane.dim == 2) return;
        const Field w = formula_field(scene, "initial.velocity.z", plane);
        set(state.qz, [&](std::size_t c) { return w[c]; });
        return;
    }
    const auto& value = scene.root().numbers("initial.velocity.value");
    if (value[1] != 0) scene.refuse("initial.velocity.value", "a height field has no vertical velocity: that along y is 0");
    set(state.qx, [&](std::size_t) { return value[0]; });
    if (plane.dim == 3) set(state.qz, [&](std::size_t) { return value[2]; });
}

template <int D>
class Raised final : public RaisedBed {
public:
    Raised(const Scene& scene, const Plane& plane) : plane_(plane), solids_(scene) {
        for (std::size_t s = 0; s < solids_.count(); ++s)
            if (solids_[s].no_slip)
                scene.refuse(fmt::format("solids[{}].slip", s), "a height field has no boundary layers: its solids are free slip");
        Field terrain = make_terrain(scene, plane), bed = terrain;
        solids_.set_time(0);
        for (std::size_t s = 0; s < solids_.count(); ++s)
            if (const std::int64_t c = raise(s, terrain, rows_stored(plane), bed, true); c >= 0)
                scene.refuse(
                    fmt::format("solids[{}]", s),
                    fmt::format(
                        "this solid has air or water below it at x = {:g}, z = {:g}: in a height field a solid must stand on the bed",
                        plane_.x(static_cast<int>(c % plane_.nx)), plane_.z(static_cast<int>(c / plane_.nx))),
                    "use floats of scheme.model = \"columns\" for floating and dragged objects");
    }
    void at(real t, const Field& terrain, const std::vector<PlaneRange>& rows, Field& bed) override {
        solids_.set_time(t);
        for_each_column(plane_, rows, [&](std::size_t c) { bed[c] = terrain[c]; });
        for (std::size_t s = 0; s < solids_.count(); ++s) raise(s, terrain, rows, bed, false);
    }
    bool moves() const override { return solids_.moving(); }

private:
    /// Four lines per column and axis; returns the index of a column over which the solid hangs, if requested, or -1.
    std::int64_t raise(std::size_t s, const Field& terrain, const std::vector<PlaneRange>& rows, Field& bed, bool look_for_gaps) {
        constexpr int lines = 4;
        std::vector<int> hangs(static_cast<std::size_t>(plane_.nz), -1);
        for_each_in_rows(plane_, rows, [&](int i, int k) {
            const std::size_t c = plane_.at(i, k);
            const real low = std::min(terrain[c], plane_.floor), slack = 2 * (plane_.ceiling - low) / hover_parts;
            real sum = 0;
            const int across = D == 3 ? lines : 1;
            for (int a = 0; a < lines; ++a)
                for (int b = 0; b < across; ++b) {
                    const real x = plane_.x(i) + ((a + 0.5) / lines - 0.5) * plane_.dx,
                               z = plane_.z(k) + ((b + 0.5) / across - 0.5) * plane_.dz;
                    const Span solid = span_of<D>(*solids_[s].shape, solids_.pose(s), x, z, low, plane_.ceiling);
                    const bool there = !solid.empty() && solid.high > terrain[c];
                    if (look_for_gaps && there && (solid.gap || solid.low > terrain[c] + slack)) hangs[static_cast<std::size_t>(k)] = i;
                    sum += there ? solid.high - terrain[c] : 0;
                }
            bed[c] = std::max(bed[c], terrain[c] + sum / (lines * across));
        });
        return look_for_gaps ? first_of_rows(plane_, hangs) : -1;
    }

    Plane plane_;
    geometry::Solids<D> solids_;
};

}  // namespace

Field make_terrain(const Scene& scene, const Plane& plane) {
    if (!scene.has("terrain")) return Field(plane.extent(), plane.floor);
    if (scene.text("terrain.kind") == "formula") return formula_field(scene, "terrain.height", plane);
    const Raster raster = read_raster(scene, plane);
    Field bed(plane.extent());
    for_each_in_rows(plane, rows_stored(plane), [&](int i, int k) { bed[plane.at(i, k)] = raster(plane.x(i), plane.z(k)); });
    return bed;
}

std::unique_ptr<RaisedBed> make_raised_bed(const Scene& scene, const Plane& plane) {
    if (scene.root().tables("solids").empty()) return nullptr;
    if (plane.dim == 2) return std::make_unique<Raised<2>>(scene, plane);
    return std::make_unique<Raised<3>>(scene, plane);
}

void start(const Scene& scene, State& state) {
    state.h = Field(state.plane.extent());
    state.qx = Field(state.plane.extent());
    if (state.plane.dim == 3) state.qz = Field(state.plane.extent());
    state.bed = make_terrain(scene, state.plane);
    if (const auto raised = make_raised_bed(scene, state.plane)) {
        const Field terrain = state.bed;
        raised->at(0, terrain, rows_stored(state.plane), state.bed);
    }
    if (scene.has("initial.surface")) {
        if (!scene.root().tables("liquid").empty()) scene.refuse("initial.surface", "give either initial.surface or liquid, not both");
        const Field surface = formula_field(scene, "initial.surface", state.plane);
        for_each_column(state.plane, rows_stored(state.plane),
                        [&](std::size_t c) { state.h[c] = std::max(0.0, surface[c] - state.bed[c]); });
    } else if (state.plane.dim == 2) {
        pour<2>(scene, state);
    } else {
        pour<3>(scene, state);
    }
    give_velocity(scene, state);
}

State::State(const Scene& scene, const Partition& partition)
    : plane(scene, partition), sides(scene), rho(scene.number("fluid.density")), dry(scene.number("scheme.dry_depth")) {
    if (plane.nx < 2 || (plane.dim == 3 && plane.nz < 2))
        scene.refuse("grid.cells", "a height field has at least 2 columns along each axis");
    constexpr real nothing = 1e-9;  // [m/s^2]: no noticeable motion in any run
    if (const auto* gravity = scene.effect("gravity")) {
        const auto& a = gravity->numbers("g");
        if (a[1] > nothing)
            scene.refuse("effects.gravity.g", "gravity points up: a height field requires gravity downwards", "g = [0, -9.81]");
        g = std::max(0.0, -a[1]);
        push[0] = a[0];
        if (plane.dim == 3) push[1] = a[2];
    }
    start(scene, *this);
}

}  // namespace weir::heightfield
