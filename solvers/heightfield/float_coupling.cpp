// The linear system of floats.hpp for the heights of the covered columns and of the bodies at the end of a step, and the contacts that it
// changes (Lannes 2017).
#include "heightfield/floats.hpp"
#include "linear/conjugate_gradients.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace weir::heightfield {

namespace {

constexpr real exact = 1e-14;  // relative to the right-hand side: tolerance of the solve

}  // namespace

void Floats::after(real dt, Field& surface, Field& rate) {
    constexpr int most = 8;  // maximum number of contact changes within a step
    for (int n = 0; n < most; ++n) {
        set_up(dt);
        solve(dt);
        if (!change_contacts()) break;
    }
    take(dt, surface, rate);
}

/// The system for s of the covered columns at the end of the step. A body's height Y satisfies M (Y - Y_0 - dt v)/dt^2 = rho g A sum f (s -
/// u - Y) - M g; divided by rho g A:  (m + F) Y = m (Y_0 + dt v - dt^2 g) + sum f (s - u).
void Floats::set_up(real dt) {
    std::fill(free_.begin(), free_.end(), 1.0);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const Body& body = *bodies_[b];
        const real m = body.mass() / (rho_ * plane_.area() * dt * dt * g_);
        stiff_[b] = m;
        given_[b] = m < infinity ? m * (body.height() + dt * body.speed() - dt * dt * g_) : body.height();
    }
    for (const Contact& c : contacts_) {
        if (!c.touches) continue;
        free_[c.place] -= c.part;
        if (stiff_[c.body] < infinity) stiff_[c.body] += c.part, given_[c.body] -= c.part * c.underside;
    }
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        const Covered& c = covered_[i];
        real rhs = c.water + dt * c.rate + free_[i] * bed_[c.column], stiffness = 0;
        for (std::size_t f = 0; f < 4; ++f) {
            stiffness += c.k[f];
            if (c.place_beside[f] < 0) rhs += dt * dt * c.k[f] * c.surface_beside[f];
        }
        diagonal_[i] = free_[i] + dt * dt * stiffness;
        r_[i] = rhs;
        x_[i] = c.surface;
    }
    for (const Contact& c : contacts_) {
        if (!c.touches) continue;
        const bool free = stiff_[c.body] < infinity;
        r_[c.place] -= c.part * (c.underside - bed_[covered_[c.place].column] + (free ? given_[c.body] / stiff_[c.body] : given_[c.body]));
    }
}

/// y = A x:  (1 - f) s + dt^2 sum k (s - s_beside) + f sum f s/(m + F)
void Floats::multiply(const std::vector<real>& x, std::vector<real>& y, real dt) const {
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        const Covered& c = covered_[i];
        real sum = diagonal_[i] * x[i];
        for (std::size_t f = 0; f < 4; ++f)
            if (c.place_beside[f] >= 0) sum -= dt * dt * c.k[f] * x[static_cast<std::size_t>(c.place_beside[f])];
        y[i] = sum;
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        if (!(stiff_[b] < infinity)) continue;
        real sum = 0;
        for (const Contact& c : contacts_)
            if (c.body == b && c.touches) sum += c.part * x[c.place];
        for (const Contact& c : contacts_)
            if (c.body == b && c.touches) y[c.place] += c.part * sum / stiff_[b];
    }
}

/// M = 1/diagonal (Jacobi).
struct Floats::System {
    static constexpr linear::Norm norm = linear::Norm::residual;
    Floats& of;
    real dt, b_norm;

    static real dot(const std::vector<real>& a, const std::vector<real>& b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), real{0});
    }
    real M(std::size_t i) const { return of.diagonal_[i] > 0 ? 1 / of.diagonal_[i] : 0; }
    real relative_residual() const { return std::sqrt(dot(of.r_, of.r_)) / b_norm; }

    real precondition() const {
        real rz = 0;
        for (std::size_t i = 0; i < of.r_.size(); ++i) rz += M(i) * of.r_[i] * of.r_[i];
        return rz;
    }
    void update_direction(real beta) {
        for (std::size_t i = 0; i < of.p_.size(); ++i) of.p_[i] = M(i) * of.r_[i] + (beta == 0 ? 0 : beta * of.p_[i]);
    }
    real multiply() {
        of.multiply(of.p_, of.ap_, dt);
        return dot(of.p_, of.ap_);
    }
    real advance(real alpha) {
        for (std::size_t i = 0; i < of.x_.size(); ++i) of.x_[i] += alpha * of.p_[i], of.r_[i] -= alpha * of.ap_[i];
        return relative_residual();
    }
};

/// Round-off may end the convergence, since the tolerance is close to it. Water at rest has b = 0 up to round-off: a failure is a residual
/// that is large relative to the initial one also.
void Floats::solve(real dt) {
    constexpr real nothing = 1e-200;  // where b = 0 any residual is too large
    System system{*this, dt, std::max(std::sqrt(System::dot(r_, r_)), nothing)};
    multiply(x_, ap_, dt);
    for (std::size_t i = 0; i < r_.size(); ++i) r_[i] -= ap_[i];
    iterations_ = 0;
    linear::StopTest stop(exact, static_cast<int>(4 * r_.size() + 50), iterations_);
    const real initial = system.relative_residual();
    linear::Outcome outcome = linear::conjugate_gradients(system, stop, initial);
    outcome.relative_residual /= std::max(initial, real{1});
    if (!outcome.broke_down) linear::require_converged("float", "solve for floats", outcome, stop);
}

real Floats::height_of(std::size_t b) const {
    if (!(stiff_[b] < infinity)) return given_[b];
    real sum = given_[b];
    for (const Contact& c : contacts_)
        if (c.body == b && c.touches) sum += c.part * x_[c.place];
    return sum / stiff_[b];
}

/// Water pushes but does not pull: contact ends where the pressure would be negative, and begins where water is higher than the underside.
/// A body of prescribed height keeps contact: columns do not model how air would get below it.
bool Floats::change_contacts() {
    bool changed = false;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
        const real height = height_of(b);
        for (Contact& c : contacts_) {
            if (c.body != b || (c.touches && !(bodies_[b]->mass() < infinity))) continue;
            const bool touches = x_[c.place] > c.underside + height;
            changed = changed || touches != c.touches;
            c.touches = touches;
        }
    }
    return changed;
}

/// Rates and heights from the solution. The volume through each face leaves one column and enters the other, so volume is conserved for any
/// residual.
void Floats::take(real dt, Field& surface, Field& rate) {
    for (std::size_t b = 0; b < bodies_.size(); ++b)
        if (const real height = height_of(b); bodies_[b]->mass() < infinity) bodies_[b]->set(height, (height - bodies_[b]->height()) / dt);
    for (std::size_t i = 0; i < covered_.size(); ++i) {
        Covered& c = covered_[i];
        real w = c.rate;
        for (std::size_t f = 0; f < 4; ++f) {
            const std::ptrdiff_t place = c.place_beside[f];
            if (place >= 0) {
                w += dt * c.k[f] * (x_[static_cast<std::size_t>(place)] - x_[i]);
            } else {
                w += dt * c.k[f] * (c.surface_beside[f] - x_[i]);
                const real more = dt * c.k[f] * (x_[i] - c.surface);  // the sweep used the old height
                rate[c.beside[f]] += more;
                surface[c.beside[f]] += dt * more;
            }
        }
        rate[c.column] = w;
        c.water += dt * w;
        surface[c.column] = free_[i] < 1 ? x_[i] : bed_[c.column] + c.water;
    }
    for (Covered& c : covered_) c.clings = false;
    for (const Contact& c : contacts_)
        if (c.touches && !(bodies_[c.body]->mass() < infinity)) covered_[c.place].clings = true;
    tell();
    forget_free_columns();
}

}  // namespace weir::heightfield
