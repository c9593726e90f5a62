// Open sides: what leaves through each is counted, and x and z are treated alike where columns are no squares.
#include "support/test.hpp"
#include "unit/heightfield/support.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sides_tests {

using namespace weir;

namespace {

real value(const Solver& solver, const std::string& name) {
    for (const auto& i : solver.integrals())
        if (i.name == name) return i.value;
    return std::nan("");
}

/// A hill of water beside the open sides, in columns of 0.05 m by 0.1 m, or with x and z exchanged.
std::unique_ptr<Solver> hill(const std::string& model, const std::string& sides, bool exchanged) {
    return test::height_solver(scene::parse(
        fmt::format("solver = \"heightfield\"\ndim = 3\ngrid.cells = {}\ngrid.size = {}\ntime = {{ end = 1.0, dt = 0.01 }}\n"
                    "effects.gravity.g = [0.0, -9.81, 0.0]\ninitial.surface = \"0.2 + 0.05*exp(-20*(({} - 0.8)^2 + ({} - 1.0)^2))\"\n"
                    "scheme.model = \"{}\"\n{}\n",
                    exchanged ? "[12, 1, 20]" : "[20, 1, 12]", exchanged ? "[1.2, 1.0, 1.0]" : "[1.0, 1.0, 1.2]", exchanged ? "z" : "x",
                    exchanged ? "x" : "z", model, sides),
        "hill.toml", {heightfield::kind().schema}));
}

}  // namespace

TEST("what leaves through any open side is counted: volume is what there was and what came, to round-off") {
    for (const std::string model : {"shallow_water", "columns"})
        for (const std::string side : {"x_min", "x_max", "z_min", "z_max"}) {
            const auto solver = hill(model, "sides." + side + " = \"open\"", false);
            const real before = value(*solver, "volume");
            for (int i = 0; i < 60; ++i) solver->step(0.01);
            EXPECT_GT(std::abs(value(*solver, "volume") - before), 1e-5) << model << ' ' << side;  // of 0.24 m3: something left
            EXPECT_NEAR(value(*solver, "volume"), before + value(*solver, "poured_volume"), 1e-12 * before) << model << ' ' << side;
        }
}

TEST("a depth that is edited adds the area of its column times its rise to the poured volume, in columns that are not squares") {
    for (const std::string model : {"shallow_water", "columns"})
        for (const bool exchanged : {false, true}) {
            const auto solver = hill(model, "", exchanged);
            for (int i = 0; i < 5; ++i) solver->step(0.01);
            const real before = value(*solver, "volume");
            const std::vector<EditableField> fields = solver->editable();
            const auto edit =
                std::find_if(fields.begin(), fields.end(), [&](const EditableField& f) { return f.data.size() == 1; });  // not the velocity
            ASSERT_NE(edit, fields.end()) << model;
            edit->data[0][25] += 0.01;
            solver->edited(*edit);
            const real net_inflow = 0.01 * 0.05 * 0.1;
            EXPECT_NEAR(value(*solver, "volume"), before + net_inflow, 1e-13) << model << exchanged;  // of 0.24 m3
            EXPECT_NEAR(value(*solver, "poured_volume"), net_inflow, 1e-13) << model << exchanged;
        }
}

TEST("with x and z exchanged the water moves as before, beside open sides and in columns that are no squares") {
    // Sums along the two axes are taken in another order: round-off, that 40 steps do not let grow beyond some thousand units.
    for (const std::string model : {"shallow_water", "columns"}) {
        const auto plain = hill(model, "sides = { x_max = \"open\", z_max = \"open\" }", false);
        const auto turned = hill(model, "sides = { x_max = \"open\", z_max = \"open\" }", true);
        for (int i = 0; i < 40; ++i) plain->step(0.01), turned->step(0.01);
        const auto a = plain->fields().find("", surface_height_name)->data[0], b = turned->fields().find("", surface_height_name)->data[0];
        ASSERT_EQ(a.size(), b.size());
        real apart = 0, moved = 0;
        for (std::size_t z = 0; z < 12; ++z)
            for (std::size_t x = 0; x < 20; ++x) {
                apart = std::max(apart, std::abs(a[x + 20 * z] - b[z + 12 * x]));
                moved = std::max(moved, std::abs(a[x + 20 * z] - 0.2));
            }
        EXPECT_LT(apart, 1e-12) << model;
        EXPECT_GT(moved, 1e-3) << model;
    }
}

}  // namespace sides_tests
