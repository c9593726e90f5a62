#include "heightfield/columns.hpp"

#include "core/error.hpp"
#include "parallel/plane_checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir::heightfield {

namespace {

void refuse_what_columns_cannot(const scene::Scene& scene, const State& state) {
    for (const char* effect : {"friction", "rain"})
        if (scene.effect(effect))
            scene.refuse(std::string("effects.") + effect, "scheme.model = \"columns\" has no currents and keeps the still depth",
                         "use scheme.model = \"shallow_water\"");
    if (state.push[0] != 0 || state.push[1] != 0)
        scene.refuse("effects.gravity.g", "scheme.model = \"columns\" supports gravity along y only",
                     "use scheme.model = \"shallow_water\" for slopes");
    if (scene.has("initial.velocity"))
        scene.refuse("initial.velocity", "scheme.model = \"columns\" has no currents", "use scheme.model = \"shallow_water\"");
    for (std::size_t s = 0; s < scene.root().tables("solids").size(); ++s)
        if (scene.root().tables("solids")[s].has("motion"))
            scene.refuse(fmt::format("solids[{}].motion", s),
                         "scheme.model = \"columns\" keeps the still depth: solids on the bed cannot move",
                         "use floats, or scheme.model = \"shallow_water\" for a moving bed");
    for (int axis = 0; axis < scene.dim() - 1; ++axis)
        for (int end = 0; end < 2; ++end)
            if (const SideKind kind = state.sides(axis, end).kind;
                kind != SideKind::wall && kind != SideKind::periodic && kind != SideKind::outflow)
                scene.refuse(fmt::format("sides.{}_{}", "xz"[axis], end == 0 ? "min" : "max"), "scheme.model = \"columns\" has no inflow",
                             "known: wall, outflow, open, periodic");
}

}  // namespace

Columns::Columns(const scene::Scene& scene, const Partition& partition)
    : state_(scene, partition),
      surface_(state_.plane.extent()),
      rate_(state_.plane.extent()),
      periodic_x_(state_.sides(0, 0).kind == SideKind::periodic),
      periodic_z_(state_.sides(1, 0).kind == SideKind::periodic),
      sweep_(state_.plane, periodic_x_, periodic_z_),
      floats_(make_floats(scene, state_.plane), state_.plane, state_.bed, state_.h, state_.g, state_.rho, periodic_x_, periodic_z_),
      brush_forcing_(geometry::make_brush(scene, {BrushKind::pour, BrushKind::drain})),
      depth_(state_.plane.extent()),
      nothing_(state_.plane.extent()),
      cfl_(scene.number("time.cfl")) {
    refuse_what_columns_cannot(scene, state_);
    Field().swap(state_.qx), Field().swap(state_.qz);
    // the still depth is relative to the mean surface: initial waves do not increase the depth
    const Plane& plane = state_.plane;
    const real wet = sum_of_columns(plane, [&](std::size_t c) { return state_.h[c] > state_.dry ? 1.0 : 0.0; });
    if (wet == 0) scene.refuse("solver", "the scene contains no water", "add liquid or initial.surface");
    const real still =
        sum_of_columns(plane, [&](std::size_t c) { return state_.h[c] > state_.dry ? state_.h[c] + state_.bed[c] : 0.0; }) / wet;
    for_each_column(plane, rows_stored(plane), [&](std::size_t c) {
        const bool is_wet = state_.h[c] > state_.dry;
        surface_[c] = state_.h[c] + state_.bed[c];
        state_.h[c] = is_wet ? std::max(0.0, still - state_.bed[c]) : 0;
    });
    make_stiffness();
    if (!floats_.empty()) {
        displaced_ = Field(state_.plane.extent());
        try {
            floats_.enter(surface_, rate_, k_);
        } catch (const NumericalFailure& failure) {  // on the bed, or in another body
            scene.refuse("floats", failure.what());
        }
    }
    if (scene.effect("gravity")) plans_.push_back({.name = "gravity", .inside = "move columns"});
    if (brush_forcing_) plans_.push_back({.name = "hand", .pass = effect_pass("hand")});
    if (const auto* t = scene.effect("damping")) {
        damping_ = t->number("rate");
        plans_.push_back({.name = "damping", .pass = effect_pass("damping")});
    }
}

/// k of faces between two wet columns: g times the mean of their still depths, over dx^2.
void Columns::make_stiffness() {
    const Plane& plane = state_.plane;
    const Field& depth = state_.h;
    const auto pull = [&](real a, real b, real d) { return a > 0 && b > 0 ? state_.g * 0.5 * (a + b) / (d * d) : 0; };
    const real first = own().distributed() ? of_ranks(communicator().rank() == 0 ? depth[0] : 0)[0] : depth[0];
    const real uneven = sum_of_columns(plane, [&](std::size_t c) { return std::abs(depth[c] - first) <= 1e-12 * first ? 0.0 : 1.0; });
    k_.uniform = floats_.empty() && uneven == 0;
    k_.along_x = pull(first, first, plane.dx), k_.along_z = plane.dim == 3 ? pull(first, first, plane.dz) : 0;
    real stiffest = 2 * (k_.along_x + k_.along_z);
    if (!k_.uniform) {
        const auto between = [&](std::size_t a, std::size_t b, real d) { return pull(depth[a], depth[b], d); };
        const int nx = plane.nx, nz = plane.nz, begin = own().lower(0), end = own().upper(nz);
        k_.x = Field(Extent<2>({{nx + 1, nz}}, own()));
        k_.z = Field(Extent<2>({{nx, nz + 1}}, own()));
        for (int r = begin; r < end; ++r)
            for (int f = 0; f <= nx; ++f)
                if (periodic_x_ || (f > 0 && f < nx))
                    k_.x[static_cast<std::size_t>(r) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(f)] =
                        between(plane.at((f - 1 + nx) % nx, r), plane.at(f % nx, r), plane.dx);
        for (int f = begin; plane.dim == 3 && f <= end; ++f)
            for (int i = 0; i < nx; ++i)
                if (periodic_z_ || (f > 0 && f < nz))
                    k_.z[plane.at(i, f)] = between(plane.at(i, (f - 1 + nz) % nz), plane.at(i, f % nz), plane.dz);
        const real deepest =
            plane_max(own(), nz, [&](int r) { return *std::max_element(&depth[plane.at(0, r)], &depth[plane.at(0, r)] + nx); });
        const real k = 2 * state_.g * deepest;
        stiffest = k / (plane.dx * plane.dx) + (plane.dim == 3 ? k / (plane.dz * plane.dz) : 0);
    }
    limit_ = stiffest > 0 ? std::sqrt(2 / stiffest) : infinity;
}

/// Waves and objects cross at most `cfl` columns per step; an object that skips columns would not push them.
real Columns::advised_dt() const { return cfl_ * std::min(limit_, 1 / floats_.pace(state_.time)); }

StepReport Columns::step(real dt) {
    ghosts_filled_ = !own().distributed();
    refresh(surface_, periodic_z_);
    if (brush_forcing_) {
        const auto timed = passes_.time("effect hand");
        apply_sources_and_sinks(*brush_forcing_, state_, surface_, dt, [&](std::size_t c) { return floats_.covers(c); });
    }
    if (!floats_.empty()) {
        const auto timed = passes_.time("place floats");
        floats_.before(state_.time + dt, surface_, rate_, k_);
    }
    {
        const auto timed = passes_.time("move columns");
        sweep_.step(surface_, rate_, k_, dt);
    }
    if (!floats_.empty()) {
        const auto timed = passes_.time("floats");
        floats_.after(dt, surface_, rate_);
    }
    state_.net_inflow += dt * through_;  // the sweep used the rates before sides and damping change them
    if (damping_ > 0) {
        const auto timed = passes_.time("effect damping");
        const real left = std::exp(-dt * damping_);
        const auto n = static_cast<std::size_t>(state_.plane.nx);
        for_each_plane(own(), 0, state_.plane.nz, [&](int r) {
            for (std::size_t c = static_cast<std::size_t>(r) * n; c < static_cast<std::size_t>(r + 1) * n; ++c) rate_[c] *= left;
        });
        through_ *= left;
    }
    if (state_.sides.any_open()) outflow_at_open_sides(dt);
    state_.time += dt;
    if (++steps_ % checked_every == 0) check();
    return {.dt = dt, .cfl = dt / limit_, .iterations = floats_.iterations()};
}

/// Open sides absorb waves: the discharge through the side is c times the wave's height, so dw/dt = -c/dx w there.
void Columns::outflow_at_open_sides(real dt) {
    const Plane& plane = state_.plane;
    const auto slow = [&](int i, int r, real d) -> real {
        if (!plane.own.contains(r)) return 0;
        const std::size_t c = plane.at(i, r);
        const real before = rate_[c];
        rate_[c] = before / (1 + dt * std::sqrt(state_.g * state_.h[c]) / d);
        return rate_[c] - before;
    };
    ExactSum taken;
    for (const int end : {0, 1}) {
        const int i = end == 0 ? 0 : plane.nx - 1, r = end == 0 ? 0 : plane.nz - 1;
        for (int k = 0; state_.sides.open(0, end) && k < plane.nz; ++k) taken.add(slow(i, k, plane.dx));
        for (int k = 0; state_.sides.open(1, end) && k < plane.nx; ++k) taken.add(slow(k, r, plane.dz));
    }
    through_ += plane.area() * sum_of_ranks(own(), taken).value();
}

void Columns::check() const {
    const Plane& plane = state_.plane;
    const real least = -plane_max(plane.own, plane.nz, [&](int r) {
        if (r == 0 && std::isinf(surface_[0])) return not_applicable;
        real most = -infinity;
        for (int i = 0; i < plane.nx; ++i) {
            const std::size_t c = plane.at(i, r);
            const real shallow = state_.h[c] > 0 && !floats_.covers(c) ? state_.bed[c] - surface_[c] : -infinity;
            if (!(shallow <= most)) most = shallow;
            if (std::isnan(most)) break;
        }
        return most;
    });
    if (std::isnan(least)) throw NumericalFailure("surface", "surface is no longer finite");
    if (least < 0)
        throw NumericalFailure(
            "depth", "a column became dry, which scheme.model = \"columns\" does not support; use scheme.model = \"shallow_water\"");
}

/// Halo exchange, or all-gather without distributed storage, before fields are read from outside; collective.
void Columns::synchronize() {
    if (ghosts_filled_) return;
    if (own().distributed_storage()) {
        const std::array<Planes, 2> all{planes_of(surface_), planes_of(rate_)};
        communicator().refresh(own().partition(), all, 1, periodic_z_);
    } else {
        for (Field* field : {&surface_, &rate_}) gather(*field);
    }
    ghosts_filled_ = true;
}

std::string Columns::concern() const {
    if (floats_.empty()) return {};
    const real over = floats_.over_top(surface_);
    return over > 0 ? fmt::format("water is {:.3g} m above the top of a float: a height field cannot represent water over objects", over)
                    : std::string();
}

FieldSet Columns::fields() const {
    for_each_column(state_.plane, rows_stored(state_.plane), [&](std::size_t c) { depth_[c] = surface_[c] - state_.bed[c]; });
    FieldSet set{.grid = state_.plane.view(),
                 .fields = {{"velocity", "m/s", Where::cell, "", {nothing_.values(), rate_.values()}},
                            {"depth", "m", Where::cell, "", {depth_.values()}},
                            {"surface", "m", Where::cell, "", {surface_.values()}},
                            {"bed", "m", Where::cell, "", {state_.bed.values()}}}};
    if (state_.plane.dim == 3) set.fields[0].data.push_back(nothing_.values());
    if (!floats_.empty()) {
        floats_.displaced(surface_, displaced_);
        for (std::size_t c = 0; c < depth_.size(); ++c) depth_[c] -= displaced_[c];
        set.fields.push_back({"displaced", "m", Where::cell, "", {displaced_.values()}});
        floats_.show(set);
    }
    if (own().distributed_storage()) set.cut = &own().partition();
    return set;
}

real Columns::volume() const {
    return sum_of_columns(state_.plane, [&](std::size_t c) { return surface_[c] - state_.bed[c]; }) + floats_.missing(surface_);
}

std::vector<Integral> Columns::integrals() const {
    const real volume = this->volume();
    if (!floats_.empty()) floats_.displaced(surface_, displaced_);
    // height of the water's top above its level at rest; below objects it is lower than the height equivalent to the pressure
    const real raised = sum_of_columns(state_.plane, [&](std::size_t c) {
        const real up = surface_[c] - (displaced_.empty() ? 0 : displaced_[c]) - state_.bed[c] - state_.h[c];
        return state_.h[c] > 0 ? up * up : 0;
    });
    const std::string volume_unit = state_.plane.dim == 2 ? "m^2" : "m^3", per_depth = state_.plane.dim == 2 ? "/m" : "";
    std::vector<Integral> list = {{"volume", volume_unit, volume},
                                  {"poured_volume", volume_unit, state_.net_inflow},
                                  {"volume_balance", volume_unit, volume - state_.net_inflow},
                                  {"potential_energy", "J" + per_depth, 0.5 * state_.rho * state_.g * raised}};
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, state_.plane.dim, list);
    for (std::size_t b = 0; b < floats_.count(); ++b) {
        const std::string name = fmt::format("float{}_", b);
        const Pushed& p = floats_.pushed(b);
        list.push_back({name + "height", "m", floats_.body(b).height()});
        list.push_back({name + "speed", "m/s", floats_.body(b).speed()});
        list.push_back({name + "displaced", volume_unit, p.displaced});
        list.push_back({name + "force_x", "N" + per_depth, p.along_x});
        list.push_back({name + "force_y", "N" + per_depth, p.up});
        if (state_.plane.dim == 3) list.push_back({name + "force_z", "N" + per_depth, p.along_z});
    }
    return list;
}

/// The height of the surface, and its rate as the vertical velocity. Not editable with floats, whose columns include their weight.
std::vector<EditableField> Columns::editable() {
    if (!floats_.empty()) return {};
    volume_before_ = volume();
    EditableField velocity{"", "velocity", {nothing_.values(), rate_.values()}}, surface{"", "surface", {surface_.values()}};
    velocity.min[0] = velocity.max[0] = 0;
    if (state_.plane.dim == 3) velocity.data.emplace_back(nothing_.values()), velocity.min[2] = velocity.max[2] = 0;
    return {std::move(velocity), std::move(surface)};
}

/// Counts raised volume as poured and lowered volume as drained. The still depth does not change.
void Columns::edited(const EditableField& field) {
    for_each_column(state_.plane, rows_stored(state_.plane), [&](std::size_t c) {
        if (is_wet(c) ? surface_[c] <= state_.bed[c] : surface_[c] != state_.bed[c] || rate_[c] != 0)
            throw BadInput(fmt::format("\"{}\" at {}: the bed is at {} m, and scheme.model = \"columns\" {}", field.name, c, state_.bed[c],
                                       is_wet(c) ? "does not support drying" : "does not support wetting"));
    });
    state_.net_inflow += volume() - volume_before_;
}

void Columns::save(Checkpoint& to) const {
    put_planes(to, "surface", surface_);
    put_planes(to, "rate", rate_);
    to.put_value("time", state_.time);
    to.put_value("poured", state_.net_inflow);
    to.put_value("through", through_);
    to.put_value("steps", steps_);
    if (brush_forcing_) brush_forcing_->save(to);
    if (!floats_.empty()) floats_.save(to);
}

void Columns::restore(const Checkpoint& from) {
    get_planes(from, "surface", surface_);
    get_planes(from, "rate", rate_);
    state_.time = from.get_value<real>("time");
    state_.net_inflow = from.get_value<real>("poured");
    through_ = from.get_value<real>("through");
    steps_ = get_count(from, "steps");
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    if (!floats_.empty()) floats_.restore(from, state_.time, surface_, rate_, k_);
    ghosts_filled_ = !own().distributed_storage();
}

std::size_t Columns::bytes() const {
    std::size_t total = state_.bytes() + k_.bytes() + sweep_.bytes() + floats_.bytes();
    for (const Field* f : {&surface_, &rate_, &std::as_const(depth_), &std::as_const(displaced_), &nothing_}) total += f->bytes();
    return total;
}

}  // namespace weir::heightfield
