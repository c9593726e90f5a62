#include "core/checkpoint.hpp"

#include "core/error.hpp"
#include "support/test.hpp"

#include <filesystem>
#include <fstream>
#include <vector>

using namespace weir;

namespace {
std::filesystem::path scratch(const std::string& name) { return std::filesystem::path(testing::TempDir()) / ("weir_checkpoint_" + name); }
}  // namespace

TEST("a checkpoint read back equals the one written, bit for bit") {
    Checkpoint out;
    const std::vector<double> values{0.1, -0.0, 1e-310, std::numeric_limits<double>::infinity()};
    out.put("values", values);
    out.put_value("step", std::int64_t{42});
    out.write(scratch("same"));
    const auto in = Checkpoint::read(scratch("same"));
    std::vector<double> back;
    in.get("values", back);
    ASSERT_EQ(back.size(), values.size());
    EXPECT_EQ(std::memcmp(back.data(), values.data(), values.size() * sizeof(double)), 0);
    EXPECT_EQ(in.get_value<std::int64_t>("step"), 42);
}

TEST("a truncated or altered checkpoint is refused, whatever byte is missing or changed") {
    Checkpoint out;
    out.put("values", std::vector<double>{1, 2, 3});
    const auto whole = scratch("whole"), bad = scratch("bad");
    out.write(whole);
    std::ifstream file(whole, std::ios::binary);
    const std::string image((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    for (std::size_t cut = 0; cut < image.size(); ++cut) {
        std::ofstream(bad, std::ios::binary) << image.substr(0, cut);
        EXPECT_THROW(Checkpoint::read(bad), BadInput) << "cut to " << cut << " bytes";
        std::string altered = image;
        altered[cut] = static_cast<char>(altered[cut] ^ 1);
        std::ofstream(bad, std::ios::binary) << altered;
        EXPECT_THROW(Checkpoint::read(bad), BadInput) << "altered byte " << cut;
    }
}

TEST("writing where nothing can be written is an output error and leaves nothing behind") {
    EXPECT_THROW(Checkpoint().write("/nonexistent/folder/checkpoint"), OutputError);
}
