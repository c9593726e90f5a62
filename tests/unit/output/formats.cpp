// The registry of formats of frames, and a format made here.
#include "output/frame_format.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/frame_arrays.hpp"
#include "output/frames.hpp"
#include "scene/frame_formats.hpp"
#include "sim/frame_options.hpp"
#include "sim/registry.hpp"
#include "support/fake_solver.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <sstream>

namespace formats_tests {

namespace {

namespace fs = std::filesystem;
using namespace weir;
using test::TemporaryFolder;

std::string text_of(const fs::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// Every selected cell field as text, a value per line.
void write_text(const FieldSet& fields, real, const output::FrameOptions& options, const output::FrameFile& file) {
    for (const output::DataArray& array : output::cell_arrays(fields, options)) {
        std::vector<double> values(array.tuples.all() * static_cast<std::size_t>(array.components));
        array.numbers->copy(0, values.size(), reinterpret_cast<std::byte*>(values.data()));
        std::string text;
        for (const double value : values) text += output::exact_text(value) + '\n';
        output::write_file(file(array.name, ".txt"), text);
    }
}

TEST("the values of output.format are the names of the registered formats, the first one is the default") {
    std::vector<std::string> names;
    for (const output::FrameFormat& format : output::frame_formats()) {
        names.push_back(format.name);
        EXPECT_TRUE(format.write) << format.name;
        EXPECT_EQ(output::frame_format(format.name).name, format.name);
    }
    EXPECT_EQ(names, scene::frame_formats());
    EXPECT_EQ(output::frame_format().name, names.front());
    try {
        output::frame_format("xyz");
        FAIL() << "accepted";
    } catch (const BadInput& bad) {
        EXPECT_NE(std::string(bad.what()).find("\"xyz\"; known: vtk"), std::string::npos) << bad.what();
    }
}

TEST("a format writes its files, and the index names their times and files after every frame") {
    TemporaryFolder folder;
    auto simulation = test::fake_simulation("time = { end = 1.0 }");
    output::Frames frames(folder, {.fields = {"pressure"}}, {.name = "text", .write = write_text});
    frames.write(simulation.fields(), 0);
    EXPECT_EQ(text_of(folder.path() / "pressure.csv"), "time [s],file\n0,frames/pressure_000000.txt\n");
    frames.write(simulation.fields(), 0.1);
    EXPECT_EQ(text_of(folder.path() / "pressure.csv"), "time [s],file\n0,frames/pressure_000000.txt\n0.1,frames/pressure_000001.txt\n");
    ASSERT_EQ(frames.series().size(), 1u);
    EXPECT_EQ(frames.series()[0], folder.path() / "pressure.csv");
    const FieldSet fields = simulation.fields();
    std::ifstream file(folder.path() / "frames/pressure_000001.txt");
    for (const double expected : fields.find("pressure")->data[0]) {
        double value = -1;
        file >> value;
        EXPECT_EQ(value, expected);
    }
}

TEST("an index of values and files reads back, is truncated with its files, and other tables are no index") {
    TemporaryFolder folder;
    const output::SeriesIndex index = output::csv_index();
    fs::create_directory(folder.path() / "frames");
    for (const char* name : {"frames/a_0.txt", "frames/a_1.txt"}) std::ofstream(folder.path() / name) << "x";
    std::ofstream(folder.path() / "a.csv") << index.text({{0, "frames/a_0.txt"}, {0.1, "frames/a_1.txt"}});
    std::ofstream(folder.path() / "steps.csv") << "step,t [s]\n1,0.1\n";
    std::ofstream(folder.path() / "foreign.csv") << index.text({{0, "frames/../precious.txt"}});
    for (const char* bad : {"time [s],file\nnan,frames/x\n", "time [s],file\n0.5\n", "time [s],file\n0.5,\n", ""}) {
        std::ofstream(folder.path() / "bad.csv") << bad;
        EXPECT_EQ(output::series_in(folder, index), std::vector<fs::path>{"a.csv"}) << bad;
        EXPECT_THROW(index.read(folder.path() / "bad.csv"), BadInput) << bad;
    }
    EXPECT_EQ(index.read(folder.path() / "a.csv")[1].time, 0.1);
    EXPECT_EQ(output::truncate_series(folder.path() / "a.csv", 1, index).size(), 1u);
    EXPECT_TRUE(fs::exists(folder.path() / "frames/a_0.txt") && !fs::exists(folder.path() / "frames/a_1.txt"));
    EXPECT_EQ(output::truncate_series(folder.path() / "a.csv", 0, index).size(), 0u);
    EXPECT_FALSE(fs::exists(folder.path() / "a.csv"));
}

TEST("the options of frames are those of the scene") {
    const auto options = [](const std::string& output) {
        return sim::frame_options(
            scene::parse("solver = \"pbf\"\ndim = 2\ngrid = { cells = [12, 12], size = [1, 1] }\ntime = { end = 1, dt = 0.001 }\n"
                         "liquid = [ { shape = \"box\", min = [0, 0], max = [0.5, 0.5] } ]\n" +
                             output,
                         "test.toml", sim::schemas()));
    };
    const auto usual = options("");
    EXPECT_EQ(usual.format, scene::frame_formats().front());
    EXPECT_TRUE(usual.fields.empty() && !usual.faces && !usual.single_precision && !usual.solid && !usual.surface);
    EXPECT_EQ(usual.compression, output::Compression::zlib);
    const auto changed = options(
        "output = { fields = [\"velocity\"], faces = true, precision = \"single\", compression = \"lz4\", surface = \"anisotropic\" }\n"
        "solids = [ { shape = \"sphere\", centre = [0.8, 0.8], radius = 0.1 } ]\n");
    EXPECT_EQ(changed.fields, std::vector<std::string>{"velocity"});
    EXPECT_TRUE(changed.faces && changed.single_precision && changed.solid && changed.surface);
    EXPECT_EQ(changed.compression, output::Compression::lz4);
    EXPECT_EQ(options("output.compression = \"none\"\n").compression, output::Compression::none);
}

}  // namespace

}  // namespace formats_tests
