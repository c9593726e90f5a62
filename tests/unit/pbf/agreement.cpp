// The fast path against the plain double-precision reference over all pairs, for every kernel and every instruction set that this machine
// runs; and equality to the last bit for any number of threads.
#include "shared/pbf_reference.hpp"

#include "support/test.hpp"

namespace agreement_tests {

using namespace weir;
using test::disturb;
using test::Expected;

namespace {

const char* const kernels[] = {"muller", "cubic", "wendland"};

}  // namespace

TEST_IN_2D_AND_3D("every instruction set agrees with the double reference to 1e-5 of the support after one step") {
    for (const auto* table : particles::available_passes())
        for (const char* kernel : kernels) {
            const double warm = kernel == kernels[0] ? 0 : 0.8;  // the paper's iteration, and the one that keeps its multipliers
            const std::string scheme = fmt::format("iterations = 4, kernel = \"{}\", backend = \"threads:{}\", warm_start = {}, settle = 0",
                                                   kernel, table->name, warm);
            auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1), scheme));
            disturb(solver->fluid());
            const auto before = solver->fluid();
            const Expected<D> expected(solver->options(), before, 0.008);
            const real h = solver->options().support * before.domain.spacing;
            // a mass counted twice once made every lambda zero, and all variants agreed: so the thing tested must be there
            EXPECT_GT(expected.largest_lambda, 1e-4 * h * h);
            EXPECT_GT(expected.largest_move, 1e-2 * h);
            solver->step(0.008);
            EXPECT_LE(expected.farthest(solver->fluid()), 1e-5 * h) << table->name << " " << kernel;
        }
}

TEST_IN_2D_AND_3D("results are equal to the last bit for one, two and three threads, and when run again") {
    std::vector<std::array<std::vector<real>, D>> results;
    for (const int count : {1, 2, 3, 2}) {
        set_threads(count);
        auto solver = test::pbf_solver<D>(
            test::pbf_scene<D>(test::box<D>(0.5, 1, 1), "", "effects.xsph = {}\neffects.vorticity = { epsilon = 0.1 }"));
        for (int s = 0; s < 20; ++s) solver->step(0.008);
        results.push_back(solver->fluid().x);
    }
    set_threads(2);
    for (const auto& x : results) EXPECT_EQ(x, results.front());
}

TEST_IN_2D_AND_3D("a restart from a checkpoint continues bit for bit") {
    const auto scene = test::pbf_scene<D>(test::box<D>(0.5, 1, 1), "", "effects.xsph = {}");
    auto through = test::pbf_solver<D>(scene), first = test::pbf_solver<D>(scene), second = test::pbf_solver<D>(scene);
    for (int s = 0; s < 30; ++s) through->step(0.008);
    for (int s = 0; s < 13; ++s) first->step(0.008);
    Checkpoint saved;
    first->save(saved);
    second->restore(saved);
    for (int s = 13; s < 30; ++s) second->step(0.008);
    EXPECT_EQ(through->fluid().x, second->fluid().x);
    EXPECT_EQ(through->fluid().v, second->fluid().v);
    EXPECT_EQ(through->fluid().id, second->fluid().id);
}

}  // namespace agreement_tests
