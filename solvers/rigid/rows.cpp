#include "rigid/rows.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Sweeps end when no impulse changes a row's velocity by more than this part of the fastest point's, or after most_sweeps.
constexpr int most_sweeps = 400;
constexpr real still = 1e-10;

}  // namespace

/// Positions and velocities are staggered (leapfrog). With v₀ the rate of the stretch s that led to it and v the next one, the tension is
/// that of the mean (x₋₁ + 2 x₀ + x₁)/4 of three positions, T = k (s + dt (v − v₀)/4) + c v. Undamped oscillations of a line then persist
/// for any step (Newmark 1959, β = 1/4, with staggered times: the map of (x, v) has the determinant 1). A line whose period is not resolved
/// must not oscillate from step to step. As z = dt √(k/m) grows beyond 2 the weights 1/4 and 1/4 change to 1 and 0, those of implicit
/// Euler. With b = 1 − 3 c their sum is at least 1/2, which is stable for any z and any number of lines.
template <int D>
void tighten(Row<D>& row) {
    const Spring& line = row.spring;
    const real z2 = line.stiffness * line.dt * line.dt * row.response;
    const real old = 0.25 / (1 + z2 * z2 / 16), now = 1 - 3 * old;
    const real firm = line.stiffness * line.dt * now + line.damping;
    row.target = -line.stiffness * (line.stretch - line.dt * old * line.rate) / firm;
    row.softness = 1 / (line.dt * firm);
}

/// By Cholesky factorization, column by column of the identity.
void invert(const Mobility& matrix, const std::vector<char>& free, Mobility& inverse) {
    const std::size_t n = matrix.size;
    std::vector<std::size_t> at;
    for (std::size_t i = 0; i < n; ++i)
        if (free[i]) at.push_back(i);
    const std::size_t m = at.size();
    std::vector<real> l(m * m, 0.0), x(m);
    for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            real sum = matrix(at[i], at[j]);
            for (std::size_t k = 0; k < j; ++k) sum -= l[i * m + k] * l[j * m + k];
            l[i * m + j] = i == j ? std::sqrt(sum) : sum / l[j * m + j];
        }
    inverse.resize(n);
    for (std::size_t column = 0; column < m; ++column) {
        for (std::size_t i = 0; i < m; ++i) {
            real sum = i == column ? 1 : 0;
            for (std::size_t k = 0; k < i; ++k) sum -= l[i * m + k] * x[k];
            x[i] = sum / l[i * m + i];
        }
        for (std::size_t i = m; i-- > 0;) {
            real sum = x[i];
            for (std::size_t k = i + 1; k < m; ++k) sum -= l[k * m + i] * x[k];
            x[i] = sum / l[i * m + i];
        }
        for (std::size_t i = 0; i < m; ++i) inverse(at[i], at[column]) = x[i];
    }
}

template <int D>
void dry_mobility(const std::vector<Body<D>>& bodies, Mobility& mobility) {
    constexpr std::size_t n = freedoms<D>;
    Mobility mass;
    mass.resize(n * bodies.size());
    std::vector<char> free(mass.size);
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        const auto m = bodies[b].mass_matrix();
        for (std::size_t i = 0; i < n; ++i) {
            free[b * n + i] = !bodies[b].held[i];
            for (std::size_t j = 0; j < n; ++j) mass(b * n + i, b * n + j) = m[i][j];
        }
    }
    invert(mass, free, mobility);
}

std::array<Vec<3>, 2> both_across(const Vec<3>& n) {
    const int a = std::abs(n[0]) < 0.6 ? 0 : 1;
    Vec<3> u = Vec<3>::unit(a) - n[a] * n;
    u = u / norm(u);
    return {u, cross(n, u)};
}

template <int D>
Twist<D> sees(const Body<D>& body, const Vec<D>& point, const Vec<D>& along) {
    Twist<D> m{};
    const Vec<D> r = point - body.at;
    for (std::size_t a = 0; a < D; ++a) m[a] = along[a];
    if constexpr (D == 2)
        m[2] = r[0] * along[1] - r[1] * along[0];
    else
        for (int a = 0; a < 3; ++a)
            m[static_cast<std::size_t>(3 + a)] = r[(a + 1) % 3] * along[(a + 2) % 3] - r[(a + 2) % 3] * along[(a + 1) % 3];
    return m;
}

template <int D>
Row<D> row_at(const std::vector<Body<D>>& bodies, std::size_t body, std::ptrdiff_t other, const Vec<D>& point, const Vec<D>& along) {
    Row<D> row;
    row.body = body, row.other = other;
    const Twist<D> own = sees<D>(bodies[body], point, along);
    std::copy(own.begin(), own.end(), row.sees.begin());
    if (other >= 0) {
        const Twist<D> back = sees<D>(bodies[static_cast<std::size_t>(other)], point, along);
        for (std::size_t d = 0; d < back.size(); ++d) row.sees[back.size() + d] = -back[d];
    }
    return row;
}

template <int D>
void Rows<D>::set(std::vector<Row<D>>& rows, const Mobility& mobility) {
    constexpr std::size_t n = freedoms<D>;
    list_.swap(rows);
    if (impulse_.size() != list_.size()) impulse_.assign(list_.size(), 0.0);
    if (given_.size() != list_.size()) given_.assign(list_.size(), 0.0);
    size_ = mobility.size;
    responses_.assign(list_.size() * size_, 0.0);
    runs_.clear(), runs_end_.clear();
    for (std::size_t i = 0; i < list_.size(); ++i) {
        Row<D>& row = list_[i];
        real* response = responses_.data() + i * size_;
        for (std::size_t d = 0; d < n; ++d)
            for (std::size_t v = 0; v < size_; ++v) {
                response[v] += mobility(v, row.body * n + d) * row.sees[d];
                if (row.other >= 0) response[v] += mobility(v, static_cast<std::size_t>(row.other) * n + d) * row.sees[n + d];
            }
        for (std::size_t d = 0; d < n; ++d) {
            row.response += row.sees[d] * response[row.body * n + d];
            if (row.other >= 0) row.response += row.sees[n + d] * response[static_cast<std::size_t>(row.other) * n + d];
        }
        if (row.spring.stiffness > 0) tighten(row);
        find_runs(response);
    }
}

template <int D>
void Rows<D>::find_runs(const real* response) {
    constexpr std::size_t n = freedoms<D>;
    const std::size_t first = runs_.size();
    for (std::size_t at = 0; at < size_; at += n) {
        if (std::all_of(response + at, response + at + n, [](real v) { return v == 0; })) continue;
        if (runs_.size() > first && runs_.back().end == at)
            runs_.back().end = at + n;
        else
            runs_.push_back({at, at + n});
    }
    runs_end_.push_back(runs_.size());
}

template <int D>
real Rows<D>::relative(const Row<D>& row, const std::vector<real>& velocities) const {
    constexpr std::size_t n = freedoms<D>;
    real v = 0;
    for (std::size_t d = 0; d < n; ++d) {
        v += row.sees[d] * velocities[row.body * n + d];
        if (row.other >= 0) v += row.sees[n + d] * velocities[static_cast<std::size_t>(row.other) * n + d];
    }
    for (int a = 0; a < D; ++a) v -= row.sees[static_cast<std::size_t>(a)] * row.moves[a];
    return v;
}

/// Upper bound of the speed of the body's point: velocities and angular velocities have different units and cannot be compared directly.
template <int D>
real Rows<D>::speed(const Row<D>& row, const std::vector<real>& velocities) const {
    constexpr std::size_t n = freedoms<D>;
    real most = 0;
    for (std::size_t d = 0; d < n; ++d) {
        most += std::abs(row.sees[d] * velocities[row.body * n + d]);
        if (row.other >= 0) most += std::abs(row.sees[n + d] * velocities[static_cast<std::size_t>(row.other) * n + d]);
    }
    return most;
}

template <int D>
void Rows<D>::push(std::size_t row, real impulse, std::vector<real>& velocities) const {
    const real* response = responses_.data() + row * size_;
    for (std::size_t r = row == 0 ? 0 : runs_end_[row - 1]; r < runs_end_[row]; ++r)
        for (std::size_t v = runs_[r].begin; v < runs_[r].end; ++v) velocities[v] += impulse * response[v];
}

/// One Gauss-Seidel sweep; gained_ is the change of each impulse. Returns the largest change of a row's velocity.
template <int D>
real Rows<D>::sweep(std::vector<real>& velocities) {
    real change = 0;
    for (std::size_t i = 0; i < list_.size(); ++i) {
        const Row<D>& row = list_[i];
        gained_[i] = 0;
        if (!(row.response > 0)) continue;
        const real before = impulse_[i], v = relative(row, velocities);
        impulse_[i] = limited(row, before + (row.target - v - row.softness * before) / (row.response + row.softness));
        gained_[i] = impulse_[i] - before;
        if (gained_[i] == 0) continue;
        push(i, gained_[i], velocities);
        change = std::max(change, std::abs(gained_[i]) * row.response);
    }
    return change;
}

/// Walls only push and lines only pull; friction is at most the coefficient times the normal impulse.
template <int D>
real Rows<D>::limited(const Row<D>& row, real impulse) const {
    if (row.limit == Limit::pushes) return std::max(0.0, impulse);
    if (row.limit == Limit::pulls) return std::min(0.0, impulse);
    if (row.limit == Limit::none) return impulse;
    const real most = row.friction * impulse_[row.normal];
    return std::clamp(impulse, -most, most);
}

/// Extrapolates along the last direction, as in conjugate gradients; velocities are recomputed from the impulses.
template <int D>
void Rows<D>::go_on(real beta, std::vector<real>& velocities) {
    velocities = free_;
    for (std::size_t i = 0; i < list_.size(); ++i) {
        impulse_[i] = limited(list_[i], impulse_[i] + beta * direction_[i]);
        if (impulse_[i] != given_[i]) push(i, impulse_[i] - given_[i], velocities);
    }
}

template <int D>
void Rows<D>::solve(std::vector<real>& velocities) {
    free_ = velocities;
    for (std::size_t i = 0; i < list_.size(); ++i)
        if (impulse_[i] != given_[i]) push(i, impulse_[i] - given_[i], velocities);
    real fastest = 0, slope = 0;
    for (const Row<D>& row : list_) fastest = std::max(fastest, speed(row, velocities));
    direction_.assign(list_.size(), 0.0), gained_.assign(list_.size(), 0.0);
    for (int count = 0; count < most_sweeps; ++count) {
        if (sweep(velocities) <= still * fastest) break;
        real gained = 0;
        for (const real g : gained_) gained += g * g;
        const real beta = slope > 0 ? gained / slope : 2;
        slope = gained;
        if (beta <= 1) go_on(beta, velocities);
        for (std::size_t i = 0; i < list_.size(); ++i) direction_[i] = (beta <= 1 ? beta * direction_[i] : 0) + gained_[i];
    }
}

template <int D>
void Rows<D>::add_impulses(std::vector<real>& impulses) const {
    constexpr std::size_t n = freedoms<D>;
    for (std::size_t i = 0; i < list_.size(); ++i)
        for (std::size_t d = 0; d < n; ++d) {
            impulses[list_[i].body * n + d] += list_[i].sees[d] * impulse_[i];
            if (list_[i].other >= 0) impulses[static_cast<std::size_t>(list_[i].other) * n + d] += list_[i].sees[n + d] * impulse_[i];
        }
}

#define WEIR_INSTANTIATE(D)                                                                                         \
    template void dry_mobility(const std::vector<Body<D>>&, Mobility&);                                             \
    template Twist<D> sees(const Body<D>&, const Vec<D>&, const Vec<D>&);                                           \
    template Row<D> row_at(const std::vector<Body<D>>&, std::size_t, std::ptrdiff_t, const Vec<D>&, const Vec<D>&); \
    template class Rows<D>;
WEIR_INSTANTIATE(2)
WEIR_INSTANTIATE(3)
#undef WEIR_INSTANTIATE

}  // namespace weir::rigid
