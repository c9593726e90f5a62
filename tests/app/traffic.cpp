// What ranks send, counted before a run by forked ranks (validation::count_messages), against what runs have counted: in the steps by which
// one run is longer than another, so that neither beginning nor end counts. (Frames are not compressed: as many bytes at any time.) At ci
// size one scene of each kind of message runs with MPI, which counts for itself; the others on forked ranks.
#include "app/process.hpp"
#include "parallel/communicator.hpp"
#include "sim/registry.hpp"
#include "sim/shares.hpp"
#include "support/size.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "validation/cost/parallel_estimate.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>

namespace weir {
namespace {

using nlohmann::json;

/// Why there are no ranks, as tests/skipped.sh knows reasons; nothing where there are.
std::string no_ranks() {
    if (!WEIR_HAS_MPI) return WEIR_WANTS_MPI ? "built without MPI (Debian: apt-get install libopenmpi-dev)" : "WEIR_MPI is off";
    return std::system("command -v mpirun >/dev/null") == 0 ? "" : "no mpirun (Debian: apt-get install openmpi-bin)";
}

struct Run {
    json log;
    std::vector<std::map<std::string, double>> rows;  // of steps.csv, without empty cells
    std::int64_t sent(const char* what, int rank) const { return log["ranks"][what][static_cast<std::size_t>(rank)].get<std::int64_t>(); }
    std::size_t steps() const { return rows.size(); }
    double value(std::size_t step, const std::string& of) const { return rows[step].contains(of) ? rows[step].at(of) : 0; }
    int iterations(std::size_t step, const char* of = "iterations") const { return static_cast<int>(value(step, of)); }
};

class Runs {
public:
    explicit Runs(std::string scene) : text_(std::move(scene)) { std::ofstream(folder_.path() / "scene.toml") << text_; }

    scene::Scene scene() const { return scene::read(folder_.path() / "scene.toml", sim::schemas()); }

    /// With that number of ranks, of MPI or forked, up to a time [s].
    Run run(int ranks, double end, bool forked) const {
        const auto out = folder_.path() / fmt::format("out-{}-{}", ranks, end);
        const std::string command = fmt::format(
            "bash -c 'source {}/tests/support/mpirun.sh; FORKED={} over {} {} run {} --quiet --threads 1 --out {} --set time.end={}' >{} "
            "2>&1 "
            "</dev/null",
            WEIR_SOURCE_DIR, forked ? "yes" : "", ranks, WEIR_EXECUTABLE, (folder_.path() / "scene.toml").string(), out.string(), end,
            (folder_.path() / "log").string());
        EXPECT_EQ(std::system(command.c_str()), 0) << test::text_of(folder_.path() / "log");
        return {json::parse(test::text_of(out / "run.json"), nullptr, false), test::rows_of(out / "steps.csv")};
    }

private:
    std::string text_;
    test::TemporaryFolder folder_;
};

struct Steps {
    double dt;
    int few, many;
    bool mpi = false;  // at ci size too
};

/// Messages and bytes of every rank, exactly.
void expect_as_counted(const std::string& text, const std::vector<int>& ranks, const Steps& steps) {
    const bool mpi = full_size() || steps.mpi;
    if (const std::string why = no_ranks(); mpi && !why.empty()) GTEST_SKIP() << why;
    const Runs runs(text);
    for (const int n : ranks) {
        if (!full_size() && n != ranks.back()) continue;  // the last has a rank between two cuts, and one at each end as every other number
        const Run few = runs.run(n, steps.few * steps.dt, !mpi), many = runs.run(n, steps.many * steps.dt, !mpi);
        ASSERT_EQ(few.steps(), static_cast<std::size_t>(steps.few));
        ASSERT_EQ(many.steps(), static_cast<std::size_t>(steps.many));
        const auto counted = validation::count_messages(runs.scene(), n, steps.few, steps.many - steps.few).sent;
        for (int rank = 0; rank < n; ++rank) {
            const Traffic sent = counted[static_cast<std::size_t>(rank)].all();
            EXPECT_GT(sent.messages, 0);
            EXPECT_EQ(sent.messages, many.sent("messages", rank) - few.sent("messages", rank)) << "rank " << rank << " of " << n;
            EXPECT_EQ(sent.bytes, many.sent("bytes", rank) - few.sent("bytes", rank)) << "rank " << rank << " of " << n;
        }
    }
}

const std::string stirred =
    "solver = \"mac\"\ndim = 2\ntime = { end = 0.01, max_dt = 1e-4 }\nsides.y_max = { kind = \"outflow\" }\n"
    "initial.velocity = { name = \"random\", speed = 0.3 }\noutput = { every = 1.0, compression = \"none\" }\n";

}  // namespace

TEST("mac: a stirred box with an open side, of one iteration a step, sends what was counted") {
    expect_as_counted(stirred + "grid = { cells = [144, 152], size = [0.045, 0.0475] }\nscheme.poisson.tolerance = 0.3\n", {2, 3},
                      {1e-4, 5, 15});
}

TEST("mac: two iterations on two levels that are cut, and one that is gathered, as counted") {
    expect_as_counted(
        stirred + "grid = { cells = [320, 512], size = [0.1, 0.16] }\nscheme.poisson = { fixed = true, max_iterations = 2 }\n", {2, 3},
        {1e-4, 2, 5});
}

TEST("mac: a closed room in 3D with smoke, heat, buoyancy and confinement sends what was counted") {
    expect_as_counted(
        "solver = \"mac\"\ndim = 3\ngrid = { cells = [28, 30, 26], size = [0.56, 0.6, 0.52] }\ntime = { end = 0.06, max_dt = 1e-3 }\n"
        "effects = { buoyancy = { alpha = 0.1, beta = 0.2, ambient = 293.0 }, confinement = { epsilon = 0.2 } }\n"
        "emitters = [ { shape = \"sphere\", centre = [0.25, 0.15, 0.24], radius = 0.1, smoke = 1.0, temperature = 343.0 } ]\n"
        "scheme.poisson = { fixed = true, max_iterations = 2 }\noutput = { every = 1.0, compression = \"none\" }\n",
        {2, 3}, {1e-3, 3, 8, true});
}

TEST("mac: around a periodic cut axis, and by a method that every rank runs for itself, as counted") {
    expect_as_counted(
        "solver = \"mac\"\ndim = 2\ngrid = { cells = [40, 48], size = [0.4, 0.48] }\ntime = { end = 0.06, max_dt = 1e-3 }\n"
        "sides = { y_min = { kind = \"periodic\" }, y_max = { kind = \"periodic\" } }\n"
        "initial.velocity = { name = \"random\", speed = 0.3 }\nscheme.poisson.method = \"cg_mic0\"\noutput = { every = 1.0, compression = "
        "\"none\" }\n",
        {2, 3}, {1e-3, 2, 6});
}

const std::string pool = "solver = \"mac_water\"\ntime = { end = 0.01, max_dt = 1e-4 }\noutput = { every = 1.0, compression = \"none\" }\n";

TEST("mac_water: a pool at rest sends what was counted, where each rank solves for the pressure") {
    expect_as_counted(pool +
                          "dim = 2\ngrid = { cells = [16, 40], size = [0.16, 0.4] }\n"
                          "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.16, 0.3] } ]\n",
                      {2, 3}, {1e-4, 10, 30});
}

TEST("mac_water: the same in 3D with a shared pressure, for every transfer") {
    for (const char* transfer : {"flip", "apic", "grid"})
        expect_as_counted(pool +
                              "dim = 3\ngrid = { cells = [32, 24, 40], size = [0.32, 0.24, 0.4] }\n"
                              "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.32, 0.16, 0.4] } ]\neffects.gravity = { g = "
                              "[0.0, -9.81, 0.0] }\nscheme.transfer = \"" +
                              std::string(transfer) + "\"\n",
                          std::string(transfer) == "flip" ? std::vector<int>{2, 3} : std::vector<int>{3}, {1e-4, 3, 6});
}

TEST("mac_water: viscous liquid sends what was counted, with its iterations") {
    expect_as_counted(
        pool +
            "dim = 3\ngrid = { cells = [32, 24, 40], size = [0.32, 0.24, 0.4] }\nfluid = { density = 1000.0, viscosity = 0.001 }\n"
            "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.32, 0.16, 0.4] } ]\n"
            "initial.velocity = { name = \"random\", speed = 1e-5 }\neffects.viscosity = {}\n",
        {2, 3}, {1e-4, 3, 6});
}

TEST("two_phase: liquid and gas at rest send what was counted, with a shared pressure and with one that every rank solves") {
    const std::string layers =
        "solver = \"two_phase\"\ntime = { end = 0.01, max_dt = 1e-4 }\nfluid = { density = 1000.0 }\ngas = { density = 1.2 }\n"
        "effects = { gravity = { g = [0.0, -9.81, 0.0] }, surface_tension = { sigma = 0.07 } }\n"
        "scheme.poisson = { fixed = true, max_iterations = 2 }\noutput = { every = 1.0, compression = \"none\" }\n"
        "dim = 3\nliquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.32, 0.12, 0.4] } ]\n";
    expect_as_counted(layers + "grid = { cells = [32, 24, 40], size = [0.32, 0.24, 0.4] }\n", {2, 3}, {1e-4, 3, 6});
    expect_as_counted(layers + "grid = { cells = [16, 12, 20], size = [0.32, 0.24, 0.4] }\n", {3}, {1e-4, 3, 6});
}

TEST("solids that move, an emitter, a sink and probes send what was counted") {
    expect_as_counted(
        pool +
            "dim = 2\ngrid = { cells = [24, 40], size = [0.24, 0.4] }\n"
            "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.24, 0.2] } ]\n"
            "solids = [ { shape = \"sphere\", centre = [0.1, 0.18], radius = 0.04, motion = { kind = \"constant\", velocity = "
            "[0.05, 0.0] } } ]\n"
            "emitters = [ { shape = \"box\", min = [0.16, 0.3], max = [0.2, 0.34], velocity = [0.0, -0.5] } ]\n"
            "probes = [ { name = \"p\", kind = \"point\", field = \"pressure\", at = [0.12, 0.1], every = 1e-4 } ]\n",
        {2, 3}, {1e-4, 4, 10});
}

const std::string still =
    "dim = 2\ngrid = { cells = [16, 40], size = [0.16, 0.4] }\ntime = { end = 0.01, dt = 1e-4 }\n"
    "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.16, 0.34] } ]\noutput = { every = 1.0, compression = \"none\" }\n";

TEST("sph: particles at rest send what was counted, with both ways to find densities") {
    for (const char* density : {"continuity", "summation"})  // slow sound, so that nothing moves as far as that hair
        expect_as_counted(still + "solver = \"sph\"\nscheme = { support = 2.0, sound_speed = 1e-3, density = \"" + density + "\" }\n", {2},
                          {1e-4, 10, 30});
}

TEST("pbf: particles at rest send what was counted") {
    expect_as_counted(still + "solver = \"pbf\"\nscheme = { support = 2.0, iterations = 5, warm_start = 0.0 }\n", {2}, {1e-4, 10, 30});
    expect_as_counted(still + "solver = \"pbf\"\nscheme = { support = 2.0, iterations = 3 }\n", {2, 3}, {1e-4, 10, 30, true});
}

TEST("tallcell: deep water at rest sends what was counted, around the cut axis too, and in 2D nothing but what the run does") {
    const std::string deep =
        "solver = \"tallcell\"\ntime = { end = 0.01, max_dt = 1e-4 }\noutput = { every = 1.0, compression = \"none\" }\n";
    const std::string box = deep +
                            "dim = 3\ngrid = { cells = [18, 48, 26], size = [0.36, 0.96, 0.52] }\n"
                            "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.36, 0.6, 0.52] } ]\n"
                            "effects.gravity = { g = [0.0, -9.81, 0.0] }\n";
    const std::string ring = "sides = { z_min = { kind = \"periodic\" }, z_max = { kind = \"periodic\" } }\n";
    expect_as_counted(box, {2, 3}, {1e-4, 3, 8});
    expect_as_counted(box + ring + "scheme = { columns = \"single\", advection = \"semi_lagrangian\" }\n", {2, 3}, {1e-4, 3, 8});
    expect_as_counted(deep +  // two levels of the pressure that are cut
                          "dim = 3\ngrid = { cells = [64, 32, 64], size = [1.28, 0.64, 1.28] }\nscheme.columns = \"uniform\"\n"
                          "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [1.28, 0.6, 1.28] } ]\n"
                          "effects.gravity = { g = [0.0, -9.81, 0.0] }\n",
                      {2}, {1e-4, 2, 4, true});
    expect_as_counted(deep +
                          "dim = 2\ngrid = { cells = [16, 40], size = [0.16, 0.4] }\n"
                          "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.16, 0.3] } ]\n",
                      {2}, {1e-4, 3, 8});
}

TEST("heightfield: both models send what was counted, with open and periodic sides") {
    const std::string field =
        "solver = \"heightfield\"\ndim = 3\ngrid = { cells = [30, 1, 44], size = [3.0, 1.0, 4.4] }\ntime = { end = 0.3, max_dt = 1e-3 }\n"
        "initial = { surface = \"0.4 + 0.05*sin(2*x)\" }\noutput = { every = 10.0, compression = \"none\" }\n";
    const std::string open = "sides = { x_min = { kind = \"open\" }, z_min = { kind = \"outflow\" }, z_max = { kind = \"open\" } }\n",
                      ring = "sides = { z_min = { kind = \"periodic\" }, z_max = { kind = \"periodic\" } }\n";
    const std::string down = "effects.gravity = { g = [0.0, -9.81, 0.0] }\n", slope = "effects.gravity = { g = [0.1, -9.81, 0.0] }\n";
    expect_as_counted(field + open + slope, {2, 3}, {1e-3, 5, 15});
    expect_as_counted(field + ring + down, {2, 3}, {1e-3, 5, 15});
    expect_as_counted(field + open + down + "scheme.model = \"columns\"\n", {2, 3}, {1e-3, 5, 40});
    expect_as_counted(field + ring + down + "scheme.model = \"columns\"\n", {2, 3}, {1e-3, 5, 40});
}

// The loop sends two messages per step. A single row is not distributed.
TEST("heightfield in 2D, which every rank moves, sends what the loop of a run sends") {
    const std::string row =
        "solver = \"heightfield\"\ndim = 2\ngrid = { cells = [30, 1], size = [3.0, 1.0] }\ntime = { end = 0.3, max_dt = 1e-3 }\n"
        "initial = { surface = \"0.4 + 0.05*sin(2*x)\" }\noutput = { every = 10.0, compression = \"none\" }\neffects.gravity = { g = [0.1, "
        "-9.81] }\n";
    expect_as_counted(row, {2, 3}, {1e-3, 5, 15});
}

TEST("waves: seas and basins with and without water below them send what was counted, and other models what the loop sends") {
    const std::string field =
        "solver = \"waves\"\ndim = 3\ntime = { end = 0.3, dt = 1e-3 }\noutput = { every = 10.0, compression = \"none\" }\n";
    const std::string down = "effects = { gravity = { g = [0.0, -9.81, 0.0] } }\n",
                      foam = "effects = { gravity = { g = [0.0, -9.81, 0.0] }, foam = { below = 0.5 } }\n";
    const std::string sheet = "grid = { cells = [30, 1, 44], size = [90.0, 4.0, 132.0], origin = [0.0, -2.0, 0.0] }\n",
                      water = "grid = { cells = [20, 3, 24], size = [60.0, 9.0, 72.0], origin = [0.0, -6.0, 0.0] }\n";
    const auto sea = [](const std::string& more) {
        return "waves = { model = \"spectrum\", spectrum = { kind = \"phillips\", wind = 6.0 }" + more + " }\n";
    };
    expect_as_counted(field + down + sheet + sea(""), {2, 3}, {1e-3, 5, 15});
    expect_as_counted(field + down + sheet + sea(", choppiness = 0.2"), {2, 3}, {1e-3, 5, 15});  // and it does not fold
    expect_as_counted(field + foam + sheet + sea(", choppiness = 1.0, velocity = false"), {3}, {1e-3, 5, 15});
    expect_as_counted(field + down + water + sea(""), {2, 3}, {1e-3, 5, 15, true});
    const std::string basin =
        "waves = { model = \"basin\" }\nliquid = [ { shape = \"box\", min = [0.0, -6.0, 0.0], max = [90.0, 0.0, 132.0] }, "
        "{ shape = \"sphere\", centre = [20.0, -2.0, 30.0], radius = 3.0 } ]\n";
    expect_as_counted(field + down + sheet + basin, {2, 3}, {1e-3, 5, 15});
    expect_as_counted(field + down + water + basin, {2, 3}, {1e-3, 5, 15});
    const std::string trochoid = "waves = { model = \"gerstner\", trains = [ { amplitude = 0.5, wavelength = 30.0 } ] }\n";
    expect_as_counted(field + down + sheet + trochoid, {2, 3}, {1e-3, 5, 15});
    expect_as_counted(field + foam + sheet + trochoid, {2}, {1e-3, 5, 15});
}

namespace {

const std::string plume =
    "solver = \"mac\"\ndim = 3\ngrid = { cells = [48, 48, 128], size = [0.48, 0.48, 1.28] }\ntime = { end = 0.003, max_dt = 0.001 }\n"
    "effects = { buoyancy = { alpha = 0.1, beta = 0.2, ambient = 293.0 }, confinement = { epsilon = 0.2 } }\n"
    "emitters = [ { shape = \"sphere\", centre = [0.25, 0.15, 0.64], radius = 0.1, smoke = 1.0, temperature = 343.0 } ]\n"
    "output = { every = 1.0, fields = [\"smoke\"], compression = \"none\" }\n";

/// What `weir` says and ends with.
std::pair<int, std::string> said(std::vector<std::string> arguments) {
    const test::TemporaryFolder folder;
    test::Process run(std::move(arguments), folder.path() / "log");
    const int code = run.wait();
    return {code, run.said()};
}

}  // namespace

// The whole is estimated within a tenth. Of a rank's part of mac, the pressure's levels of fewer than 20,000 cells are whole, less than a
// tenth of the half or quarter that it holds. In mac_water, of liquid that stands as high on all planes, the band and the markers reach
// beyond the 5 or 9 planes near cuts that are counted: 11 planes to either side of 40 for bytes, one for markers. Of a height field and of
// waves a rank reads fewer, 2 rows or 1 beyond a cut, less than a tenth of 64; a sea that is summed in parallel has the messages of its
// transposition beside that, 2 complex numbers for each wave, where it has 5 and 12 reals for the two points that make one. Of tall cells
// it has 2 lines of columns beyond a cut where the lattice has 4 planes and bytes 11, and whole levels of the pressure as mac.
TEST(
    "what each rank of mac will hold is estimated within a fifth, and of mac_water within a third, of tallcell, heightfield and waves "
    "within a fifth") {
    if (const std::string why = no_ranks(); full_size() && !why.empty()) GTEST_SKIP() << why;
    const auto compare = [](const std::string& text, double end, double wrong) {
        const Runs runs(text);
        const auto scene = runs.scene();
        validation::CostEstimate f;
        f.held = sim::estimate_memory(scene, sim::registry());
        f.count = 1, f.ms = 1;
        for (const int ranks : {2, 4}) {
            const Run run = runs.run(ranks, end, !full_size());
            const validation::ParallelEstimate told = validation::estimate_in_parallel(scene, f, ranks, validation::Link{1e-6, 1e9, ""});
            for (int rank = 0; rank < ranks; ++rank)
                EXPECT_NEAR(told.bytes[static_cast<std::size_t>(rank)] / static_cast<double>(run.sent("solver_bytes", rank)), 1, wrong)
                    << "rank " << rank << " of " << ranks;
        }
    };
    compare(plume, 0.003, 0.2);
    compare(pool +
                "dim = 2\ngrid = { cells = [128, 160], size = [1.28, 1.6] }\n"
                "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.64, 1.6] } ]\n",
            2e-4, 0.33);
    // a quarter of the cut axis: of the planes that hold it a rank has a few, and of empty ones many
    compare(pool +
                "dim = 3\ngrid = { cells = [32, 32, 160], size = [0.32, 0.32, 1.6] }\n"
                "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.32, 0.24, 0.4] } ]\n",
            2e-4, 0.25);
    compare(
        "solver = \"tallcell\"\ndim = 3\ngrid = { cells = [32, 48, 128], size = [0.32, 0.48, 1.28] }\n"
        "time = { end = 0.002, max_dt = 1e-3 }\noutput = { every = 1.0, fields = [\"pressure\"], compression = \"none\" }\n"
        "liquid = [ { shape = \"box\", min = [0.0, 0.0, 0.0], max = [0.32, 0.36, 1.28] } ]\neffects.gravity.g = [0.0, -9.81, 0.0]\n",
        0.002, 0.2);
    compare(
        "solver = \"heightfield\"\ndim = 3\ngrid = { cells = [64, 1, 256], size = [6.4, 1.0, 25.6] }\ntime = { end = 0.003, dt = 0.001 }\n"
        "initial = { surface = \"0.4 + 0.05*sin(2*x)\" }\neffects.gravity.g = [0.0, -9.81, 0.0]\noutput = { every = 1.0 }\n",
        0.003, 0.2);
    compare(
        "solver = \"waves\"\ndim = 3\ngrid = { cells = [64, 1, 256], size = [128.0, 4.0, 512.0], origin = [0.0, -2.0, 0.0] }\n"
        "time = { end = 0.003, dt = 0.001 }\neffects.gravity.g = [0.0, -9.81, 0.0]\noutput = { every = 1.0 }\n"
        "waves = { model = \"spectrum\", spectrum = { kind = \"phillips\", wind = 6.0 } }\n",
        0.003, 0.2);
}

TEST("cost --plan --ranks prints the counted numbers, the constants with their source, and weak scaling") {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "pool.toml") << pool << "dim = 2\ngrid = { cells = [16, 40], size = [0.16, 0.4] }\n"
                                               << "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.16, 0.3] } ]\n";
    const auto [code, text] =
        said({"cost", "--plan", folder.path() / "pool.toml", "--ranks", "2", "--latency", "2e-6", "--bandwidth", "1e10"});
    EXPECT_EQ(code, 0) << text;
    const auto scene = scene::read(folder.path() / "pool.toml", sim::schemas());
    for (const RankTraffic& two : validation::count_messages(scene, 2, 1, 2).sent) {
        const Traffic sent{(two.beside.messages / 2) + (two.everywhere.messages / 2), (two.beside.bytes / 2) + (two.everywhere.bytes / 2)};
        EXPECT_NE(text.find(fmt::format("{:6} messages {:>12} bytes per step", sent.messages, sent.bytes)), std::string::npos) << text;
    }
    for (const char* part :
         {"2 ranks, partitioned along y", "each rank stores the whole grids; replicated work: the levels of the pressure",
          "planes     0 to    15", "2 us per message and 10 GB/s as given", "1024 ranks", "weak scaling"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
    const auto [explained, explanation] = said({"run", folder.path() / "pool.toml", "--explain", "--ranks", "2"});
    EXPECT_EQ(explained, 0) << explanation;
    EXPECT_NE(explanation.find("2 ranks, partitioned along y"), std::string::npos) << explanation;
    EXPECT_NE(explanation.find("through the shared memory of this machine, measured now"), std::string::npos);
}

TEST("what cannot run with that number of ranks is refused by a plan as by the run, with the key and what is allowed") {
    const test::TemporaryFolder folder;
    const std::string file = folder.path() / "scene.toml";
    std::ofstream(file) << pool << "dim = 2\ngrid = { cells = [16, 40], size = [0.16, 0.4] }\n"
                        << "liquid = [ { shape = \"box\", min = [0.0, 0.0], max = [0.16, 0.3] } ]\n";
    const auto refused = [&](std::vector<std::string> arguments, const std::string& why) {
        const auto [code, text] = said(std::move(arguments));
        EXPECT_EQ(code, 2);
        EXPECT_NE(text.find(why), std::string::npos) << text;
    };
    for (const bool plan : {true, false}) {
        const auto ask = [&](const std::string& ranks, std::vector<std::string> more, const std::string& why) {
            std::vector<std::string> arguments =
                plan ? std::vector<std::string>{"cost", "--plan", file} : std::vector<std::string>{"run", file, "--explain"};
            arguments.insert(arguments.end(), {"--ranks", ranks});
            arguments.insert(arguments.end(), more.begin(), more.end());
            refused(arguments, why);
        };
        ask("41", {}, "40 planes of cells along y cannot be partitioned over 41 ranks");
        ask("41", {}, "at most 40");
        ask("3", {"--set", "solver=tallcell", "--set", "effects.hand={}"},
            "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process");
        ask("3", {"--set", "effects.hand={}"}, "effects.hand: interactive forcing is not supported in parallel (MPI); run in one process");
    }
    refused({"cost", "--ranks", "2"}, "--ranks estimates a scene in parallel (MPI): it requires --plan SCENE");
    refused({"run", file, "--ranks", "2"}, "--ranks estimates a run in parallel (MPI): it requires --explain; mpirun -n N starts one");
    refused({"cost", "--plan", file, "--ranks", "2", "--latency", "1e-6"}, "--latency and --bandwidth describe one network: give both");
}

TEST("the model: rounds of neighbours take one latency, those of all the logarithm of the ranks, and bytes their time") {
    RankTraffic sent{.beside = {20, 1000}, .everywhere = {3, 100}, .rounds = 13, .received = 4000};
    const validation::ModelStep step = validation::model_step(1e-3, sent, 8, {1e-6, 1e9, ""});
    EXPECT_DOUBLE_EQ(step.sending, (10 + 3 * 3) * 1e-6 + 5000e-9);
    EXPECT_DOUBLE_EQ(validation::model_step(1e-3, sent, 1, {1e-6, 1e9, ""}).efficiency(), 1);
    const validation::Link link = validation::measure_link();
    EXPECT_GT(link.latency, 1e-8);  // a cache line does not go to another processor and back in less than 20 ns
    EXPECT_LT(link.latency, 1e-2);  // a shared processor switches processes within milliseconds
    EXPECT_GT(link.bandwidth, 1e7);
    EXPECT_LT(link.bandwidth, 1e12);
}

}  // namespace weir
