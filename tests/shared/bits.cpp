// Lanes of every width that have a fused product and sum, and devices that have it, compute the same bits: one text, one order of
// neighbours, no rounding that a compiler or a processor may choose.
#include "particles/threads/isa.hpp"
#include "pbf/device_solver.hpp"
#include "pbf/solver.hpp"
#include "shared/device.hpp"
#include "shared/pbf_reference.hpp"
#include "shared/sph_reference.hpp"
#include "sph/device_solver.hpp"
#include "sph/solver.hpp"

#include "support/test.hpp"

#include <algorithm>

namespace {

using namespace weir;
using particles::Fluid;

/// The backends of this machine that should agree to the bit.
std::vector<std::string> backends() {
    std::vector<std::string> list;
    for (const auto* table : particles::available_passes())
        if (std::string(table->name) != "sse2") list.push_back(std::string("threads:") + table->name);
    const auto devices = backend::devices();
    if (!devices.empty() && devices.front().same_bits) list.push_back("opencl");
    return list;
}
#define NEEDS_TWO_BACKENDS \
    if (backends().size() < 2) GTEST_SKIP() << "no second backend with fused product and sum here; no OpenCL device here"

/// Runs `steps` of the scene on a backend; `change` acts on the first state.
template <int D, class Threads, class Device, class MakeScene, class Change>
Fluid<D> after(const std::string& backend, int steps, real dt, MakeScene&& scene, Change&& change) {
    const auto run = [&](auto&& solver) {
        change(solver.fluid());
        for (int s = 0; s < steps; ++s) solver.step(dt);
        return Fluid<D>(solver.fluid());
    };
    return backend == "opencl" ? run(Device(scene(backend))) : run(Threads(scene(backend)));
}

/// Runs on every backend, each compared with the first.
template <int D, class Run>
void agree(const std::string& what, Run&& run) {
    const auto list = backends();
    const Fluid<D> a = run(list.front());
    for (std::size_t k = 1; k < list.size(); ++k) {
        const Fluid<D> b = run(list[k]);
        const std::string names = list.front() + " and " + list[k] + ": " + what;
        EXPECT_EQ(a.id, b.id) << names;
        int differ = 0;
        real worst = 0;
        for (int i = 0; i < a.count(); ++i) {
            const auto at = static_cast<std::size_t>(i);
            const real apart = norm(a.position(i) - b.position(i)) + norm(a.velocity(i) - b.velocity(i));
            differ += apart != 0 || a.density[at] != b.density[at];
            worst = std::max(worst, apart);
        }
        EXPECT_EQ(differ, 0) << "of " << a.count() << " particles, by up to " << worst << ", " << names;
    }
}

}  // namespace

TEST("ten steps of cases/dam_break_particles, at its own size, are the same to the last bit on every backend") {
    NEEDS_TWO_BACKENDS;
    const auto read = [](const std::string& on) {
        return scene::read(WEIR_SOURCE_DIR "/cases/dam_break_particles", {pbf::kind().schema}, {{"scheme.backend", "\"" + on + "\""}});
    };
    agree<3>("dam_break_particles", [&](const std::string& on) {
        const Fluid<3> fluid = after<3, pbf::PbfSolver<3>, pbf::DevicePbfSolver<3>>(on, 10, 0.002, read, [](auto&) {});
        EXPECT_EQ(fluid.count(), 32768);
        return fluid;
    });
}

TEST_IN_2D_AND_3D("PBF is the same to the last bit on every backend, with every kernel and every effect") {
    NEEDS_TWO_BACKENDS;
    const std::string all = fmt::format(
        "effects.xsph = {{ c = 0.2 }}\neffects.vorticity = {{ epsilon = 0.2 }}\neffects.central_force = {{ omega = 5.0, centre = {} }}",
        D == 2 ? "[0.5, 0.75]" : "[0.5, 0.75, 0.5]");
    const std::pair<const char*, std::string> scenes[] = {
        {"kernel = \"muller\", warm_start = 0", "effects.artificial_pressure = { k = 0.01 }"},
        {"kernel = \"cubic\"", all},
        {"kernel = \"wendland\"", ""}};
    for (const auto& [scheme, effects] : scenes) {
        const auto scene = [&, scheme = scheme, effects = effects](const std::string& on) {
            return test::pbf_scene<D>(test::box<D>(0.75, 1, 1), fmt::format("backend = \"{}\", settle = 0, {}", on, scheme), effects);
        };
        agree<D>(scheme, [&](const std::string& on) {
            return after<D, pbf::PbfSolver<D>, pbf::DevicePbfSolver<D>>(on, 20, 0.004, scene, test::disturb<D>);
        });
    }
}

TEST_IN_2D_AND_3D("SPH is the same to the last bit on every backend, with every kernel and every term") {
    NEEDS_TWO_BACKENDS;
    auto physics = test::all_physics<D>();
    physics.push_back({"density = \"summation\", state = \"tait\"", "effects.xsph = { c = 0.3 }\neffects.vorticity = { epsilon = 1.0 }"});
    const char* kernels[] = {"muller", "cubic", "wendland", "wendland"};
    for (std::size_t k = 0; k < physics.size(); ++k) {
        const auto scene = [&](const std::string& on) {
            const std::string scheme =
                fmt::format("backend = \"{}\", support = 2.0, sound_speed = 10, kernel = \"{}\", {}", on, kernels[k], physics[k].scheme);
            return test::sph_scene<D>(scheme, physics[k].effects);
        };
        agree<D>(physics[k].effects, [&](const std::string& on) {
            return after<D, sph::SphSolver<D>, sph::DeviceSphSolver<D>>(on, 20, 0.001, scene,
                                                                        [](Fluid<D>& fluid) { test::shake(fluid, 0.1); });
        });
    }
}

// Sums over the particles beside a body are the host's on every backend, in one order.
TEST_IN_2D_AND_3D("bodies among particles are the same to the last bit on every backend, and go on from another's checkpoint") {
    NEEDS_TWO_BACKENDS;
    const char* at = D == 2 ? "0.5, 0.9" : "0.5, 0.9, 0.5";
    const std::string bodies = fmt::format(
        "bodies = [ {{ shape = \"sphere\", centre = [{0}], radius = 0.2, density = 200.0, spin = [{1}] }},\n"
        "           {{ shape = \"box\", min = [{2}], max = [{3}], density = 1500.0, slip = \"SLIP\", friction = 0.3 }} ]\n"
        "joints = [ {{ kind = \"mooring\", body = \"0\", at = [{0}], anchor = [{4}], length = 0.7, stiffness = 3000.0, damping = 10.0 }} "
        "]\n",
        at, D == 2 ? "1.0" : "1.0, 2.0, 3.0", D == 2 ? "0.3, 0.05" : "0.3, 0.05, 0.3", D == 2 ? "0.6, 0.3" : "0.6, 0.3, 0.7",
        D == 2 ? "0.2, 0.0" : "0.2, 0.0, 0.5");
    const auto solver = [&](bool sph, const std::string& on) -> std::unique_ptr<Solver> {
        std::string all = bodies;
        all.replace(all.find("SLIP"), 4, sph ? "no" : "free");
        const std::string scheme = "backend = \"" + on + "\"";
        if (!sph) return pbf::kind().make(test::pbf_scene<D>(test::box<D>(1, 1, 1), scheme, all), {});
        return sph::kind().make(test::sph_scene<D>(scheme + ", sound_speed = 20",
                                                   all + "effects.viscosity = {}\neffects.density_diffusion = {}\neffects.gravity.g = " +
                                                       (D == 2 ? "[0, -9.81]\n" : "[0, -9.81, 0]\n")),
                                {});
    };
    const auto expect_same = [](const Solver& one, const Solver& two, const std::string& what) {
        const FieldSet a = one.fields(), b = two.fields();
        for (std::size_t f = 0; f < a.fields.size(); ++f)
            for (std::size_t c = 0; c < a.fields[f].data.size(); ++c)
                EXPECT_TRUE(std::ranges::equal(a.fields[f].data[c], b.fields[f].data[c]))
                    << a.fields[f].set << ' ' << a.fields[f].name << what;
    };
    for (const bool sph : {false, true}) {
        const auto list = backends();
        const real dt = sph ? 0.001 : 0.004;
        const auto first = solver(sph, list.front());
        const auto lowest = first->fields().find("bodies", "position")->data[1][1];
        Checkpoint middle;
        for (int s = 0; s < 30; ++s) {
            if (s == 20) first->save(middle);
            first->step(dt);
        }
        EXPECT_LT(first->fields().find("bodies", "position")->data[1][1], lowest);
        for (std::size_t k = 1; k < list.size(); ++k) {
            const std::string names = list.front() + " and " + list[k] + (sph ? ", SPH" : ", PBF");
            const auto other = solver(sph, list[k]), later = solver(sph, list[k]);
            for (int s = 0; s < 30; ++s) other->step(dt);
            expect_same(*first, *other, names);
            later->restore(middle);
            for (int s = 20; s < 30; ++s) later->step(dt);
            expect_same(*first, *later, names + ", restored");
        }
    }
}
