// What enthalpy means to particles, and the sums over a lattice by which conduction is divided.
#include "particles/heat.hpp"
#include "matter/substance.hpp"
#include "support/test.hpp"

namespace weir {
namespace {

using particles::LatticeSums;
using particles::Smoothing;
using thermo::State;

template <int D>
LatticeSums sums(Smoothing kernel, real support, real spacing) {
    particles::Scheme scheme;
    scheme.smoothing = kernel, scheme.support = support;
    return particles::lattice_sums<D>(scheme, spacing);
}

TEST("the moment of a lattice is that of the published sums, whatever the spacing") {
    struct Row {
        int dim;
        Smoothing kernel;
        real support, moment;
    };
    // sum V (-W'/r) x^2 to the digits of 16_sph_conduction_lattice
    for (const Row& row :
         {Row{2, Smoothing::cubic, 2, 1.013099}, Row{2, Smoothing::cubic, 3, 1.006725}, Row{2, Smoothing::wendland, 2, 0.976231},
          Row{2, Smoothing::wendland, 3, 0.997399}, Row{2, Smoothing::muller, 2, 0.886462}, Row{2, Smoothing::muller, 4, 0.985020},
          Row{3, Smoothing::cubic, 2, 1.020042}, Row{3, Smoothing::cubic, 2.6, 0.993484}, Row{3, Smoothing::wendland, 4, 0.999413},
          Row{3, Smoothing::muller, 2, 0.956289}})
        for (const real spacing : {1.0, 0.013}) {
            const auto ours = row.dim == 2 ? sums<2>(row.kernel, row.support, spacing) : sums<3>(row.kernel, row.support, spacing);
            EXPECT_NEAR(ours.moment, row.moment, 1e-6) << row.dim << ' ' << row.support;
        }
}

/// A step of conduction on a lattice is stable up to 2 over the largest eigenvalue; the diagonal's inverse is never longer.
TEST("the step in which no particle of a lattice becomes warmer than its neighbours is one that is stable") {
    struct Row {
        int dim;
        Smoothing kernel;
        real support, most;
    };
    for (const Row& row :
         {Row{2, Smoothing::cubic, 2, 0.36652}, Row{2, Smoothing::wendland, 3, 0.68992}, Row{2, Smoothing::muller, 4, 1.09846},
          Row{3, Smoothing::cubic, 2, 0.33078}, Row{3, Smoothing::wendland, 4, 1.15025}}) {
        const auto ours = row.dim == 2 ? sums<2>(row.kernel, row.support, 1) : sums<3>(row.kernel, row.support, 1);
        EXPECT_LT(1 / ours.diagonal, row.most * ours.moment);
        EXPECT_GT(1 / ours.diagonal, 0.4 * row.most * ours.moment);
    }
}

TEST("temperatures and shares are those of the substance's curve, through both latent heats and back") {
    const auto water = thermo::water();
    for (const real p : {2e4, 101325.0, 5e5}) {
        const auto curve = water->heat_curve(p);
        const auto states = particles::heat_states(curve, {2.2, 0.6, 0.025});
        for (real h = -4e5; h < 4e6; h += 12345.6) {
            const auto warmth = curve.warmth(h);
            EXPECT_NEAR(particles::heat_temperature(h, 0, &states), warmth.T, 1e-12 * warmth.T);
            EXPECT_NEAR(1 - particles::heat_melted(h, &states), curve.share(State::solid, warmth), 1e-12);
            EXPECT_NEAR(particles::heat_vapour(h, 0, &states), curve.share(State::vapour, warmth), 1e-12);
        }
        // Kirchhoff's integral of the conductivity
        const real T = curve.begins_at(1), boils = curve.begins_at(2);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(T - 20), 0, &states), -20 * 2.2, 1e-9);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(T + 20), 0, &states), 20 * 0.6, 1e-9);
        EXPECT_NEAR(particles::heat_theta(curve.enthalpy(boils + 20), 0, &states), (boils - T) * 0.6 + 20 * 0.025, 1e-9);
        EXPECT_EQ(particles::heat_theta(0.5 * (curve.highest(0) + curve.lowest(1)), 0, &states), 0);  // ice and water together
    }
}

}  // namespace
}  // namespace weir
