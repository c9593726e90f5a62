// Pockets of liquid that walls close in: what a wall sweeps into them is spread over them, and the rest of the liquid does not know.
#include "tallcell/pockets.hpp"

#include "support.hpp"

namespace weir::test::pockets_tests {
namespace {

/// Deep water with a box of liquid 3 cells wide and 8 high in a shell of solid cells, on the floor or above it.
template <int D>
struct BoxInWater : Basin<D> {
    Index<D> low, high;
    explicit BoxInWater(int row) : Basin<D>(cells(), 0) {
        low = Index<D>::constant(2), high = Index<D>::constant(5);
        low[1] = row, high[1] = row + 8;
        for_each_cell(this->frame.cells, [&](const Index<D>& I) {
            bool shell = true;
            for (int a = 0; a < D; ++a) shell = shell && I[a] >= low[a] - 1 && I[a] <= high[a];
            this->closed(I) = shell && !is_inside(I);
        });
    }
    static Index<D> cells() {
        Index<D> n = Index<D>::constant(7);
        n[1] = 40;
        return n;
    }
    bool is_inside(const Index<D>& I) const {
        bool inside = true;
        for (int a = 0; a < D; ++a) inside = inside && I[a] >= low[a] && I[a] < high[a];
        return inside;
    }
    /// The wall at the upper end of x moves inwards, at every face.
    void push(real speed) {
        Index<D> lo = low;
        Extent<D> hi(high);
        lo[0] = high[0], hi[0] = high[0] + 1;
        for_each_in(lo, hi, [&](const Index<D>& I) { this->state.u[0](I) = -speed; });
    }
};

TEST_IN_2D_AND_3D("what a wall sweeps into a pocket is spread evenly over its rows, and comes into no other liquid") {
    for (const int row : {0, 1, 9})
        for (const int longest : {1, 5}) {
            BoxInWater<D> box(row);
            TallPressure<D> tall(box.frame, 1, poisson::Options{.tolerance = 1e-12});
            tall.set_surface(box.phi, box.closed, box.state, any_knots<D>(box, longest));
            box.stir();
            box.push(0.5);
            tall.restrict_velocity(box.state);
            const poisson::Report report = tall.project(box.phi, box.state, 0.1, true);
            EXPECT_TRUE(report.converged);
            std::vector<real> b(static_cast<std::size_t>(tall.knots().count()));
            tall.weak_divergence(box.state, b);
            const real rate = 0.5 / (3 * box.frame.h[0]);  // of compression: a face of each row, over three cells
            real in_pocket = 0;
            for (int c = 0; c < tall.layout().columns(); ++c)
                for (int k = tall.knots().start[static_cast<std::size_t>(c)]; k < tall.knots().start[static_cast<std::size_t>(c) + 1];
                     ++k) {
                    const auto i = static_cast<std::size_t>(k);
                    Index<D> I = tall.layout().foot(c);
                    I[1] = tall.knots().row[i];
                    const int above = tall.knots().length[i], under = k > 0 ? tall.knots().length[i - 1] : 0;
                    const real rows = 1 + 0.5 * (std::max(above - 1, 0) + std::max(under - 1, 0));
                    const real wanted = box.is_inside(I) ? rate * rows : 0;
                    in_pocket += box.is_inside(I) ? rows : 0;
                    // The tolerance, of speeds of 1 over cells of 0.25 m in some thousand cells
                    ASSERT_NEAR(b[i], wanted, 1e-9) << row << " " << longest << " " << I[0] << " " << I[1];
                }
            EXPECT_NEAR(in_pocket, D == 2 ? 24 : 72, 1e-12);
        }
}

TEST_IN_2D_AND_3D("pockets change nothing where there is none, to the last bit") {
    Basin<D> basin(D == 2 ? Index<D>{12, 40} : Index<D>(BoxInWater<D>::cells()), 3), same = basin;
    TallPressure<D> tall(basin.frame, 1, {}), asked(basin.frame, 1, {});
    tall.set_surface(basin.phi, basin.closed, basin.state, any_knots(basin, 5));
    asked.set_surface(same.phi, same.closed, same.state, any_knots(same, 5));
    basin.stir(), same.stir();
    tall.restrict_velocity(basin.state), asked.restrict_velocity(same.state);
    tall.project(basin.phi, basin.state, 0.1), asked.project(same.phi, same.state, 0.1, true);
    EXPECT_EQ(tall.potential(), asked.potential());
}

}  // namespace
}  // namespace weir::test::pockets_tests
