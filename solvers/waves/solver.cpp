#include "waves/solver.hpp"

#include "waves/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::waves {

Waves::Waves(const scene::Scene& scene, const Partition& partition)
    : box_(scene, partition),
      model_(make_model(scene, box_)),
      level_(model_->level() ? *model_->level() : mean_level(scene, box_)),
      density_(scene.number("fluid.density")),
      g_(restoring(scene).g),
      end_(scene.number("time.end")),
      with_velocity_(scene.flag("waves.velocity")),
      gravity_(scene.effect("gravity") != nullptr),
      tension_(scene.effect("surface_tension") != nullptr),
      sheet_(box_, {.velocity = with_velocity_, .sideways = model_->sideways()}) {
    for (int a = 0; a < box_.dim; ++a) position_[static_cast<std::size_t>(a)] = Values(box_.of_sheet());
    if (const scene::Table* foam = scene.effect("foam")) {
        if (!model_->sideways())
            scene.refuse("effects.foam", "these waves have no foam: their points move only vertically, and the surface does not fold",
                         "use gerstner waves or a spectrum with choppiness");
        foam_below_ = foam->number("below");
        foam_ = Values(box_.of_sheet());
    }
    if (shows_water()) {
        level_set_ = Values(box_.of_cells());
        if (with_velocity_)
            for (int a = 0; a < box_.dim; ++a) water_[static_cast<std::size_t>(a)] = Values(box_.of_cells());
    }
    compute();
    passes_.reset();
}

StepReport Waves::step(real dt) {
    set_time(time_ + dt);
    return {.dt = dt};
}

void Waves::set_time(real t) {
    time_ = t;
    compute();
}

/// Computes all output fields at the present time.
void Waves::compute() {
    ghosts_filled_ = !box_.own.distributed();
    {
        const auto timed = passes_.time("surface");
        model_->set_time(time_);
        model_->fill(box_, sheet_);
        place_surface();
    }
    if (shows_water()) fill_water();
    if (foam_below_) make_foam();
}

/// The distributed fields in parallel: in 2D the sheet is replicated.
std::vector<Values*> Waves::shared() {
    std::vector<Values*> list;
    const auto add = [&](Values& values) {
        if (!values.empty()) list.push_back(&values);
    };
    add(level_set_);
    for (Values& v : water_) add(v);
    if (box_.dim == 2) return list;
    for (Values* of_sheet : {&sheet_.height, &sheet_.moved_x, &sheet_.moved_z, &sheet_.jacobian, &foam_}) add(*of_sheet);
    for (auto* vectors : {&position_, &sheet_.velocity})
        for (Values& v : *vectors) add(v);
    return list;
}

/// Halo exchange, or all-gather without distributed storage, before fields are read from outside; collective.
void Waves::synchronize() {
    if (ghosts_filled_) return;
    if (box_.own.distributed_storage()) {
        std::vector<Planes> all;
        for (Values* values : shared()) all.push_back(planes_of(*values));
        communicator().refresh(box_.own.partition(), all, 1, false);
    } else {
        for (Values* values : shared()) gather(*values);
    }
    ghosts_filled_ = true;
}

void Waves::place_surface() {
    const auto nx = static_cast<std::size_t>(box_.nx());
    for_own_rows(box_, [&](int k) {
        for (int i = 0; i < box_.nx(); ++i) {
            const std::size_t at = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(k);
            position_[0][at] = box_.x(i) + (sheet_.moved_x.empty() ? 0 : sheet_.moved_x[at]);
            position_[1][at] = level_ + sheet_.height[at];
            if (box_.dim == 3) position_[2][at] = box_.z(k) + (sheet_.moved_z.empty() ? 0 : sheet_.moved_z[at]);
        }
    });
}

/// The distance to the surface along y, negative in the water, and the velocity, layer by layer. With horizontal displacements the surface
/// height above a column is found iteratively.
void Waves::fill_water() {
    const auto timed = passes_.time("water");
    const auto nx = static_cast<std::size_t>(box_.nx()), ny = static_cast<std::size_t>(box_.ny()), row = nx * ny;
    const PlaneRange layers = box_.layers();
    for_own_rows(box_, [&](int k) {
        for (int i = 0; i < box_.nx(); ++i) {
            const std::size_t at = static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(k);
            real height = sheet_.height[at];
            if (model_->sideways()) {
                const Vec<2> rest = rest_of(*model_, box_.x(i), box_.z(k));
                height = model_->motion(rest[0], rest[1]).moved[1];
            }
            for (int j = layers.begin; j < layers.end; ++j)
                level_set_[static_cast<std::size_t>(i) + nx * static_cast<std::size_t>(j) + row * static_cast<std::size_t>(k)] =
                    box_.y(j) - level_ - height;
        }
    });
    if (with_velocity_) model_->fill_water(box_, level_, water_);
}

/// 1 where the surface is folded, 0 where a patch keeps at least the fraction `below` of its area.
real Waves::foam_of(real jacobian) const { return *foam_below_ > 0 ? std::clamp(1 - jacobian / *foam_below_, 0.0, 1.0) : 0; }

void Waves::make_foam() {
    const auto timed = passes_.time(effect_pass("foam"));
    const auto nx = static_cast<std::size_t>(box_.nx());
    for_own_rows(box_, [&](int k) {
        for (std::size_t at = static_cast<std::size_t>(k) * nx, end = at + nx; at < end; ++at) foam_[at] = foam_of(sheet_.jacobian[at]);
    });
}

FieldSet Waves::fields() const {
    FieldSet set;
    if (box_.own.distributed_storage()) set.cut = &box_.own.partition();
    GridView& grid = set.grid;
    grid.dim = box_.dim;
    for (std::size_t a = 0; a < 3; ++a) {
        grid.cells[a] = box_.cells[a];
        grid.origin[a] = box_.origin[a];
        grid.spacing[a] = box_.spacing[a];
    }
    const auto dims = static_cast<std::size_t>(box_.dim);
    const auto vectors = [&](const std::array<Values, 3>& values) {
        std::vector<std::span<const real>> list;
        for (std::size_t a = 0; a < dims; ++a) list.push_back(values[a].values());
        return list;
    };
    const auto add = [&](const char* name, const char* unit, const std::string& of, std::vector<std::span<const real>> data) {
        set.fields.push_back({name, unit, of.empty() ? Where::cell : Where::particle, of, std::move(data)});
    };
    if (shows_water()) {
        add(level_set_name, "m", "", {level_set_.values()});
        if (with_velocity_) add("velocity", "m/s", "", vectors(water_));
    }
    const std::string surface = surface_set_name;
    for (const std::string& of : {std::string(), surface}) {
        if (of.empty() && shows_water()) continue;
        if (of.empty())
            add(surface_height_name, "m", of, {position_[1].values()});
        else
            add("position", "m", of, vectors(position_));
        if (with_velocity_) add("velocity", "m/s", of, vectors(sheet_.velocity));
        if (!sheet_.jacobian.empty()) add("jacobian", "", of, {sheet_.jacobian.values()});
        if (foam_below_) add("foam", "", of, {foam_.values()});
    }
    set.sheets.push_back({surface, {box_.nx(), box_.nz()}});
    return set;
}

bool Waves::answer(std::string_view field, const Vec<3>& at, std::span<real> values) const {
    const auto whole = [&](const Vec<3>& v) {
        for (std::size_t a = 0; a < values.size(); ++a) values[a] = v[a];
        return true;
    };
    if (field == "velocity") return whole(model_->velocity({{at[0], at[1] - level_, at[2]}}));
    if (Motion m; field == "position" && model_->particle({{at[0], at[1] - level_, at[2]}}, m)) return whole(at + m.moved);
    const Vec<2> rest = rest_of(*model_, at[0], at[2]);
    const Motion m = model_->motion(rest[0], rest[1]);
    if (field == surface_height_name) return values[0] = level_ + m.moved[1], true;
    if (field == level_set_name) return values[0] = at[1] - level_ - m.moved[1], true;
    if (field == "jacobian") return values[0] = m.jacobian(), true;
    if (field == "foam" && foam_below_) return values[0] = foam_of(m.jacobian()), true;
    return false;
}

real Waves::least_jacobian() const {
    if (sheet_.jacobian.empty()) return 1;
    const auto least_of_row = [&](int k) {
        const real* row = sheet_.jacobian.data() + static_cast<std::ptrdiff_t>(k) * box_.nx();
        return -*std::min_element(row, row + box_.nx());
    };
    return -most_of_rows(box_, least_of_row);
}

/// The fraction of the sheet's patches with foam.
real Waves::foam_cover() const {
    const real covered = sum_of_rows(box_, [&](int k) {
        const real* row = foam_.data() + static_cast<std::ptrdiff_t>(k) * box_.nx();
        return static_cast<real>(std::count_if(row, row + box_.nx(), [](real f) { return f > 0; }));
    });
    return covered / static_cast<real>(foam_.size());
}

std::string Waves::concern() const {
    if (foam_below_ || sheet_.jacobian.empty()) return {};
    const real least = least_jacobian();
    if (least >= 0) return {};
    return fmt::format(
        "the surface is folded over itself at t = {:.4g} s: the Jacobian of its motion falls to {:.2g}; lower the waves' steepness or "
        "choppiness, or add effects.foam, which marks such places",
        time_, least);
}

/// Means over the horizontal area: each point is weighted by the relative area of its patch.
std::vector<Integral> Waves::integrals() const {
    const auto nx = static_cast<std::size_t>(box_.nx());
    const auto mean = [&](const auto& f) {
        return sum_of_rows(box_, [&](int k) {
            real sum = 0;
            for (std::size_t at = static_cast<std::size_t>(k) * nx, end = at + nx; at < end; ++at)
                sum += f(sheet_.height[at]) * (sheet_.jacobian.empty() ? 1 : sheet_.jacobian[at]);
            return sum;
        });
    };
    const real area = mean([](real) { return 1.0; }), first = mean([](real h) { return h; }) / area;
    const real second = mean([](real h) { return h * h; }) / area;
    const real cell = box_.spacing[0] * (box_.dim == 3 ? box_.spacing[2] : 1);
    std::vector<Integral> list{{"mean_level", "m", level_ + first},
                               {"significant_height", "m", 4 * std::sqrt(std::max(0.0, second - first * first))},
                               {"potential_energy", box_.dim == 3 ? "J" : "J/m", 0.5 * density_ * g_ * second * area * cell},
                               {"carried_variance", "", model_->carried()}};
    if (!sheet_.jacobian.empty()) list.push_back({"least_jacobian", "", least_jacobian()});
    if (foam_below_) list.push_back({"foam_cover", "", foam_cover()});
    return list;
}

std::size_t Waves::bytes() const {
    std::size_t total = foam_.bytes() + level_set_.bytes();
    for (const auto* vectors : {&position_, &water_})
        for (const Values& v : *vectors) total += v.bytes();
    return total + sheet_.bytes() + model_->bytes();
}

std::vector<EffectPlan> Waves::effects() const {
    std::vector<EffectPlan> plans;
    if (gravity_) plans.push_back({.name = "gravity", .inside = "surface", .at_start = true});
    if (tension_) plans.push_back({.name = "surface_tension", .inside = "surface", .at_start = true});
    if (foam_below_) plans.push_back({.name = "foam", .pass = effect_pass("foam"), .bytes = foam_.bytes(), .shown = {"foam"}});
    return plans;
}

}  // namespace weir::waves
