#include "rigid/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Sweeps over all contacts end when no impulse changes a velocity by more than this part of the largest one, or here.
constexpr int most_sweeps = 400;
constexpr real still = 1e-10;

/// What overlaps is pushed apart at a fifth of the overlap a step, beyond a slop of a thousandth of the body (Catto 2005).
constexpr real push_apart = 0.2, slop = 1e-3;

/// Points of a pair whose gaps differ by less than this part of the body are taken to touch together.
constexpr real as_deep = 0.02;

/// Directions across a normal.
Vec<2> tangent(const Vec<2>& n, int) { return {{-n[1], n[0]}}; }
Vec<3> tangent(const Vec<3>& n, int k) {
    const int a = std::abs(n[0]) < 0.6 ? 0 : 1;
    Vec<3> u = Vec<3>::unit(a) - n[a] * n;
    u = u / norm(u);
    return k == 0 ? u : Vec<3>{{n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]}};
}

/// How a body's rigid velocity moves its point, along a direction.
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
Vec<D> gradient(const geometry::Solids<D>& solids, std::size_t solid, const Vec<D>& x, real eps) {
    Vec<D> n;
    for (int a = 0; a < D; ++a) {
        const Vec<D> step = eps * Vec<D>::unit(a);
        n[a] = solids.distance(solid, x + step) - solids.distance(solid, x - step);
    }
    const real length = norm(n);
    return length > 0 ? n / length : Vec<D>::unit(1);
}

}  // namespace

/// By Cholesky's factors, column by column of the identity.
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

template <int D>
void Contacts<D>::against(std::size_t body, std::ptrdiff_t other, const Vec<D>& at, const Vec<D>& normal, const Vec<D>& moves, real gap,
                          const std::vector<Body<D>>& bodies) {
    Contact c;
    c.body = body, c.other = other, c.at = at, c.normal = normal, c.moves = moves, c.gap = gap;
    const Body<D>& b = bodies[body];
    c.friction = b.friction, c.restitution = b.restitution;
    if (other >= 0) {  // the geometric mean, and the livelier of the two
        const Body<D>& o = bodies[static_cast<std::size_t>(other)];
        c.friction = std::sqrt(b.friction * o.friction);
        c.restitution = std::max(b.restitution, o.restitution);
    }
    list_.push_back(c);
}

/// Of the contacts of one pair, listed from `first` on, those that hold it: the deepest, and of the others that are about as deep the ones
/// furthest from those that are kept already.
template <int D>
void Contacts<D>::reduce(std::size_t first, const std::vector<Body<D>>& bodies) {
    constexpr std::size_t most = D == 2 ? 2 : 4;
    if (list_.size() <= first + 1) return;
    const auto begin = list_.begin() + static_cast<std::ptrdiff_t>(first);
    std::iter_swap(begin, std::min_element(begin, list_.end(), [](const Contact& a, const Contact& b) { return a.gap < b.gap; }));
    const real about = list_[first].gap + as_deep * bodies[list_[first].body].radius;
    list_.erase(std::remove_if(begin + 1, list_.end(), [&](const Contact& c) { return c.gap > about; }), list_.end());
    for (std::size_t kept = 1; kept < most && first + kept < list_.size(); ++kept) {
        real furthest = -1;
        std::size_t which = first + kept;
        for (std::size_t i = first + kept; i < list_.size(); ++i) {
            real near = infinity;
            for (std::size_t k = first; k < first + kept; ++k) near = std::min(near, norm(list_[i].at - list_[k].at));
            if (near > furthest) furthest = near, which = i;
        }
        std::swap(list_[first + kept], list_[which]);
    }
    if (list_.size() > first + most) list_.resize(first + most);
}

template <int D>
void Contacts<D>::touch_walls(const std::vector<Body<D>>& bodies, std::size_t b, const Surroundings<D>& around) {
    const geometry::Pose<D> pose = bodies[b].pose();
    for (int a = 0; a < D; ++a)
        for (const int end : {0, 1}) {
            if (!around.wall[static_cast<std::size_t>(2 * a + end)]) continue;
            const real away = end == 0 ? bodies[b].at[a] - around.min[a] : around.max[a] - bodies[b].at[a];
            if (away > bodies[b].radius + around.reach) continue;
            const Vec<D> n = (end == 0 ? 1.0 : -1.0) * Vec<D>::unit(a);
            const std::size_t first = list_.size();
            for (const Feeler<D>& feeler : bodies[b].feelers) {
                const Vec<D> x = pose.to_world(feeler.at);
                const real gap = (end == 0 ? x[a] - around.min[a] : around.max[a] - x[a]) - feeler.radius;
                if (gap <= around.reach) against(b, -1, x - feeler.radius * n, n, {}, gap, bodies);
            }
            reduce(first, bodies);
        }
}

/// Balls of one body against the distance of a solid, which may be another body.
template <int D>
void Contacts<D>::touch_solid(const std::vector<Body<D>>& bodies, std::size_t b, std::size_t solid, const Surroundings<D>& around) {
    const geometry::Solids<D>& solids = *around.solids;
    const geometry::Pose<D> pose = bodies[b].pose();
    const std::ptrdiff_t other = solid < around.prescribed ? -1 : static_cast<std::ptrdiff_t>(solid - around.prescribed);
    for (const Feeler<D>& feeler : bodies[b].feelers) {
        const Vec<D> x = pose.to_world(feeler.at);
        const real gap = solids.distance(solid, x) - feeler.radius;
        if (gap > around.reach) continue;
        const Vec<D> n = gradient<D>(solids, solid, x, 1e-4 * bodies[b].radius), at = x - feeler.radius * n;
        against(b, other, at, n, other < 0 ? solids.pose(solid).velocity_at(at) : Vec<D>{}, gap, bodies);
    }
}

template <int D>
void Contacts<D>::find(const std::vector<Body<D>>& bodies, const Surroundings<D>& around) {
    list_.clear();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        touch_walls(bodies, b, around);
        for (std::size_t s = 0; s < around.prescribed; ++s) {
            const std::size_t first = list_.size();
            if (around.solids->distance(s, bodies[b].at) > bodies[b].radius + around.reach) continue;
            touch_solid(bodies, b, s, around);
            reduce(first, bodies);
        }
        for (std::size_t o = 0; o < b; ++o) {
            if (norm(bodies[b].at - bodies[o].at) > bodies[b].radius + bodies[o].radius + around.reach) continue;
            const std::size_t first = list_.size();
            touch_solid(bodies, b, around.prescribed + o, around);
            touch_solid(bodies, o, around.prescribed + b, around);
            reduce(first, bodies);
        }
    }
}

template <int D>
void Contacts<D>::build_rows(const std::vector<Body<D>>& bodies, const Mobility& mobility) {
    constexpr std::size_t n = freedoms<D>;
    size_ = mobility.size;
    rows_.assign(list_.size() * D, {});
    responses_.assign(rows_.size() * size_, 0.0);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Contact& c = list_[i / D];
        const int k = static_cast<int>(i % D);
        const Vec<D> along = k == 0 ? c.normal : tangent(c.normal, k - 1);
        Row& row = rows_[i];
        const Twist<D> own = sees<D>(bodies[c.body], c.at, along);
        std::copy(own.begin(), own.end(), row.sees.begin());
        if (c.other >= 0) {
            const Twist<D> back = sees<D>(bodies[static_cast<std::size_t>(c.other)], c.at, along);
            for (std::size_t d = 0; d < n; ++d) row.sees[n + d] = -back[d];
        }
        real* response = responses_.data() + i * size_;
        for (std::size_t d = 0; d < n; ++d)
            for (std::size_t v = 0; v < size_; ++v) {
                response[v] += mobility(v, c.body * n + d) * row.sees[d];
                if (c.other >= 0) response[v] += mobility(v, static_cast<std::size_t>(c.other) * n + d) * row.sees[n + d];
            }
        for (std::size_t d = 0; d < n; ++d) {
            row.response += row.sees[d] * response[c.body * n + d];
            if (c.other >= 0) row.response += row.sees[n + d] * response[static_cast<std::size_t>(c.other) * n + d];
        }
    }
}

/// Of the body's point past the other side, along the row's direction.
template <int D>
real Contacts<D>::relative(const Contact& c, const Row& row, const std::vector<real>& velocities) const {
    constexpr std::size_t n = freedoms<D>;
    real v = 0;
    for (std::size_t d = 0; d < n; ++d) {
        v += row.sees[d] * velocities[c.body * n + d];
        if (c.other >= 0) v += row.sees[n + d] * velocities[static_cast<std::size_t>(c.other) * n + d];
    }
    for (int a = 0; a < D; ++a) v -= row.sees[static_cast<std::size_t>(a)] * c.moves[a];
    return v;
}

template <int D>
void Contacts<D>::push(std::size_t row, real impulse, std::vector<real>& velocities) const {
    const real* response = responses_.data() + row * size_;
    for (std::size_t v = 0; v < size_; ++v) velocities[v] += impulse * response[v];
}

/// One sweep of Gauss-Seidel; gained_ is what it added to each impulse. Answers the largest change of a contact's velocity.
template <int D>
real Contacts<D>::sweep(std::vector<real>& velocities) {
    real change = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Contact& c = list_[i / D];
        const std::size_t k = i % D;
        const Row& row = rows_[i];
        gained_[i] = 0;
        if (!(row.response > 0)) continue;
        const real before = c.impulse[k], v = relative(c, row, velocities);
        c.impulse[k] = k == 0 ? before + (c.target - v) / row.response : before - v / row.response;
        limit(c, k);
        gained_[i] = c.impulse[k] - before;
        if (gained_[i] == 0) continue;
        push(i, gained_[i], velocities);
        change = std::max(change, std::abs(gained_[i]) * row.response);
    }
    return change;
}

/// No wall pulls; friction is at most the coefficient times what presses.
template <int D>
void Contacts<D>::limit(Contact& c, std::size_t k) {
    const real most = c.friction * c.impulse[0];
    c.impulse[k] = k == 0 ? std::max(0.0, c.impulse[0]) : std::clamp(c.impulse[k], -most, most);
}

/// Further along the last direction, as conjugate gradients do; the velocities follow from the impulses anew.
template <int D>
void Contacts<D>::go_on(real beta, std::vector<real>& velocities) {
    velocities = free_;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        Contact& c = list_[i / D];
        c.impulse[i % D] += beta * direction_[i];
        limit(c, i % D);
        if (c.impulse[i % D] != 0) push(i, c.impulse[i % D], velocities);
    }
}

template <int D>
void Contacts<D>::resolve(std::vector<Body<D>>& bodies, const Mobility& mobility, std::vector<real>& velocities, real dt, real gravity) {
    build_rows(bodies, mobility);
    for (std::size_t i = 0; i < list_.size(); ++i) {
        Contact& c = list_[i];
        const real approach = relative(c, rows_[i * D], velocities);
        // What falls from less than a step's fall is at rest, not bouncing.
        c.bounces = c.bounces || (c.restitution > 0 && approach * dt < -std::max(c.gap, 0.0) && approach < -2 * gravity * dt);
        const real over = -c.gap - slop * bodies[c.body].radius;
        c.target = c.bounces ? -c.restitution * approach : c.gap > 0 ? -c.gap / dt : over > 0 ? push_apart * over / dt : 0;
    }
    free_ = velocities;
    for (std::size_t i = 0; i < rows_.size(); ++i)
        if (const real known = list_[i / D].impulse[i % D]; known != 0) push(i, known, velocities);
    real fastest = 0, slope = 0;
    for (const real v : velocities) fastest = std::max(fastest, std::abs(v));
    direction_.assign(rows_.size(), 0.0), gained_.assign(rows_.size(), 0.0);
    for (int count = 0; count < most_sweeps; ++count) {
        if (sweep(velocities) <= still * fastest) break;
        real gained = 0;
        for (const real g : gained_) gained += g * g;
        const real beta = slope > 0 ? gained / slope : 2;
        slope = gained;
        if (beta <= 1) go_on(beta, velocities);
        for (std::size_t i = 0; i < rows_.size(); ++i) direction_[i] = (beta <= 1 ? beta * direction_[i] : 0) + gained_[i];
    }
    for (const Contact& c : list_)
        if (c.impulse[0] > 0) {
            bodies[c.body].touches = true;
            if (c.other >= 0) bodies[static_cast<std::size_t>(c.other)].touches = true;
        }
}

template <int D>
void Contacts<D>::mark(std::vector<Body<D>>& bodies) const {
    for (const Contact& c : list_) {
        bodies[c.body].touches = true;
        if (c.other >= 0) bodies[static_cast<std::size_t>(c.other)].touches = true;
    }
}

template void dry_mobility(const std::vector<Body<2>>&, Mobility&);
template void dry_mobility(const std::vector<Body<3>>&, Mobility&);
template class Contacts<2>;
template class Contacts<3>;

}  // namespace weir::rigid
