// The length of the next step: advised by the solver or fixed, shortened for frames, changes and the end, and within the stability limit.
#include "core/error.hpp"
#include "scene/names.hpp"
#include "sim/extremes.hpp"
#include "sim/requested_times.hpp"
#include "sim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace weir {

namespace {

/// A step may exceed its limit by this factor, so that a sum of rounded steps leaves no sliver before a frame. n steps round n times, by at
/// most n ε t / 2, which is n² ε / 2 of a step; 1e-6 covers a hundred thousand steps.
constexpr real stretch = 1 + 1e-6;

}  // namespace

/// The time for which steps are shortened: the end or the next change, whichever comes first, and frames with output.at = "exact".
real Simulation::next_target() const {
    real target = meets_frames_ ? next_frame() : end_;
    for (auto at = static_cast<std::size_t>(changed_); at < changes_.size(); ++at)
        if (!reached(changes_[at].time)) return std::min(target, changes_[at].time);
    return target;
}

/// The same without the end of the scene.
real Simulation::next_target_but_end() const {
    real target = meets_frames_ && every_ < infinity ? sim::requested_time(every_, sim::first_after(every_, time())) : infinity;
    for (auto at = static_cast<std::size_t>(changed_); at < changes_.size(); ++at)
        if (!reached(changes_[at].time)) return std::min(target, changes_[at].time);
    return target;
}

bool Simulation::shortens_for_end() const {
    if (finished()) return false;
    const StepLimit stable = limit();
    return within_limit(wanted_dt(next_target()), stable) != within_limit(wanted_dt(next_target_but_end()), stable);
}

/// The next frame, or the end where that comes first. A frame that rounding puts just before the end equals the end.
real Simulation::next_frame() const {
    if (every_ == infinity || finished()) return end_;
    const real frame = sim::requested_time(every_, sim::first_after(every_, time()));
    return frame >= end_ - 1e-9 * every_ ? end_ : frame;
}

real Simulation::uncut_dt() const { return fixed_dt_ > 0 ? fixed_dt_ : std::min(solver_->advised_dt(), max_dt_); }

/// Such a step makes no progress: less than a millionth of the longest step and a billionth of the frame interval.
bool Simulation::hopeless(real dt) const { return dt < 1e-6 * longest_dt_ && dt < 1e-9 * std::min(end_, every_); }

void Simulation::refuse_step(const char* which, real dt) const {
    const StepLimit stable = solver_->stable_dt();
    const std::string longest = longest_dt_ > dt ? fmt::format(" (the longest was {:.3g} s)", longest_dt_) : "",
                      why = stable.dt < infinity ? fmt::format("; stable up to {} s ({})", scene::number_text(stable.dt), stable.why) : "";
    throw NumericalFailure("time step", fmt::format("the {} step is {} s{}{}: time no longer advances. Now {}", which,
                                                    scene::number_text(dt), longest, why, sim::extremes(scene_, fields(), time())));
}

real Simulation::wanted_dt(real target) const {
    const real remaining = target - time();
    const bool fixed = fixed_dt_ > 0;
    const real dt = uncut_dt();
    if (remaining > 0 && (!(dt > sim::same_time(time())) || (!fixed && hopeless(dt)))) refuse_step("advised time", dt);
    if (remaining <= 0) return dt;
    if (dt * stretch >= remaining) return remaining;
    return !fixed && 2 * dt > remaining ? remaining / 2 : dt;  // two equal steps rather than one step and a sliver
}

/// The step itself, bit for bit, where it is stable; otherwise the largest equal part of it that is stable.
real Simulation::within_limit(real dt, const StepLimit& limit) const {
    if (!(dt > limit.dt * stretch)) return dt;
    const real part = dt / std::ceil(dt / limit.dt);
    if (!(part > sim::same_time(time())) || hopeless(part)) refuse_step("longest stable", limit.dt);
    return part;
}

void Simulation::warn_of_parts(real wanted, real dt, const StepLimit& limit) {
    split_ = true;
    const char* key = scene_.has("time.dt") ? "time.dt" : "time.cfl";
    warnings_.push_back(
        fmt::format("{}: {} requests a step of {:.4g} s at t = {:.4g} s, and the solver is stable up to {:.4g} s ({}): from here on such "
                    "steps are divided into substeps, now of {:.4g} s (time.guard = \"off\" disables this)",
                    scene_.file(), key, wanted, time(), limit.dt, limit.why, dt));
}

}  // namespace weir
