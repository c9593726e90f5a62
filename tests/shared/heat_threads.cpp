// The bodies shared by all backends, on threads with the best instruction set of this processor.
#include "shared/on_threads.hpp"
// first: what the bodies run on
#include "shared/heat_bodies.hpp"

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
