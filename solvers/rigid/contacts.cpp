#include "rigid/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace weir::rigid {

namespace {

/// Position correction: a fifth of the overlap per step, beyond a tolerance of a thousandth of the body (Catto 2005).
constexpr real push_apart = 0.2, slop = 1e-3;

/// Contact points of a pair belong together if their gaps differ by less than this part of the body.
constexpr real as_deep = 0.02;

/// A unit tangent of a normal.
Vec<2> tangent(const Vec<2>& n, int) { return {{-n[1], n[0]}}; }
Vec<3> tangent(const Vec<3>& n, int k) { return both_across(n)[static_cast<std::size_t>(k)]; }

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

template <int D>
void Contacts<D>::against(std::size_t body, std::ptrdiff_t other, const Vec<D>& at, const Vec<D>& normal, const Vec<D>& moves, real gap,
                          const std::vector<Body<D>>& bodies) {
    Contact c;
    c.body = body, c.other = other, c.at = at, c.normal = normal, c.moves = moves, c.gap = gap;
    const Body<D>& b = bodies[body];
    c.friction = b.friction, c.restitution = b.restitution;
    if (other >= 0) {  // the geometric mean of friction, the larger restitution
        const Body<D>& o = bodies[static_cast<std::size_t>(other)];
        c.friction = std::sqrt(b.friction * o.friction);
        c.restitution = std::max(b.restitution, o.restitution);
    }
    list_.push_back(c);
}

/// Selects the supporting contacts of one pair, listed from `first` on: the deepest, and of those about as deep the ones farthest from the
/// contacts already selected.
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
            for (const ContactSphere<D>& sphere : bodies[b].contact_spheres) {
                const Vec<D> x = pose.to_world(sphere.at);
                const real gap = (end == 0 ? x[a] - around.min[a] : around.max[a] - x[a]) - sphere.radius;
                if (gap <= around.reach) against(b, -1, x - sphere.radius * n, n, {}, gap, bodies);
            }
            reduce(first, bodies);
        }
}

/// Contact spheres of one body against the signed distance of a solid, which may be another body.
template <int D>
void Contacts<D>::touch_solid(const std::vector<Body<D>>& bodies, std::size_t b, std::size_t solid, const Surroundings<D>& around) {
    const geometry::Solids<D>& solids = *around.solids;
    const geometry::Pose<D> pose = bodies[b].pose();
    const std::ptrdiff_t other = solid < around.prescribed ? -1 : static_cast<std::ptrdiff_t>(solid - around.prescribed);
    for (const ContactSphere<D>& sphere : bodies[b].contact_spheres) {
        const Vec<D> x = pose.to_world(sphere.at);
        const real gap = solids.distance(solid, x) - sphere.radius;
        if (gap > around.reach) continue;
        const Vec<D> n = gradient<D>(solids, solid, x, 1e-4 * bodies[b].radius), at = x - sphere.radius * n;
        against(b, other, at, n, other < 0 ? solids.pose(solid).velocity_at(at) : Vec<D>{}, gap, bodies);
    }
}

template <int D>
void Contacts<D>::find(const std::vector<Body<D>>& bodies, const Surroundings<D>& around) {
    list_.clear(), rows_.clear(), carried_ = false;
    joints_ = around.joints && !around.joints->empty() ? around.joints : nullptr;
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
            if (joints_ && joints_->tie(b, o)) continue;
            const std::size_t first = list_.size();
            touch_solid(bodies, b, around.prescribed + o, around);
            touch_solid(bodies, o, around.prescribed + b, around);
            reduce(first, bodies);
        }
    }
}

template <int D>
void Contacts<D>::make_rows(const std::vector<Body<D>>& bodies, real dt) {
    made_.clear();
    for (const Contact& c : list_)
        for (int k = 0; k < D; ++k) {
            made_.push_back(row_at<D>(bodies, c.body, c.other, c.at, k == 0 ? c.normal : tangent(c.normal, k - 1)));
            Row<D>& row = made_.back();
            row.moves = c.moves, row.friction = c.friction;
            row.limit = k == 0 ? Limit::pushes : Limit::rubs;
            row.normal = made_.size() - 1 - static_cast<std::size_t>(k);
        }
    if (joints_) joints_->add_rows(bodies, dt, made_);
}

template <int D>
void Contacts<D>::resolve(std::vector<Body<D>>& bodies, const Mobility& mobility, std::vector<real>& velocities, real dt, real gravity) {
    make_rows(bodies, dt);
    rows_.set(made_, mobility);
    for (std::size_t i = 0; i < list_.size(); ++i) {
        Contact& c = list_[i];
        Row<D>& row = rows_.list()[i * D];
        const real approach = rows_.relative(row, velocities);
        // an approach slower than two steps of free fall counts as rest, without a bounce
        const bool known = c.bounces && carried_;
        c.bounces = c.bounces || (c.restitution > 0 && approach * dt < -std::max(c.gap, 0.0) && approach < -2 * gravity * dt);
        if (!known) c.rebound = -c.restitution * approach;
        const real over = -c.gap - slop * bodies[c.body].radius;
        row.target = c.bounces ? c.rebound : c.gap > 0 ? -c.gap / dt : over > 0 ? push_apart * over / dt : 0;
    }
    rows_.solve(velocities);
    for (std::size_t i = 0; i < rows_.list().size(); ++i) {
        const Row<D>& row = rows_.list()[i];
        if (rows_.impulses()[i] == 0 || row.limit == Limit::rubs) continue;
        bodies[row.body].touches = true;
        if (row.other >= 0) bodies[static_cast<std::size_t>(row.other)].touches = true;
    }
}

template <int D>
void Contacts<D>::mark(std::vector<Body<D>>& bodies) const {
    for (const Contact& c : list_) {
        bodies[c.body].touches = true;
        if (c.other >= 0) bodies[static_cast<std::size_t>(c.other)].touches = true;
    }
    if (joints_) joints_->mark(bodies);
}

template class Contacts<2>;
template class Contacts<3>;

}  // namespace weir::rigid
