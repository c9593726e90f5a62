// The fast path against the plain double-precision reference over all pairs, for every kernel and every instruction set that this machine
// runs; and equality to the last bit for any number of threads.
#include "particles/reference.hpp"
#include "unit/pbf/scenes.hpp"

#include "support/test.hpp"

#include <random>

using namespace weir;
using particles::Point;

namespace {

const char* const kernels[] = {"muller", "cubic", "wendland"};

/// Shakes the particles by up to a fifth of a spacing and squeezes them downwards, so that constraints act everywhere.
template <int D>
void disturb(particles::Fluid<D>& fluid) {
    std::mt19937 random(7);
    std::uniform_real_distribution<real> jitter(-0.2, 0.2);
    for (int i = 0; i < fluid.count(); ++i) {
        Vec<D> x = fluid.position(i), u{};
        for (int a = 0; a < D; ++a) x[a] += fluid.domain.spacing * jitter(random), u[a] = jitter(random);
        x[1] *= 0.97;
        particles::Fluid<D>::put(fluid.x, i, fluid.domain.kept(x));
        particles::Fluid<D>::put(fluid.v, i, u);
    }
}

/// The same step by the reference: predict, iterate over all pairs in double precision.
template <int D>
struct Expected {
    std::vector<Point> x;
    real largest_lambda = 0, largest_move = 0;

    Expected(const pbf::PbfSolver<D>& solver, const particles::Fluid<D>& before, real dt) {
        const auto& o = solver.options();
        const real d = before.domain.spacing;
        particles::ReferencePbf reference;
        reference.p = pbf::pbf_params<particles::plain::PbfParams, D>(o, d);
        reference.walls =
            before.domain.template walls<particles::plain::WallParams>(pbf::density_kernel<D>(o, d), pbf::gradient_kernel<D>(o, d));
        reference.kernel = static_cast<int>(o.smoothing);
        for (int i = 0; i < before.count(); ++i) {
            Vec<D> u = before.velocity(i);
            u[1] -= dt * 9.81;
            const Vec<D> local = before.domain.kept(before.position(i) + dt * u) - before.domain.centre();
            Point p{0, 0, 0};
            for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] = local[a];
            x.push_back(p);
        }
        const auto start = x;
        reference.find_neighbours(x);
        std::vector<double> sums(x.size(), 0.0);
        for (int iteration = 0; iteration < o.iterations; ++iteration) {
            const auto lambda = reference.lambdas(x, o.warm_start > 0 ? &sums : nullptr);
            for (const real l : lambda) largest_lambda = std::max(largest_lambda, std::abs(l));
            x = reference.corrected(x, lambda);
        }
        for (std::size_t i = 0; i < x.size(); ++i) largest_move = std::max(largest_move, std::abs(x[i][1] - start[i][1]));
        for (auto& p : x)
            for (int a = 0; a < D; ++a) p[static_cast<std::size_t>(a)] += before.domain.centre()[a];
    }
};

}  // namespace

TEST_IN_2D_AND_3D("every instruction set agrees with the double reference to 1e-5 of the support after one step") {
    for (const auto* table : particles::available_passes())
        for (const char* kernel : kernels) {
            const double warm = kernel == kernels[0] ? 0 : 0.8;  // the paper's iteration, and the one that keeps its multipliers
            const std::string scheme =
                fmt::format("iterations = 4, kernel = \"{}\", isa = \"{}\", warm_start = {}, settle = 0", kernel, table->name, warm);
            auto solver = test::pbf_solver<D>(test::pbf_scene<D>(test::box<D>(1, 1, 1), scheme));
            disturb(solver->fluid());
            const auto before = solver->fluid();
            const Expected<D> expected(*solver, before, 0.008);
            const real h = solver->options().support * before.domain.spacing;
            // a mass counted twice once made every lambda zero, and all variants agreed: so the thing tested must be there
            EXPECT_GT(expected.largest_lambda, 1e-4 * h * h);
            EXPECT_GT(expected.largest_move, 1e-2 * h);
            solver->step(0.008);
            real worst = 0;
            for (int i = 0; i < before.count(); ++i)
                for (int a = 0; a < D; ++a)
                    worst = std::max(worst, std::abs(solver->fluid().position(i)[a] -
                                                     expected.x[static_cast<std::size_t>(i)][static_cast<std::size_t>(a)]));
            EXPECT_LE(worst, 1e-5 * h) << table->name << " " << kernel;
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
