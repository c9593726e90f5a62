#include "core/checkpoint.hpp"

#include "core/error.hpp"
#include "support/count_allocations.hpp"
#include "support/forked_ranks.hpp"
#include "support/test.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

namespace checkpoint_tests {

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

namespace {

/// A block of numbers that ranks share, and one that all have.
void write_in_parallel(const std::filesystem::path& path, std::size_t count) {
    const Checkpoint::Held share = Checkpoint::Held{0, count, count, false}.share(communicator().rank(), communicator().ranks());
    std::vector<double> own;
    for (std::size_t i = share.begin; i < share.end; ++i) own.push_back(0.5 * static_cast<double>(i));
    Checkpoint out;
    out.put_part("field", std::span<const double>(own), share.begin, count);
    out.put_value("time", 0.25);
    out.write(path);
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// What a reader says; empty where it takes the file.
std::string refusal(const std::filesystem::path& path) {
    try {
        Checkpoint::read(path);
    } catch (const BadInput& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST(
    "a checkpoint of several ranks has the bytes of one, and each of other ranks reads no more than its part and its part of the "
    "checksum") {
    constexpr std::size_t count = 30001;
    write_in_parallel(scratch("one"), count);
    const std::string whole = bytes_of(scratch("one"));
    for (const int ranks : {2, 3}) {
        test::on_ranks(ranks, [] { write_in_parallel(scratch("several"), count); });
        EXPECT_TRUE(bytes_of(scratch("several")) == whole) << ranks;
    }
    for (const int ranks : {1, 2, 4})
        test::on_ranks(ranks, [&] {
            const Checkpoint in = Checkpoint::read(scratch("several"));
            const auto share = in.held<double>("field").share(communicator().rank(), communicator().ranks());
            std::vector<double> own(share.end - share.begin);
            in.get_part("field", std::span<double>(own), share.begin, share.all);
            for (std::size_t i = 0; i < own.size(); ++i) ASSERT_EQ(own[i], 0.5 * static_cast<double>(share.begin + i));
            EXPECT_EQ(in.get_value<double>("time"), 0.25);
            // a rank's part of the file for the checksum, its part of the field, and beside them names, sizes, the time, the sum: 3 blocks'
            // worth
            const auto r = static_cast<std::size_t>(ranks);
            EXPECT_LE(in.bytes_read(), whole.size() / r + 1 + count / r * sizeof(double) + sizeof(double) + 128);
        });
}

TEST("while a rank reads, it holds its part and a piece of the file") {
    constexpr std::size_t count = std::size_t{1} << 22;  // 32 MiB
    write_in_parallel(scratch("large"), count);
    for (const int ranks : {1, 2, 4})
        test::on_ranks(ranks, [&] {
            const long before = test::held;
            test::most_held = before;
            const Checkpoint in = Checkpoint::read(scratch("large"));
            const auto share = in.held<double>("field").share(communicator().rank(), communicator().ranks());
            std::vector<double> own(share.end - share.begin);
            in.get_part("field", std::span<double>(own), share.begin, share.all);
            // a piece is 1 MiB; names, lists of ranks, pages at the ends of both: less than 64 KiB
            EXPECT_LE(test::most_held - before,
                      static_cast<long>(count * sizeof(double) / static_cast<std::size_t>(ranks) + (1 << 20) + (1 << 16)));
        });
}

TEST("several ranks refuse a file alike, whichever of them sees what is wrong") {
    write_in_parallel(scratch("right"), 1000);
    const std::string whole = bytes_of(scratch("right"));
    const auto bad = scratch("wrong");
    for (std::size_t at = 0; at < whole.size(); at += 401) {  // some in each rank's part
        std::string altered = whole;
        altered[at] = static_cast<char>(altered[at] ^ 1);
        for (const std::string& text : {altered, whole.substr(0, at)}) {
            std::ofstream(bad, std::ios::binary) << text;
            const std::string one = refusal(bad);
            EXPECT_FALSE(one.empty()) << "byte " << at;
            test::on_ranks(3, [&] { EXPECT_EQ(refusal(bad), one) << "byte " << at << ", rank " << communicator().rank(); });
        }
    }
    std::filesystem::remove(bad);
    const std::string one = refusal(bad);
    EXPECT_NE(one.find("cannot read"), std::string::npos);
    test::on_ranks(3, [&] { EXPECT_EQ(refusal(bad), one); });
    // a rank for which it is another file, as on a machine with another disk
    test::on_ranks(3, [&] {
        const auto own = scratch("wrong_" + std::to_string(communicator().rank()));
        std::ofstream(own, std::ios::binary) << (communicator().rank() == 1 ? whole.substr(0, 700) : whole);
        EXPECT_NE(refusal(own).find("truncated or altered"), std::string::npos) << communicator().rank();
    });
}

TEST("a checkpoint that is replaced while it is read stays what it was") {
    Checkpoint first, second;
    first.put("values", std::vector<double>{1, 2, 3});
    second.put("values", std::vector<double>{4, 5});
    first.write(scratch("replaced"));
    const Checkpoint in = Checkpoint::read(scratch("replaced"));
    second.write(scratch("replaced"));
    std::vector<double> back;
    in.get("values", back);
    EXPECT_EQ(back, (std::vector<double>{1, 2, 3}));
    in.write(scratch("copied"));  // from the one file to the other
    Checkpoint::read(scratch("copied")).get("values", back);
    EXPECT_EQ(back, (std::vector<double>{1, 2, 3}));
}

}  // namespace checkpoint_tests
