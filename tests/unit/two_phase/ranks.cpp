// Liquid and gas in parallel: every plane has the bits of one process, and no pass reads a ghost plane that was not filled.
#include "parallel/partition.hpp"
#include "support.hpp"
#include "support/forked_ranks.hpp"

#include <cstring>

namespace weir {
namespace {

template <int D>
std::size_t different_in_own_planes(const Grid<real, D>& one, const Grid<real, D>& parts) {
    const auto plane = static_cast<std::size_t>(one.stride(D - 1));
    std::size_t count = 0;
    for (int k = parts.own().lower(0); k < parts.own().upper(parts.extent()[D - 1]); ++k)
        for (std::size_t i = static_cast<std::size_t>(k) * plane; i < static_cast<std::size_t>(k + 1) * plane; ++i)
            if (std::memcmp(&one[i], &parts[i], sizeof(real)) != 0) ++count;
    return count;
}

/// The unknowns after some steps, and everything that is reported, as one process has them.
template <int D>
void expect_as_one_process(const std::string& text, int ranks, int steps) {
    const auto scene = test::two_phase_scene(text);
    test::on_ranks(
        ranks,
        [&] {
            two_phase::TwoPhase<D> one(scene), parts(scene, equal_partition(scene.index<D>("grid.cells")[D - 1], ranks));
            for (int step = 0; step < steps; ++step) {
                const real dt = one.advised_dt();
                ASSERT_EQ(dt, parts.advised_dt());
                const StepReport a = one.step(dt), b = parts.step(dt);
                EXPECT_EQ(a.iterations, b.iterations);
                EXPECT_EQ(a.max_divergence, b.max_divergence);
            }
            for (int a = 0; a < D; ++a) EXPECT_EQ(different_in_own_planes(one.state().u[a], parts.state().u[a]), 0u) << "u along " << a;
            EXPECT_EQ(different_in_own_planes(one.state().p, parts.state().p), 0u) << "pressure";
            EXPECT_EQ(different_in_own_planes(one.fraction(), parts.fraction()), 0u) << "fraction";
            parts.synchronize();
            const auto fields = static_cast<const Solver&>(one).fields(), shown = static_cast<const Solver&>(parts).fields();
            const auto &phi = fields.find("", "level_set")->data[0], &phi_shown = shown.find("", "level_set")->data[0];
            EXPECT_TRUE(std::equal(phi.begin(), phi.end(), phi_shown.begin())) << "level set";  // whole: so few cells are not distributed
            const auto list = one.integrals(), list_of_parts = parts.integrals();
            for (std::size_t i = 0; i < list.size(); ++i) EXPECT_EQ(list[i].value, list_of_parts[i].value) << list[i].name;
        },
        true);
}

/// A column of liquid that falls past a ball, between an inflow and open sides on the partitioned axis.
template <int D>
std::string flow_past_a_ball() {
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {} }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {{ shape = "box", min = {}, max = {} }} ]
solids = [ {{ shape = "sphere", centre = {}, radius = 0.2 }} ]
sides = {{ {}_min = {{ kind = "inflow", velocity = {}, fluid = "liquid" }}, {}_max = {{ kind = "outflow" }} }}
effects = {{ gravity = {{ g = {} }} }}
)",
                       D, test::list({"16", "15", "14"}, D), test::list({"1.0", "1.0", "1.0"}, D), test::list({"0.0", "0.0", "0.0"}, D),
                       test::list({"0.41", "0.63", "0.33"}, D), test::list({"0.5", "0.45", "0.5"}, D), "xyz"[D - 1],
                       D == 2 ? "[0.0, 0.5]" : "[0.0, 0.0, 0.5]", "xyz"[D - 1], test::list({"1.0", "-9.81", "2.0"}, D));
}

/// A drop across the ends of a periodic axis, which is partitioned, with surface tension.
template <int D>
std::string drop_on_the_seam() {
    return fmt::format(R"(solver = "two_phase"
dim = {}
grid = {{ cells = {}, size = {}, periodic = ["{}"] }}
time = {{ end = 1.0 }}
fluid = {{ density = 1000.0 }}
gas = {{ density = 1.0 }}
liquid = [ {{ shape = "sphere", centre = {}, radius = 0.21 }}, {{ shape = "sphere", centre = {}, radius = 0.31 }} ]
initial = {{ liquid_velocity = {} }}
effects = {{ surface_tension = {{ sigma = 10.0 }} }}
)",
                       D, test::list({"16", "16", "16"}, D), test::list({"1.0", "1.0", "1.0"}, D), "xyz"[D - 1],
                       D == 2 ? "[0.5, 0.9]" : "[0.5, 0.5, 0.9]", D == 2 ? "[0.4, 0.0]" : "[0.4, 0.5, 0.0]",
                       test::list({"0.3", "0.7", "0.5"}, D));
}

TEST_IN_2D_AND_3D("two_phase in parallel: a flow past a ball through open sides has the bits of one process") {
    for (const int ranks : {2, 3, 4}) expect_as_one_process<D>(flow_past_a_ball<D>(), ranks, D == 2 ? 12 : 3);
}

TEST_IN_2D_AND_3D("two_phase in parallel: a drop with tension across a periodic end has the bits of one process") {
    for (const int ranks : {2, 3, 4}) expect_as_one_process<D>(drop_on_the_seam<D>(), ranks, D == 2 ? 12 : 3);
}

}  // namespace
}  // namespace weir
