// The published tables as the cases read them: signs, axes, scalings, misprints left out.
#include "support/test.hpp"
#include "validation/references/table.hpp"

#include <algorithm>

namespace published_tests {

using namespace weir;
using namespace weir::validation;

namespace {

Table data(const std::string& path) { return read_table(std::filesystem::path(WEIR_SOURCE_DIR) / "cases" / path); }
real smallest(const Curve& c) { return *std::min_element(c.y.begin(), c.y.end()); }
real largest(const Curve& c) { return *std::max_element(c.y.begin(), c.y.end()); }

}  // namespace

TEST("own and Botella & Peyret's cavity at Re 1000 agree to 2.5e-5, the own solve's error") {
    const Table own = data("cavity/data/cavity2d_own.csv").where("Re", "1000"), paper = data("cavity/data/cavity2d_botella_peyret1998.csv");
    for (const std::string kind : {"u", "v"}) {
        const Curve a = own.where("kind", kind).curve("coord", "value", ""), b = paper.where("kind", kind).curve("coord", "value", "");
        ASSERT_EQ(a.x, b.x);
        for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a.y[i], b.y[i], 2.6e-5);
    }
}

TEST("Ghia's misprint is marked, and without it Ghia and own differ by no more than the reference notes say") {
    const Table ghia = data("cavity/data/cavity2d_ghia1982.csv"), own = data("cavity/data/cavity2d_own.csv");
    EXPECT_EQ(ghia.rows.size() - ghia.where("ok", "1").rows.size(), 1u);
    for (const std::string Re : {"100", "400", "1000"})
        for (const std::string kind : {"u", "v"}) {
            const Curve g = ghia.where("ok", "1").where("Re", Re).where("kind", kind).curve("coord", "value", "");
            const Curve o = own.where("Re", Re).where("kind", kind).curve("coord", "value", "");
            for (std::size_t i = 0; i < g.size(); ++i) EXPECT_NEAR(g.y[i], interpolate(o, g.x[i]), 0.0186);  // largest known: v, Re 1000
        }
}

TEST("the cube's lid moves at 1, its walls rest, and it is slower than the plane cavity") {
    const Table cube = data("cavity_3d/data/cavity3d_albensoeder_kuhlmann2005.csv");
    const Curve u = cube.where("kind", "v").curve("coord", "value", "");
    EXPECT_EQ(u.y.back(), 1);
    EXPECT_EQ(u.x.back(), -0.5);
    EXPECT_EQ(u.y.front(), 0);
    EXPECT_GT(smallest(u), -0.3886);  // the plane cavity's
    EXPECT_NEAR(largest(cube.where("kind", "u").curve("coord", "value", "")), 0.4342, 1e-3);
}

TEST("Taylor-Green DNS: dissipation is the slope of the energy, and peaks at t = 9") {
    const Table dns = data("taylor_green_3d/data/tgv3d_Re1600_spectral512.csv");
    const Curve K = dns.curve("t", "kinetic_energy", ""), eps = dns.curve("t", "minus_dKdt", "");
    for (std::size_t i = 1; i + 1 < K.size(); ++i)  // central difference: dt^2/6 K''' = 4e-4 * 1e-2
        EXPECT_NEAR(-(K.y[i + 1] - K.y[i - 1]) / (K.x[i + 1] - K.x[i - 1]), eps.y[i], 2e-5) << K.x[i];
    EXPECT_NEAR(largest(eps), 1.2858e-2, 1e-5);
}

TEST("the collapsing columns start at Z = 1 = H, fronts advance and heights fall") {
    for (const auto& [file, x, y] : {std::tuple{"dam_break_martin_moyce/data/martin_moyce1952_n2eq2_front.csv", "T", "Z"},
                                     std::tuple{"dam_break_martin_moyce/data/martin_moyce1952_n2eq2_height.csv", "tau", "H"}}) {
        const Curve c = data(file).curve(x, y, "");
        EXPECT_TRUE(std::is_sorted(c.x.begin(), c.x.end()));
        EXPECT_TRUE(std::is_sorted(c.y.begin(), c.y.end()) || std::is_sorted(c.y.rbegin(), c.y.rend()));
    }
    const Table ko = data("dam_break_koshizuka_oka/data/koshizuka_oka1996.csv");
    EXPECT_EQ(ko.where("series", "exp").number(0, "Z"), 1);
    EXPECT_EQ(data("dam_break_martin_moyce/data/martin_moyce1952_n2eq2_height.csv").number(0, "H"), 1);
}

TEST("heated cavity: de Vahl Davis and the own solve agree within 0.1%") {
    const Table t = data("heated_cavity/data/heated_cavity_devahldavis1983.csv");
    for (const std::string Ra : {"1e3", "1e4"}) {
        const Table rows = t.where("Ra", Ra);
        ASSERT_EQ(rows.rows.size(), 2u);
        EXPECT_NEAR(rows.number(0, "Nu_mean") / rows.number(1, "Nu_mean"), 1, 1e-3);
    }
}

}  // namespace published_tests
