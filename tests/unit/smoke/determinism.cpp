// The same bits for any number of threads, after a restart, and on both sides of a mirror.
#include "support/grid_solvers.hpp"
#include "support/test.hpp"

#include "core/parallel.hpp"

namespace weir::smoke::determinism_tests {

namespace {

/// Smoke and heat past a moving obstacle with every effect: all passes run.
std::string everything(int dim, const std::string& advection) {
    return test::unit_box(dim, 24,
                          "fluid = { viscosity = 0.002 }\n"
                          "scheme = { advection = \"" +
                              advection +
                              "\" }\n"
                              "sides = { x_min = { kind = \"wall\", slip = \"no\" }, y_max = { kind = \"open\" } }\n"
                              "solids = [ { shape = \"sphere\", centre = " +
                              test::list(dim, "0.5") +
                              ", radius = 0.15,"
                              " motion = { kind = \"sinusoidal\", amplitude = " +
                              test::list(dim, "0.1") +
                              ", frequency = 1.0 } } ]\n"
                              "emitters = [ { shape = \"sphere\", centre = " +
                              test::list(dim, "0.2") +
                              ", radius = 0.15, smoke = 1.0,"
                              " temperature = 2.0 } ]\n"
                              "initial = { velocity = { name = \"random\", speed = 0.5 } }\n"
                              "effects = { buoyancy = { alpha = 0.3, beta = 0.5 }, confinement = { epsilon = 0.1 }, viscosity = {},"
                              " diffusion = { temperature = 0.001 }, cooling = { rate = 0.1 }, gravity = { g = " +
                              test::list(dim, "-0.1") + " } }\n");
}

template <int D>
void run(FlowSolver<D>& flow, int steps) {
    for (int i = 0; i < steps; ++i) flow.step(0.01);
}

}  // namespace

TEST_IN_2D_AND_3D("one, two and three threads give the same bits") {
    for (const char* advection : {"semi_lagrangian", "maccormack", "conservative"}) {
        const auto scene = test::mac_scene(everything(D, advection));
        std::vector<std::unique_ptr<FlowSolver<D>>> flows;
        for (const int count : {1, 2, 3}) {
            set_threads(count);
            flows.push_back(std::make_unique<FlowSolver<D>>(scene));
            run(*flows.back(), 4);
        }
        set_threads(1);
        EXPECT_TRUE(test::same_bits(*flows[0], *flows[1])) << advection << ", 2 threads";
        EXPECT_TRUE(test::same_bits(*flows[0], *flows[2])) << advection << ", 3 threads";
        EXPECT_GT(flows[0]->state().find("smoke")->values()[0] + flows[0]->integrals()[0].value, 0);
    }
}

TEST_IN_2D_AND_3D("a restarted run continues bit for bit") {
    for (const char* advection : {"semi_lagrangian", "maccormack", "conservative"}) {
        const auto scene = test::mac_scene(everything(D, advection));
        FlowSolver<D> whole(scene), first(scene), second(scene);
        run(whole, 6);
        run(first, 3);
        Checkpoint checkpoint;
        first.save(checkpoint);
        second.restore(checkpoint);
        run(second, 3);
        EXPECT_EQ(whole.time(), second.time());
        EXPECT_TRUE(test::same_bits(whole, second)) << advection;
    }
}

namespace {

/// Largest difference between a field and its mirror image in the plane across x through the middle of the domain.
template <int D>
real asymmetry(const Grid<real, D>& q, real sign) {
    return max_over(q.extent(), [&](const Index<D>& I) {
        Index<D> mirrored = I;
        mirrored[0] = q.extent()[0] - 1 - I[0];
        return std::abs(q(I) - sign * q(mirrored));
    });
}

template <int D>
real largest_asymmetry(const MacState<D>& s) {
    real largest = asymmetry(s.p, 1);
    for (int a = 0; a < D; ++a) largest = std::max(largest, asymmetry(s.u[a], a == 0 ? -1 : 1));
    for (const auto& field : s.fields) largest = std::max(largest, asymmetry(field.values, 1));
    return largest;
}

/// A hot, smoky ball on the mirror plane of a box, rising past a fixed block whose faces are grid faces.
std::string mirrored_plume(int dim, const std::string& advection, const std::string& poisson, const std::string& velocity = "rest") {
    const std::string z = dim == 3 ? ", 0.4" : "";
    return test::unit_box(dim, 16,
                          "fluid = { viscosity = 0.001 }\n"
                          "scheme = { advection = \"" +
                              advection + "\", poisson = { method = " + poisson +
                              " } }\n"
                              "solids = [ { shape = \"box\", min = [0.375, 0.625" +
                              std::string(dim == 3 ? ", 0.25" : "") + "], max = [0.625, 0.75" + std::string(dim == 3 ? ", 0.5" : "") +
                              "] } ]\n"
                              "initial = { velocity = { name = \"" +
                              velocity + "\" }, temperature = { name = \"ball\", centre = [0.5, 0.3" + z +
                              "], radius = 0.2 },"
                              " smoke = { name = \"ball\", centre = [0.5, 0.3" +
                              z +
                              "], radius = 0.2 } }\n"
                              "effects = { buoyancy = { alpha = 0.1, beta = 2.0 }, confinement = { epsilon = 0.05 }, viscosity = {} }\n");
}

/// Makes the state its own mirror image, bit for bit: the right half is copied from the left.
template <int D>
void make_symmetric(Grid<real, D>& q, real sign) {
    for_each_cell(q.extent(), [&](const Index<D>& I) {
        Index<D> mirrored = I;
        mirrored[0] = q.extent()[0] - 1 - I[0];
        if (I[0] > mirrored[0]) q(I) = sign * q(mirrored);
        if (I[0] == mirrored[0] && sign < 0) q(I) = 0;
    });
}

}  // namespace

// A row of the pressure matrix adds its neighbours in the order of their numbers, and a mirror reverses that order: this is the one sum
// that rounds differently on both sides. From p = 0, one Jacobi sweep has no such sum, so all other passes can be held to the last bit.
TEST_IN_2D_AND_3D("a step from a mirror-symmetric state is mirror-symmetric to the last bit, but for the row sums of the pressure matrix") {
    for (const char* advection : {"semi_lagrangian", "maccormack"})
        for (const real dt : {0.03, 0.2}) {  // below and above one cell a step: both interpolation paths
            const auto text = mirrored_plume(D, advection, "\"jacobi\", fixed = true, max_iterations = 1", "random");
            FlowSolver<D> flow(test::mac_scene(text));
            for (int a = 0; a < D; ++a) make_symmetric(flow.state().u[a], a == 0 ? -1 : 1);
            flow.step(dt);
            EXPECT_EQ(largest_asymmetry(flow.state()), 0) << advection << ", dt " << dt;
            EXPECT_GT(max_rate(flow.state().u), 1) << "nothing moves";
        }
}

// Without a limiter: a clamp jumps where a path turns from one cell into the next, and on faces where fluid stands still at the block
// it is round-off that decides which way it goes.
TEST_IN_2D_AND_3D("over many steps the asymmetry is that of the pressure solver's round-off") {
    for (const char* method : {"\"cg_jacobi\"", "\"multigrid\""}) {
        FlowSolver<D> flow(test::mac_scene(mirrored_plume(D, "maccormack\", limiter = \"none", method)));
        run(flow, 8);
        EXPECT_LE(largest_asymmetry(flow.state()), 1e-6) << method;  // tolerance 1e-8, 8 steps, speeds and pressures of order 1
        EXPECT_GT(max_rate(flow.state().u), 1) << "nothing moves";
    }
}

}  // namespace weir::smoke::determinism_tests
