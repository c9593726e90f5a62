// The impulses between one particle and one body: the added mass along and across the normal, in closed form.
#include "particles/boundaries/bodies_in_liquid.hpp"
#include "pbf/solver.hpp"
#include "support.hpp"

#include <cmath>

namespace impulses_in_particles_tests {

using namespace weir;
using namespace weir::test;

namespace {

constexpr real radius = 0.2;

/// A ball in the middle of a closed box, far from all walls, and some liquid in a corner.
template <int D>
scene::Scene ball_scene() {
    return scene::parse(
        fmt::format("solver = \"pbf\"\ndim = {}\ngrid = {{ cells = [{}], size = [{}] }}\ntime.end = 1.0\nfluid.density = 1000.0\n"
                    "liquid = [ {{ shape = \"box\", min = [{}], max = [{}] }} ]\n"
                    "bodies = [ {{ shape = \"sphere\", centre = [{}], radius = {}, density = 300.0 }} ]\n",
                    D, D == 2 ? "20, 20" : "20, 20, 20", D == 2 ? "1.0, 1.0" : "1.0, 1.0, 1.0", D == 2 ? "0, 0" : "0, 0, 0",
                    D == 2 ? "0.1, 0.1" : "0.1, 0.1, 0.1", D == 2 ? "0.5, 0.5" : "0.5, 0.5, 0.5", radius),
        "test.toml", {pbf::kind().schema});
}

/// A ball at rest that one particle touches, in the direction `normal` from its centre.
template <int D>
struct Exchange {
    scene::Scene scene = ball_scene<D>();
    particles::Fluid<D> fluid{scene};
    particles::BodiesInLiquid<D> carried{fluid};
    const rigid::Body<D>& body = carried.bodies()[0];
    Vec<D> normal{}, tangent{};
    particles::Meeting<D> meeting;

    Exchange() {
        if constexpr (D == 2)
            normal = {{0.6, 0.8}}, tangent = {{-0.8, 0.6}};
        else
            normal = {{0.48, 0.6, 0.64}}, tangent = {{0.8, 0.0, -0.6}};
        meeting.particle = 0, meeting.body = 0, meeting.at = body.at + radius * normal;
        meeting.pull = 7.0 * normal;  // [1/m], as of a kernel
    }
    /// The body gives the particle this velocity; returns what the particle has been given in all.
    Vec<D> give(const Vec<D>& velocity) {
        carried.begin(fluid.domain, 0, 1e-3);
        meeting.given = velocity;
        carried.meetings().assign(1, meeting);
        carried.exchange(fluid.domain, 1e-3, false);
        return carried.meetings()[0].given;
    }
    Vec<D> velocity() const {
        Vec<D> u;
        for (int a = 0; a < D; ++a) u[a] = body.velocity[static_cast<std::size_t>(a)];
        return u;
    }
    /// 1/M + R^2/I: what a unit impulse along the surface changes the velocity of the point of contact by.
    real response_across() const { return 1 / body.mass + radius * radius / body.principal[2]; }
};

}  // namespace

// The body's velocity V solves (M + K) dV = P. Along the normal n through the centre of mass there is no torque, and only the stiffness
// acts: the particle gets stiff |pull|^2 (n.dV) n back. K = m stiff |pull|^2, whatever the friction, which acts across n only.
// Doubles, in a system of 3 or 6 unknowns whose entries lie within a factor of a thousand: 1e-12 is some thousand roundings.
TEST_IN_2D_AND_3D("friction adds no mass to a body along the normal") {
    const OneThread alone;
    for (const real stiff : {0.0, 0.01, 3.0})
        for (const real friction : {0.0, 0.5, 20.0}) {
            Exchange<D> e;
            e.meeting.stiff = stiff, e.meeting.friction = friction;
            const real m = e.fluid.mass, g = 2, pull2 = dot(e.meeting.pull, e.meeting.pull);
            const Vec<D> given = e.give(g * e.normal);
            const real change = -m * g / (e.body.mass + m * stiff * pull2);
            EXPECT_NEAR(dot(e.velocity(), e.normal), change, 1e-12 * g) << stiff << ' ' << friction;
            EXPECT_NEAR(norm(e.velocity() - change * e.normal), 0, 1e-12 * g);
            for (std::size_t k = D; k < rigid::freedoms<D>; ++k) EXPECT_NEAR(e.body.velocity[k], 0, 1e-12 * g / radius);
            EXPECT_NEAR(norm(e.body.mass * e.velocity() + m * given), 0, 1e-12 * m * g) << "momentum: " << stiff << ' ' << friction;
        }
}

// An impulse along the surface turns the ball too: the point of contact gains u = kappa J with kappa = 1/M + R^2/I, and the particle gets
// rub u back, so u = -m g kappa / (1 + m rub kappa), whatever the stiffness, which acts along the normal only.
TEST_IN_2D_AND_3D("stiffness adds no mass to a body across the normal") {
    const OneThread alone;
    for (const real stiff : {0.0, 3.0})
        for (const real friction : {0.0, 0.5, 20.0}) {
            Exchange<D> e;
            e.meeting.stiff = stiff, e.meeting.friction = friction;
            const real m = e.fluid.mass, g = 2, kappa = e.response_across();
            const Vec<D> given = e.give(g * e.tangent);
            const real impulse = -m * g / (1 + m * friction * kappa);
            EXPECT_NEAR(dot(e.velocity(), e.tangent), impulse / e.body.mass, 1e-12 * g) << stiff << ' ' << friction;
            EXPECT_NEAR(dot(e.velocity(), e.normal), 0, 1e-12 * g);
            real spin2 = 0;
            for (std::size_t k = D; k < rigid::freedoms<D>; ++k) spin2 += e.body.velocity[k] * e.body.velocity[k];
            EXPECT_NEAR(std::sqrt(spin2), std::abs(impulse) * radius / e.body.principal[2], 1e-11 * g / radius);
            EXPECT_NEAR(norm(e.body.mass * e.velocity() + m * given), 0, 1e-12 * m * g) << "momentum: " << stiff << ' ' << friction;
        }
}

}  // namespace impulses_in_particles_tests
