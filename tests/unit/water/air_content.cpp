// The bookkeeping of enclosed air alone: what pockets contain where they merge, split, open, close and appear.
#include "water/air_pockets.hpp"

#include "support.hpp"

#include <cmath>

namespace air_content_tests {

using namespace weir;
using namespace weir::test;
using poisson::Cell;

namespace {

/// A box of 8 by 12 (by 4) cells whose cells are air or liquid as drawn by a predicate, for the bookkeeping of pockets alone.
template <int D>
struct Drawn {
    water::MacState<D> state;
    water::Frame<D> frame;
    water::LevelSet<D> surface;
    Grid<std::uint8_t, D> closed;
    Grid<real, D> part;
    Drawn()
        : state(water_scene(fmt::format("solver = \"mac_water\"\ndim = {}\ngrid = {{ cells = {}, size = {} }}\ntime.end = 1.0\n"
                                        "fluid.density = 1000.0\nliquid = [ {{ shape = \"box\", min = {}, max = {} }} ]\n",
                                        D, list({"8", "12", "4"}, D), list({"8.0", "12.0", "4.0"}, D), list({"0.0", "0.0", "0.0"}, D),
                                        list({"1.0", "1.0", "1.0"}, D))),
                FieldPlan{}),
          frame(state.u, state.sides),
          surface(frame, 1),
          part(frame.cells) {}
    template <class F>
    void draw(F&& is_air) {
        for_each_cell(frame.cells, [&](const Index<D>& I) {
            const bool air = is_air(I);
            state.cells(I) = air ? Cell::air : Cell::fluid;
            part(I) = air ? 0 : 1;
            surface.phi(I) = air ? 0.5 : -0.5;
        });
    }
};

}  // namespace

// A pocket of two cells across has no law of its own: its pressure is that of the liquid before.
TEST_IN_2D_AND_3D("a pocket that is not resolved has the pressure of the liquid") {
    Drawn<D> box;
    water::AirPockets<D> pockets(box.frame, water::GasLaw{100000, 1.4}, box.surface, box.closed, &box.part);
    box.draw([](const Index<D>&) { return false; });
    pockets.find(box.state);
    box.state.p.fill(5000);
    box.draw([](const Index<D>& I) { return (I[0] == 2 || I[0] == 3) && (I[1] == 2 || I[1] == 3) && I[D - 1] < 4; });
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 1);
    EXPECT_FALSE(pockets.pockets()[0].resolved);
    EXPECT_NEAR(pockets.pockets()[0].pressure, 105000, 1e-8);
}

// The volume of a small part follows the error of the volume fractions beside it. It must neither make nor destroy gas.
TEST_IN_2D_AND_3D("a part too small for the law gives back, when it merges, the content with which it left") {
    Drawn<D> box;
    water::AirPockets<D> pockets(box.frame, water::GasLaw{100000, 1.4}, box.surface, box.closed, &box.part);
    const auto whole = [](const Index<D>& I) { return I[0] < 7 && I[1] < 10; };
    // as large as `cells`, behind a wall of liquid in the corner
    const auto apart = [&](int cells) {
        return [=](const Index<D>& I) {
            const bool small = I[0] < cells && I[1] < 2 && I[D - 1] < 2;
            return small || (whole(I) && !(I[0] <= cells && I[1] <= 2 && I[D - 1] <= 2));
        };
    };
    box.draw(whole);
    pockets.find(box.state);
    for (const int cells : {2, 3, 1}) {
        box.draw(apart(cells));
        pockets.find(box.state);
        ASSERT_EQ(pockets.pockets().size(), 2);
        EXPECT_NE(pockets.pockets()[0].resolved, pockets.pockets()[1].resolved);
    }
    box.draw(whole);
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 1);
    EXPECT_NEAR(pockets.pockets()[0].pressure, 100000, 1e-8);
}

// p^(1/γ) V adds up: with V1 = V2 the merged pressure is ((p1^(1/γ) + p2^(1/γ)) / 2)^γ.
TEST_IN_2D_AND_3D("pockets that merge add their content, and parts of a split one have its pressure") {
    Drawn<D> box;
    water::AirPockets<D> pockets(box.frame, water::GasLaw{100000, 1.4}, box.surface, box.closed, &box.part);
    box.draw([](const Index<D>& I) { return I[0] != 3 && I[0] < 7; });
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 2);
    const real plane = D == 2 ? 12 : 48;
    EXPECT_NEAR(pockets.pockets()[0].volume, 3 * plane, 1e-12 * plane);
    EXPECT_NEAR(pockets.pockets()[0].pressure, 100000, 1e-8);
    box.draw([](const Index<D>& I) { return I[0] != 3 && I[0] > 1 && I[0] < 7; });  // the first is squeezed to a third
    pockets.find(box.state);
    const real squeezed = 100000 * std::pow(3.0, 1.4);
    ASSERT_EQ(pockets.pockets().size(), 2);
    EXPECT_NEAR(pockets.pockets()[0].pressure, squeezed, 1e-8 * squeezed);
    box.draw([](const Index<D>& I) { return I[0] > 1 && I[0] < 7; });  // 1 plane of the first, 3 of the second, 1 new: 5
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 1);
    const real merged = 100000 * std::pow(6.0 / 5, 1.4);
    EXPECT_NEAR(pockets.pockets()[0].pressure, merged, 1e-8 * merged);
    box.draw([](const Index<D>& I) { return I[0] > 1 && I[0] != 4 && I[0] < 7; });  // 2 of the 4 remaining planes each
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 2);
    const real parted = 100000 * std::pow(6.0 / 4, 1.4);
    for (const auto& pocket : pockets.pockets()) EXPECT_NEAR(pocket.pressure, parted, 1e-8 * parted);
}

TEST_IN_2D_AND_3D("air that reaches an open side is open, and is enclosed at its pressure") {
    Drawn<D> box;
    box.state.sides.side(0, 1).kind = geometry::SideKind::outflow;
    water::AirPockets<D> pockets(box.frame, water::GasLaw{90000, 1.4}, box.surface, box.closed, &box.part);
    box.draw([](const Index<D>& I) { return I[0] > 1; });
    pockets.find(box.state);
    EXPECT_EQ(pockets.pockets().size(), 0);
    EXPECT_TRUE(pockets.has_open_air());
    box.draw([](const Index<D>& I) { return I[0] > 1 && I[0] < 6; });
    pockets.find(box.state);
    ASSERT_EQ(pockets.pockets().size(), 1);
    EXPECT_NEAR(pockets.pockets()[0].pressure, 90000, 1e-8);
    EXPECT_FALSE(pockets.has_open_air());
}

}  // namespace air_content_tests
