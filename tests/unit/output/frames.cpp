#include "output/frames.hpp"

#include "core/error.hpp"
#include "output/read_frame.hpp"
#include "sim/registry.hpp"
#include "sim/solid_cells.hpp"
#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "support/vtk_files.hpp"
#include "surfaces/reconstruction.hpp"

#include <cmath>
#include <csignal>
#include <fstream>

#include <sys/resource.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>

namespace frames_tests {

namespace {

namespace fs = std::filesystem;
using weir::real;
using weir::output::Frames;
using weir::test::fake_simulation;
using weir::test::FakeSolver;
using weir::test::TemporaryFolder;

TEST_IN_2D_AND_3D("a grid frame holds cell fields to the last bit, and the velocity as the mean of the faces, as a 3-vector") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }", D);
    simulation.step();
    Frames frames(folder, {});
    frames.write(simulation.fields(), simulation.time());
    const auto image = weir::test::read_image(folder.path() / "frames/grid_000000.vti");
    const auto fields = simulation.fields();
    auto* pressure = image->GetCellData()->GetArray("pressure");
    auto* velocity = image->GetCellData()->GetArray("velocity");
    const auto& expected = fields.find("pressure")->data[0];
    ASSERT_EQ(static_cast<std::size_t>(image->GetNumberOfCells()), expected.size());
    ASSERT_EQ(velocity->GetNumberOfComponents(), 3);
    for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i) {
        EXPECT_EQ(pressure->GetTuple1(i), expected[static_cast<std::size_t>(i)]);
        double bounds[6];
        image->GetCellBounds(i, bounds);
        for (int a = 0; a < 3; ++a) {
            const real centre = 0.5 * (bounds[2 * a] + bounds[2 * a + 1]);
            EXPECT_NEAR(velocity->GetComponent(i, a), a < D ? FakeSolver::velocity(a, centre, simulation.time()) : 0.0, 1e-14);
        }
    }
    EXPECT_EQ(image->GetFieldData()->GetArray("TimeValue")->GetTuple1(0), simulation.time());
}

TEST("cells whose centre a moving solid takes are hidden from VTK's filters, and are no field of the frame; without solids none is") {
    TemporaryFolder folder;
    const auto frame = [&](const std::string& solids, int number) {
        const std::string text = "solver = \"mac\"\ndim = 2\ngrid = { cells = [16, 16], size = [1, 1] }\ntime = { end = 1 }\n" + solids;
        weir::Simulation simulation(weir::scene::parse(text, "disc.toml", weir::sim::schemas()));
        weir::output::FrameOptions options;
        options.solid = weir::sim::solid_cells(simulation.scene());
        const auto out = folder.path() / std::to_string(number);
        Frames frames(out, options);
        frames.write(simulation.fields(), 0.5);
        EXPECT_EQ(weir::output::read_frame(out, 0, 2).cells.size(), 2u);  // velocity and pressure
        return weir::test::read_image(out / "frames/grid_000000.vti");
    };
    const auto image = frame(
        "solids = [ { shape = \"sphere\", centre = [0.3, 0.5], radius = 0.2, motion = { kind = \"constant\", velocity = "
        "[0.4, 0.0] } } ]\n",
        0);
    for (vtkIdType i = 0; i < image->GetNumberOfCells(); ++i) {
        const real x = (static_cast<real>(i % 16) + 0.5) / 16, y = (static_cast<real>(i / 16) + 0.5) / 16;
        EXPECT_EQ(image->IsCellVisible(i) == 0, std::hypot(x - 0.5, y - 0.5) < 0.2) << x << ", " << y;
    }
    EXPECT_EQ(frame("", 1)->GetCellGhostArray(), nullptr);
}

TEST_IN_2D_AND_3D("with output.faces each face component stands at its face, to the last bit") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }", D);
    Frames frames(folder, {.fields = {"velocity"}, .faces = true});
    frames.write(simulation.fields(), 0);
    const auto fields = simulation.fields();
    for (int a = 0; a < D; ++a) {
        const std::string axis(1, "xyz"[a]);
        const auto image = weir::test::read_image(folder.path() / ("frames/faces_" + axis + "_000000.vti"));
        auto* values = image->GetPointData()->GetArray(("velocity_" + axis).c_str());
        const auto& expected = fields.find("velocity")->data[static_cast<std::size_t>(a)];
        ASSERT_EQ(static_cast<std::size_t>(values->GetNumberOfTuples()), expected.size());
        for (vtkIdType i = 0; i < values->GetNumberOfTuples(); ++i) {
            EXPECT_EQ(values->GetTuple1(i), expected[static_cast<std::size_t>(i)]);
            EXPECT_NEAR(values->GetTuple1(i), FakeSolver::velocity(a, image->GetPoint(i)[a], 0), 1e-14);
        }
    }
}

TEST_IN_2D_AND_3D("a sheet of points is written as a surface: a line in 2D, quadrilaterals between its rows in 3D") {
    TemporaryFolder folder;
    const std::string wave = "waves = { model = \"gerstner\", trains = [ { amplitude = 0.05, wavelength = 1.0 } ] }\n";
    weir::Simulation simulation(weir::scene::parse(
        "solver = \"waves\"\ndim = " + std::to_string(D) +
            "\ngrid = { cells = " + (D == 2 ? "[9, 1], size = [2, 1]" : "[9, 1, 5], size = [2, 1, 1]") + " }\ntime = { end = 1 }\n" + wave,
        "sheet.toml", weir::sim::schemas()));
    Frames frames(folder, {});
    frames.write(simulation.fields(), 0);
    const auto surface = weir::test::read_particles(folder.path() / "frames/surface_000000.vtp");
    const auto fields = simulation.fields();
    const auto& x = fields.find("surface", "position")->data;
    ASSERT_EQ(static_cast<std::size_t>(surface->GetNumberOfPoints()), x[0].size());
    for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
        for (int a = 0; a < D; ++a) EXPECT_EQ(surface->GetPoint(i)[a], x[static_cast<std::size_t>(a)][static_cast<std::size_t>(i)]);
    EXPECT_EQ(surface->GetNumberOfLines(), D == 2 ? 1 : 0);
    EXPECT_EQ(surface->GetNumberOfPolys(), D == 2 ? 0 : 8 * 4);
    EXPECT_EQ(surface->GetNumberOfVerts(), 0);
    EXPECT_NE(surface->GetPointData()->GetArray("jacobian"), nullptr);
}

TEST("markers are vertices at their positions") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    Frames frames(folder, {});
    frames.write(simulation.fields(), 0);
    const auto markers = weir::test::read_particles(folder.path() / "frames/markers_000000.vtp");
    const auto fields = simulation.fields();
    const auto& position = fields.find("markers", "position")->data;
    ASSERT_EQ(markers->GetNumberOfVerts(), 10);
    for (vtkIdType i = 0; i < 10; ++i) EXPECT_EQ(markers->GetPoint(i)[1], position[1][static_cast<std::size_t>(i)]);
}

TEST("a surface is written as triangles with normals, velocity and thickness, a file a frame, and only where one is named") {
    const auto scene = [](const std::string& more) {
        return weir::scene::parse(
            "solver = \"pbf\"\ndim = 3\ngrid = { cells = [8, 8, 8], size = [1, 1, 1] }\ntime = { end = 1, dt = 0.001 }\n"
            "liquid = [ { shape = \"box\", min = [0, 0, 0], max = [0.5, 0.5, 0.5] } ]\n" +
                more,
            "test.toml", weir::sim::schemas());
    };
    weir::Simulation simulation(scene("output.surface = \"zhu_bridson\"\n"));
    const std::shared_ptr<weir::surfaces::Reconstruction> maker = weir::surfaces::reconstruction_of(simulation.scene());
    weir::output::FrameOptions options;
    options.surface = [maker](const weir::FieldSet& fields, real t) -> const weir::SurfaceMesh& { return maker->make(fields, t); };
    TemporaryFolder folder, plain;
    Frames frames(folder, options), without(plain, {});
    frames.write(simulation.fields(), 0), without.write(simulation.fields(), 0);
    simulation.step();
    frames.write(simulation.fields(), simulation.time());
    EXPECT_TRUE(fs::exists(folder.path() / "liquid_surface.pvd"));
    EXPECT_FALSE(fs::exists(plain.path() / "liquid_surface.pvd"));
    const auto data = weir::test::read_particles(folder.path() / "frames/liquid_surface_000001.vtp");
    const auto& mesh = maker->mesh();
    ASSERT_EQ(static_cast<std::size_t>(data->GetNumberOfPolys()), mesh.corners.size());
    ASSERT_EQ(static_cast<std::size_t>(data->GetNumberOfPoints()), mesh.points.size());
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(i);
            EXPECT_EQ(data->GetPoint(i)[a], mesh.points[at][a]);
            EXPECT_EQ(data->GetPointData()->GetNormals()->GetComponent(i, a), mesh.normals[at][a]);
            EXPECT_EQ(data->GetPointData()->GetArray("velocity")->GetComponent(i, a), mesh.velocity[at][a]);
            EXPECT_EQ(data->GetPointData()->GetArray("thickness")->GetTuple1(i), mesh.thickness[at]);
        }
}

TEST("the surface of a flat liquid is written as lines with normals, velocity and thickness") {
    weir::Simulation simulation(
        weir::scene::parse("solver = \"pbf\"\ndim = 2\ngrid = { cells = [12, 12], size = [1, 1] }\ntime = { end = 1, dt = 0.001 }\n"
                           "liquid = [ { shape = \"box\", min = [0, 0], max = [0.5, 0.5] } ]\noutput.surface = \"anisotropic\"\n",
                           "test.toml", weir::sim::schemas()));
    const std::shared_ptr<weir::surfaces::Reconstruction> maker = weir::surfaces::reconstruction_of(simulation.scene());
    weir::output::FrameOptions options;
    options.surface = [maker](const weir::FieldSet& fields, real t) -> const weir::SurfaceMesh& { return maker->make(fields, t); };
    TemporaryFolder folder;
    Frames(folder, options).write(simulation.fields(), 0);
    const auto data = weir::test::read_particles(folder.path() / "frames/liquid_surface_000000.vtp");
    const auto& mesh = maker->mesh();
    ASSERT_GT(mesh.lines.size(), 10U);
    ASSERT_EQ(static_cast<std::size_t>(data->GetNumberOfLines()), mesh.lines.size());
    for (vtkIdType i = 0; i < data->GetNumberOfLines(); ++i)
        for (int end = 0; end < 2; ++end)
            EXPECT_EQ(data->GetCell(i)->GetPointId(end), mesh.lines[static_cast<std::size_t>(i)][static_cast<std::size_t>(end)]);
    for (const char* name : {"Normals", "velocity", "thickness"})
        EXPECT_EQ(data->GetPointData()->GetArray(name)->GetNumberOfTuples(), data->GetNumberOfPoints());
}

TEST("every compression reads back the same numbers; single precision halves them") {
    auto simulation = fake_simulation("time = { end = 1.0 }");
    std::vector<std::uintmax_t> sizes;
    for (const auto compression : {weir::output::Compression::none, weir::output::Compression::zlib, weir::output::Compression::lz4}) {
        TemporaryFolder folder;
        Frames frames(folder, {.fields = {"pressure"}, .compression = compression});
        frames.write(simulation.fields(), 0);
        const auto image = weir::test::read_image(folder.path() / "frames/grid_000000.vti");
        const auto fields = simulation.fields();
        for (vtkIdType i = 0; i < 64; ++i)
            EXPECT_EQ(image->GetCellData()->GetArray("pressure")->GetTuple1(i),
                      fields.find("pressure")->data[0][static_cast<std::size_t>(i)]);
    }
    TemporaryFolder folder;
    Frames frames(folder, {.single_precision = true});
    frames.write(simulation.fields(), 0);
    EXPECT_EQ(weir::test::read_image(folder.path() / "frames/grid_000000.vti")->GetCellData()->GetArray("pressure")->GetDataTypeSize(), 4);
}

TEST("only the fields that are asked for are written, and unknown ones are refused with the known") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    Frames frames(folder, {.fields = {"level_set"}});
    frames.write(simulation.fields(), 0);
    const auto image = weir::test::read_image(folder.path() / "frames/grid_000000.vti");
    EXPECT_EQ(image->GetCellData()->GetNumberOfArrays(), 1);
    try {
        weir::output::check({.fields = {"smoke"}}, simulation.fields());
        FAIL() << "accepted";
    } catch (const weir::BadInput& bad) {
        EXPECT_NE(std::string(bad.what()).find("no field \"smoke\"; known: level_set, position, pressure, velocity"), std::string::npos)
            << bad.what();
    }
}

TEST("the series is readable after every frame, names exact times, and a new run leaves no frame of an older one") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    {
        Frames frames(folder, {});
        for (int k = 0; k < 3; ++k) {
            frames.write(simulation.fields(), 0.1 * k);
            EXPECT_EQ(weir::test::read_whole_series(folder.path() / "grid.pvd"), k + 1);
            EXPECT_EQ(weir::test::read_whole_series(folder.path() / "markers.pvd"), k + 1);
        }
        EXPECT_EQ(weir::output::read_series(folder.path() / "grid.pvd")[2].time, 0.1 * 2);
    }
    Frames again(folder, {});
    again.write(simulation.fields(), 0);
    EXPECT_EQ(weir::test::read_whole_series(folder.path() / "grid.pvd"), 1);
    EXPECT_FALSE(fs::exists(folder.path() / "frames/grid_000001.vti"));
}

TEST("files that are not ours are never removed, whatever a foreign .pvd names") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "precious.txt") << "x";
    std::ofstream(folder.path() / "foreign.pvd") << weir::output::series_text({{0, "precious.txt"}, {1, "frames/../precious.txt"}});
    Frames frames(folder, {});
    EXPECT_TRUE(fs::exists(folder.path() / "precious.txt"));
    EXPECT_TRUE(fs::exists(folder.path() / "foreign.pvd"));
}

TEST("a resumed series keeps the frames up to the checkpoint and goes on from there") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    {
        Frames frames(folder, {});
        for (int k = 0; k < 5; ++k) frames.write(simulation.fields(), 0.1 * k);
    }
    auto frames = Frames::resume(folder, {}, 3, 0.25);
    EXPECT_FALSE(fs::exists(folder.path() / "frames/grid_000003.vti"));
    frames.write(simulation.fields(), 0.7);
    const auto entries = weir::output::read_series(folder.path() / "grid.pvd");
    ASSERT_EQ(entries.size(), 4u);
    EXPECT_EQ(entries[3].time, 0.7);
    EXPECT_EQ(weir::test::read_whole_series(folder.path() / "markers.pvd"), 4);
}

TEST("the series of a branch goes on by its times, whatever the numbers of its frames; frames that are missing are told before any goes") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    {
        Frames frames(folder, {});
        for (const double t : {0.5, 0.6, 0.7}) frames.write(simulation.fields(), t);
    }
    {
        auto frames = Frames::resume(folder, {}, 7, 0.6);  // frames 5 and 6 of the run
        EXPECT_EQ(frames.count(), 2);
        frames.write(simulation.fields(), 0.8);
        EXPECT_EQ(weir::output::read_series(folder.path() / "grid.pvd")[2].time, 0.8);
    }
    EXPECT_EQ(Frames::resume(folder, {}, 5, 0.45).count(), 0);  // the branch from its beginning
    Frames whole(folder, {});
    for (const double t : {0.0, 0.1, 0.2}) whole.write(simulation.fields(), t);
    std::ofstream(folder.path() / "markers.pvd") << weir::output::series_text({{0, "frames/markers_000000.vtp"}});
    EXPECT_THROW(Frames::resume(folder, {}, 2, 0.15), weir::BadInput);
    EXPECT_EQ(weir::output::read_series(folder.path() / "grid.pvd").size(), 3u);
}

/// The largest file that this process may write, while it lives; writes beyond fail as on a full disk (EFBIG, not ENOSPC).
struct SmallDisk {
    explicit SmallDisk(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before);
        rlimit small{bytes, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() { setrlimit(RLIMIT_FSIZE, &before); }
    rlimit before{};
};

TEST("when writing fails the error names file and reason, earlier frames stay readable, no half file is left") {
    TemporaryFolder folder;
    auto simulation = fake_simulation("time = { end = 1.0 }");
    Frames frames(folder, {.compression = weir::output::Compression::none});
    frames.write(simulation.fields(), 0);
    {
        const SmallDisk small(1000);
        try {
            frames.write(simulation.fields(), 0.1);
            FAIL() << "the frame of several thousand bytes was written";
        } catch (const weir::OutputError& error) {
            EXPECT_NE(std::string(error.what()).find("grid_000001.vti: File too large"), std::string::npos) << error.what();
        }
    }
    EXPECT_EQ(weir::test::read_whole_series(folder.path() / "grid.pvd"), 1);
    EXPECT_FALSE(fs::exists(folder.path() / "frames/grid_000001.vti"));
    EXPECT_FALSE(fs::exists(folder.path() / "frames/grid_000001.vti.part"));
}

TEST("an output folder that cannot be written is refused, with the system's reason") {
    TemporaryFolder folder;
    std::ofstream(folder.path() / "file") << "x";
    try {
        Frames frames(folder.path() / "file" / "out", {});
        FAIL() << "accepted";
    } catch (const weir::OutputError& error) {
        EXPECT_NE(std::string(error.what()).find("Not a directory"), std::string::npos) << error.what();
    }
}

}  // namespace

}  // namespace frames_tests
