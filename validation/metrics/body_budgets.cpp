// What bodies and the fluid that carries them hold together: momentum, which walls alone may change where no weight acts; angular momentum
// of particles, whose walls are far; and energy, which nothing puts in.
#include "rigid/bodies.hpp"
#include "validation/metrics/lists.hpp"
#include "validation/metrics/needed_field.hpp"
#include "validation/metrics/samples.hpp"
#include "validation/metrics/signal.hpp"

#include <algorithm>
#include <cmath>

namespace weir::validation {
namespace {

const char* const axis_names[] = {"x", "y", "z"};

void refuse(const char* metric, const std::string& why) { throw BadInput(std::string(metric) + ' ' + why); }

bool has_bodies(const scene::Scene& scene) { return scene.has("bodies") && !scene.root().tables("bodies").empty(); }

/// Force of the fluid on the two walls across an axis [N; per metre of depth in 2D], by the pressure of the cells beside them: on a grid
/// no gradient passes a wall. Particles show no pressure there: they are to stay away from walls.
real force_on_walls(const FieldSet& fields, int axis) {
    const FieldView* pressure = fields.find("", "pressure");
    if (!pressure || pressure->where != Where::cell) return 0;
    const GridView& g = fields.grid;
    const auto a = static_cast<std::size_t>(axis);
    const real area = cell_volume(g) / g.spacing[a];
    real force = 0;
    std::size_t i = 0;
    for (int z = 0; z < g.cells[2]; ++z)
        for (int y = 0; y < g.cells[1]; ++y)
            for (int x = 0; x < g.cells[0]; ++x, ++i) {
                const int at = std::array{x, y, z}[a];
                force += area * pressure->data[0][i] * ((at == g.cells[a] - 1 ? 1 : 0) - (at == 0 ? 1 : 0));
            }
    return force;
}

/// The density of the one body of a scene.
real density_of_body(const RunRecord& run, const char* metric) {
    const auto& list = run.scene->root().tables("bodies");
    if (list.size() != 1 || !list[0].has("density")) refuse(metric, "requires one body with a density, where fluid fills the domain");
    return list[0].number("density");
}

/// Of water in a box that it fills: what a body displaces goes the other way, -rho V times its velocity, as the sum of x div u over the box
/// tells, where walls let nothing through. The solver's own integral counts cells that a body cuts as full of water. At first it rests.
Curve momentum_by_displacement(const RunRecord& run, const std::string& axis) {
    const char* metric = "budget.momentum";
    const real ratio = run.scene->number("fluid.density") / density_of_body(run, metric);
    const GridView& g = run.fields.grid;
    real room = 1;
    for (int d = 0; d < g.dim; ++d) room *= g.spacing[static_cast<std::size_t>(d)] * g.cells[static_cast<std::size_t>(d)];
    for (const scene::Table& liquid : run.scene->root().tables("liquid"))
        for (std::size_t d = 0; liquid.text("shape") == "box" && d < static_cast<std::size_t>(g.dim); ++d)
            room /= liquid.numbers("max").at(d) - liquid.numbers("min").at(d);
    if (!(std::abs(room - 1) < 1e-12)) refuse(metric, "of water requires a full domain");
    Curve momentum = run.series("bodies_momentum_" + axis);
    if (run.scene->has("initial.velocity")) refuse(metric, "of water requires water at rest at the start");
    for (std::size_t i = 0; i < momentum.size(); ++i) momentum.y[i] *= i > 0 ? -ratio : 0;
    return momentum;
}

Curve momentum_of_fluid(const RunRecord& run, const std::string& axis) {
    return run.fields.find("", level_set_name) ? momentum_by_displacement(run, axis) : run.series("momentum_" + axis);
}

/// Along an axis, over the run: momentum of the fluid and of the bodies, and the impulse that walls were given, less the first sum.
Curve missing_momentum(const RunRecord& run, const std::string& metric, const std::string& axis) {
    if (run.scene->effect("gravity")) refuse(metric.c_str(), "requires a scene without gravity, whose impulse is not an integral");
    Curve missing = momentum_of_fluid(run, axis);
    const Curve bodies = run.series("bodies_momentum_" + axis), force = run.series(metric);
    const real first = missing.y.at(0) + bodies.y.at(0);
    real given = 0;
    for (std::size_t i = 0; i < missing.size(); ++i) {
        if (i > 0) given += (missing.x[i] - missing.x[i - 1]) * force.y[i];
        missing.y[i] += bodies.y[i] + given - first;
    }
    missing.label = "missing along " + axis;
    return missing;
}

/// The largest momentum that bodies have had along any axis.
real momentum_of_bodies(const RunRecord& run) {
    real most = 0;
    for (int a = 0; a < run.scene->dim(); ++a)
        most = std::max(most, largest_magnitude(run.series(std::string("bodies_momentum_") + axis_names[a])));
    return most;
}

Metric momentum_metric(int axis) {
    const std::string letter = axis_names[axis], name = "budget.momentum_" + letter;
    return {.name = name,
            .unit = "",
            .doc = "Largest change of the momentum of fluid and bodies along " + letter +
                   " that the pressure on the walls does not account for, over the largest momentum of the bodies.",
            .measure = [=](const RunRecord& run,
                           const Reference&) { return largest_magnitude(missing_momentum(run, name, letter)) / momentum_of_bodies(run); },
            .figure =
                [=](const RunRecord& run, const Reference&) {
                    Curve bodies = run.series("bodies_momentum_" + letter), fluid = momentum_of_fluid(run, letter);
                    bodies.label = "bodies", fluid.label = "fluid";
                    return Panel{.title = "Momentum along " + letter + ", " + run.scene->solver(),
                                 .x = {"t [s]"},
                                 .y = {"[kg m/s]"},
                                 .curves = {bodies, fluid, missing_momentum(run, name, letter)}};
                },
            .observe = [=](const FieldSet& fields, const scene::Scene&, real) { return force_on_walls(fields, axis); }};
}

/// Of particles and bodies about the domain's middle, about z, less what it was first; bodies as the fields show them.
template <int D>
real turning_of_bodies(const FieldSet& fields, const scene::Scene& scene) {
    rigid::Bodies<D> bodies(scene);
    const auto value = [&](const char* name, std::size_t component, std::size_t body) {
        const FieldView* field = fields.find(rigid::body_set_name, name);
        if (!field) refuse("budget.angular_momentum", std::string("requires bodies that provide their ") + name);
        return field->data.at(component)[body];
    };
    bodies.recall(value);
    const Vec<D> middle = scene.vec<D>("grid.origin") + 0.5 * scene.vec<D>("grid.size");
    real sum = 0;
    for (std::size_t b = 0; b < bodies.count(); ++b) {
        auto& body = bodies[b];
        for (std::size_t k = D; k < body.velocity.size(); ++k) body.velocity[k] = value("spin", k - D, b);
        const Vec<D> r = body.at - middle;
        sum += body.mass * (r[0] * body.velocity[1] - r[1] * body.velocity[0]) + body.angular_momentum()[2];
    }
    return sum;
}

real observe_turning(const FieldSet& fields, const scene::Scene& scene, real) {
    if (!has_bodies(scene)) return 0;
    return scene.dim() == 2 ? turning_of_bodies<2>(fields, scene) : turning_of_bodies<3>(fields, scene);
}

real missing_turning(const RunRecord& run, const Reference&) {
    const Curve fluid = run.series("angular_momentum_z"), bodies = run.series("budget.angular_momentum");
    Curve sum = fluid;
    for (std::size_t i = 0; i < sum.size(); ++i) sum.y[i] += bodies.y[i] - fluid.y[0] - bodies.y[0];
    return largest_magnitude(sum) / largest_magnitude(bodies);
}

/// A cell's water is counted in so many places along each axis where a surface or a body may cut it.
template <int D>
constexpr int samples = D == 2 ? 8 : 4;

/// A field of cells at s [cells] from the centre of cell I, linear between the centres of cells.
template <int D>
real value_between(const FieldView& field, const GridView& g, const std::array<int, 3>& I, const std::array<real, 3>& s) {
    std::array<int, 3> lo{}, hi{};
    std::array<real, 3> w{};
    for (std::size_t d = 0; d < D; ++d) {
        const int below = s[d] < 0 ? I[d] - 1 : I[d];
        w[d] = s[d] < 0 ? s[d] + 1 : s[d];
        lo[d] = std::clamp(below, 0, g.cells[d] - 1), hi[d] = std::clamp(below + 1, 0, g.cells[d] - 1);
    }
    real sum = 0;
    for (int c = 0; c < (1 << D); ++c) {
        real weight = 1;
        std::array<int, 3> at{};
        for (std::size_t d = 0; d < D; ++d) {
            const bool up = (c >> d) & 1;
            at[d] = up ? hi[d] : lo[d], weight *= up ? w[d] : 1 - w[d];
        }
        sum += weight * value_at(field, g, 0, at);
    }
    return sum;
}

/// Kinetic and potential energy of water under a level set, beside bodies, by itself: the solver's own integrals count cells that a body
/// cuts as full. Above the domain's lower corner.
template <int D>
real energy_of_water(const FieldSet& fields, const scene::Scene& scene) {
    const FieldView *phi = fields.find("", level_set_name), *velocity = fields.find("", "velocity");
    if (!phi || !velocity || velocity->where != Where::face) return 0;
    rigid::Bodies<D> bodies(scene);
    bodies.recall([&](const char* name, std::size_t component, std::size_t body) {
        return needed_field(fields, rigid::body_set_name, name).data.at(component)[body];
    });
    const GridView& g = fields.grid;
    const auto* gravity = scene.effect("gravity");
    const Vec<D> down = gravity ? gravity->template vec<D>("g") : Vec<D>{};
    real reach = 0, energy = 0;
    for (int d = 0; d < D; ++d) reach = std::max(reach, g.spacing[static_cast<std::size_t>(d)]);
    reach *= std::sqrt(1.0 * D);
    std::vector<geometry::Pose<D>> poses;
    for (const auto& body : bodies.all()) poses.push_back(body.pose());
    const auto away = [&](const Vec<D>& x) {
        real least = infinity;
        for (std::size_t b = 0; b < bodies.count(); ++b)
            if (norm(x - bodies[b].at) < bodies[b].radius + 2 * reach)
                least = std::min(least, bodies[b].shape->distance(poses[b].to_rest(x)));
        return least;
    };
    const real rho = scene.number("fluid.density"), volume = cell_volume(g);
    for_each_sample(g, -1, [&](const Vec<3>& centre, real, std::size_t i) {
        const std::array<int, 3> I{static_cast<int>(i) % g.cells[0], static_cast<int>(i) / g.cells[0] % g.cells[1],
                                   static_cast<int>(i) / g.cells[0] / g.cells[1]};
        Vec<D> x;
        for (int d = 0; d < D; ++d) x[d] = centre[d];
        const real here = phi->data[0][i], beside = away(x);
        if (here > 2 * reach || beside < -reach) return;
        real part = 0;
        Vec<D> middle{};  // of the water in the cell, above the corner
        int all = 1;
        for (int d = 0; d < D; ++d) all *= samples<D>;
        const bool whole = here < -2 * reach && beside > reach;
        for (int s = 0; s < (whole ? 1 : all); ++s) {
            std::array<real, 3> at{};
            Vec<D> y = x;
            for (int d = 0, rest = s; d < D && !whole; ++d, rest /= samples<D>) {
                at[static_cast<std::size_t>(d)] = (rest % samples<D> + 0.5) / samples<D> - 0.5;
                y[d] += g.spacing[static_cast<std::size_t>(d)] * at[static_cast<std::size_t>(d)];
            }
            if (!whole && (value_between<D>(*phi, g, I, at) >= 0 || away(y) <= 0)) continue;
            const real weight = whole ? 1 : 1.0 / all;
            part += weight;
            for (int d = 0; d < D; ++d) middle[d] += weight * (y[d] - g.origin[static_cast<std::size_t>(d)]);
        }
        if (part == 0) return;
        real square = 0;
        for (int d = 0; d < D; ++d) {
            auto above = I;
            ++above[static_cast<std::size_t>(d)];
            const real u = value_at(*velocity, g, d, I), v = value_at(*velocity, g, d, above);
            square += 0.5 * (u * u + v * v);
        }
        energy += rho * volume * (0.5 * part * square - dot(down, middle));
    });
    return energy;
}

real observe_water(const FieldSet& fields, const scene::Scene& scene, real) {
    if (!has_bodies(scene)) return 0;
    return scene.dim() == 2 ? energy_of_water<2>(fields, scene) : energy_of_water<3>(fields, scene);
}

/// The least potential energy that bodies could have in the domain, and what of it is counted from elsewhere than the lowest corner.
template <int D>
real lowest_of_bodies(const scene::Scene& scene) {
    const rigid::Bodies<D> bodies(scene);
    const auto* gravity = scene.effect("gravity");
    real lowest = 0;
    for (const auto& body : bodies.all())
        for (int d = 0; d < D && gravity; ++d) {
            const real lo = scene.vec<D>("grid.origin")[d], hi = lo + scene.vec<D>("grid.size")[d], g = gravity->template vec<D>("g")[d];
            lowest += body.mass * std::min(-g * lo, -g * hi);
        }
    return lowest;
}

/// Of fluid and bodies over the run: kinetic, potential and, of what can be compressed, elastic.
Curve energy_of_all(const RunRecord& run) {
    if (!has_bodies(*run.scene)) refuse("budget.energy_gain", "requires bodies: energy_gain covers fluids only");
    Curve sum = run.series("bodies_kinetic_energy");
    const auto add = [&](const std::string& name) {
        const Curve c = run.series(name);
        for (std::size_t i = 0; i < sum.size(); ++i) sum.y[i] += c.y[i];
    };
    add("bodies_potential_energy");
    if (run.fields.find("", level_set_name)) {
        add("budget.energy_gain");
    } else {
        for (const char* part : {"kinetic_energy", "potential_energy", "elastic_energy"})
            if (run.has_integral(part)) add(part);
    }
    if (!run.fields.find("", level_set_name) && !run.has_integral("potential_energy") && run.scene->effect("gravity")) {
        // a fluid that fills its box falls where the body rises
        const real ratio = run.scene->number("fluid.density") / density_of_body(run, "budget.energy_gain");
        const Curve bodies = run.series("bodies_potential_energy");
        for (std::size_t i = 0; i < sum.size(); ++i) sum.y[i] -= ratio * bodies.y[i];
    }
    sum.label = "fluid and bodies";
    return sum;
}

/// What all could lose at the start: fluid above its lowest corner, bodies above theirs; with fluid that fills its box, all that there is.
real first_energy(const RunRecord& run, const Curve& all) {
    if (!run.fields.find("", level_set_name) && !run.has_integral("potential_energy")) return std::abs(all.y.at(0));
    const real bodies = run.scene->dim() == 2 ? lowest_of_bodies<2>(*run.scene) : lowest_of_bodies<3>(*run.scene);
    return all.y.at(0) - bodies;
}

real energy_gain(const RunRecord& run, const Reference&) {
    const Curve all = energy_of_all(run);
    real least = infinity, gain = 0;
    for (const real energy : all.y) {
        if (std::isnan(energy)) return energy;
        least = std::min(least, energy), gain = std::max(gain, energy - least);
    }
    return gain / first_energy(run, all);
}

Panel energy_panel(const RunRecord& run, const Reference&) {
    Curve all = energy_of_all(run), bodies = run.series("bodies_kinetic_energy");
    const real first = first_energy(run, all), lost = all.y.at(0);
    for (real& y : all.y) y = 1 + (y - lost) / first;
    for (real& y : bodies.y) y /= first;
    bodies.label = "bodies, kinetic";
    return {.title = "Energy over the first, " + run.scene->solver(), .x = {"t [s]"}, .y = {"E/E0"}, .curves = {all, bodies}};
}

}  // namespace

std::vector<Metric> body_budget_metrics() {
    std::vector<Metric> list;
    for (int axis = 0; axis < 3; ++axis) list.push_back(momentum_metric(axis));
    list.push_back({.name = "budget.angular_momentum",
                    .unit = "",
                    .doc = "Largest change of the angular momentum of particles and bodies about z, over the largest of the bodies.",
                    .measure = missing_turning,
                    .observe = observe_turning});
    list.push_back({.name = "budget.energy_gain",
                    .unit = "",
                    .doc = "Largest rise of the energy of fluid and bodies above the least it was before, over the first (potential: above "
                           "the lowest corner of the domain); kinetic, potential and, of what can be compressed, elastic.",
                    .measure = energy_gain,
                    .figure = energy_panel,
                    .observe = observe_water});
    return list;
}

}  // namespace weir::validation
