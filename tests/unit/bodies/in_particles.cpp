// Bodies among particles: what water and bodies give each other, bodies of any weight, drafts, what is kept from step to step, and the
// plain double-precision reference beside the threads.
#include "pbf/solver.hpp"
#include "sph/solver.hpp"
#include "sph/state.hpp"
#include "support.hpp"

namespace in_particles_tests {

using namespace weir;
using namespace weir::test;

namespace {

std::unique_ptr<Solver> particles_of(const std::string& text) {
    static const std::vector<scene::SolverSchema> schemas{sph::kind().schema, pbf::kind().schema};
    const scene::Scene scene = scene::parse(text, "bodies.toml", schemas);
    return scene.solver() == "sph" ? sph::kind().make(scene, {}) : pbf::kind().make(scene, {});
}

/// A tank of 1 m by 0.8 m, 0.4 m deep, with bodies.
std::string tank(const char* solver, int cells, const std::string& bodies, const std::string& more = "") {
    return fmt::format(R"(solver = "{}"
dim = 2
grid = {{ cells = [{}, {}], size = [1.0, 0.8] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "box", min = [0.0, 0.0], max = [1.0, 0.4] }} ]
effects = {{ gravity = {{ g = [0.0, -9.81] }} }}
{}
{}
)",
                       solver, cells, cells * 4 / 5, bodies.empty() ? "" : "bodies = [ " + bodies + " ]", more);
}

/// A blob of liquid far from all walls, without gravity, that a body flies into, turning; `behind` may be tied to it.
std::string collision(const char* solver, int dim, const std::string& more = "", const std::string& behind = "") {
    const bool flat = dim == 2;
    return fmt::format(R"(solver = "{}"
dim = {}
grid = {{ cells = [{}], size = [{}] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
liquid = [ {{ shape = "sphere", centre = [{}], radius = 0.2 }} ]
bodies = [ {{ shape = "box", min = [{}], max = [{}], density = 300.0, velocity = [{}], spin = [{}] }}{} ]
{}
)",
                       solver, dim, flat ? "40, 40" : "28, 28, 28", flat ? "1.0, 1.0" : "1.0, 1.0, 1.0",
                       flat ? "0.4, 0.5" : "0.4, 0.5, 0.5", flat ? "0.61, 0.45" : "0.61, 0.45, 0.4",
                       flat ? "0.81, 0.57" : "0.81, 0.57, 0.6", flat ? "-1.0, 0.0" : "-1.0, 0.0, 0.0", flat ? "3.0" : "1.0, 2.0, 3.0",
                       behind, more);
}

real sum_of(const Solver& solver, const std::string& name) {
    for (const Integral& i : solver.integrals())
        if (i.name == name) return i.value;
    throw std::runtime_error("no integral " + name);
}

/// Of water and bodies about the origin, about z.
real turning(const Solver& solver, int dim) {
    const FieldSet set = solver.fields();
    const auto &x = set.find("particles", "position")->data, &v = set.find("particles", "velocity")->data;
    real l = 0;
    const real mass = sum_of(solver, "mass") / static_cast<real>(x[0].size());
    for (std::size_t i = 0; i < x[0].size(); ++i) l += mass * (x[0][i] * v[1][i] - x[1][i] * v[0][i]);
    const auto add = [&](const auto& bodies) {
        for (const auto& body : bodies.all())
            l += body.mass * (body.at[0] * body.velocity[1] - body.at[1] * body.velocity[0]) + body.angular_momentum()[2];
    };
    if (dim == 2)
        add(dynamic_cast<const particles::ParticleSolver<2>&>(solver).carried()->bodies());
    else
        add(dynamic_cast<const particles::ParticleSolver<3>&>(solver).carried()->bodies());
    return l;
}

}  // namespace

// Forces between particles are sums of some hundred numbers in single precision, each good to 6e-8 of the largest: of m v that changes
// hands, 1e-5 is left for 30 steps on threads. The reference has double precision throughout.
TEST("momentum of water and body is kept to round-off, and angular momentum by SPH") {
    const OneThread alone;
    for (const char* solver : {"sph", "pbf"})
        for (const int dim : {2, 3})
            for (const bool plain : {false, true}) {
                if (plain && dim == 3) continue;
                const auto s = particles_of(collision(solver, dim, plain ? "scheme.backend = \"reference\"" : ""));
                const auto momentum = [&](const char* axis) {
                    return sum_of(*s, std::string("momentum_") + axis) + sum_of(*s, std::string("bodies_momentum_") + axis);
                };
                const real x = momentum("x"), y = momentum("y"), l = turning(*s, dim), water = sum_of(*s, "momentum_x");
                const real dt = s->advised_dt();
                for (int i = 0; i < (plain ? 12 : 30); ++i) s->step(dt);
                const real changed = std::abs(sum_of(*s, "momentum_x") - water);
                EXPECT_GT(changed, 1e-3 * std::abs(x)) << "they have met: " << solver << dim << plain;
                const real bound = (plain ? 1e-10 : 1e-5) * std::abs(x);
                EXPECT_NEAR(momentum("x"), x, bound) << solver << dim << plain;
                EXPECT_NEAR(momentum("y"), y, bound) << solver << dim << plain;
                if (std::string(solver) == "sph") {
                    EXPECT_NEAR(turning(*s, dim), l, bound) << solver << dim << plain;
                }
            }
}

TEST("the threads' step is the reference's, with a body in the water") {
    const OneThread alone;
    for (const char* solver : {"sph", "pbf"}) {
        const std::string body = "{ shape = \"box\", min = [0.31, 0.34], max = [0.71, 0.46], density = 300.0, spin = [0.5] }";
        const std::string unsettled = std::string(solver) == "pbf" ? "scheme = { settle = 0, backend = \"" : "scheme = { backend = \"";
        const auto fast = particles_of(tank(solver, 20, body, unsettled + "threads\" }"));
        const auto plain = particles_of(tank(solver, 20, body, unsettled + "reference\" }"));
        const real dt = fast->advised_dt();
        fast->step(dt), plain->step(dt);
        for (const char* field : {"position", "velocity", "spin", "force"})
            for (std::size_t a = 0; a < (std::string(field) == "spin" ? 1u : 2u); ++a) {
                // single precision of pressures and multipliers: 1e-4 of what the first step does
                const real scale = std::string(field) == "force" ? 1000 * 9.81 * 0.4 * 0.12 : 1;
                EXPECT_NEAR(shown(*fast, field, a), shown(*plain, field, a), 1e-4 * scale) << solver << field << a;
            }
    }
}

TEST("bodies of any weight among particles: none is thrown, none stirs the water") {
    const OneThread alone;
    for (const char* solver : {"sph", "pbf"})
        for (const real density : {0.0, 1.0, 100.0, 1000.0, 1e6}) {
            const auto s = particles_of(
                tank(solver, 20, fmt::format("{{ shape = \"sphere\", centre = [0.5, 0.4], radius = 0.15, density = {} }}", density)));
            real fastest = 0;
            while (s->time() < 0.5) s->step(s->advised_dt()), fastest = std::max(fastest, std::abs(shown(*s, "velocity", 1)));
            // nothing here falls or rises further than 0.4 m
            EXPECT_LT(fastest, std::sqrt(2 * 9.81 * 0.4)) << solver << density;
            EXPECT_GT(shown(*s, "position", 1), 0.14) << solver << density;
        }
}

// What comes back to a particle from its body's own change du is the linear part of what the body gives: with du along the pull g the
// density at the step's end is lower by 2 rho dt g.du (a body stands for liquid and its image behind it), the pressure by c² times that,
// and the push by 2 dt dp/rho g with it.
TEST_IN_2D_AND_3D("the response of SPH to a body's change of velocity is the derivative of the pressure force") {
    const OneThread alone;
    const std::string middle = D == 2 ? "0.5, 0.3" : "0.5, 0.3, 0.5";
    const auto scene =
        scene::parse(fmt::format("solver = \"sph\"\ndim = {}\ngrid = {{ cells = [{}], size = [{}] }}\ntime = {{ end = 1.0 }}\n"
                                 "fluid = {{ density = 1000.0 }}\nliquid = [ {{ shape = \"box\", min = [{}], max = [{}] }} ]\n"
                                 "scheme = {{ sound_speed = 30.0 }}\nbodies = [ {{ shape = \"sphere\", centre = [{}], radius = "
                                 "0.1, density = 500.0 }} ]\n",
                                 D, D == 2 ? "10, 10" : "10, 10, 10", D == 2 ? "1.0, 1.0" : "1.0, 1.0, 1.0",
                                 D == 2 ? "0.0, 0.0" : "0.0, 0.0, 0.0", D == 2 ? "1.0, 0.6" : "1.0, 0.6, 1.0", middle),
                     "stiff.toml", {sph::kind().schema});
    auto fluid = sph::first_fluid<D>(scene);
    const sph::Options options(scene, 1);
    const auto params = sph::sph_params<particles::plain::SphParams, D>(options, fluid.domain.spacing, fluid.rho0);
    fluid.carried[0] = 2000, fluid.density[0] = options.density(2000, fluid.rho0);
    const real dt = 1e-3, rho = fluid.density[0];
    Vec<D> change = Vec<D>::constant(0.02);
    change[0] = -0.05;
    const auto met = [&](real rise) {
        particles::Meeting<D> m;
        m.particle = 0, m.body = 0, m.at = fluid.position(0), m.part = 0.2;
        for (int a = 0; a < D; ++a) m.pull[a] = 3.0 - a;
        (void)sph::meet_body(options, params, fluid, 0, rise, dt, m);
        return m;
    };
    const auto still = met(100);
    const real closing = dot(still.pull, change);
    const auto changed = met(100 - 2 * rho * options.sound * options.sound * dt * closing);
    for (int a = 0; a < D; ++a)  // some roundings
        EXPECT_NEAR(changed.given[a] - still.given[a], still.stiff * closing * still.pull[a], 1e-12 * norm(still.given)) << a;
    EXPECT_GT(norm(changed.given - still.given), 0.01 * norm(still.given));
}

// Two spacings below the ball the floor begins. Where a particle between them saw each hide a part of the other, the water carried a
// twentieth too little, and the ball sank by a spacing in this time and went on.
TEST("a ball of nine tenths of the water's density floats close above the floor") {
    const OneThread alone;
    const real start = 0.2783200422636367;
    const auto s = particles_of(R"(solver = "sph"
dim = 3
grid = { cells = [25, 20, 25], size = [1.0, 0.8, 1.0] }
time = { end = 1.0 }
fluid = { density = 1000.0 }
liquid = [ { shape = "box", min = [0.0, 0.0, 0.0], max = [1.0, 0.4, 1.0] } ]
bodies = [ { shape = "sphere", centre = [0.5, 0.2783200422636367, 0.5], radius = 0.2, density = 900.0 } ]
initial = { surface = [0.0, 0.4, 0.0] }
effects = { gravity = { g = [0.0, -9.81, 0.0] } }
)");
    while (s->time() < 0.6) s->step(s->advised_dt());
    EXPECT_NEAR(shown(*s, "position", 1), start, 0.5 / 25) << "half a spacing, as of drafts";
}

TEST("a body falls through the air as a stone, beside the water, by its own weight") {
    const OneThread alone;
    for (const char* solver : {"sph", "pbf"}) {
        const auto s = particles_of(tank(solver, 20, "{ shape = \"box\", min = [0.4, 0.6], max = [0.6, 0.7], density = 3000.0 }"));
        const real dt = 0.0005;
        for (int i = 0; i < 100; ++i) s->step(dt);  // 0.05 s: 1.2 cm
        EXPECT_NEAR(shown(*s, "position", 1), 0.65 - 0.5 * 9.81 * 0.0025, 1e-12) << solver;
    }
}

TEST("particles and bodies that touch continue from a checkpoint bit for bit, with two threads as with one") {
    const std::string bodies = bodies_that_touch(0.101);
    for (const char* solver : {"sph", "pbf"}) {
        set_threads(1);
        const auto one = particles_of(tank(solver, 20, bodies)), two = particles_of(tank(solver, 20, bodies));
        for (int i = 0; i < 40; ++i) one->step(0.001);
        Checkpoint checkpoint;
        one->save(checkpoint);
        two->restore(checkpoint);
        for (int i = 0; i < 10; ++i) one->step(0.001);
        set_threads(2);
        for (int i = 0; i < 10; ++i) two->step(0.001);
        set_threads(0);
        expect_same_bodies(*one, *two, 3, 2);
        expect_same_numbers(*one, *two, "particles.x1");
    }
}

// Two bodies held together fly into the liquid: what the hinge gives one it takes from the other, in one point.
TEST("a hinge between two bodies among particles holds them, and keeps momentum to round-off") {
    const OneThread alone;
    const std::string hinge = "joints = [ { kind = \"hinge\", body = \"0\", to = \"1\", at = [0.82, 0.51] } ]";
    const std::string behind = ", { shape = \"box\", min = [0.83, 0.46], max = [0.93, 0.56], density = 900.0, velocity = [-1.0, 0.0] }";
    for (const char* solver : {"sph", "pbf"})
        for (const bool plain : {false, true}) {
            const auto s = particles_of(collision(solver, 2, hinge + (plain ? "\nscheme.backend = \"reference\"" : ""), behind));
            const auto momentum = [&](const char* axis) {
                return sum_of(*s, std::string("momentum_") + axis) + sum_of(*s, std::string("bodies_momentum_") + axis);
            };
            const real x = momentum("x"), y = momentum("y"), l = turning(*s, 2), water = sum_of(*s, "momentum_x"), dt = s->advised_dt();
            const auto& bodies = dynamic_cast<const particles::ParticleSolver<2>&>(*s).carried()->bodies();
            real fastest = 0, apart = 0;
            for (int i = 0; i < (plain ? 12 : 30); ++i) {
                s->step(dt);
                for (const std::size_t b : {0u, 1u}) fastest = std::max(fastest, std::abs(shown(*s, "spin", 0, b)));
                const auto end = bodies.joints().ends(bodies.joints().all()[0], bodies.all());
                apart = std::max(apart, norm(end[1] - end[0]));
            }
            EXPECT_GT(std::abs(sum_of(*s, "momentum_x") - water), 1e-3 * std::abs(x)) << "they have met: " << solver << plain;
            const real bound = (plain ? 1e-10 : 1e-5) * std::abs(x);
            EXPECT_NEAR(momentum("x"), x, bound) << solver << plain;
            EXPECT_NEAR(momentum("y"), y, bound) << solver << plain;
            if (std::string(solver) == "sph") {
                EXPECT_NEAR(turning(*s, 2), l, bound) << solver << plain;
            }
            // an arm r that turns by omega dt along its tangent ends r (omega dt)^2 / 2 too far out, and the next step takes that back
            EXPECT_LT(apart, 1.001 * 0.5 * (0.12 + 0.12) * std::pow(fastest * dt, 2)) << solver << plain;
        }
}

TEST("a line holds a float under water with what the water pushes, and a flap swings about its hinge") {
    const OneThread alone;
    const std::string joints =
        "joints = [ { kind = \"mooring\", body = \"0\", at = [0.3, 0.21], anchor = [0.3, 0.0], length = 0.2, stiffness = 10000.0, damping "
        "= "
        "500.0 }, { kind = \"hinge\", body = \"1\", at = [0.7, 0.05] } ]";
    const std::string bodies =
        "{ shape = \"sphere\", centre = [0.3, 0.29], radius = 0.08, density = 300.0 }, "
        "{ shape = \"box\", min = [0.67, 0.04], max = [0.73, 0.3], density = 300.0, spin = [1.0] }";
    for (const char* solver : {"sph", "pbf"}) {
        const std::string text = tank(solver, 40, bodies, joints);
        const auto one = particles_of(text), two = particles_of(text);
        const auto& carried = dynamic_cast<const particles::ParticleSolver<2>&>(*one).carried()->bodies();
        const real dt = 0.5 * one->advised_dt();
        real stretch = 0, off = 0, spin = 0, lean = 0;
        int count = 0;
        while (one->time() < 1.0) {
            one->step(dt);
            const auto line = carried.joints().ends(carried.joints().all()[0], carried.all());
            if (one->time() > 0.5) stretch += norm(line[0] - line[1]) - 0.2, ++count;
            const auto hinge = carried.joints().ends(carried.joints().all()[1], carried.all());
            off = std::max(off, norm(hinge[0] - hinge[1])), spin = std::max(spin, std::abs(shown(*one, "spin", 0, 1)));
            lean = std::max(lean, std::abs(shown(*one, "angle", 0, 1)));
        }
        // Archimedes; a waterline known to a fifth of a spacing (drafts, cases/floating_bodies) is a layer as thick all about the float
        const real area = pi * 0.08 * 0.08, layer = 2 * pi * 0.08 * 0.2 * 0.025;
        EXPECT_NEAR(stretch / count, (1000 - 300) * 9.81 * area / 10000, 1000 * 9.81 * layer / 10000) << solver;
        EXPECT_LT(off, 1.001 * 0.5 * 0.12 * std::pow(spin * dt, 2)) << solver;
        EXPECT_GT(lean, 0.01) << solver;  // it swings, and the water puts it up again
        EXPECT_LT(lean, 0.5) << solver;
        Checkpoint checkpoint;
        one->save(checkpoint);
        two->restore(checkpoint);
        for (int i = 0; i < 10; ++i) one->step(dt), two->step(dt);
        expect_same_bodies(*one, *two, 2, 2);
    }
}

TEST("a scene of particles without bodies holds none, and runs no pass for them") {
    const OneThread alone;
    for (const char* solver : {"sph", "pbf"}) {
        const auto without = particles_of(tank(solver, 10, ""));
        without->step(0.001);
        EXPECT_EQ(without->fields().find(rigid::body_set_name, "position"), nullptr);
        for (const auto& pass : without->passes().list()) EXPECT_NE(pass.name, "bodies") << solver;
        const auto with = particles_of(tank(solver, 10, "{ shape = \"sphere\", centre = [0.5, 0.6], radius = 0.05, density = 500.0 }"));
        with->step(0.001);
        EXPECT_LT(without->bytes(), with->bytes()) << solver;
    }
}

TEST("the water that a body displaces at the start is taken out to a particle") {
    for (const real low : {0.31, 0.3375, 0.34, 0.355}) {  // a flat bottom anywhere between the particles' rows
        const auto s = particles_of(
            tank("sph", 40, fmt::format("{{ shape = \"box\", min = [0.31, {}], max = [0.71, {}], density = 500.0 }}", low, low + 0.2)));
        EXPECT_NEAR(sum_of(*s, "volume"), 0.4 - 0.4 * (0.4 - low), 1.5 * 0.025 * 0.025)
            << low;  // of each of 16 cells half an eighth, and half a particle
    }
}

}  // namespace in_particles_tests
