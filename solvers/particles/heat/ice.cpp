#include "particles/heat/ice.hpp"

#include <algorithm>

namespace weir::particles {

namespace {

/// Distance, in spacings of the liquid, within which two frozen particles are bonded. It includes the nearest neighbours of any lattice,
/// also of a wider one (1.044 spacings in 2D, of ice), and those of liquid that froze in place, but not the next ones, at 1.48.
constexpr real reach_in_spacings = 1.3;
/// The same for a wall: half a spacing of the solid, plus the same margin.
constexpr real wall_reach_in_spacings = 1.05;
/// Sweeps over walls and solids; the remaining depth is corrected in the particles' positions alone.
constexpr int contact_sweeps = 8;
constexpr real contact_tolerance = 1e-6;  // relative to a spacing
/// A moment of inertia below this part of the largest belongs to collinear points, which have no rotation about that axis.
constexpr real thin = 1e-9;

}  // namespace

template <int D>
Ice<D>::Ice(const Heat<D>& heat, const Domain<D>& domain)
    : heat_(heat), domain_(domain), reach_(reach_in_spacings * domain.spacing), wall_reach_(wall_reach_in_spacings * domain.spacing) {
    for (int a = 0; a < D; ++a) cells_[a] = std::max(1, static_cast<int>((domain.hi[a] - domain.lo[a]) / reach_));
    start_.resize(product(cells_) + 1);
}

template <int D>
void Ice<D>::find(Fluid<D>& fluid) {
    mass_ = fluid.mass;
    resting_ = false;
    list_frozen(fluid);
    join_neighbours(fluid);
    gather_pieces(fluid);
    move_as_one(fluid);
}

template <int D>
void Ice<D>::move_as_one(Fluid<D>& fluid) {
    for (Piece& piece : pieces_) {
        weigh(fluid, piece);
        set_velocities(fluid, piece);
    }
}

/// Momentum of points, and the rigid velocity with the same momentum.
template <int D>
void Ice<D>::weigh(const Fluid<D>& fluid, Piece& piece) {
    const real n = piece.count();
    const auto means = sums<2 * D>(piece, [&](std::size_t m, std::array<real, 2 * D>& sum) {
        const Vec<D> x = fluid.position(members_[m]) - domain_.lo, v = fluid.velocity(members_[m]);
        for (std::size_t a = 0; a < D; ++a) sum[a] += x[static_cast<int>(a)], sum[D + a] += v[static_cast<int>(a)];
    });
    rigid::Body<D>& body = piece.body;
    Vec<D> centre, velocity;
    for (int a = 0; a < D; ++a) {
        const auto k = static_cast<std::size_t>(a);
        centre[a] = domain_.lo[a] + means[k] / n, velocity[a] = piece.fixed ? 0 : means[D + k] / n;
        body.velocity[k] = velocity[a];
    }
    const auto second = sums<D * D + 3>(piece, [&](std::size_t m, std::array<real, D * D + 3>& sum) {
        const Vec<D> r = rest_[m] = fluid.position(members_[m]) - centre;
        const Vec<3> l = cross(r, fluid.velocity(members_[m]) - velocity);
        for (std::size_t a = 0; a < D; ++a)
            for (std::size_t b = 0; b < D; ++b) sum[D * a + b] += r[static_cast<int>(a)] * r[static_cast<int>(b)];
        for (std::size_t a = 0; a < 3; ++a) sum[D * D + a] += l[static_cast<int>(a)];
    });
    body.moments.volume = mass_ * n;
    body.moments.centre = centre;
    for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = 0; b < D; ++b) body.moments.second[a][static_cast<int>(b)] = mass_ * second[D * a + b];
    body.weigh(mass_ * n, centre);
    const real largest = std::max({body.principal[0], body.principal[1], body.principal[2]});
    for (real& moment : body.principal)
        if (moment <= thin * largest) moment = 0;
    body.orientation = D == 2 ? rigid::Orientation{} : rigid::Orientation{1, 0, 0, 0};
    for (std::size_t a = 0; a < 3; ++a) piece.spin_momentum[static_cast<int>(a)] = piece.fixed ? 0 : mass_ * second[D * D + a];
    const Vec<3> spin = turning(body, piece.spin_momentum);
    for (std::size_t k = D; k < body.velocity.size(); ++k) body.velocity[k] = spin[D == 2 ? 2 : static_cast<int>(k - D)];
    piece.impulse = {};
}

/// The angular velocity for an angular momentum.
template <int D>
Vec<3> Ice<D>::turning(const rigid::Body<D>& body, const Vec<3>& momentum) {
    if constexpr (D == 2) {
        return {{0, 0, body.principal[2] > 0 ? momentum[2] / body.principal[2] : 0}};
    } else {
        const auto rows = rigid::rotation<3>(body.orientation);
        Vec<3> spin{};
        for (int k = 0; k < 3; ++k) {
            if (body.principal[k] == 0) continue;
            const Vec<3> axis = times(rows, body.axes[static_cast<std::size_t>(k)]);
            spin += dot(axis, momentum) / body.principal[k] * axis;
        }
        return spin;
    }
}

template <int D>
void Ice<D>::set_velocities(Fluid<D>& fluid, const Piece& piece) const {
    const auto pose = piece.body.pose();
    parallel_for(piece.begin, piece.end, [&](int m) {
        const int i = members_[static_cast<std::size_t>(m)];
        Fluid<D>::put(fluid.v, i, piece.fixed ? Vec<D>{} : pose.velocity_at(fluid.position(i)));
    });
}

template <int D>
void Ice<D>::advance_free(real dt) {
    resting_ = dt == 0;
    for (Piece& piece : pieces_) {
        if (resting_ || piece.fixed) continue;
        piece.body.touches = true;  // moves with its velocity, which already includes gravity
        piece.body.advance_free(dt, {});
        keep_in(piece);
    }
}

template <int D>
void Ice<D>::push(Piece& piece, const std::array<real, D + 3>& moves) {
    std::array<real, D + 3> impulse;
    for (std::size_t k = 0; k < D + 3; ++k) impulse[k] = k < D ? moves[k] / piece.count() : mass_ * moves[k];
    move(piece, impulse);
    keep_in(piece);
}

/// Displacement by impulses times time: translation by the first ones, rotation by the others over the inertia.
template <int D>
void Ice<D>::move(Piece& piece, const std::array<real, D + 3>& impulse) {
    Vec<3> momentum;
    for (int a = 0; a < 3; ++a) momentum[a] = impulse[static_cast<std::size_t>(D + a)];
    const Vec<3> turn = turning(piece.body, momentum);
    rigid::Twist<D> by;
    for (std::size_t k = 0; k < by.size(); ++k) by[k] = k < D ? impulse[k] : turn[D == 2 ? 2 : static_cast<int>(k - D)];
    piece.body.shift(by);
    for (std::size_t k = 0; k < D + 3; ++k) piece.impulse[k] += impulse[k];
}

/// Moves a piece out of walls and solids by position-based contacts (Müller et al. 2020, "Detailed rigid body simulation").
template <int D>
void Ice<D>::keep_in(Piece& piece) {
    for (int sweep = 0; sweep < contact_sweeps; ++sweep) {
        real deepest = 0;
        for (int a = 0; a < D; ++a)
            for (int end = 0; end < 2; ++end)
                if (domain_.walled(a, end)) deepest = std::max(deepest, leave(piece, a, end));
        if (!domain_.solids.empty()) deepest = std::max(deepest, leave_solids(piece));
        if (deepest <= contact_tolerance * domain_.spacing) break;
    }
}

/// A wall acts at the centroid of the particles behind it, by their mean depth, both weighted by depth: a face resting on a wall stays
/// there. Returns the largest depth.
template <int D>
real Ice<D>::leave(Piece& piece, int axis, int end) {
    const real wall = end ? domain_.keep_hi[axis] : domain_.keep_lo[axis], sign = end ? -1 : 1;
    const auto turned = rigid::rotation<D>(piece.body.orientation);
    Vec<D> arm{};
    real all = 0, squares = 0, deepest = 0;
    for (int m = piece.begin; m < piece.end; ++m) {
        const Vec<D> r = times(turned, rest_[static_cast<std::size_t>(m)]);
        const real depth = sign * (wall - piece.body.at[axis] - r[axis]);
        if (!(depth > 0)) continue;
        all += depth, squares += depth * depth, arm += depth * r, deepest = std::max(deepest, depth);
    }
    if (all == 0) return 0;
    const Vec<D> normal = sign * Vec<D>::unit(axis);
    const Vec<3> lever = cross(arm / all, normal);
    const real impulse = squares / all / (1 / piece.body.mass + dot(lever, turning(piece.body, lever)));
    std::array<real, D + 3> by{};
    by[static_cast<std::size_t>(axis)] = impulse * normal[axis] / piece.body.mass;
    for (std::size_t a = 0; a < 3; ++a) by[D + a] = impulse * lever[static_cast<int>(a)];
    move(piece, by);
    return deepest;
}

/// Corrects the deepest particle in a solid.
template <int D>
real Ice<D>::leave_solids(Piece& piece) {
    const auto turned = rigid::rotation<D>(piece.body.orientation);
    Vec<D> arm{};
    real deepest = 0;
    for (int m = piece.begin; m < piece.end; ++m) {
        const Vec<D> r = times(turned, rest_[static_cast<std::size_t>(m)]);
        const real depth = domain_.margin - domain_.solids.distance(piece.body.at + r);
        if (depth > deepest) deepest = depth, arm = r;
    }
    if (deepest == 0) return 0;
    const Vec<D> normal = domain_.solids.normal(piece.body.at + arm, 1e-3 * domain_.spacing);
    const Vec<3> lever = cross(arm, normal);
    const real impulse = deepest / (1 / piece.body.mass + dot(lever, turning(piece.body, lever)));
    std::array<real, D + 3> by{};
    for (std::size_t a = 0; a < D; ++a) by[a] = impulse * normal[static_cast<int>(a)] / piece.body.mass;
    for (std::size_t a = 0; a < 3; ++a) by[D + a] = impulse * lever[static_cast<int>(a)];
    move(piece, by);
    return deepest;
}

template <int D>
void Ice<D>::finish_motion(Fluid<D>& fluid, real dt) {
    each_place([&](int i, const Vec<D>& place) {
        Vec<D> x = place;
        for (int a = 0; a < D; ++a) x[a] = std::min(std::max(x[a], domain_.keep_lo[a]), domain_.keep_hi[a]);
        Fluid<D>::put(fluid.x, i, x);
    });
    for (Piece& piece : pieces_) {
        if (resting_ || piece.fixed) continue;
        Vec<3> momentum;
        for (int a = 0; a < 3; ++a) momentum[a] = piece.spin_momentum[a] + piece.impulse[static_cast<std::size_t>(D + a)] / dt;
        const Vec<3> spin = turning(piece.body, momentum);
        auto& velocity = piece.body.velocity;
        for (std::size_t k = 0; k < velocity.size(); ++k) {
            if (k < D)
                velocity[k] += piece.impulse[k] / dt;
            else
                velocity[k] = spin[D == 2 ? 2 : static_cast<int>(k - D)];
        }
        set_velocities(fluid, piece);
    }
}

template <int D>
std::size_t Ice<D>::bytes() const {
    return pieces_.capacity() * sizeof(Piece) + rest_.capacity() * sizeof(Vec<D>) + sums_.capacity() * sizeof(real) +
           (members_.capacity() + piece_of_.capacity() + frozen_.capacity() + parent_.capacity() + start_.capacity() + sorted_.capacity() +
            cell_.capacity()) *
               sizeof(int);
}

template class Ice<2>;
template class Ice<3>;

}  // namespace weir::particles
