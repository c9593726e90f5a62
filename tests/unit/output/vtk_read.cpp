// Frames that are damaged anywhere are refused with their name, or are frames: nothing crashes, nothing is read past an end.
#include "output/vtk_read.hpp"

#include "core/error.hpp"
#include "output/vtk_file.hpp"
#include "output/vtk_frame.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "support/vtk_files.hpp"

#include <fstream>
#include <random>
#include <sstream>

#include <vtkCellData.h>
#include <vtkPointData.h>

namespace vtk_read_tests {

namespace {

namespace fs = std::filesystem;
using namespace weir;
using output::Compression;
using output::read_vtk;
using output::ReadFile;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// Frames of a small tank: the grid, and its markers.
struct Written {
    fs::path image, points;
};
Written written(const fs::path& folder, int dim, Compression compression) {
    const std::string box = dim == 2 ? "[6, 5]" : "[6, 5, 4]", three = dim == 2 ? "" : ", 0";
    Simulation simulation(
        scene::parse("solver = \"mac_water\"\ndim = " + std::to_string(dim) + "\ngrid = { cells = " + box + ", size = " + box +
                         " }\ntime = { end = 1, dt = 0.01 }\nliquid = [ { shape = \"box\", min = [0, 0" + three + "], max = [3, 3" +
                         (dim == 2 ? "" : ", 4") + "] } ]\neffects.gravity.g = [0, -9.81" + three + "]\n",
                     "tank.toml", sim::schemas()));
    simulation.step();
    output::FrameOptions options;
    options.compression = compression;
    Written files{folder / "grid.vti", folder / "markers.vtp"};
    output::write(files.image, output::image_of(simulation.fields(), simulation.time(), options), compression);
    output::write(files.points, output::particles_of(simulation.fields(), "markers", simulation.time(), options), compression);
    return files;
}

/// All numbers of it.
std::vector<real> numbers_of(const ReadFile& file) {
    std::vector<real> all = file.position;
    for (const auto* list : {&file.cell_data, &file.point_data})
        for (const auto& array : *list) all.insert(all.end(), array.values.begin(), array.values.end());
    return all;
}

/// 1: read; 0: refused with its name.
int outcome(const fs::path& file, std::vector<real>* numbers = nullptr) {
    try {
        const ReadFile read = read_vtk(file);
        if (numbers) *numbers = numbers_of(read);
        return 1;
    } catch (const BadInput& bad) {
        EXPECT_EQ(std::string(bad.what()).find(file.string()), 0u) << bad.what();
        return 0;
    }
}

const std::vector<Compression> all_compressions{Compression::none, Compression::zlib, Compression::lz4};

}  // namespace

TEST_IN_2D_AND_3D("a frame is read as VTK reads it, in every compression") {
    const test::TemporaryFolder folder;
    for (const Compression compression : all_compressions) {
        const Written files = written(folder, D, compression);
        const ReadFile image = read_vtk(files.image), points = read_vtk(files.points);
        const auto vtk = test::read_image(files.image);
        const auto vtk_points = test::read_particles(files.points);
        ASSERT_EQ(static_cast<int>(image.cell_data.size()), vtk->GetCellData()->GetNumberOfArrays());
        for (const auto& array : image.cell_data) {
            vtkDataArray* theirs = vtk->GetCellData()->GetArray(array.name.c_str());
            ASSERT_EQ(static_cast<vtkIdType>(array.tuples()), theirs->GetNumberOfTuples());
            ASSERT_EQ(static_cast<int>(array.components), theirs->GetNumberOfComponents());
            for (std::size_t i = 0; i < array.values.size(); ++i)
                ASSERT_EQ(array.values[i],
                          theirs->GetComponent(static_cast<vtkIdType>(i / array.components), static_cast<int>(i % array.components)));
        }
        for (int a = 0; a < 3; ++a) {
            const auto at = static_cast<std::size_t>(a);
            EXPECT_EQ(image.points[at], vtk->GetDimensions()[a]);
            EXPECT_EQ(image.spacing[at], vtk->GetSpacing()[a]);
            EXPECT_EQ(image.origin[at], vtk->GetOrigin()[a]);
        }
        ASSERT_EQ(static_cast<vtkIdType>(points.position.size()), 3 * vtk_points->GetNumberOfPoints());
        ASSERT_GT(points.position.size(), 30u);
        for (std::size_t i = 0; i < points.position.size(); ++i)
            ASSERT_EQ(points.position[i], vtk_points->GetPoint(static_cast<vtkIdType>(i / 3))[i % 3]);
        EXPECT_EQ(static_cast<vtkIdType>(points.vertices.ends.size()), vtk_points->GetNumberOfVerts());
    }
}

TEST("a frame that is cut off anywhere is refused with its name") {
    const test::TemporaryFolder folder;
    for (const Compression compression : all_compressions) {
        const Written files = written(folder, 2, compression);
        for (const fs::path& file : {files.image, files.points}) {
            const std::string whole = text_of(file);
            for (std::size_t length = 0; length + 2 < whole.size(); length += 1 + whole.size() / 60) {
                std::ofstream(file, std::ios::binary) << whole.substr(0, length);
                EXPECT_EQ(outcome(file), 0) << length << " of " << whole.size();
            }
        }
    }
}

TEST("a frame with wrong bytes is refused, or read whole: 1800 damaged frames; the checksum of zlib leaves none with other numbers") {
    const test::TemporaryFolder folder;
    std::mt19937 random(33);
    for (const Compression compression : all_compressions) {
        const Written files = written(folder, 3, compression);
        for (const fs::path& file : {files.image, files.points}) {
            const std::string whole = text_of(file);
            const std::vector<real> numbers = numbers_of(read_vtk(file));
            const std::size_t data = whole.find("<AppendedData"), first = whole.find('_', data) + 1;
            for (int i = 0; i < 300; ++i) {
                std::string damaged = whole;
                const bool header = i % 2 == 0;
                const std::size_t at = header ? random() % first : first + random() % (whole.size() - first - 30);
                for (std::size_t b = 0; b < 1 + random() % 3 && at + b < whole.size(); ++b)
                    damaged[at + b] = static_cast<char>(i % 3 == 0 ? damaged[at + b] ^ (1 << random() % 8) : random());
                if (damaged == whole) continue;
                std::ofstream(file, std::ios::binary) << damaged;
                std::vector<real> others;
                if (outcome(file, &others) == 0 || header || compression != Compression::zlib) continue;
                EXPECT_EQ(others, numbers) << file << " at " << at;  // a bit that means nothing, as padding
            }
        }
    }
}

TEST("counts that the data cannot hold are refused before memory is taken for them") {
    const test::TemporaryFolder folder;
    const Written files = written(folder, 2, Compression::none);
    const auto changed = [&](const fs::path& file, const std::string& from, const std::string& to) {
        std::string text = text_of(file);
        for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
            text.replace(at, from.size(), to);
        const fs::path other = folder.path() / ("changed" + file.extension().string());
        std::ofstream(other, std::ios::binary) << text;
        return outcome(other);
    };
    EXPECT_EQ(changed(files.image, "nothing", "nothing"), 1);
    EXPECT_EQ(changed(files.image, "\"0 6 0 5 0 0\"", "\"0 99999999 0 99999999 0 99999999\""), 0);
    EXPECT_EQ(changed(files.image, "\"0 6 0 5 0 0\"", "\"0 -6 0 5 0 0\""), 0);
    EXPECT_EQ(changed(files.image, "Spacing=\"1 ", "Spacing=\"0 "), 0);
    EXPECT_EQ(changed(files.image, "Origin=\"0 ", "Origin=\"nan "), 0);
    EXPECT_EQ(changed(files.points, "NumberOfPoints=\"", "NumberOfPoints=\"999999999"), 0);
    EXPECT_EQ(changed(files.points, "NumberOfComponents=\"3\"", "NumberOfComponents=\"0\""), 0);
    EXPECT_EQ(changed(files.points, "type=\"Float64\"", "type=\"Float128\""), 0);
}

TEST("corners of cells that are no points are refused") {
    const test::TemporaryFolder folder;
    const Written files = written(folder, 2, Compression::none);
    const ReadFile whole = read_vtk(files.points);
    const std::string text = text_of(files.points);
    for (const std::int64_t corner : {std::int64_t{-1}, static_cast<std::int64_t>(whole.position.size() / 3), std::int64_t{1} << 62})
        for (const char* list : {"connectivity", "offsets"}) {
            const std::size_t tag = text.find(list), offset = text.find("offset=\"", tag + 12) + 8;
            const std::size_t at = text.find('_', text.find("<AppendedData")) + 1 + std::stoul(text.substr(offset)) + 4 + 8;
            std::string damaged = text;
            damaged.replace(at, 8, reinterpret_cast<const char*>(&corner), 8);
            std::ofstream(files.points, std::ios::binary) << damaged;
            EXPECT_EQ(outcome(files.points), 0) << list << ' ' << corner;
        }
}

}  // namespace vtk_read_tests
