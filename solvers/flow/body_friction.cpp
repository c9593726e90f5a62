#include "flow/body_friction.hpp"

#include "linear/conjugate_gradients.hpp"

namespace weir::flow {

namespace {

/// The same as without bodies (helmholtz.cpp).
constexpr real tolerance = 1e-6;
constexpr int max_iterations = 2000;

/// Conductance of a wall: ρν ΔV/(θ h²) [N per m/s].
template <int D>
real conductance(const MacState<D>& s, const WallLink<D>& link) {
    return s.rho * s.nu * s.u.cell_volume() * link.nearer / (s.u.h[link.across] * s.u.h[link.across]);
}

}  // namespace

template <int D>
BodyFriction<D>::BodyFriction(const MacState<D>& s) : direction_(s.u) {
    for (int a = 0; a < D; ++a) {
        nodes_.push_back(free_faces(s.u, s.sides, a));
        homogeneous_[static_cast<std::size_t>(a)] = s.boundary[static_cast<std::size_t>(a)].homogeneous();
    }
    direction_bodies_.resize(s.no_slip_walls->bodies.size());
    for (Vector* v : {&residual_, &solution_, &image_, &diagonal_}) size(*v, s);
}

template <int D>
void BodyFriction<D>::size(Vector& v, const MacState<D>& s) const {
    for (int a = 0; a < D; ++a) v.fluid[static_cast<std::size_t>(a)] = Grid<real, D>(s.u[a].extent());
    v.bodies.resize(s.no_slip_walls->bodies.size());
}

/// ∇²q of the grid neighbours, without links across walls: their terms are added where the wall velocity is known.
template <int D>
void BodyFriction<D>::laplacian_of(const Padded<D>& q, const MacState<D>& s, int a, Grid<real, D>& out) const {
    const auto& mask = s.no_slip_walls->takes_part[static_cast<std::size_t>(a)];
    laplacian(q, s.u.h, nodes_[static_cast<std::size_t>(a)], mask, nullptr, out);
    for (const WallLink<D>& link : s.no_slip_walls->links)
        if (link.axis == a) out(link.node) -= (q(link.beyond) - q(link.node)) / (s.u.h[link.across] * s.u.h[link.across]);
}

/// Explicit part: ν∇² of the previous velocity, walls included, times ρ ΔV, stored in the image.
template <int D>
static void add_walls_of_before(const MacState<D>& s, std::array<Grid<real, D>, D>& rate) {
    const real mass = s.rho * s.u.cell_volume();
    for (std::size_t a = 0; a < D; ++a) for_each_cell(rate[a].extent(), [&](const Index<D>& I) { rate[a](I) *= s.nu * mass; });
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        const auto a = static_cast<std::size_t>(link.axis);
        const real wall = NoSlipWalls<D>::along(link.moves, s.no_slip_walls->bodies[link.body].velocity);
        rate[a](link.node) += conductance(s, link) * (wall - s.before[link.axis](link.node));
    }
}

template <int D>
void BodyFriction<D>::set_right_side(const MacState<D>& s, real dt) {
    const real mass = s.rho * s.u.cell_volume();
    for (int a = 0; a < D; ++a) {
        const auto at = static_cast<std::size_t>(a);
        laplacian_of(s.before[a], s, a, residual_.fluid[at]);
        if (s.walls)
            set_wall_rows(s, a, {.early = 0, .has_early = false, .before = 1, .implicit = 1}, dt * s.nu, s.before[a], residual_.fluid[at],
                          rows_[at]);
    }
    add_walls_of_before<D>(s, residual_.fluid);
    for (std::size_t a = 0; a < D; ++a) {
        const auto& mask = s.no_slip_walls->takes_part[a];
        auto& r = residual_.fluid[a];
        for_each_in(nodes_[a].lo, nodes_[a].hi, [&](const Index<D>& I) {
            const real changed = mass * (s.u.face[a](I) - s.before.face[a](I));
            r(I) = mask(I) * (changed + dt * r(I));
        });
    }
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b) {
        const NoSlipBody<D>& body = s.no_slip_walls->bodies[b];
        auto& r = residual_.bodies[b];
        r = body.coupled ? body.drive : rigid::Twist<D>{};
        for (std::size_t k = D; k < n && body.coupled; ++k) r[k] -= dt * body.turning * body.velocity[k];
    }
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        const real wall = NoSlipWalls<D>::along(link.moves, s.no_slip_walls->bodies[link.body].velocity);
        const real pull = dt * conductance(s, link) * (s.before[link.axis](link.node) - wall);
        for (std::size_t k = 0; k < n; ++k) residual_.bodies[link.body][k] += pull * link.moves[k];
    }
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b)
        for (std::size_t k = 0; k < n; ++k)
            if (s.no_slip_walls->bodies[b].held[k]) residual_.bodies[b][k] = 0;
}

/// image = A direction
template <int D>
void BodyFriction<D>::set_image(const MacState<D>& s, real dt) {
    const real mass = s.rho * s.u.cell_volume();
    for (int c = 0; c < D; ++c) {
        const auto at = static_cast<std::size_t>(c);
        auto& image = image_.fluid[at];
        laplacian_of(direction_[c], s, c, image);
        rows_[at].each([&](const Index<D>& I, real extra, real) { image(I) += extra * direction_[c](I); });
        for_each_in(nodes_[at].lo, nodes_[at].hi, [&](const Index<D>& I) { image(I) = mass * (direction_[c](I) - dt * s.nu * image(I)); });
    }
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b) {
        const NoSlipBody<D>& body = s.no_slip_walls->bodies[b];
        image_.bodies[b] = body.with_mass(direction_bodies_[b]);
        for (std::size_t k = D; k < n; ++k) image_.bodies[b][k] += dt * body.turning * direction_bodies_[b][k];
    }
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        const real apart = direction_[link.axis](link.node) - NoSlipWalls<D>::along(link.moves, direction_bodies_[link.body]);
        const real pull = dt * conductance(s, link) * apart;
        image_.fluid[static_cast<std::size_t>(link.axis)](link.node) += pull;
        for (std::size_t k = 0; k < n; ++k) image_.bodies[link.body][k] -= pull * link.moves[k];
    }
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b)
        for (std::size_t k = 0; k < n; ++k)
            if (s.no_slip_walls->bodies[b].held[k] || !s.no_slip_walls->bodies[b].coupled) image_.bodies[b][k] = direction_bodies_[b][k];
}

/// Inner product: the fluid's part, then the bodies', in fixed order.
template <int D>
template <class Faces>
real BodyFriction<D>::dot(const std::array<Faces, D>& fluid, const std::vector<rigid::Twist<D>>& bodies, const Vector& y) const {
    real sum = 0;
    for (std::size_t a = 0; a < D; ++a)
        sum += sum_over(y.fluid[a].extent(), [&](const Index<D>& I) { return y.fluid[a](I) * fluid[a](I); });
    for (std::size_t b = 0; b < bodies.size(); ++b)
        for (std::size_t k = 0; k < n; ++k) sum += y.bodies[b][k] * bodies[b][k];
    return sum;
}

template <int D>
void BodyFriction<D>::set_diagonal(const MacState<D>& s, real dt) {
    const real mass = s.rho * s.u.cell_volume();
    real across = 0;
    for (int b = 0; b < D; ++b) across += 2 / (s.u.h[b] * s.u.h[b]);
    for (auto& diagonal : diagonal_.fluid) diagonal.fill(mass * (1 + dt * s.nu * across));
    for (std::size_t a = 0; a < D; ++a)
        rows_[a].each([&](const Index<D>& I, real extra, real) { diagonal_.fluid[a](I) -= mass * dt * s.nu * extra; });
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b)
        for (std::size_t k = 0; k < n; ++k)
            diagonal_.bodies[b][k] = s.no_slip_walls->bodies[b].coupled ? s.no_slip_walls->bodies[b].mass[k][k] : 1;
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        const real c = dt * conductance(s, link);
        diagonal_.fluid[static_cast<std::size_t>(link.axis)](link.node) += c * (1 - 1 / link.nearer);
        for (std::size_t k = 0; k < n; ++k) diagonal_.bodies[link.body][k] += c * link.moves[k] * link.moves[k];
    }
}

/// M = 1/diagonal (Jacobi): walls very close to nodes give entries a hundred times larger.
template <int D>
struct BodyFriction<D>::System {
    static constexpr linear::Norm norm = linear::Norm::natural;
    BodyFriction& of;
    const MacState<D>& s;
    real dt;

    /// z is stored in the image.
    real precondition() {
        auto& z = of.image_;
        for (std::size_t c = 0; c < D; ++c)
            for_each_cell(z.fluid[c].extent(),
                          [&](const Index<D>& I) { z.fluid[c](I) = of.residual_.fluid[c](I) / of.diagonal_.fluid[c](I); });
        for (std::size_t b = 0; b < z.bodies.size(); ++b)
            for (std::size_t k = 0; k < n; ++k) z.bodies[b][k] = of.residual_.bodies[b][k] / of.diagonal_.bodies[b][k];
        return of.dot(of.residual_.fluid, of.residual_.bodies, z);
    }
    void update_direction(real beta) {
        const auto& z = of.image_;
        for (std::size_t c = 0; c < D; ++c) {
            auto& d = of.direction_.face[c];
            for_each_in(of.nodes_[c].lo, of.nodes_[c].hi, [&](const Index<D>& I) { d(I) = z.fluid[c](I) + (beta == 0 ? 0 : beta * d(I)); });
            fill_ghosts(d, of.homogeneous_[c], 1);
        }
        auto& d = of.direction_bodies_;
        for (std::size_t b = 0; b < d.size(); ++b)
            for (std::size_t k = 0; k < n; ++k) d[b][k] = z.bodies[b][k] + (beta == 0 ? 0 : beta * d[b][k]);
    }
    real multiply() {
        of.set_image(s, dt);
        return of.dot(of.direction_.face, of.direction_bodies_, of.image_);
    }
    void advance(real alpha) {
        for (std::size_t c = 0; c < D; ++c)
            for_each_in(of.nodes_[c].lo, of.nodes_[c].hi, [&](const Index<D>& I) {
                of.solution_.fluid[c](I) += alpha * of.direction_.face[c](I);
                of.residual_.fluid[c](I) -= alpha * of.image_.fluid[c](I);
            });
        for (std::size_t b = 0; b < of.direction_bodies_.size(); ++b)
            for (std::size_t k = 0; k < n; ++k) {
                of.solution_.bodies[b][k] += alpha * of.direction_bodies_[b][k];
                of.residual_.bodies[b][k] -= alpha * of.image_.bodies[b][k];
            }
    }
};

template <int D>
void BodyFriction<D>::solve(MacState<D>& s, real dt) {
    set_right_side(s, dt);
    set_diagonal(s, dt);
    for (auto& q : solution_.fluid) q.fill(0);
    for (auto& q : solution_.bodies) q = {};
    System system{*this, s, dt};
    iterations_ = 0;
    linear::StopTest stop(tolerance, max_iterations, iterations_);
    linear::require_converged("velocity", "viscous solve with bodies", linear::conjugate_gradients(system, stop), stop);
    finish(s, dt);
}

/// Updates u and the friction impulses of the bodies: equal and opposite to the fluid's.
template <int D>
void BodyFriction<D>::finish(MacState<D>& s, real dt) {
    for (std::size_t b = 0; b < s.no_slip_walls->bodies.size(); ++b) {
        NoSlipBody<D>& body = s.no_slip_walls->bodies[b];
        body.impulse = {};
        for (std::size_t k = D; k < n && body.coupled; ++k)
            body.impulse[k] = -dt * body.turning * (body.velocity[k] + solution_.bodies[b][k]);
    }
    for (const WallLink<D>& link : s.no_slip_walls->links) {
        NoSlipBody<D>& body = s.no_slip_walls->bodies[link.body];
        const real before = s.before[link.axis](link.node) - NoSlipWalls<D>::along(link.moves, body.velocity);
        const real change = solution_.fluid[static_cast<std::size_t>(link.axis)](link.node) -
                            NoSlipWalls<D>::along(link.moves, solution_.bodies[link.body]);
        const real pull = dt * conductance(s, link) * (before + change);
        for (std::size_t k = 0; k < n; ++k) body.impulse[k] += pull * link.moves[k];
    }
    for (std::size_t a = 0; a < D; ++a) {
        const auto& mask = s.no_slip_walls->takes_part[a];
        for_each_in(nodes_[a].lo, nodes_[a].hi, [&](const Index<D>& I) {
            if (mask(I) != 0) s.u.face[a](I) = s.before.face[a](I) + solution_.fluid[a](I);
        });
    }
}

template <int D>
void BodyFriction<D>::carry(MacState<D>& s) const {
    for (const InsideFace<D>& f : s.no_slip_walls->inside) {
        rigid::Twist<D> velocity = s.no_slip_walls->bodies[f.body].velocity;
        for (std::size_t k = 0; k < n; ++k) velocity[k] += solution_.bodies[f.body][k];
        s.u[f.axis](f.face) = NoSlipWalls<D>::along(f.moves, velocity);
    }
}

template <int D>
std::size_t BodyFriction<D>::bytes() const {
    std::size_t nodes = 0;
    for (const auto& q : residual_.fluid) nodes += 4 * q.size();
    for (const auto& q : direction_.face) nodes += q.bytes() / sizeof(real);
    std::size_t rows = 0;
    for (const auto& of_axis : rows_) rows += of_axis.bytes();
    return rows + nodes * sizeof(real) + 5 * direction_bodies_.size() * sizeof(rigid::Twist<D>);
}

template class BodyFriction<2>;
template class BodyFriction<3>;

}  // namespace weir::flow
