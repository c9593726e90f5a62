// Pieces of moving ice and walls: a dumbbell of two particles that falls on a wall, by the laws of impact.
#include "particles/heat/ice.hpp"
#include "particles/state/flow.hpp"
#include "sph/solver.hpp"
#include "support/test.hpp"

#include <fmt/format.h>

#include <cmath>

namespace weir::ice_tests {
namespace {

constexpr real spacing = 0.1;  // [m]

/// Two frozen particles in a closed box of twelve spacings. `solids`: TOML.
template <int D>
scene::Scene ice_scene(const std::string& solids) {
    return scene::parse(
        fmt::format("solver = \"sph\"\ndim = {}\ngrid = {{ cells = [{}], size = [{}] }}\ntime.end = 1.0\nfluid.density = 1000.0\n"
                    "liquid = [ {{ shape = \"box\", min = [{}], max = [{}] }} ]\nscheme.density = \"summation\"\nsubstance = \"water\"\n"
                    "heat.frozen = \"free\"\ninitial.temperature = {{ name = \"constant\", value = 260.0 }}\n{}\n",
                    D, D == 2 ? "12, 12" : "12, 12, 12", D == 2 ? "1.2, 1.2" : "1.2, 1.2, 1.2", D == 2 ? "0.5, 0.5" : "0.5, 0.5, 0.5",
                    D == 2 ? "0.7, 0.6" : "0.7, 0.6, 0.6", solids),
        "test.toml", {sph::kind().schema});
}

/// Particles at the ends of a massless rod of length 2 a that leans by `angle` out of the plane of a wall and comes towards it at `speed`.
struct Dumbbell {
    real a, angle, speed;
    real dt;
};

/// Its state after a step: move and velocity of its centre along the wall's normal and along the wall, and along the normal the velocity of
/// the far end relative to the near end, and the depth of the near end behind the wall.
struct Impact {
    real move, along, normal, tangential, turning, depth;
};

/// One step of a dumbbell whose near end starts at `contact`, where a wall with this normal stops particles.
template <int D>
Impact fall(const scene::Scene& scene, const Vec<D>& contact, const Vec<D>& normal, const Vec<D>& tangent, const Dumbbell& bell,
            real slide) {
    particles::Fluid<D> fluid = particles::initial_fluid<D>(scene);
    const particles::Heat<D> heat(scene, fluid.domain);
    EXPECT_EQ(fluid.count(), 2);
    const Vec<D> rod = 2 * bell.a * (std::cos(bell.angle) * tangent + std::sin(bell.angle) * normal);
    const std::array<Vec<D>, 2> start{contact, contact + rod};
    for (int i = 0; i < 2; ++i) {
        particles::Fluid<D>::put(fluid.x, i, start[static_cast<std::size_t>(i)]);
        particles::Fluid<D>::put(fluid.v, i, slide * tangent - bell.speed * normal);
    }
    particles::Ice<D> ice(heat, fluid.domain);
    ice.find(fluid);
    EXPECT_EQ(ice.pieces(), 1);
    ice.advance_free(bell.dt);
    std::array<Vec<D>, 2> place;
    ice.each_place([&](int i, const Vec<D>& x) { place[static_cast<std::size_t>(i)] = x; });
    ice.finish_motion(fluid, bell.dt);
    const Vec<D> move = 0.5 * (place[0] + place[1] - start[0] - start[1]), mean = 0.5 * (fluid.velocity(0) + fluid.velocity(1));
    return {dot(move, normal),
            dot(move, tangent),
            dot(mean, normal),
            dot(mean, tangent),
            dot(fluid.velocity(1) - fluid.velocity(0), normal),
            dot(contact - place[0], normal)};
}

/// Two masses m at distance a from the centre: M = 2 m, I = 2 m a^2. An impulse J at the near end, at the lever a cos(angle), stops that
/// end: J (1/M + a^2 cos^2/I) = speed, so J = 2 m speed / (1 + cos^2). The centre goes on at -speed cos^2 / (1 + cos^2), and the rod turns
/// its far end to the wall at (speed / a) cos / (1 + cos^2). The wall is smooth: the velocity along it stays.
void expect_impact(const Impact& got, const Dumbbell& bell, real slide, const std::string& where) {
    const real c = std::cos(bell.angle), part = 1 / (1 + c * c), centre = -bell.speed * (1 - part);
    const real spin = bell.speed / bell.a * c * part;
    // The near end moves along a circle: the angle turned in a step, spin dt, changes its move along the normal by tan(angle) / 2 of that
    // angle, relative to the move, and the lever by as much. Contacts leave 1e-6 of a spacing, relative to speed dt.
    const real relative = 4 * spin * bell.dt + 1e-6 * spacing / (bell.speed * bell.dt), bound = relative * bell.speed;
    EXPECT_LT(relative, 6e-3) << where;
    EXPECT_NEAR(got.normal, centre, bound) << where;
    EXPECT_NEAR(got.move, centre * bell.dt, bound * bell.dt) << where;
    EXPECT_NEAR(got.turning, -spin * 2 * bell.a * c, 2 * bound) << where;
    EXPECT_NEAR(got.tangential, slide, 1e-12) << where;
    EXPECT_NEAR(got.along, slide * bell.dt, 1e-12) << where;
    EXPECT_LE(got.depth, 1e-6 * spacing + 1e-15) << "as deep as contacts are solved: " << where;
}

const Dumbbell bells[] = {{0.05, 0.3, 1.0, 1e-4}, {0.05, pi / 4, 1.0, 1e-4}, {0.05, 1.1, 1.0, 1e-4}, {0.05, pi / 2, 1.0, 1e-4}};

}  // namespace

TEST_IN_2D_AND_3D("a wall that stops one end of a piece of ice turns it, by the laws of impact") {
    const scene::Scene scene = ice_scene<D>("");
    const particles::Domain<D> domain(scene);
    for (int axis = 0; axis < D; ++axis)
        for (int end = 0; end < 2; ++end)
            for (const Dumbbell& bell : bells) {
                const Vec<D> normal = (end ? -1.0 : 1.0) * Vec<D>::unit(axis), tangent = Vec<D>::unit((axis + 1) % D);
                Vec<D> contact = domain.centre();
                contact[axis] = end ? domain.keep_hi[axis] : domain.keep_lo[axis];
                const Impact got = fall<D>(scene, contact, normal, tangent, bell, 0.25);
                expect_impact(got, bell, 0.25, fmt::format("axis {} end {} angle {}", axis, end, bell.angle));
            }
}

TEST_IN_2D_AND_3D("a solid that stops one end of a piece of ice turns it, by the laws of impact") {
    const scene::Scene scene = ice_scene<D>(fmt::format("solids = [ {{ shape = \"box\", min = [{}], max = [{}] }} ]",
                                                        D == 2 ? "-1, -1" : "-1, -1, -1", D == 2 ? "3, 0.3" : "3, 0.3, 3"));
    const particles::Domain<D> domain(scene);
    for (const Dumbbell& bell : bells) {
        Vec<D> contact = domain.centre();
        contact[1] = 0.3 + domain.margin;
        const Impact got = fall<D>(scene, contact, Vec<D>::unit(1), Vec<D>::unit(0), bell, 0.25);
        expect_impact(got, bell, 0.25, fmt::format("angle {}", bell.angle));
    }
}

}  // namespace weir::ice_tests
