// Coupling of bodies and pressure in a step: bodies in the pressure matrix where their added mass allows it, otherwise partitioned
// iterations (bodies_in_flow.hpp).
#include "mac/bodies/bodies_in_flow.hpp"
#include "rigid/inside.hpp"

#include <algorithm>
#include <cmath>

namespace weir::mac {

using poisson::Cell;
using rigid::Body;
using rigid::Twist;

namespace {

/// Limits of the partitioned coupling iterations: before the added mass is measured (one solve per degree of freedom) instead of estimated,
/// and after that.
constexpr int most_iterations = 12, most_iterations_measured = 6;

/// Stop tolerance of the pressure solve in one coupling iteration, relative to the right-hand side and to the last change of the
/// velocities.
constexpr real first_tolerance = 1e-2, of_change = 1e-2;

/// A change updates the estimate of the added mass if it exceeds the previous residual by this factor.
constexpr real differs = 5;

/// Part of the tolerance for the pressure solve where the system is monolithic: the following change of the velocities is then round-off.
constexpr real monolithic_part = 0.9;

/// Largest ratio of added mass to mass for bodies in the pressure matrix, whose condition number grows with it. Lighter bodies are coupled
/// by partitioned iterations.
constexpr real most_added = 60;

}  // namespace

/// Initializes the bodies' masses, forces and velocities; the next velocities are extrapolated with the last step's acceleration.
template <int D>
void BodiesInFlow<D>::begin(const MacState<D>& s, bool wet, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        body.wet = wet ? liquid_fraction(s, i) : 0;
        masses_[i] = mass_of(i);
        added_.see(i, body.wet > 0 ? mass_of_wet_surface(s, i) : rigid::Block<D>{});
        const Twist<D> heavy = weight(s, i);
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t at = i * n + k;
            before_[at] = velocity_[at] = base_[at] = body.velocity[k];
            next_[at] = before_[at] + (body.wet > 0 && !body.touches ? dt * gained_[at] : 0);
            heavy_[at] = dt * heavy[k];
            if (k < D) heavy_[at] += dt * (masses_[i][k][k] - body.mass) * gravity_[k];
            if (no_slip_walls_) heavy_[at] += no_slip_walls_->bodies[i].impulse[k];
        }
    }
    if (brush_forcing_) apply_grab(s, dt);
    added_.begin(masses_, free_, mobility_);
}

template <int D>
void BodiesInFlow<D>::follow(std::shared_ptr<BrushForcing> forcing, const scene::Scene& scene) {
    brush_forcing_ = std::move(forcing);
    for (std::size_t i = 0; i < brush_forcing_->keys.size(); ++i)
        if (brush_forcing_->keys[i].kind == BrushKind::grab && brush_forcing_->keys[i].body >= static_cast<int>(bodies_.count()))
            scene.refuse("effects.hand.keyframes[" + std::to_string(i) + "].body", "there is no such body",
                         "numbers of the list bodies, from 0 to " + std::to_string(bodies_.count() - 1));
}

/// Interactive forcing: dv/dt = rate (target − v) for the mass of the body and of the displaced liquid, implicit in v, so stable for any
/// step. The factor of v is added to the mass.
template <int D>
void BodiesInFlow<D>::apply_grab(const MacState<D>& s, real dt) {
    const auto brush = brush_forcing_->at<D>(s.time);
    grab_.body = brush.kind == BrushKind::grab ? brush.body : -1;
    if (grab_.body < 0) return;
    const auto b = static_cast<std::size_t>(grab_.body);
    const Body<D>& body = bodies_[b];
    grab_.weight = dt * brush_forcing_->rate * (body.mass + body.wet * rho_ * body.moments.volume);
    grab_.target = 0.25 * brush_forcing_->rate * (brush.centre - body.at);
    for (std::size_t a = 0; a < D; ++a) {
        real& target = grab_.target[static_cast<int>(a)];
        target = std::clamp(target, -h_[static_cast<int>(a)] / dt, h_[static_cast<int>(a)] / dt);
        masses_[b][a][a] += grab_.weight;
        heavy_[b * n + a] += grab_.weight * (target - before_[b * n + a]);
    }
}

template <int D>
void BodiesInFlow<D>::record_brush_impulse() {
    for (int a = 0; a < D && grab_.body >= 0; ++a)
        if (const std::size_t i = static_cast<std::size_t>(grab_.body) * n + static_cast<std::size_t>(a); free_[i])
            brush_forcing_->impulse[a] += grab_.weight * (grab_.target[a] - velocity_[i]);
}

/// The impulses of the pressure in a time dt.
template <int D>
void BodiesInFlow<D>::pushed(const MacState<D>& s, std::vector<real>& impulse, real dt) const {
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        const Twist<D> f = bodies_[b].wet > 0 ? force(s, b) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) impulse[b * n + k] = dt * f[k];
    }
}

/// V += (M + m)⁻¹ (dt (G + F) − M (V − V_before)): Newton's step, as F falls by m V/dt.
template <int D>
void BodiesInFlow<D>::move_under_forces() {
    for (std::size_t i = 0; i < missing_.size(); ++i) {
        missing_[i] = met_[i] + heavy_[i];
        for (std::size_t l = 0, at = i / n * n; l < n; ++l) missing_[i] -= masses_[i / n][i % n][l] * (velocity_[at + l] - before_[at + l]);
    }
    next_ = velocity_;
    for (std::size_t i = 0; i < next_.size(); ++i)
        for (std::size_t j = 0; j < next_.size(); ++j) next_[i] += mobility_(i, j) * missing_[j];
}

template <int D>
void BodiesInFlow<D>::find_contacts(const geometry::Solids<D>& solids, real dt) {
    rigid::Surroundings<D> around = bodies_.surroundings(solids);
    real fastest = 0;
    for (std::size_t b = 0; b < bodies_.count(); ++b) {
        real speed = 0, turning = 0;
        for (std::size_t k = 0; k < n; ++k) (k < D ? speed : turning) += std::abs(next_[b * n + k]);
        fastest = std::max(fastest, speed + turning * bodies_[b].radius);
    }
    // a light body's first velocity may be many times the converged one: obstacles within that range are included
    around.reach = 2 * dt * fastest + 1e-2 * norm(h_);
    contacts_.find(bodies_.all(), around);
}

template <int D>
void BodiesInFlow<D>::touch(const geometry::Solids<D>& solids, real dt, bool anew) {
    if (anew) find_contacts(solids, dt);
    for (auto& body : bodies_.all()) body.touches = false;
    std::fill(others_.begin(), others_.end(), 0.0);
    if (contacts_.empty()) return;
    contacts_.resolve(bodies_.all(), mobility_, next_, dt, norm(gravity_));
    contacts_.add_impulses(others_);
}

/// Adds bodies to the pressure matrix where their added mass is not too large. With V = base + dt M⁻¹ (pressure impulse), where `base`
/// contains all other impulses, A p = b − h² ρ/dt Σ D_k V_k becomes (A + U C Uᵀ) p = b − h² ρ/dt Σ D_k base_k with U = ΔV D and C = h² ρ/ΔV
/// M⁻¹.
template <int D>
bool BodiesInFlow<D>::join_matrix(const MacState<D>& s) {
    matrix_.clear();
    const real scale = h2_ * s.rho / cell_;
    bool any = false;
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        joined_[i] = bodies_[i].wet > 0;
        for (std::size_t k = 0; k < n; ++k)
            if (free_[i * n + k] && added_.of(i)[k][k] > most_added * masses_[i][k][k]) joined_[i] = 0;
        if (!joined_[i]) continue;
        any = true;
        inverse_[i] = rigid::inverse_of<D>(masses_[i], free_.data() + i * n);
        const std::size_t begin = matrix_.entries.size();
        for (const Cut& c : cuts_[i]) {
            if (s.cells[c.cell] != Cell::fluid) continue;
            matrix_.entries.push_back({c.cell, {}});
            std::copy(c.out.begin(), c.out.end(), matrix_.entries.back().u.begin());
        }
        matrix_.blocks.push_back({begin, matrix_.entries.size(), {}});
        for (std::size_t k = 0; k < n; ++k)
            for (std::size_t l = 0; l < n; ++l) matrix_.blocks.back().C[k][l] = scale * inverse_[i][k][l];
    }
    return any;
}

/// All impulses except the part of the pressure that depends on p.
template <int D>
Twist<D> BodiesInFlow<D>::impulse_without_pressure(const MacState<D>& s, std::size_t body, real dt) const {
    Twist<D> sum{};
    for (const Cut& c : cuts_[body])
        for (std::size_t k = 0; s.cells[c.cell] == Cell::fluid && k < n; ++k) sum[k] += c.out[k] * c.below * (density(s, c.cell) / s.rho);
    for (std::size_t k = 0; k < n; ++k) sum[k] = dt * s.rho * sum[k] + heavy_[body * n + k] + others_[body * n + k];
    return sum;
}

/// Estimates the contact impulses: where a body had contact in the last step, the impulse that keeps its velocity.
template <int D>
void BodiesInFlow<D>::expect_others(const MacState<D>& s, real dt) {
    std::fill(others_.begin(), others_.end(), 0.0);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        if (!bodies_[i].touches) continue;
        const Twist<D> f = force(s, i);
        for (std::size_t k = 0; k < n; ++k) others_[i * n + k] = -heavy_[i * n + k] - dt * f[k];
    }
}

/// Updates the right-hand side: with the velocity without pressure for bodies in the matrix, with the next velocity for others. Returns the
/// norm of its change, ‖δb‖₂.
template <int D>
real BodiesInFlow<D>::adopt(const MacState<D>& s, real dt, Grid<real, D>* b) {
    real sum = 0, squares = 0;
    const real scale = h2_ * s.rho / (dt * cell_);
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Twist<D> change{};
        const Twist<D> impulse = joined_[i] ? impulse_without_pressure(s, i, dt) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) {
            real base = next_[i * n + k];
            if (joined_[i]) base = before_[i * n + k];
            for (std::size_t l = 0; joined_[i] && l < n; ++l) base += inverse_[i][k][l] * impulse[l];
            change[k] = base - base_[i * n + k];
            base_[i * n + k] = base;
        }
        if (!b || bodies_[i].wet == 0) continue;
        for (const Cut& c : cuts_[i]) {
            if (s.cells[c.cell] != Cell::fluid) continue;
            real out = 0;
            for (std::size_t k = 0; k < n; ++k) out += c.out[k] * change[k];
            real& at = (*b)[c.cell];
            squares -= at * at;
            at -= scale * out;
            squares += at * at;
            sum += scale * out * (scale * out);
        }
    }
    b_squared_ += squares;
    return std::sqrt(sum);
}

/// Computes the velocities of the new pressure and their change.
template <int D>
void BodiesInFlow<D>::follow_pressure(const MacState<D>& s, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        const Twist<D> f = joined_[i] ? push(i, s.p) : Twist<D>{};
        for (std::size_t k = 0; k < n; ++k) {
            real v = base_[i * n + k];
            for (std::size_t l = 0; joined_[i] && l < n; ++l) v += dt * inverse_[i][k][l] * f[l];
            change_[i * n + k] = v - velocity_[i * n + k];
            velocity_[i * n + k] = v;
        }
    }
}

template <int D>
void BodiesInFlow<D>::learn() {
    for (std::size_t i = 0; i < last_.size(); ++i) last_[i] -= met_[i];
    added_.learn(change_, last_, masses_, free_, mobility_);
}

/// ‖b‖₂² over the fluid.
template <int D>
real BodiesInFlow<D>::square_of(const MacState<D>& s, const Grid<real, D>& b) const {
    const std::size_t plane = b.size() / static_cast<std::size_t>(s.extent()[D - 1]);
    return plane_sum(s.own(), s.extent()[D - 1], [&](int k) {
        const std::size_t first = static_cast<std::size_t>(k) * plane;
        const Cell* cell = s.cells.data() + first;
        const real* value = b.data() + first;
        real sum = 0;
#pragma omp simd reduction(+ : sum)
        for (std::size_t i = 0; i < plane; ++i) sum += cell[i] == Cell::fluid ? value[i] * value[i] : 0;
        return sum;
    });
}

/// One pressure solve to `tolerance`, relative to ‖b‖ of the extrapolated velocities. If the solve with bodies in the matrix fails, they
/// switch to partitioned coupling.
template <int D>
void BodiesInFlow<D>::coupling_iteration(MacState<D>& s, poisson::Solver<D>& solver, real tolerance, real dt, Grid<real, D>& b) {
    const poisson::Report* report = nullptr;
    if (!matrix_.blocks.empty()) {
        solver.set_tolerance(tolerance * std::min(1.0, whole_ / std::sqrt(std::max(b_squared_, whole_ * whole_ * 1e-4))));
        report = solver.solve(s.p, b, matrix_);
        if (!report) {
            leave_matrix();
            adopt(s, dt, &b);
        }
    }
    if (!report) {
        solver.set_tolerance(tolerance);
        report = &solver.solve(s.p, b);
    }
    const int iterations = report_.iterations + report->iterations;
    const real first = report_.iterations == 0 ? report->residual_before : report_.residual_before;
    report_ = *report;
    report_.iterations = iterations, report_.residual_before = first;
    ++coupling_iterations_;
}

template <int D>
void BodiesInFlow<D>::leave_matrix() {
    matrix_.clear();
    std::fill(joined_.begin(), joined_.end(), 0);
}

/// Returns whether the system is monolithic: all wet bodies are in the matrix and no body has a contact.
template <int D>
bool BodiesInFlow<D>::fluid_decides(const geometry::Solids<D>& solids, real dt) {
    for (std::size_t i = 0; i < bodies_.count(); ++i)
        if (bodies_[i].touches || (bodies_[i].wet > 0 && !joined_[i])) return false;
    find_contacts(solids, dt);
    return contacts_.empty();
}

/// Stores the converged velocities in the bodies. Throws NumericalFailure where a body is beyond a wall.
template <int D>
void BodiesInFlow<D>::take_velocities(MacState<D>& s, SolidPlacement<D>& placement, real dt) {
    velocity_ = next_;
    for (std::size_t i = 0; i < bodies_.count(); ++i) {
        Body<D>& body = bodies_[i];
        for (std::size_t k = 0; k < n; ++k) {
            body.velocity[k] = velocity_[i * n + k];
            gained_[i * n + k] = (velocity_[i * n + k] - before_[i * n + k]) / dt;
        }
        body.force = force(s, i);
        for (std::size_t k = 0; no_slip_walls_ && k < n; ++k) {
            body.viscous[k] = no_slip_walls_->bodies[i].impulse[k] / dt;
            body.force[k] += body.viscous[k];
        }
    }
    if (brush_forcing_) record_brush_impulse();
    bodies_.place(placement.solids());
    rigid::require_inside(bodies_.all(), bodies_.surroundings(placement.solids()));
    set_velocities(s);
}

template <int D>
const poisson::Report& BodiesInFlow<D>::solve(MacState<D>& s, SolidPlacement<D>& placement, real dt, poisson::Solver<D>* solver,
                                              real tolerance, Grid<real, D>* b) {
    find_cuts(s, placement);
    if (b) add_films(s, dt, *b);
    begin(s, solver != nullptr, dt);
    const bool coupled = std::any_of(bodies_.all().begin(), bodies_.all().end(), [](const Body<D>& body) { return body.wet > 0; });
    coupling_iterations_ = report_.iterations = 0;
    leave_matrix();
    adopt(s, dt, b);
    b_squared_ = coupled ? square_of(s, *b) : 0, whole_ = std::sqrt(b_squared_);
    const real enough = coupled ? 0.5 * tolerance : tolerance;
    real solve_tolerance = coupled ? std::max(enough, first_tolerance) : enough, left = 0,
         change = 0;  // left: residual before the last change
    if (coupled && join_matrix(s)) {
        if (fluid_decides(placement.solids(), dt)) solve_tolerance = monolithic_part * tolerance;
        expect_others(s, dt);
        adopt(s, dt, b);
    }
    bool measured = false, again = false;
    for (int count = 0, last = most_iterations;; ++count) {
        if (solver) coupling_iteration(s, *solver, solve_tolerance, dt, *b);
        follow_pressure(s, dt);
        std::swap(met_, last_);
        pushed(s, met_, dt);
        if (count > 0 && !again && change > differs * left) learn();
        const real changed = change;
        move_under_forces();
        touch(placement.solids(), dt, count == 0);
        const real added = adopt(s, dt, b);
        left = solve_tolerance, change = added == 0 ? 0 : added / whole_;
        if (!coupled || solve_tolerance + change <= tolerance) break;
        again = !measured && count > 0 && change > std::max(changed, 1.0);  // the estimate is so poor that the iteration diverges
        if (again) {
            next_ = before_;
            std::fill(others_.begin(), others_.end(), 0.0);
            change = std::max(adopt(s, dt, b) / whole_, enough);
        }
        if (!measured && (again || count == last)) measured = true, last = count + most_iterations_measured, measure_added_mass(s, *solver);
        if (measured && count == last) break;
        solve_tolerance = std::max(enough, of_change * std::min(change, 1.0));
    }
    take_velocities(s, placement, dt);
    if (solver) solver->set_tolerance(tolerance);
    return report_;
}

template class BodiesInFlow<2>;
template class BodiesInFlow<3>;

}  // namespace weir::mac
