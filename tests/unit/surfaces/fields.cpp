// The fields whose zero is the surface: the fast ones against their definition, and what the definition says of liquids at rest.
#include "liquids.hpp"
#include "support/test.hpp"
#include "surfaces/reference.hpp"

namespace fields_tests {

using namespace weir;
using namespace weir::test;

namespace {

std::vector<Vec<3>> positions(const Liquid& liquid) {
    std::vector<Vec<3>> list;
    for (std::size_t i = 0; i < liquid.x[0].size(); ++i) list.push_back({{liquid.x[0][i], liquid.x[1][i], liquid.x[2][i]}});
    return list;
}

/// Samples around the liquid, a spacing apart by `cell`.
Samples lattice(int domain, real cell) {
    Samples samples;
    for (std::size_t a = 0; a < 3; ++a) {
        samples.n[a] = static_cast<int>(domain / cell);
        samples.first[a] = 0.31 * cell;
        samples.spacing[a] = cell;
    }
    return samples;
}

void compute(ParticleField& field, const Cloud& cloud, Samples& samples) {
    samples.make_room();
    const CloudExtent all = extent_of(cloud);
    field.lay(all.box, all.count, cloud.spacing, samples);
    field.compute(cloud, samples);
}

void compare(Method method, const Liquid& liquid, real cell) {
    Cloud cloud;
    cloud.spacing = 1, cloud.x = liquid.x, cloud.own = liquid.count();
    Samples samples = lattice(liquid.domain, cell);
    ParticleField field(method);
    compute(field, cloud, samples);
    const ReferenceField exact(method, positions(liquid));
    int compared = 0;
    real worst = 0;
    for (int k = 0; k < samples.n[2]; ++k)
        for (int j = 0; j < samples.n[1]; ++j)
            for (int i = 0; i < samples.n[0]; ++i) {
                const real fast = real(samples(i, j, k));
                const real slow = std::clamp(exact.depth(samples.position(i, j, k)), -1.0, 1.0);
                // Coordinates of up to 24 spacings are good to 2^-24 of that, 1.4e-6, and a value is a sum of up to 110 terms of slope 1 at
                // most, of which roundings of 6e-8 add up: 2e-5. A profile turns a value into a depth with a slope of up to 10 where
                // kernels end.
                worst = std::max(worst, std::abs(fast - slow));
                compared += std::abs(slow) < 1;
            }
    EXPECT_LT(worst, 2e-4) << static_cast<int>(method) << ", cell " << cell;
    EXPECT_GT(compared, 500);  // there is a surface
}

}  // namespace

TEST("the fast fields are those that are defined in double precision") {
    const Liquid drop = fill(
        24,
        [](const Vec<3>& x) {
            return norm(x - Vec<3>{{12, 12, 12}}) < 6;
        },
        0.25);
    for (const Method method : of_particles) compare(method, drop, 1), compare(method, drop, 0.4);
}

TEST("so they are for sprays, of which hardly a particle has neighbours enough") {
    const Liquid drops = spray(24, 300, 5);
    for (const Method method : of_particles) compare(method, drops, 1);
}

TEST("what is not computed deep in a liquid is inside") {
    const Liquid block = fill(
        48, [](const Vec<3>& x) { return x[0] > 2 && x[0] < 46 && x[1] > 2 && x[1] < 46 && x[2] > 2 && x[2] < 46; }, 0.25);
    Cloud cloud;
    cloud.spacing = 1, cloud.x = block.x, cloud.own = block.count();
    for (const Method method : of_particles) {
        Samples samples = lattice(48, 1);
        ParticleField field(method);
        compute(field, cloud, samples);
        EXPECT_LT(field.computed(), 48 * 48 * 48);  // there are such blocks
        for (int k = 12; k < 36; k += 4)
            for (int j = 12; j < 36; j += 4)
                for (int i = 12; i < 36; i += 4) EXPECT_GT(samples(i, j, k), 0.0F);
    }
}

TEST("a particle of a plane surface stays, and a profile tells the depth below a plane") {
    // the mean of a lattice's half ball of three spacings, weighted by 1 - (d/3)^3: where the stretched kernels leave their particles
    real weight = 0, sum = 0;
    for (int k = -3; k <= 3; ++k)
        for (int j = 0; j <= 3; ++j)
            for (int i = -3; i <= 3; ++i) {
                const real r = std::sqrt(real(i * i + j * j + k * k)) / 3;
                if (r < 1) weight += 1 - r * r * r, sum += (1 - r * r * r) * j;
            }
    EXPECT_NEAR(sum / weight, mean_of_plane, 1e-4);  // as many digits as are written down
    for (const Method method : of_particles) {
        std::vector<Vec<3>> half;
        for (int k = -8; k <= 8; ++k)
            for (int j = 0; j < 8; ++j)
                for (int i = -8; i <= 8; ++i) half.push_back({{real(i), -0.5 - j, real(k)}});
        const ReferenceField field(method, half);
        for (const real depth : {-0.25, 0.0, 0.25}) {
            real mean = 0;
            for (int k = 0; k < 4; ++k)
                for (int i = 0; i < 4; ++i) mean += field.value({{(i + 0.5) / 4, -depth, (k + 0.5) / 4}}) / 16;
            EXPECT_NEAR(profile_of(method, false).depth(mean), depth, 1e-3);  // 512 linear pieces of a smooth curve
        }
    }
}

}  // namespace fields_tests
