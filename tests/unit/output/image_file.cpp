#include "output/image_file.hpp"

#include "output/png_read.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include <vtkImageData.h>
#include <vtkJPEGReader.h>
#include <vtkNew.h>

namespace image_file_tests {

namespace {

namespace fs = std::filesystem;

constexpr int width = 96, height = 64;

/// A sky above a sea: smooth, as rendered pictures are.
std::vector<std::uint8_t> landscape() {
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const int channel : {0, 1, 2})
                rgb.push_back(static_cast<std::uint8_t>(y < height / 2 ? 200 + 10 * channel + y / 2
                                                                       : 60 + 30 * channel + 20 * std::sin(.3 * x + .01 * y * y)));
    return rgb;
}

TEST("a picture as JPEG is the picture, right way up, to what quality 88 allows, and smaller") {
    weir::test::TemporaryFolder folder;
    const fs::path png = folder.path() / "sea.png", jpeg = folder.path() / "sea.jpg";
    const auto rgb = landscape();
    weir::output::write_png(png, width, height, rgb);
    const std::string bytes = weir::output::jpeg_of(png);
    EXPECT_GT(bytes.size(), 100u);
    EXPECT_LT(bytes.size(), fs::file_size(png));
    std::ofstream(jpeg, std::ios::binary) << bytes;

    vtkNew<vtkJPEGReader> reader;
    reader->SetFileName(jpeg.c_str());
    reader->Update();
    EXPECT_EQ(reader->GetOutput()->GetDimensions()[0], width);
    EXPECT_EQ(reader->GetOutput()->GetDimensions()[1], height);
    double squares = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int channel = 0; channel < 3; ++channel) {
                const double was = rgb[static_cast<std::size_t>(3 * (y * width + x) + channel)];
                squares += std::pow(reader->GetOutput()->GetScalarComponentAsDouble(x, height - 1 - y, 0, channel) - was, 2);
            }
    // 40 dB is where differences stop being seen (root mean square 255/100); upside down it would be some 100.
    EXPECT_LT(std::sqrt(squares / (3 * width * height)), 2.55);
}

TEST("a PNG reads back as it was written; cut off anywhere, or with any byte changed, it is none") {
    weir::test::TemporaryFolder folder;
    const fs::path png = folder.path() / "sea.png", bad = folder.path() / "bad.png";
    const auto rgb = landscape();
    weir::output::write_png(png, width, height, rgb, "a test");
    EXPECT_TRUE(weir::output::was_made_as(png, "a test"));
    EXPECT_FALSE(weir::output::was_made_as(png, "another"));
    const auto read = weir::output::read_png(png);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->width, width);
    EXPECT_TRUE(read->rgb == rgb);
    std::ostringstream text;
    text << std::ifstream(png, std::ios::binary).rdbuf();
    const std::string whole = text.str();
    for (std::size_t at = 0; at < whole.size(); at += at < 200 ? 1 : 37) {
        std::ofstream(bad, std::ios::binary) << whole.substr(0, at);
        EXPECT_FALSE(weir::output::read_png(bad)) << "cut off at " << at;
        std::string changed = whole;
        changed[at] = static_cast<char>(changed[at] ^ 0x55);
        std::ofstream(bad, std::ios::binary) << changed;
        EXPECT_FALSE(weir::output::read_png(bad)) << "byte " << at;
    }
}

TEST("what is no picture gives no JPEG") {
    weir::test::TemporaryFolder folder;
    std::ofstream(folder.path() / "note.png") << "not a picture";
    EXPECT_TRUE(weir::output::jpeg_of(folder.path() / "note.png").empty());
    EXPECT_TRUE(weir::output::jpeg_of(folder.path() / "absent.png").empty());
}

}  // namespace

}  // namespace image_file_tests
