// The files of a frame are those of VTK's own writers, byte for byte, and the same bytes whichever ranks write them together.
#include "output/vtk_file.hpp"

#include "core/error.hpp"
#include "output/vtk_frame.hpp"
#include "parallel/partition.hpp"
#include "sim/registry.hpp"
#include "sim/solid_cells.hpp"
#include "support/fake_solver.hpp"
#include "support/forked_ranks.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "support/vtk_writer.hpp"
#include "surfaces/reconstruction.hpp"

#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include <sys/resource.h>

namespace vtk_file_tests {

namespace {

namespace fs = std::filesystem;
using namespace weir;
using output::Compression;
using output::face_image_of;
using output::FrameOptions;
using output::image_of;
using output::particles_of;
using output::surface_of;
using output::VtkFile;
using test::TemporaryFolder;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Long texts that differ are told by where.
void expect_same(const std::string& ours, const std::string& theirs, const std::string& what) {
    ASSERT_FALSE(theirs.empty()) << what;
    const auto at = static_cast<std::size_t>(
        std::mismatch(ours.begin(), ours.begin() + static_cast<std::ptrdiff_t>(std::min(ours.size(), theirs.size())), theirs.begin())
            .first -
        ours.begin());
    if (ours == theirs) return;
    const auto around = [&](const std::string& text) { return text.substr(at < 60 ? 0 : at - 60, 90); };
    ADD_FAILURE() << what << ": " << ours.size() << " bytes and " << theirs.size() << ", others from " << at << " on\n"
                  << around(ours) << "\n--\n"
                  << around(theirs);
}

std::string written(const VtkFile& file, Compression compression) {
    const TemporaryFolder folder;
    output::write(folder.path() / "file", file, compression);
    return text_of(folder.path() / "file");
}

/// All files of a frame, in every encoding.
void expect_as_vtk(const FieldSet& fields, FrameOptions options, const std::vector<std::string>& sets) {
    for (const Compression compression : {Compression::none, Compression::zlib, Compression::lz4})
        for (const bool single : {false, true}) {
            options.compression = compression, options.single_precision = single;
            const test::VtkWriter vtk(options);
            const std::string encoding = std::to_string(static_cast<int>(compression)) + (single ? " single" : " double");
            expect_same(written(image_of(fields, 0.1, options), compression), vtk.image(fields, 0.1), "image, " + encoding);
            for (int axis = 0; axis < fields.grid.dim; ++axis)
                expect_same(written(face_image_of(fields, axis, 1e-7, options), compression), vtk.faces(fields, axis, 1e-7),
                            "faces, " + encoding);
            for (const auto& set : sets)
                expect_same(written(particles_of(fields, set, 3, options), compression), vtk.particles(fields, set, 3),
                            set + ", " + encoding);
        }
}

Simulation simulation_of(const std::string& scene) { return Simulation(scene::parse(scene, "test.toml", sim::schemas())); }

TEST_IN_2D_AND_3D("cells, faces and markers are as VTK writes them") {
    auto simulation = test::fake_simulation("time = { end = 1.0 }", D);
    simulation.step();
    expect_as_vtk(simulation.fields(), {}, {"markers"});
}

TEST("hidden cells, fields of many blocks and a domain of odd numbers are as VTK writes them") {
    auto simulation = simulation_of(
        "solver = \"mac_water\"\ndim = 3\ngrid = { cells = [30, 20, 26], size = [3e-7, 2e-7, 2.6e-7], origin = [1e-5, -0.0, 0.25] }\n"
        "time = { end = 1 }\ninitial.velocity = { name = \"random\", speed = 0.1 }\n"
        "liquid = [ { shape = \"box\", min = [0, 0, 0.25], max = [1, 1e-7, 1] } ]\n"
        "solids = [ { shape = \"sphere\", centre = [1.01e-5, 1e-7, 0.25], radius = 1e-7 } ]\n");
    FrameOptions options;
    options.solid = sim::solid_cells(simulation.scene());
    expect_as_vtk(simulation.fields(), options, {"markers"});
}

TEST_IN_2D_AND_3D("sheets are as VTK writes them: a line, or quadrilaterals") {
    auto simulation =
        simulation_of("solver = \"waves\"\ndim = " + std::to_string(D) +
                      "\ngrid = { cells = " + (D == 2 ? "[9, 1], size = [2, 1]" : "[9, 1, 5], size = [2, 1, 1]") +
                      " }\ntime = { end = 1 }\nwaves = { model = \"gerstner\", trains = [ { amplitude = 0.05, wavelength = 1.0 } ] }\n");
    expect_as_vtk(simulation.fields(), {}, {"surface"});
}

TEST_IN_2D_AND_3D("surfaces are as VTK writes them, of liquid and of none") {
    auto simulation =
        simulation_of("solver = \"pbf\"\ndim = " + std::to_string(D) +
                      "\ngrid = { cells = " + (D == 2 ? "[12, 12], size = [1, 1]" : "[8, 8, 8], size = [1, 1, 1]") +
                      " }\ntime = { end = 1, dt = 0.001 }\noutput.surface = \"zhu_bridson\"\nliquid = [ { shape = \"box\", min = " +
                      (D == 2 ? "[0, 0], max = [0.5, 0.5]" : "[0, 0, 0], max = [0.5, 0.5, 0.5]") + " } ]\n");
    const auto maker = surfaces::reconstruction_of(simulation.scene());
    for (const Compression compression : {Compression::none, Compression::zlib}) {
        const FrameOptions options{.compression = compression};
        const SurfaceMesh &mesh = maker->make(simulation.fields(), 0), none;
        ASSERT_FALSE(mesh.points.empty());
        for (const SurfaceMesh* one : {&mesh, &none})
            expect_same(written(surface_of(*one, 0, options), compression), test::VtkWriter(options).surface(*one, 0), "surface");
    }
}

/// Cells of one field, each number once (but for zeros): which cell it is may be seen in it.
struct Field {
    explicit Field(int nx, int ny) : values(static_cast<std::size_t>(nx * ny)) {
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1 + std::sin(static_cast<real>(i));
        values.front() = -0.0, values.back() = 0.0;  // the least is the first of both
        fields.grid = {.dim = 2, .cells = {nx, ny, 1}, .origin = {0, 0, 0}, .spacing = {1, 1, 1}};
        fields.fields = {{"wave", "1", Where::cell, "", {values}}};
    }
    std::vector<real> values;
    FieldSet fields{};
};

TEST("what is not a number, numbers beyond all, and none have the extremes that VTK finds") {
    for (const std::vector<real>& values : {std::vector<real>{NAN, 1.0, NAN, 2.0}, {INFINITY, 1e300, 1e-310, 2.0}}) {
        Field field(2, 2);
        field.values = values;
        field.fields.fields[0].data = {field.values};
        expect_as_vtk(field.fields, {}, {});
        field.fields.fields[0].data = {field.values, field.values, field.values};
        expect_as_vtk(field.fields, {}, {});
    }
    FieldSet empty;
    const std::vector<real> none;
    empty.grid = Field(1, 1).fields.grid;
    empty.fields = {{"position", "m", Where::particle, "none", {none, none}}, {"mass", "kg", Where::particle, "none", {none}}};
    expect_as_vtk(empty, {}, {"none"});
}

TEST("in parallel the file has the bytes of one process, wherever its blocks are cut, and by a part that is smaller than a block") {
    const Field field(700, 500);  // 86 blocks of 4096 numbers, and a part of one
    for (const Compression compression : {Compression::none, Compression::zlib, Compression::lz4})
        for (const std::vector<int>& at : {std::vector<int>{0, 250, 500}, {0, 1, 3, 500}, {0, 499, 500}, {0, 200, 203, 204, 500}}) {
            FieldSet fields = field.fields;
            const std::string alone = written(image_of(fields, 0, {}), compression);
            const TemporaryFolder folder;
            const Partition cut{at};
            test::on_ranks(cut.ranks(), [&] {
                const auto first = static_cast<std::size_t>(700 * cut.begin(communicator().rank())),
                           last = static_cast<std::size_t>(700 * cut.end(communicator().rank(), 500));
                Field own = field;  // no rank may read the data of others
                for (std::size_t i = 0; i < own.values.size(); ++i)
                    if (i < first || i >= last) own.values[i] = NAN;
                own.fields.fields[0].data = {own.values};
                own.fields.cut = &cut;
                output::write(folder.path() / "file", image_of(own.fields, 0, {}), compression);
            });
            expect_same(text_of(folder.path() / "file"), alone, "over " + std::to_string(cut.ranks()));
        }
}

TEST("particles of which each rank has a part, one of them none, follow one another; of those that all have the first writes") {
    constexpr std::size_t count = 20000;
    std::vector<real> x(count), mass(count);
    for (std::size_t i = 0; i < count; ++i) x[i] = std::cos(static_cast<real>(i)), mass[i] = static_cast<real>(i);
    const auto set_of = [&](std::size_t first, std::size_t last, bool parts) {
        FieldSet fields;
        const auto part = [&](const std::vector<real>& all) { return std::span<const real>(all).subspan(first, last - first); };
        fields.grid.dim = 2;
        fields.fields = {{"position", "m", Where::particle, "all", {part(x), part(mass)}},
                         {"mass", "kg", Where::particle, "all", {part(mass)}}};
        fields.particles_in_parts = parts;
        return fields;
    };
    const std::string alone = written(particles_of(set_of(0, count, false), "all", 0, {}), Compression::zlib);
    const std::vector<std::size_t> begins{0, 0, 1234, 1300, count};
    for (const bool parts : {true, false}) {
        const TemporaryFolder folder;
        test::on_ranks(4, [&] {
            const auto rank = static_cast<std::size_t>(communicator().rank());
            const FieldSet fields = parts ? set_of(begins[rank], begins[rank + 1], true) : set_of(0, count, false);
            output::write(folder.path() / "file", particles_of(fields, "all", 0, {}), Compression::zlib);
        });
        expect_same(text_of(folder.path() / "file"), alone, parts ? "parts" : "whole");
    }
}

TEST("what the first rank cannot write is an error of all; what stood there stays, and no part of another file") {
    const Field field(100, 100);
    const TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "old";
    const Partition cut{{0, 40, 100}};
    test::on_ranks(2, [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        const rlimit small{20000, 20000};
        setrlimit(RLIMIT_FSIZE, &small);
        FieldSet fields = field.fields;
        fields.cut = &cut;
        for (const Compression compression : {Compression::none, Compression::zlib}) try {
                output::write(folder.path() / "file", image_of(fields, 0, {}), compression);
                ADD_FAILURE() << "80000 bytes of noise were written";
            } catch (const OutputError& error) {
                if (communicator().rank() == 0) {
                    EXPECT_NE(std::string(error.what()).find("file: File too large"), std::string::npos) << error.what();
                }
            }
    });
    EXPECT_EQ(text_of(folder.path() / "file"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace

}  // namespace vtk_file_tests
