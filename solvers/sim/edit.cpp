// Steering a running simulation between two steps: writing fields, adding and removing particles, calling observers.
#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "sim/simulation.hpp"
#include "sim/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir {

namespace {

std::string full_name(const std::string& set, const std::string& name) { return set.empty() ? name : set + "." + name; }

void check_values(const std::string& name, const std::vector<real>& values, std::size_t wanted, real min, real max) {
    if (values.size() != wanted)
        throw BadInput(fmt::format("\"{}\" has {} values per component; expected {}", name, wanted, values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!std::isfinite(values[i])) throw BadInput(fmt::format("\"{}\" is not finite at {}", name, i));
        if (values[i] < min || values[i] > max)
            throw BadInput(fmt::format("\"{}\" is {} at {}; it must lie in [{}, {}]", name, values[i], i, min, max));
    }
}

/// Scope in which the simulation records the field being written.
class Edited {
public:
    Edited(std::string& which, std::string name) : which_(which) { which_ = std::move(name); }
    ~Edited() { which_.clear(); }
    Edited(const Edited&) = delete;
    Edited& operator=(const Edited&) = delete;

private:
    std::string& which_;
};

/// Edits need the whole state, but a rank may hold only a part of it.
void one_process_only(const std::string& what) {
    if (communicator().several())
        throw BadInput(fmt::format("{} in one process only, and the number of ranks is {}", what, communicator().ranks()));
}

/// Checks that a point has as many coordinates as the scene has dimensions.
void check_points(std::span<const Vec<3>> points, const std::string& what, const GridView& grid, bool inside) {
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(a);
            const real x = points[i][a], lo = grid.origin[at], hi = lo + grid.spacing[at] * grid.cells[at];
            if (!std::isfinite(x)) throw BadInput(fmt::format("{} {} is not finite", what, i));
            if (a >= grid.dim && x != 0) throw BadInput(fmt::format("{} {} has z = {} in a scene of two dimensions", what, i, x));
            if (inside && a < grid.dim && !(x >= lo && x <= hi))
                throw BadInput(fmt::format("{} {} has {} = {}; the domain is [{}, {}]", what, i, "xyz"[a], x, lo, hi));
        }
}

}  // namespace

std::vector<std::string> Simulation::editable() {
    std::vector<std::string> names;
    if (communicator().several()) return names;
    for (const auto& field : solver_->editable()) names.push_back(full_name(field.set, field.name));
    return names;
}

EditableField Simulation::editable_named(std::string_view name) {
    std::string known;
    for (auto& field : solver_->editable()) {
        const std::string full = full_name(field.set, field.name);
        if (name == full || name == field.name) return std::move(field);
        known += (known.empty() ? "" : ", ") + full;
    }
    throw BadInput(fmt::format("solver \"{}\" has no field \"{}\" that may be edited in this scene; {}", scene_.solver(), name,
                               known.empty() ? std::string("it has none") : "known: " + known));
}

void Simulation::refuse_while_edited(const char* what) const {
    if (!edited_.empty()) throw BadInput(fmt::format("\"{}\" is being edited: {} only after that", edited_, what));
}

/// Applies the whole change or none of it.
void Simulation::change_state(const std::function<void(Solver&)>& change) {
    Checkpoint before;
    solver_->save(before);
    try {
        change(*solver_);
    } catch (...) {
        solver_->restore(before);
        throw;
    }
    probes_.forget();
    steady_ = false;
    if (steady_rate_ > 0) last_velocity_ = sim::grid_velocity(fields());
}

void Simulation::edit(std::string_view name, const std::function<void(FieldEdit&)>& write) {
    one_process_only(fmt::format("\"{}\" is edited", name));
    refuse_while_edited("another field is edited");
    const EditableField at = editable_named(name);
    const FieldSet shown = fields();
    const FieldView* view = shown.find(at.set, at.name);
    FieldEdit field{at.set, at.name, view ? view->unit : "", view ? view->where : Where::cell, shown.grid, {}};
    for (const auto& component : at.data) field.data.emplace_back(component.begin(), component.end());
    {
        const Edited now(edited_, full_name(at.set, at.name));
        write(field);
    }
    if (field.data.size() != at.data.size())
        throw BadInput(fmt::format("\"{}\" has {} components, not {}", at.name, at.data.size(), field.data.size()));
    for (std::size_t c = 0; c < at.data.size(); ++c) check_values(at.name, field.data[c], at.data[c].size(), at.min[c], at.max[c]);
    change_state([&](Solver& solver) {
        const EditableField to = editable_named(full_name(at.set, at.name));  // a copy of the state may have relocated it
        for (std::size_t c = 0; c < to.data.size(); ++c) std::copy(field.data[c].begin(), field.data[c].end(), to.data[c].begin());
        solver.edited(to);
    });
}

void Simulation::add_particles(std::string_view set, std::span<const Vec<3>> at, std::span<const Vec<3>> velocity) {
    one_process_only(fmt::format("particles of the set \"{}\" are added", set));
    refuse_while_edited("particles are added");
    if (at.size() != velocity.size()) throw BadInput(fmt::format("{} places of particles and {} velocities", at.size(), velocity.size()));
    const GridView grid = fields().grid;
    check_points(at, "the place of particle", grid, true);
    check_points(velocity, "the velocity of particle", grid, false);
    change_state([&](Solver& solver) {
        if (!solver.add_particles(set, at, velocity))
            throw BadInput(
                fmt::format("solver \"{}\" does not support adding particles of a set \"{}\" in this scene", scene_.solver(), set));
    });
}

void Simulation::remove_particles(std::string_view set, std::span<const std::size_t> which) {
    one_process_only(fmt::format("particles of the set \"{}\" are removed", set));
    refuse_while_edited("particles are removed");
    const FieldSet shown = fields();
    const FieldView* position = shown.find(set, "position");
    std::vector<unsigned char> gone(position ? position->data[0].size() : 0, 0);
    for (const std::size_t i : which) {
        if (i >= gone.size()) throw BadInput(fmt::format("there is no particle {} of a set \"{}\" with {} particles", i, set, gone.size()));
        gone[i] = 1;
    }
    if (which.empty()) return;
    change_state([&](Solver& solver) {
        if (!solver.remove_particles(set, gone))
            throw BadInput(
                fmt::format("solver \"{}\" does not support removing particles of a set \"{}\" in this scene", scene_.solver(), set));
    });
}

void Simulation::observe_steps(Observer observer, std::int64_t every) {
    if (every < 1) throw BadInput(fmt::format("an interval of {} steps; at least 1", every));
    observers_.push_back({every, std::move(observer)});
}

}  // namespace weir
