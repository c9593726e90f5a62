#include "metamorphic/snapshot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace weir::metamorphic {
namespace {

std::size_t at(int a) { return static_cast<std::size_t>(a); }

/// Integrals that are places, energies of places, or counts of what a method did.
const std::set<std::string> from_the_start{"potential_energy", "bodies_potential_energy",
                                           "mean_height",      "top",
                                           "mean_level",       "front_x",
                                           "height_at_x_min",  "centre_x",
                                           "centre_y",         "centre_z",
                                           "gas_centre_x",     "gas_centre_y",
                                           "gas_centre_z"};
const std::set<std::string> along_x{"front_x", "height_at_x_min"}, along_y{"mean_height", "top", "mean_level", "height_at_x_min"};
const std::set<std::string> pseudo{"angle", "rotation", "spin", "torque", "viscous_torque"};
const std::set<std::string> never{"id", "max_divergence", "angular_momentum_z", "total_level_set"};

real largest(const std::vector<std::vector<real>>& data) {
    real most = 0;
    for (const auto& component : data)
        for (const real v : component) most = std::max(most, std::abs(v));
    return most;
}

std::array<int, 3> extent(const Snapshot& s, const Field& f, int component) {
    auto n = s.cells;
    if (f.where == Where::face) ++n[at(component)];
    return n;
}

/// The component of a vector with `count` of them that belongs to an axis, and back: height fields show x and z.
int axis_of(int component, int count, int dim) { return count == 2 && dim == 3 ? 2 * component : component; }
int component_of(int axis, int count, int dim) { return count == 2 && dim == 3 ? axis / 2 : axis; }

/// f(I) for each index, x fastest.
template <class F>
void for_each(const std::array<int, 3>& n, F&& f) {
    for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
            for (int i = 0; i < n[0]; ++i) f(std::array<int, 3>{i, j, k});
}
std::size_t place(const std::array<int, 3>& I, const std::array<int, 3>& n) {
    return at(I[0]) + at(n[0]) * (at(I[1]) + at(n[1]) * at(I[2]));
}

std::vector<real> mapped(const Snapshot& s, const Snapshot& to, const Field& f, int from, int component, const Transformation& by) {
    const auto& data = f.data[at(from)];
    const auto n = extent(s, f, axis_of(from, static_cast<int>(f.data.size()), s.dim));
    const auto m = extent(to, f, axis_of(component, static_cast<int>(f.data.size()), s.dim));
    std::vector<real> out(data.size());
    for_each(n, [&](const std::array<int, 3>& I) {
        std::array<int, 3> J{};
        for (int a = 0; a < 3; ++a) J[at(by.axis[at(a)])] = by.sign[at(a)] > 0 ? I[at(a)] : n[at(a)] - 1 - I[at(a)];
        out[place(J, m)] = data[place(I, n)];
    });
    return out;
}

Field image(const Snapshot& s, const Snapshot& to, const Field& f, const Transformation& by) {
    Field out = f;
    const real scale = by.scale.of(f.unit);
    const int count = static_cast<int>(f.data.size());
    const bool is_place = f.name == "position" && f.unit == "m", is_extent = f.name == "size";
    const bool is_height = f.set.empty() && (f.name == "bed" || f.name == "surface");
    const bool is_pseudo = pseudo.count(f.name) > 0, is_vector = count > 1 || f.where == Where::face;
    for (int c = 0; c < count; ++c) {
        const int a = axis_of(c, count, s.dim);
        const int to_axis = is_vector ? by.axis[at(a)] : a, d = is_vector ? component_of(to_axis, count, s.dim) : c;
        out.data[at(d)] = f.where == Where::particle ? f.data[at(c)] : mapped(s, to, f, c, d, by);
        const real sign = (is_vector && !is_extent ? by.sign[at(a)] : 1) * (is_pseudo ? by.handedness() : 1);
        for (real& v : out.data[at(d)]) v = sign * scale * v + (is_place ? by.shift[at(to_axis)] : is_height ? by.shift[1] : 0);
    }
    return out;
}

Integral image(const Integral& i, const Transformation& by) {
    Integral out = i;
    out.value *= by.scale.of(i.unit);
    const auto n = i.name.size();
    if (n > 2 && i.name[n - 2] == '_' && i.name[n - 1] >= 'x' && i.name[n - 1] <= 'z' && !along_x.count(i.name)) {
        const auto a = at(i.name[n - 1] - 'x');
        out.name[n - 1] = "xyz"[by.axis[a]];
        out.value *= by.sign[a];
    }
    return out;
}

const Integral* find(const std::vector<Integral>& list, const std::string& name) {
    for (const Integral& i : list)
        if (i.name == name) return &i;
    return nullptr;
}

/// Its end, or how far it came from its start.
real value_of(const Snapshot& s, const Integral& i) {
    const Integral* first = find(s.start, i.name);
    return (from_the_start.count(i.name) || i.name.ends_with("_height")) && first ? i.value - first->value : i.value;
}

/// Rows of a particle set: position first, in the order of x.
std::vector<std::size_t> order_of(const Field& position) {
    std::vector<std::size_t> order(position.data[0].size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return position.data[0][a] < position.data[0][b]; });
    return order;
}

/// For each particle of `a` its partner in `b` within `reach`, or -1.
std::vector<std::ptrdiff_t> partners(const Snapshot& s, const Field& a, const Field& b, real reach) {
    const auto order = order_of(b);
    std::vector<std::ptrdiff_t> found(a.data[0].size(), -1);
    for (std::size_t i = 0; i < found.size(); ++i) {
        real best = reach * reach;
        for (int wrap = -1; wrap <= 1; ++wrap) {
            if (wrap && !s.periodic[0]) continue;
            const real x = a.data[0][i] + wrap * s.size[0];
            auto near = std::lower_bound(order.begin(), order.end(), x - reach, [&](std::size_t p, real v) { return b.data[0][p] < v; });
            for (; near != order.end() && b.data[0][*near] <= x + reach; ++near) {
                real d2 = 0;
                for (std::size_t c = 0; c < a.data.size(); ++c) {
                    real d = a.data[c][i] + (c == 0 ? wrap * s.size[0] : 0) - b.data[c][*near];
                    if (c > 0 && s.periodic[c]) d -= s.size[c] * std::round(d / s.size[c]);
                    d2 += d * d;
                }
                if (d2 <= best) best = d2, found[i] = static_cast<std::ptrdiff_t>(*near);
            }
        }
    }
    return found;
}

const Field* find(const Snapshot& s, const std::string& set, const std::string& name) {
    for (const Field& f : s.fields)
        if (f.set == set && f.name == name) return &f;
    return nullptr;
}

bool is_cloud(const std::string& set) { return set == marker_set_name || set == particle_set_name || set == surface_set_name; }

real floor_of(const Snapshot& s, const std::string& unit) { return 1e-3 * s.scale_of(unit); }

/// Particles have no order that a transformation keeps: each is compared with the one that stands where it should.
void compare_cloud(const Snapshot& expected, const Snapshot& actual, const std::string& set, Difference& worst) {
    const Field *a = find(expected, set, "position"), *b = find(actual, set, "position");
    if (!a || !b) return;
    if (a->data[0].size() != b->data[0].size())
        return worst.take(infinity, fmt::format("{} {} for {}", b->data[0].size(), set, a->data[0].size()));
    const real h = expected.size[0] / expected.cells[0];
    const auto partner = partners(expected, *a, *b, 0.05 * h);
    for (std::size_t i = 0; i < partner.size(); ++i)
        if (partner[i] < 0) return worst.take(1, fmt::format("a particle of {} has no partner", set));
    for (const Field& f : expected.fields) {
        const Field* g = f.set == set ? find(actual, set, f.name) : nullptr;
        if (!g || never.count(f.name)) continue;
        const real most = std::max(largest(f.data), floor_of(expected, f.unit));
        for (std::size_t c = 0; c < f.data.size(); ++c)
            for (std::size_t i = 0; i < partner.size(); ++i) {
                real d = f.data[c][i] - g->data[c][at(static_cast<int>(partner[i]))];
                if (f.name == "position" && expected.periodic[c]) d -= expected.size[c] * std::round(d / expected.size[c]);
                worst.take(std::abs(d) / most, set + "." + f.name);
            }
    }
}

}  // namespace

real Snapshot::scale_of(const std::string& unit) const {
    const Dimension d = dimension_of(unit);
    const real second = speed > 0 ? length / speed : std::max(time, 1e-300);
    return std::pow(length, d.length) * std::pow(second, d.time) * std::pow(mass, d.mass);
}

Snapshot snapshot(const Simulation& simulation, const std::vector<Integral>& start) {
    Snapshot s;
    const scene::Scene& scene = simulation.scene();
    s.dim = scene.dim(), s.time = simulation.time(), s.start = start, s.end = simulation.solver().integrals();
    std::erase_if(s.end, [](const Integral& i) { return i.name.find("torque") != std::string::npos; });  // of forces about the origin
    const auto &cells = scene.root().numbers("grid.cells"), &size = scene.root().numbers("grid.size");
    const FieldSet shown = simulation.fields();
    // Particles are single numbers of seven digits: what rounding moves them in a step is a speed.
    const real steps_a_second = s.time > 0 ? static_cast<real>(simulation.steps()) / s.time : 0;
    for (int a = 0; a < s.dim; ++a) {
        s.cells[at(a)] = shown.grid.dim ? shown.grid.cells[at(a)] : static_cast<int>(cells[at(a)]);
        s.size[at(a)] = size[at(a)], s.origin[at(a)] = scene.root().numbers("grid.origin")[at(a)];
        s.length = a == 0 ? size[0] : std::max(s.length, size[at(a)]);
    }
    if (scene.has("grid.periodic"))
        for (const auto& axis : scene.root().texts("grid.periodic")) s.periodic[at(axis[0] - 'x')] = true;
    for (const FieldView& f : shown.fields) {
        Field copy{f.set, f.name, f.name == level_set_name ? "m" : f.unit, f.where, {}};  // the transport of one has no units
        for (const auto& component : f.data) copy.data.emplace_back(component.begin(), component.end());
        if (f.name == "velocity") s.speed = std::max(s.speed, largest(copy.data));
        s.fields.push_back(std::move(copy));
    }
    if (const auto* gravity = scene.effect("gravity")) {
        real g = 0;
        for (const real v : gravity->numbers("g")) g = std::max(g, std::abs(v));
        s.speed = std::max(s.speed, std::sqrt(g * s.length));
    }
    if (scene.solver() == "sph" || scene.solver() == "pbf") s.speed = std::max(s.speed, 1e-3 * s.length * steps_a_second);
    if (scene.has("scheme.sound_speed")) s.speed = std::max(s.speed, 0.1 * scene.number("scheme.sound_speed"));
    s.mass = (scene.has("fluid.density") ? scene.number("fluid.density") : 1) * std::pow(s.length, 3);
    return s;
}

Snapshot image(const Snapshot& of, const Transformation& by) {
    Snapshot s = of;
    for (int a = 0; a < 3; ++a) {
        const auto A = at(by.axis[at(a)]), b = at(a);
        s.cells[A] = of.cells[b], s.periodic[A] = of.periodic[b], s.size[A] = by.scale.length * of.size[b];
        s.origin[A] = by.shift[A] + by.scale.length * (by.sign[b] > 0 ? of.origin[b] : -(of.origin[b] + of.size[b]));
    }
    s.fields.clear();
    for (const Field& f : of.fields) s.fields.push_back(image(of, s, f, by));
    s.start.clear(), s.end.clear();
    for (const Integral& i : of.start) s.start.push_back(image(i, by));
    for (const Integral& i : of.end) s.end.push_back(image(i, by));
    s.time *= by.scale.time, s.length *= by.scale.length, s.speed *= by.scale.of("m/s"), s.mass *= by.scale.mass;
    return s;
}

Snapshot rolled(const Snapshot& of, const std::array<int, 3>& cells) {
    Snapshot s = of;
    for (Field& f : s.fields) {
        if (f.where == Where::particle) continue;
        for (std::size_t c = 0; c < f.data.size(); ++c) {
            const auto n = extent(of, f, static_cast<int>(c));
            const auto old = f.data[c];
            for_each(n, [&](const std::array<int, 3>& I) {
                std::array<int, 3> from = I;
                for (int a = 0; a < of.dim; ++a)
                    if (cells[at(a)]) from[at(a)] = (I[at(a)] + cells[at(a)]) % of.cells[at(a)];
                f.data[c][place(I, n)] = old[place(from, n)];
            });
        }
    }
    for (int a = 0; a < of.dim; ++a) s.origin[at(a)] += cells[at(a)] * of.size[at(a)] / of.cells[at(a)];
    return s;
}

Difference difference(const Snapshot& expected, const Snapshot& actual, const Transformation& by) {
    Difference worst;
    worst.take(std::abs(actual.time - expected.time) / std::max(expected.time, 1e-300), "time");
    std::set<std::string> clouds;
    for (const Field& f : expected.fields) {
        if (is_cloud(f.set)) {
            clouds.insert(f.set);
            continue;
        }
        const Field* g = find(actual, f.set, f.name);
        if (never.count(f.name) || (pseudo.count(f.name) && f.data.size() == 4)) continue;
        if (!g || g->data.size() != f.data.size()) {
            worst.take(infinity, "field " + f.name + " is missing");
            continue;
        }
        const real most = std::max(largest(f.data), floor_of(expected, f.unit));
        for (std::size_t c = 0; c < f.data.size(); ++c)
            for (std::size_t i = 0; i < f.data[c].size(); ++i)
                worst.take(i < g->data[c].size() ? std::abs(f.data[c][i] - g->data[c][i]) / most : infinity,
                           f.set.empty() ? f.name : f.set + "." + f.name);
    }
    for (const auto& set : clouds) compare_cloud(expected, actual, set, worst);
    for (const Integral& i : expected.end) {
        const Integral* j = find(actual.end, i.name);
        if (i.name.ends_with("potential_energy") && (by.sign[1] < 0 || by.shifts())) continue;  // measured from a place
        if (!j || never.count(i.name) || (along_x.count(i.name) && !by.keeps(0)) || (along_y.count(i.name) && !by.keeps_up())) continue;
        const real a = value_of(expected, i), b = value_of(actual, *j);
        const real scale = std::max({std::abs(a), std::abs(b), 1e-3 * expected.scale_of(i.unit), std::abs(i.value)});
        worst.take(std::abs(a - b) / scale, i.name);
    }
    return worst;
}

Statistics statistics(const Snapshot& expected, const Snapshot& actual, const Transformation& by, bool same_domain) {
    Statistics s;
    const int dim = expected.dim;
    const auto value = [](const Snapshot& of, const char* name) {
        const Integral* i = find(of.end, name);
        return i ? value_of(of, *i) : 0;
    };
    const auto change = [](const Snapshot& of, const char* name) {
        const Integral *a = find(of.start, name), *b = find(of.end, name);
        return a && b && a->value != 0 ? b->value / a->value - 1 : 0;
    };
    for (const char* name : {"volume", "mass"})
        s.kept.take(std::abs(change(expected, name) - change(actual, name)), fmt::format("change of {}", name));
    const real energy = std::max({value(expected, "kinetic_energy"), std::abs(value(expected, "potential_energy")),
                                  value(actual, "kinetic_energy"), 3e-4 * expected.scale_of(dim == 2 ? "J/m" : "J")});
    const auto compare_energy = [&](const char* name) {
        s.moved.take(std::abs(value(expected, name) - value(actual, name)) / energy, name);
    };
    compare_energy("kinetic_energy");
    if (by.sign[1] > 0 && same_domain) compare_energy("potential_energy");
    const real force = 0.02 * expected.scale_of(dim == 2 ? "N/m" : "N");
    for (const char* name : {"solid_force_x", "solid_force_y", "solid_force_z"}) {
        if (!same_domain) break;
        const real a = value(expected, name), b = value(actual, name);
        s.moved.take(std::abs(a - b) / std::max({std::abs(a), std::abs(b), force}), name);
    }
    const Field *v = find(expected, "bodies", "velocity"), *w = find(actual, "bodies", "velocity");
    for (std::size_t c = 0; v && w && c < v->data.size(); ++c)
        for (std::size_t i = 0; i < v->data[c].size(); ++i)
            s.moved.take(std::abs(v->data[c][i] - w->data[c][i]) / std::max(largest(v->data), 0.05 * expected.speed), "bodies.velocity");
    return s;
}

}  // namespace weir::metamorphic
