#include "validation/stability/preconditions.hpp"

#include "geometry/solids.hpp"
#include "rigid/bodies.hpp"
#include "validation/metrics/samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace weir::validation {
namespace {

enum class Content : std::uint8_t { dry, wet, solid };

template <int D>
geometry::Solids<D> solids_at(const Simulation& simulation) {
    geometry::Solids<D> solids(simulation.scene().root().tables("solids"));
    solids.set_time(simulation.time());
    return solids;
}

template <int D>
Vec<D> in_dim(const Vec<3>& x) {
    Vec<D> y;
    for (int d = 0; d < D; ++d) y[d] = x[d];
    return y;
}

real side(const GridView& g, int axis) { return g.spacing[static_cast<std::size_t>(axis)]; }

/// The cells in which there is a particle.
std::vector<bool> cells_with_particles(const GridView& g, const FieldView& position) {
    std::vector<bool> there(static_cast<std::size_t>(g.cells[0]) * static_cast<std::size_t>(g.cells[1]) *
                            static_cast<std::size_t>(g.cells[2]));
    for (std::size_t p = 0; p < position.data[0].size(); ++p) {
        std::size_t cell = 0, stride = 1;
        for (int d = 0; d < g.dim; ++d) {
            const auto at = static_cast<std::size_t>(d);
            const auto i = static_cast<int>(std::floor((position.data[at][p] - g.origin[at]) / g.spacing[at]));
            cell += stride * static_cast<std::size_t>(std::clamp(i, 0, g.cells[at] - 1));
            stride *= static_cast<std::size_t>(g.cells[at]);
        }
        there[cell] = true;
    }
    return there;
}

/// What is in each cell. A level set says so at the cell's centre; without one the particles do.
template <int D>
std::vector<Content> contents(const Simulation& simulation) {
    const FieldSet fields = simulation.fields();
    const GridView& g = fields.grid;
    const FieldView* phi = fields.find(level_set_name);
    const FieldView* position = fields.find(particle_set_name, "position");
    const std::vector<bool> held = !phi && position ? cells_with_particles(g, *position) : std::vector<bool>{};
    const auto solids = solids_at<D>(simulation);
    std::vector<Content> is;
    for_each_sample(g, -1, [&](const Vec<3>& x, real, std::size_t i) {
        const bool solid = !solids.empty() && solids.distance(in_dim<D>(x)) < 0;
        const bool wet = phi ? phi->data[0][i] < 0 : !held.empty() && held[i];
        is.push_back(solid ? Content::solid : wet ? Content::wet : Content::dry);
    });
    return is;
}

/// Connected parts, across faces, of the cells that hold `what`.
int parts_of(std::vector<Content> is, const GridView& g, Content what) {
    const std::array<std::size_t, 3> stride{1, static_cast<std::size_t>(g.cells[0]), static_cast<std::size_t>(g.cells[0] * g.cells[1])};
    int parts = 0;
    std::vector<std::size_t> open;
    for (std::size_t first = 0; first < is.size(); ++first) {
        if (is[first] != what) continue;
        ++parts;
        is[first] = Content::solid;  // counted
        for (open.assign(1, first); !open.empty();) {
            const std::size_t c = open.back();
            open.pop_back();
            for (std::size_t d = 0; d < static_cast<std::size_t>(g.dim); ++d) {
                const auto n = static_cast<std::size_t>(g.cells[d]), at = c / stride[d] % n;
                for (const bool up : {false, true}) {
                    if (up ? at + 1 == n : at == 0) continue;
                    const std::size_t next = up ? c + stride[d] : c - stride[d];
                    if (is[next] == what) is[next] = Content::solid, open.push_back(next);
                }
            }
        }
    }
    return parts;
}

/// The least free height over the floor, in cells: of every column, to a sixteenth of a cell.
template <int D>
real least_gap(const Simulation& simulation, const GridView& g) {
    constexpr int samples = 16;
    const auto solids = solids_at<D>(simulation);
    real least = g.cells[1];
    if (solids.empty()) return least;
    for_each_sample(g, -1, [&](const Vec<3>& x, real, std::size_t) {
        if (x[1] > g.origin[1] + side(g, 1)) return;  // one for each column
        Vec<D> at = in_dim<D>(x);
        for (int k = 0; k < samples * g.cells[1]; ++k) {
            at[1] = g.origin[1] + (k + 0.5) * side(g, 1) / samples;
            if (solids.distance(at) >= 0) continue;
            least = std::min(least, static_cast<real>(k) / samples);
            break;
        }
    });
    return least;
}

template <int D>
real solid_speed(const Simulation& simulation) {
    const auto solids = solids_at<D>(simulation);
    real fastest = 0;
    for (std::size_t i = 0; i < solids.count(); ++i) fastest = std::max(fastest, norm(solids.pose(i).velocity));
    return fastest;
}

/// Bodies of which `is` holds, by their number in the set that the solver shows.
template <class F>
real bodies_with(const Simulation& simulation, const char* field, F&& is) {
    const FieldSet fields = simulation.fields();
    const FieldView* view = fields.find(rigid::body_set_name, field);
    if (!view) return 0;
    real count = 0;
    for (std::size_t b = 0; b < view->data[0].size(); ++b) count += is(*view, b) ? 1 : 0;
    return count;
}

real pushed(const Simulation& simulation) {
    return bodies_with(simulation, "force", [](const FieldView& force, std::size_t b) {
        return std::any_of(force.data.begin(), force.data.end(), [&](const auto& component) { return component[b] != 0; });
    });
}

real strays(const Simulation& simulation) {
    const FieldSet fields = simulation.fields();
    const GridView& g = fields.grid;
    return bodies_with(simulation, "position", [&](const FieldView& position, std::size_t b) {
        for (std::size_t d = 0; d < static_cast<std::size_t>(g.dim); ++d)
            if (const real x = position.data[d][b] - g.origin[d]; !(x >= 0 && x <= g.spacing[d] * g.cells[d])) return true;
        return false;
    });
}

/// The scene's bodies where the solver shows them.
template <int D>
rigid::Bodies<D> bodies_now(const Simulation& simulation) {
    rigid::Bodies<D> bodies(simulation.scene());
    const FieldSet fields = simulation.fields();
    bodies.recall([&](const char* field, std::size_t component, std::size_t body) {
        return fields.find(rigid::body_set_name, field)->data[component][body];
    });
    return bodies;
}

/// Bodies whose middle is further than a cell from where the scene puts it.
template <int D>
real carried(const Simulation& simulation) {
    const GridView g = simulation.fields().grid;
    real longest = 0, count = 0;
    for (int d = 0; d < D; ++d) longest = std::max(longest, side(g, d));
    const auto bodies = bodies_now<D>(simulation);
    for (const auto& body : bodies.all()) count += norm(body.at - body.centre) > longest ? 1 : 0;
    return count;
}

/// Bodies that another one is nearer to than a hundredth of its size.
template <int D>
real touching(const Simulation& simulation) {
    const auto bodies = bodies_now<D>(simulation);
    const auto touches = [](const rigid::Body<D>& one, const rigid::Body<D>& other) {
        if (norm(one.at - other.at) > 1.01 * (one.radius + other.radius)) return false;
        const auto from = one.pose(), to = other.pose();
        return std::any_of(one.contact_spheres.begin(), one.contact_spheres.end(), [&](const rigid::ContactSphere<D>& sphere) {
            return other.shape->distance(to.to_rest(from.to_world(sphere.at))) - sphere.radius < 0.01 * one.radius;
        });
    };
    real count = 0;
    for (const auto& one : bodies.all())
        count += std::any_of(bodies.all().begin(), bodies.all().end(),
                             [&](const auto& other) { return &one != &other && (touches(one, other) || touches(other, one)); })
                     ? 1
                     : 0;
    return count;
}

/// The least and the greatest of what the scene's bodies weigh, over the fluid in their place.
template <int D>
std::pair<real, real> densities(const Simulation& simulation) {
    const rigid::Bodies<D> bodies(simulation.scene());
    std::pair<real, real> range{infinity, -infinity};
    for (const auto& body : bodies.all()) {
        const real ratio = body.density() / simulation.scene().number("fluid.density");
        range = {std::min(range.first, ratio), std::max(range.second, ratio)};
    }
    return range;
}

real integral_of(const Simulation& simulation, const std::string& name) {
    for (const Integral& i : simulation.integrals())
        if (i.name == name) return i.value;
    throw BadInput(fmt::format("the solver shows no integral \"{}\"", name));
}

template <int D>
std::optional<real> counted_in(const std::string& name, const Simulation& simulation, const StepReport& report) {
    const GridView g = simulation.fields().grid;
    const auto count = [&](Content what) {
        const auto is = contents<D>(simulation);
        return static_cast<real>(std::count(is.begin(), is.end(), what));
    };
    real shortest = side(g, 0), longest = side(g, 0);
    for (int d = 1; d < D; ++d) shortest = std::min(shortest, side(g, d)), longest = std::max(longest, side(g, d));
    if (name == "steps") return static_cast<real>(simulation.steps());
    if (name == "fastest") return std::isnan(report.cfl) ? integral_of(simulation, "max_speed") : report.cfl * shortest / report.dt;
    if (name == "wet_cells") return count(Content::wet);
    if (name == "dry_cells") return count(Content::dry);
    if (name == "solid_cells") return count(Content::solid);
    if (name == "bodies") return parts_of(contents<D>(simulation), g, Content::wet);
    if (name == "pockets") return parts_of(contents<D>(simulation), g, Content::dry);
    if (name == "aspect") return longest / shortest;
    if (name == "gap") return least_gap<D>(simulation, g);
    if (name == "solid_speed") return solid_speed<D>(simulation);
    if (name == "pushed") return pushed(simulation);
    if (name == "strays") return strays(simulation);
    if (name == "free_bodies") return static_cast<real>(simulation.scene().root().tables("bodies").size());
    if (name == "carried") return carried<D>(simulation);
    if (name == "touching") return touching<D>(simulation);
    if (name == "lightest") return densities<D>(simulation).first;
    if (name == "heaviest") return densities<D>(simulation).second;
    if (name == "mass_ratio") return densities<D>(simulation).second / densities<D>(simulation).first;
    if (name == "viscous_number") return simulation.scene().number("fluid.viscosity") * report.dt / (shortest * shortest);
    if (name != "film") return std::nullopt;
    real floor = 1;
    for (int d = 0; d < D; ++d)
        if (d != 1) floor *= side(g, d) * g.cells[static_cast<std::size_t>(d)];
    return integral_of(simulation, "volume") / floor / side(g, 1);
}

}  // namespace

std::optional<real> counted(const std::string& name, const Simulation& simulation, const StepReport& report) {
    return simulation.scene().dim() == 2 ? counted_in<2>(name, simulation, report) : counted_in<3>(name, simulation, report);
}

real value_of(const std::string& name, const Simulation& simulation, const StepReport& report) {
    if (const auto plus = name.find('+'); plus != std::string::npos)
        return value_of(name.substr(0, plus), simulation, report) + value_of(name.substr(plus + 1), simulation, report);
    if (const auto minus = name.find('-'); minus != std::string::npos)
        return value_of(name.substr(0, minus), simulation, report) - value_of(name.substr(minus + 1), simulation, report);
    if (const StepQuantity* quantity = find_step_quantity(name)) return quantity->value(report);
    for (const Integral& i : simulation.integrals())
        if (i.name == name) return i.value;
    if (const auto value = counted(name, simulation, report)) return *value;
    throw BadInput(fmt::format("there is no integral or value of a step report named \"{}\"", name));
}

void Preconditions::start(const Simulation& simulation) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        if ((*preconditions_)[i].when == Precondition::When::start) values_[i] = value_of((*preconditions_)[i].quantity, simulation, {});
}

void Preconditions::step(const Simulation& simulation, const StepReport& report) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        if ((*preconditions_)[i].when == Precondition::When::most)
            values_[i] = std::max(values_[i], value_of((*preconditions_)[i].quantity, simulation, report));
}

void Preconditions::end(const Simulation& simulation, const StepReport& report) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        if ((*preconditions_)[i].when == Precondition::When::end) values_[i] = value_of((*preconditions_)[i].quantity, simulation, report);
}

std::vector<MeasuredValue> Preconditions::measured() const {
    std::vector<MeasuredValue> list;
    for (std::size_t i = 0; i < values_.size(); ++i)
        if (values_[i] > -infinity) list.push_back({(*preconditions_)[i].quantity, values_[i]});
    return list;
}

std::string Preconditions::missing(bool at_start) const {
    for (std::size_t i = 0; i < values_.size(); ++i) {
        const Precondition& p = (*preconditions_)[i];
        if (at_start && p.when != Precondition::When::start) continue;
        const real grown = std::pow(pushed_, p.power), value = values_[i];
        if (p.at_least && !(value >= *p.at_least * grown))
            return fmt::format("{} is {:.4g}, not at least {:.4g}: {}", p.quantity, value, *p.at_least * grown, p.why);
        if (p.at_most && !(value <= *p.at_most * grown))
            return fmt::format("{} is {:.4g}, not at most {:.4g}: {}", p.quantity, value, *p.at_most * grown, p.why);
    }
    return {};
}

}  // namespace weir::validation
