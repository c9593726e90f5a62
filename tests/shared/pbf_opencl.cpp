// The bodies shared by all backends, on the first OpenCL device; and what is true of a device alone.
#include "shared/on_opencl.hpp"
// first: what the bodies run on
#include "shared/pbf_bodies.hpp"

TEST_IN_2D_AND_3D("the order of sorted particles is that of the processor's path, also where thousands share a cell") {
    NEEDS_BACKEND;
    for (const real squeeze : {1.0, 0.3, 0.01}) {
        auto here = on_backend<D>(test::box<D>(1, 1, 1), "settle = 0");
        auto there = test::on_sse2<D>(test::box<D>(1, 1, 1), "settle = 0");
        for (Fluid<D>* fluid : {&here->fluid(), &there->fluid()}) {
            test::disturb(*fluid);
            for (int i = 0; i < fluid->count(); ++i)
                Fluid<D>::put(fluid->x, i, Vec<D>::constant(0.5) + squeeze * (fluid->position(i) - Vec<D>::constant(0.5)));
        }
        here->step(0.001), there->step(0.001);
        EXPECT_EQ(here->on_device().sorted_order(), there->pairs().particle_order()) << squeeze;
    }
}

TEST_IN_2D_AND_3D("a period shorter than two supports is refused by name, and not run on the processor") {
    try {
        test::Pbf<D>(test::pbf_scene<D>(test::box<D>(0.5, 0.5, 0.5), "backend = \"opencl\", support = 4.0", test::periodic_sides<D>(),
                                        D == 2 ? "[6, 6]" : "[6, 6, 6]", D == 2 ? "[0.75, 0.75]" : "[0.75, 0.75, 0.75]"));
        ADD_FAILURE() << "was not refused";
    } catch (const scene::BadScene& refused) {
        EXPECT_NE(std::string(refused.what()).find("the backend opencl does not support periods shorter than two supports"),
                  std::string::npos)
            << refused.what();
    }
}

TEST_IN_2D_AND_3D("memory is planned for all that emitters let in, up to a full domain; more than that grows, and no particle is lost") {
    NEEDS_BACKEND;
    const std::string liquid = test::box<D>(1, 0.25, 1);
    const auto plan = [](const auto& solver) {
        return std::pair{solver.on_device().stride(), solver.on_device().plan().bytes_per_particle()};
    };
    EXPECT_EQ(on_backend<D>(liquid)->on_device().stride(), D == 2 ? 16 : 128);
    auto solver = on_backend<D>(liquid, "", test::jet_and_drain<D>());
    const auto [room, bytes] = plan(*solver);
    EXPECT_EQ(room, D == 2 ? 105 : 844);  // 1.1 times 8 x 12 [x 8] cells
    EXPECT_EQ(bytes, on_backend<D>(liquid)->on_device().plan().bytes_per_particle());
    const auto on_threads = test::on_sse2<D>(liquid, "", test::jet_and_drain<D>());
    const auto run = [room = room](auto& any) {
        for (int s = 0; s < 3; ++s) any.step(0.008);
        auto& fluid = any.fluid();
        while (fluid.count() < room + 10) fluid.add(Vec<D>::constant(0.5) + 1e-3 * fluid.count() * Vec<D>::unit(1), Vec<D>{});
        any.step(1e-4);
        return any.fluid().id;
    };
    EXPECT_EQ(run(*solver), run(*on_threads));
    EXPECT_GT(solver->on_device().stride(), room + 10);
}

TEST("the dam break of the cases, at half its resolution: ten steps on the device and on threads end within 1e-4 of the support") {
    NEEDS_BACKEND;
    const auto read = [](const char* on) {
        return scene::read(WEIR_SOURCE_DIR "/cases/dam_break_particles", {pbf::kind().schema},
                           {{"grid.cells", "[48, 32, 17]"}, {"grid.size", "[3.0, 2.0, 1.0625]"}, {"scheme.backend", on}});
    };
    pbf::DevicePbfSolver<3> here(read("opencl"));
    pbf::PbfSolver<3> there(read("threads"));
    ASSERT_EQ(here.fluid().count(), 4096);
    for (int s = 0; s < 10; ++s) here.step(0.002), there.step(0.002);
    EXPECT_EQ(here.fluid().id, there.fluid().id);
    const real h = here.options().support * here.fluid().domain.spacing, worst = test::farthest_apart(here.fluid(), there.fluid());
    // coordinates of up to 12 h are rounded to 7e-7 h in each of five passes a step, and that stays as speed: 55 times 1.6e-6 h
    EXPECT_LE(worst, 1e-4 * h);
    testing::Test::RecordProperty("farthest_over_support", fmt::format("{:.3g}", worst / h));
}
