// The bodies shared by all backends, on threads with the best instruction set of this processor.
#include "shared/on_threads.hpp"
// first: what the bodies run on
#include "shared/heat_bodies.hpp"

/// A heater that gives nothing has heat found by itself.
TEST_IN_2D_AND_3D("heat that is found in one pass with PBF's densities has the bits of a pass of its own") {
    for (const char* kernel : {"muller", "cubic", "wendland"})
        for (const std::string& wall :
             {std::string(), test::warm_places<D>()[1].substr(0, test::warm_places<D>()[1].find("sides.x_max"))}) {
            const auto after = [&](const std::string& more) {
                test::Pbf<D> solver(test::heat_scene<D>("pbf", test::backend, wall + more, fmt::format("kernel = \"{}\"", kernel)));
                test::shake(solver.fluid(), 0.1);
                for (int s = 0; s < 3; ++s) solver.step(0.002);
                return std::tuple{Fluid<D>(solver.fluid()), test::sum_of("heat_added", solver), test::sum_of("max_compression", solver)};
            };
            const auto [one, one_added, one_worst] = after("");
            const auto [other, added, worst] = after(fmt::format(
                "heaters = [ {{ shape = \"sphere\", centre = {}, radius = 0.3, power = 0.0 }} ]\n", test::list<D>(0.5, 0.4, 0.5)));
            EXPECT_EQ(one.enthalpy, other.enthalpy) << kernel << wall;
            EXPECT_EQ(one.density, other.density) << kernel << wall;
            EXPECT_EQ(one.x, other.x) << kernel << wall;
            EXPECT_EQ(one_added, added) << kernel << wall;
            EXPECT_EQ(one_worst, worst) << kernel << wall;
        }
}

TEST_IN_2D_AND_3D("a liquid that boils: the same bits with one, two and three threads") {
    test::on_both_boiling<D>([&](auto here, auto, const char* name, const std::string& place, const std::string& scheme) {
        const auto after = [&](int threads) {
            set_threads(threads);
            typename decltype(here)::type solver(test::heat_scene<D>(name, test::backend, place, scheme));
            test::shake(solver.fluid(), 0.1), test::heat_through(solver.fluid(), 4e5, 2e6);
            for (int s = 0; s < 10; ++s) solver.step(0.0005);
            return std::pair{Fluid<D>(solver.fluid()), test::sum_of("heat_added", solver)};
        };
        const auto [one, one_added] = after(1);
        for (const int threads : {2, 3}) {
            const auto [other, added] = after(threads);
            EXPECT_EQ(one.x, other.x) << name << threads;
            EXPECT_EQ(one.v, other.v) << name << threads;
            EXPECT_EQ(one.enthalpy, other.enthalpy) << name << threads;
            EXPECT_EQ(one_added, added) << name << threads;
        }
        set_threads(1);
    });
}
