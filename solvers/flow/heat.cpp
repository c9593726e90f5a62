#include "flow/heat.hpp"

#include "core/error.hpp"
#include "staggered/rows.hpp"

#include <algorithm>
#include <utility>

namespace weir::flow {

namespace {

using poisson::Cell;

constexpr real smallest_liquid = 1e-3;   // ε: of the same size as in Voller & Prakash 1987; the drag of pure ice is C/ε
constexpr real least_mobility = 1e-3;    // less is none: the pressure's matrix knows no weaker face
constexpr int most_iterations = 40;      // of Newton's method
constexpr int most_halvings = 12;        // of a step
constexpr real least_part = 0.125;       // of a Newton step
constexpr real newton_tolerance = 1e-8;  // of the heat that melts a kilogramme; no heat is lost by it
constexpr int most_solve_iterations = 5000;
constexpr real solve_ahead = 1e-3;  // of what Newton asks for is left by a linear solve, whose norm weighs cells by their diagonal

real harmonic(real a, real b) { return a > 0 && b > 0 ? 2 * a * b / (a + b) : 0; }

/// Of the face between two cells; negative are those of cells on the plateau. From a whole cell heat comes to the front inside such a cell
/// through its own state alone: with the mean of both, a melt that conducts well is kept from its ice by ice that is not in the way.
real face_conductivity(real a, real b) {
    if (a < 0 && b > 0) return b;
    if (b < 0 && a > 0) return a;
    return harmonic(std::abs(a), std::abs(b));
}

/// t < moment, where a sum of rounded steps that ends at the moment counts as there.
bool before(real t, real moment) { return t < moment * (1 - 1e-9); }

}  // namespace

template <int D>
void Heat<D>::set_source(const MacState<D>& s) {
    if (source_.empty()) return;
    source_.fill(0);
    if (!wall_source_.empty()) for_each_cell(s.extent(), [&](const Index<D>& I) { source_(I) = wall_source_(I); });
    for (const Heater& heater : heaters_)
        if (!before(s.time, heater.start) && before(s.time, heater.end))
            for (const std::size_t c : heater.cells) source_[c] += heater.density;
}

/// Temperature and share of liquid that belong to the enthalpies.
template <int D>
void Heat<D>::note(MacState<D>& s) {
    const auto& h = s["enthalpy"];
    auto& T = s["temperature"];
    for_each_cell(s.extent(), [&](const Index<D>& I) { T(I) = melting_.temperature(h(I)), liquid_(I) = melting_.liquid(h(I)); });
    const real hottest = max_over(s.extent(), [&](const Index<D>& I) { return h(I); });
    if (!(hottest <= melting_.boils_above))
        throw NumericalFailure("temperature", std::isnan(hottest) ? "the enthalpy is not finite"
                                                                  : "the liquid begins to boil, and solver \"mac\" has no vapour");
}

template <int D>
void Heat<D>::set_conductances(const MacState<D>& s, const Grid<real, D>& h) {
    for_each_cell(s.extent(), [&](const Index<D>& I) {
        const real f = melting_.liquid(h(I)), k = melting_.conductivity(f);
        k_(I) = s.cells(I) != Cell::fluid ? 0 : f > 0 && f < 1 ? -k : k;
    });
    fill_ghosts(k_, no_flux_);
    for (int a = 0; a < D; ++a) {
        auto& g = conductance_[static_cast<std::size_t>(a)];
        const real factor = 1 / (s.u.h[a] * s.u.h[a]);
        for_each_cell(g.extent(), [&](const Index<D>& I) { g(I) = factor * face_conductivity(k_(I - e<D>(a)), k_(I)); });
    }
}

/// out = ∇·(k ∇T) [W/m³]
template <int D>
void Heat<D>::flow(const Padded<D>& T, Grid<real, D>& out) const {
    for_each_row(Index<D>{}, out.extent(), [&](const Index<D>& first, int count) {
        const real* t = T.at(first);
        real* sum = &out(first);
        std::fill_n(sum, count, 0.0);
        for (int b = 0; b < D; ++b) {
            const auto& faces = conductance_[static_cast<std::size_t>(b)];
            const real* g = &faces(first);
            const std::ptrdiff_t up = faces.stride(b), next = T.stride(b);
#pragma omp simd
            for (int i = 0; i < count; ++i) sum[i] += g[i + up] * (t[i + next] - t[i]) - g[i] * (t[i] - t[i - next]);
        }
    });
}

/// What of it comes through the sides of the domain, over all cells.
template <int D>
real Heat<D>::through_sides(const Padded<D>& T) const {
    const Index<D> n = T.extent();
    return sum_over(n, [&](const Index<D>& I) {
        real sum = 0;
        for (int a = 0; a < D; ++a) {
            if (boundary_.end[static_cast<std::size_t>(a)][0].kind == EndRule::Kind::periodic) continue;
            const auto& g = conductance_[static_cast<std::size_t>(a)];
            const Index<D> up = I + e<D>(a);
            if (I[a] == n[a] - 1) sum += g(up) * (T(up) - T(I));
            if (I[a] == 0) sum -= g(I) * (T(I) - T(I - e<D>(a)));
        }
        return sum;
    });
}

template <int D>
void Heat<D>::conduct(MacState<D>& s, real dt) {
    set_source(s);
    if (explicit_) {
        auto& h = s["enthalpy"];
        const auto& T = s.field("temperature").before;
        set_conductances(s, h);
        flow(T, residual_);
        const real a = dt / s.rho;
        for_each_cell(s.extent(), [&](const Index<D>& I) { h(I) += a * (residual_(I) + source(I)); });
        count(s, T, dt);
    } else {
        implicit(s, dt, 0);
    }
    note(s);
}

template <int D>
void Heat<D>::count(const MacState<D>& s, const Padded<D>& T, real dt) {
    added_ += dt * s.u.cell_volume() * through_sides(T);
    if (!source_.empty()) added_ += dt * s.u.cell_volume() * sum_over(s.extent(), [&](const Index<D>& I) { return source_(I); });
}

/// H = H* + (dt/ρ) (∇·(k ∇T(H)) + q). Where Newton's method goes round in circles, as it may while many cells leave their plateau at once,
/// the step is taken in two halves.
template <int D>
void Heat<D>::implicit(MacState<D>& s, real dt, int halvings) {
    auto& h = s["enthalpy"];
    for_each_cell(s.extent(), [&](const Index<D>& I) { start_(I) = h(I); });
    set_conductances(s, h);
    if (solve(h, dt / s.rho)) return count(s, T_, dt);
    if (halvings == most_halvings) throw NumericalFailure("temperature", "the implicit conduction of heat did not converge");
    for_each_cell(s.extent(), [&](const Index<D>& I) { h(I) = start_(I); });
    for (int half = 0; half < 2; ++half) implicit(s, 0.5 * dt, halvings + 1);
}

/// Newton's method from H* = H: the linear part is solved where the temperature can change, for a cell on the plateau keeps its own until
/// it leaves it. Each iterate is H* plus fluxes that cancel between cells, so that no heat is lost however it ends. Where a cell goes to
/// and fro between plateau and liquid, steps of a part of Newton's often end that. Whether it converged.
template <int D>
bool Heat<D>::solve(Grid<real, D>& h, real a) {
    const Index<D> n = h.extent();
    const real goal = newton_tolerance * std::max(melting_.h_liquid - melting_.h_solid, melting_.c_liquid);
    real part = 1, last = infinity;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        for_each_cell(n, [&](const Index<D>& I) { T_(I) = melting_.temperature(h(I)); });
        fill_ghosts(T_, boundary_);
        flow(T_, residual_);
        for_each_cell(n, [&](const Index<D>& I) { residual_(I) = start_(I) + a * (residual_(I) + source(I)) - h(I); });
        const real left = max_over(n, [&](const Index<D>& I) { return std::abs(residual_(I)); });
        if (!std::isfinite(left)) throw NumericalFailure("temperature", "the enthalpy is not finite");
        if (left <= goal) {
            for_each_cell(n, [&](const Index<D>& I) { h(I) += residual_(I); });
            return true;
        }
        part = left < last ? std::min(real(1), 2 * part) : std::max(least_part, part / 2);
        last = left;
        correct(a, h, std::clamp(solve_ahead * goal / left, 1e-10, 1e-3));
        flow(direction_, image_);
        for_each_cell(n, [&](const Index<D>& I) { h(I) += part * (residual_(I) + a * image_(I)); });
    }
    return false;
}

/// direction_ = δT of (c − a ∇·k∇) δT = residual, 0 on the plateau, to a part `tolerance`: conjugate gradients with the diagonal.
template <int D>
void Heat<D>::correct(real a, const Grid<real, D>& h, real tolerance) {
    const Index<D> n = h.extent();
    for_each_cell(n, [&](const Index<D>& I) {
        const real c = capacity_(I) = melting_.capacity(h(I));
        real diagonal = c;
        for (int b = 0; b < D; ++b) {
            const auto& g = conductance_[static_cast<std::size_t>(b)];
            diagonal += a * (g(I) + g(I + e<D>(b)));
        }
        inverse_(I) = c > 0 ? 1 / diagonal : 0;
        change_(I) = 0;
        rest_(I) = c > 0 ? residual_(I) : 0;
        direction_(I) = rest_(I) * inverse_(I);
    });
    fill_ghosts(direction_, correction_);
    real rz = sum_over(n, [&](const Index<D>& I) { return rest_(I) * rest_(I) * inverse_(I); });
    const real goal = tolerance * tolerance * rz;
    for (int iteration = 0; rz > goal; ++iteration) {
        if (iteration == most_solve_iterations)
            throw NumericalFailure("temperature", "the linear solve of the conduction of heat did not converge");
        flow(direction_, image_);
        const real curvature = sum_over(n, [&](const Index<D>& I) {
            image_(I) = capacity_(I) > 0 ? capacity_(I) * direction_(I) - a * image_(I) : 0;
            return image_(I) * direction_(I);
        });
        const real step = rz / curvature, last = rz;
        rz = sum_over(n, [&](const Index<D>& I) {
            change_(I) += step * direction_(I), rest_(I) -= step * image_(I);
            return rest_(I) * rest_(I) * inverse_(I);
        });
        for_each_cell(n, [&](const Index<D>& I) { direction_(I) = rest_(I) * inverse_(I) + rz / last * direction_(I); });
        fill_ghosts(direction_, correction_);
    }
    for_each_cell(n, [&](const Index<D>& I) { direction_(I) = change_(I); });
    fill_ghosts(direction_, correction_);
}

/// Where all is liquid, and was before, there is nothing to do.
template <int D>
bool Heat<D>::slow(MacState<D>& s, real dt) {
    const bool ice = max_over(s.extent(), [&](const Index<D>& I) { return -liquid_(I); }) > -1;
    const bool was_ice = std::exchange(slows_, ice);
    if (!ice && !was_ice) return false;
    const real k = dt * drag_ / s.rho;
    for (int a = 0; a < D; ++a) {
        auto &beta = s.mobility[static_cast<std::size_t>(a)], &u = s.u[a];
        const int n = s.extent()[a];
        for_each_cell(u.extent(), [&](const Index<D>& I) {
            Index<D> below = I - e<D>(a), above = I;
            if (I[a] == 0) below[a] = s.sides.periodic(a) ? n - 1 : 0;
            if (I[a] == n) above[a] = s.sides.periodic(a) ? 0 : n - 1;
            const real f = std::min(liquid_(below), liquid_(above));
            const real b = 1 / (1 + k * (1 - f) * (1 - f) / (f * f * f + smallest_liquid));
            beta(I) = b < least_mobility ? 0 : b;
            u(I) *= beta(I);
            slowed_[a](I) = u(I);
        });
    }
    return true;
}

template <int D>
void Heat<D>::give_back(MacState<D>& s) const {
    if (!slows_) return;
    for (int a = 0; a < D; ++a) {
        const auto& beta = s.mobility[static_cast<std::size_t>(a)];
        for_each_cell(s.u[a].extent(), [&](const Index<D>& I) {
            if (beta(I) < 1) s.u[a](I) = (1 - beta(I)) * slowed_[a](I) + beta(I) * s.u[a](I);
        });
    }
}

/// Euler's explicit scheme takes no more heat from a cell than makes it as cold as its neighbours: six half-distances of walls at the most,
/// and faces that conduct up to twice as well as the worse of their cells.
template <int D>
real Heat<D>::stable_dt(const MacState<D>& s) const {
    if (!explicit_) return infinity;
    const real best = std::max(melting_.k_solid, melting_.k_liquid);
    const real fastest =
        std::max(std::min(2 * melting_.k_solid, best) / melting_.c_solid, std::min(2 * melting_.k_liquid, best) / melting_.c_liquid);
    real sum = 0;
    for (int a = 0; a < D; ++a) sum += 3 / (s.u.h[a] * s.u.h[a]);
    return fastest > 0 ? s.rho / (fastest * sum) : infinity;
}

/// No step crosses the moment at which a heater is switched.
template <int D>
real Heat<D>::max_dt(const MacState<D>& s) const {
    real limit = stable_dt(s);
    for (const Heater& heater : heaters_)
        for (const real moment : {heater.start, heater.end})
            if (before(s.time, moment)) limit = std::min(limit, moment - s.time);
    return limit;
}

template <int D>
std::vector<Integral> Heat<D>::integrals(const MacState<D>& s) const {
    const auto over = [&](const Grid<real, D>& q) {
        return s.u.cell_volume() * sum_over(s.extent(), [&](const Index<D>& I) { return s.cells(I) == Cell::fluid ? q(I) : 0; });
    };
    const char* joule = D == 2 ? "J/m" : "J";
    return {{"heat", joule, s.rho * over(*s.find("enthalpy"))},
            {"heat_added", joule, added_},
            {"liquid_volume", D == 2 ? "m^2" : "m^3", over(liquid_)}};
}

template <int D>
void Heat<D>::restore(const Checkpoint& from, MacState<D>& s) {
    added_ = from.template get_value<real>("heat_added");
    note(s);
}

template <int D>
std::size_t Heat<D>::bytes() const {
    std::size_t count = slowed_.bytes();
    for (const auto* grid : {&source_, &wall_source_, &liquid_, &start_, &residual_, &change_, &image_, &rest_, &capacity_, &inverse_})
        count += grid->size() * sizeof(real);
    for (const auto* padded : {&k_, &T_, &direction_}) count += padded->bytes();
    for (const auto& g : conductance_) count += g.size() * sizeof(real);
    for (const Heater& heater : heaters_) count += heater.cells.size() * sizeof(std::size_t);
    return count;
}

template class Heat<2>;
template class Heat<3>;

}  // namespace weir::flow
