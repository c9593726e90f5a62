#include "heightfield/shallow_water.hpp"

#include "core/error.hpp"
#include "parallel/plane_checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weir::heightfield {

namespace {

/// dt max sum (|u| + c)/h: beyond it a column could lose more water than it has (Audusse et al. 2004).
constexpr real most_cfl = 0.5;

}  // namespace

ShallowWater::ShallowWater(const scene::Scene& scene, const Partition& partition)
    : state_(scene, partition),
      rows_(state_.plane, limiter_named(scene.text("scheme.limiter"))),
      reports_(static_cast<std::size_t>(state_.plane.nz)),
      h1_(state_.h.extent()),
      qx1_(state_.qx.extent()),
      qz1_(state_.qz.extent()),
      nothing_(state_.h.extent()),
      raised_(make_raised_bed(scene, state_.plane)),
      effects_(make_effects(scene, state_, "move water")),
      brush_forcing_(geometry::make_brush(scene, geometry::moving_kinds)),
      cfl_(scene.number("time.cfl")) {
    if (brush_forcing_) effects_.add("hand", brush_effect(brush_forcing_));
    if (cfl_ > most_cfl) scene.refuse("time.cfl", "more than half a column per step: the depth may become negative", "cfl is at most 0.5");
    if (raised_ && raised_->moves())
        terrain_ = make_terrain(scene, state_.plane);
    else
        raised_.reset();
    measure();
}

/// Recomputes the volume and the rate that limits the step: at the start, and after effects have changed depths or speeds.
void ShallowWater::measure() {
    const Plane& plane = state_.plane;
    const real rx = 1 / plane.dx, rz = 1 / plane.dz, dry = state_.dry;
    rate_ = plane_max(plane.own, plane.nz, [&](int k) {
        real most = 0;
        for (int i = 0; i < plane.nx; ++i) {
            const std::size_t c = plane.at(i, k);
            const real h = state_.h[c], d = h > dry ? h : dry, over = h > dry ? 1 / d : 0, wave = std::sqrt(state_.g * d);
            const real along_x = (std::abs(state_.qx[c] * over) + wave) * rx;
            most = std::max(most, plane.dim == 2 ? along_x : along_x + (std::abs(state_.qz[c] * over) + wave) * rz);
        }
        return most;
    });
    volume_ = sum_of_columns(plane, [&](std::size_t c) { return state_.h[c]; });
}

/// Audusse et al. 2004 with Heun's method.
StepReport ShallowWater::step(real dt) {
    ghosts_filled_ = !own().distributed();
    const real cfl = dt * rate_;
    effects_.apply(Stage::source, state_, dt, passes_);
    if (raised_) raise_bed(state_.time + dt);
    move_water(dt);
    effects_.apply(Stage::force, state_, dt, passes_);
    effects_.apply(Stage::implicit, state_, dt, passes_);
    state_.time += dt;
    if (!effects_.empty(Stage::force)) measure();
    return {.dt = dt, .cfl = cfl};
}

void ShallowWater::raise_bed(real t) {
    const auto timed = passes_.time("raise bed");
    raised_->at(t, terrain_, rows_near(state_.plane), state_.bed);
}

void ShallowWater::move_water(real dt) {
    const auto timed = passes_.time("move water");
    const Water now{state_.h.data(), state_.qx.data(), state_.qz.data()}, next{h1_.data(), qx1_.data(), qz1_.data()};
    refresh_water({&state_.h, &state_.qx, &state_.qz}, rows_beside);
    rows_.stage({.state = state_, .from = now, .to = next, .dt = dt, .second = false}, reports_);
    take_reports(0.5);
    refresh_water({&h1_, &qx1_, &qz1_}, rows_beside);
    rows_.stage({.state = state_, .from = next, .to = now, .dt = dt, .second = true}, reports_);
    take_reports(0.5);
}

/// In parallel, fills the ghost rows: the two reconstructions of a face read two.
void ShallowWater::refresh_water(const std::array<Field*, 3>& water, int ghost_planes) {
    if (!own().distributed()) return;
    const std::array<Planes, 3> all{planes_of(*water[0]), planes_of(*water[1]), planes_of(*water[2])};
    communicator().refresh(own().partition(), all, ghost_planes, own().slab->ring());
}

/// Halo exchange, or all-gather without distributed storage, before fields are read from outside; collective.
void ShallowWater::synchronize() {
    if (ghosts_filled_) return;
    if (own().distributed_storage()) {
        refresh_water({&state_.h, &state_.qx, &state_.qz}, 1);
    } else {
        for (Field* field : {&state_.h, &state_.qx, &state_.qz}) gather(*field);
        if (raised_) gather(state_.bed);
    }
    ghosts_filled_ = true;
}

void ShallowWater::take_reports(real weight) {
    struct Totals {
        ExactSum volume, through;
        real rate = 0, clipped = 0;
        void add(const Totals& other) {
            volume.add(other.volume), through.add(other.through);
            rate = std::max(rate, other.rate), clipped = std::max(clipped, other.clipped);
        }
    } totals;
    for (int k = own().lower(0); k < own().upper(state_.plane.nz); ++k) {
        const RowReport& r = reports_[static_cast<std::size_t>(k)];
        totals.volume.add(r.volume), totals.through.add(r.through);
        totals.rate = std::max(totals.rate, r.rate), totals.clipped = std::max(totals.clipped, -r.lowest);
    }
    totals = sum_of_ranks(own(), totals);
    volume_ = totals.volume.value() * state_.plane.dz;
    rate_ = totals.rate;
    clipped_ = std::max(clipped_, totals.clipped);
    state_.net_inflow += weight * totals.through.value();
    if (!std::isfinite(volume_)) throw NumericalFailure("depth", "depth is no longer finite");
}

real ShallowWater::advised_dt() const { return rate_ > 0 ? cfl_ / rate_ : infinity; }

StepLimit ShallowWater::stable_dt() const {
    if (!(rate_ > 0)) return {};
    return {most_cfl / rate_, "the depth may become negative where waves cross more than half a column a step"};
}

FieldSet ShallowWater::fields() const {
    const OwnPlanes shown = own().distributed_storage() ? own().wider(1) : OwnPlanes{};
    const Field &h = state_.h, &qx = state_.qx, &qz = state_.qz;
    for_each_plane(shown, 0, state_.plane.nz, [&](int k) {
        for (int i = 0; i < state_.plane.nx; ++i) {
            const std::size_t c = state_.plane.at(i, k);
            const real over = h[c] > state_.dry ? 1 / h[c] : 0;
            h1_[c] = h[c] + state_.bed[c];
            qx1_[c] = qx[c] * over;
            if (!qz.empty()) qz1_[c] = qz[c] * over;
        }
    });
    FieldSet set{.grid = state_.plane.view(),
                 .fields = {{"velocity", "m/s", Where::cell, "", {qx1_.values(), nothing_.values()}},
                            {"depth", "m", Where::cell, "", {h.values()}},
                            {"surface", "m", Where::cell, "", {h1_.values()}},
                            {"bed", "m", Where::cell, "", {state_.bed.values()}}}};
    if (!qz.empty()) set.fields[0].data.push_back(qz1_.values());
    if (own().distributed_storage()) set.cut = &own().partition();
    return set;
}

std::vector<Integral> ShallowWater::integrals() const {
    const Plane& plane = state_.plane;
    const auto sum = [&](const auto& f) { return sum_of_columns(plane, f); };
    const Field &h = state_.h, &qx = state_.qx, &qz = state_.qz;
    const auto speed2 = [&](std::size_t c) { return h[c] > state_.dry ? (qx[c] * qx[c] + (qz.empty() ? 0 : qz[c] * qz[c])) / h[c] : 0; };
    const real kinetic = sum(speed2), weight = sum([&](std::size_t c) { return h[c] * (state_.bed[c] + 0.5 * h[c]); });
    const real volume = sum([&](std::size_t c) { return h[c]; });
    const bool flat = plane.dim == 2;
    const std::string volume_unit = flat ? "m^2" : "m^3", per_depth = flat ? "/m" : "";
    std::vector<Integral> list = {{"volume", volume_unit, volume},
                                  {"poured_volume", volume_unit, state_.net_inflow},
                                  {"volume_balance", volume_unit, volume - state_.net_inflow},
                                  {"kinetic_energy", "J" + per_depth, 0.5 * state_.rho * kinetic},
                                  {"potential_energy", "J" + per_depth, state_.rho * state_.g * weight},
                                  {"momentum_x", "kg m/s" + per_depth, state_.rho * sum([&](std::size_t c) { return qx[c]; })}};
    if (!qz.empty()) list.push_back({"momentum_z", "kg m/s", state_.rho * sum([&](std::size_t c) { return qz[c]; })});
    list.push_back({"wet_area", flat ? "m" : "m^2", sum([&](std::size_t c) { return h[c] > state_.dry ? 1.0 : 0.0; })});
    list.push_back({"raised_depth", "m", clipped_});
    if (brush_forcing_) geometry::sum_up(*brush_forcing_, plane.dim, list);
    return list;
}

/// Editable: the depth, with the velocity kept, and the depth-averaged velocity, which has no vertical component.
std::vector<EditableField> ShallowWater::editable() {
    fields();
    EditableField velocity{"", "velocity", {qx1_.values(), nothing_.values()}}, depth{"", "depth", {state_.h.values()}};
    if (!qz1_.empty()) velocity.data.emplace_back(qz1_.values());
    velocity.min[1] = velocity.max[1] = 0;
    depth.min[0] = 0;
    return {std::move(velocity), std::move(depth)};
}

/// Added water is counted as poured; below the dry depth it is set at rest.
void ShallowWater::edited(const EditableField&) {
    const real before = volume_;
    for_each_column(state_.plane, rows_stored(state_.plane), [&](std::size_t c) {
        const real wet = state_.h[c] > state_.dry ? state_.h[c] : 0;
        state_.qx[c] = wet * qx1_[c];
        if (!qz1_.empty()) state_.qz[c] = wet * qz1_[c];
    });
    measure();
    state_.net_inflow += volume_ - before;
}

void ShallowWater::save(Checkpoint& to) const {
    put_planes(to, "depth", state_.h);
    put_planes(to, "discharge_x", state_.qx);
    put_planes(to, "discharge_z", state_.qz);
    put_planes(to, "bed", state_.bed);
    to.put_value("time", state_.time);
    to.put_value("poured", state_.net_inflow);
    to.put_value("volume", volume_);
    to.put_value("rate", rate_);
    to.put_value("clipped", clipped_);
    if (brush_forcing_) brush_forcing_->save(to);
}

void ShallowWater::restore(const Checkpoint& from) {
    get_planes(from, "depth", state_.h);
    get_planes(from, "discharge_x", state_.qx);
    get_planes(from, "discharge_z", state_.qz);
    get_planes(from, "bed", state_.bed);
    if (own().distributed_storage()) refresh(state_.bed, own().slab->ring(), rows_beside);
    state_.time = from.get_value<real>("time");
    state_.net_inflow = from.get_value<real>("poured");
    volume_ = from.get_value<real>("volume");
    rate_ = from.get_value<real>("rate");
    clipped_ = from.get_value<real>("clipped");
    if (brush_forcing_ && from.has("hand")) brush_forcing_->restore(from);
    ghosts_filled_ = !own().distributed_storage();
}

std::size_t ShallowWater::bytes() const {
    std::size_t fields = 0;
    for (const Field* f : {&std::as_const(h1_), &std::as_const(qx1_), &std::as_const(qz1_), &terrain_, &nothing_}) fields += f->bytes();
    return state_.bytes() + fields + reports_.capacity() * sizeof(RowReport) + rows_.bytes() + effects_.bytes();
}

}  // namespace weir::heightfield
