// Checkpoints whose checksum is right and whose content is not, as a stranger may make them: each is refused as bad input, fails as a
// numerical failure, or runs. Nothing crashes, runs for ever, or takes memory for counts that the file cannot hold.
#include "core/checkpoint.hpp"
#include "core/error.hpp"
#include "sim/registry.hpp"
#include "sim/simulation.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <random>
#include <sstream>
#include <utility>

namespace crafted_checkpoints_tests {

using namespace weir;
namespace fs = std::filesystem;

namespace {

using Blocks = std::vector<std::pair<std::string, std::string>>;

std::uint64_t number_at(const std::string& bytes, std::size_t at) {
    std::uint64_t n = 0;
    std::memcpy(&n, bytes.data() + at, sizeof n);
    return n;
}
std::string text_of(std::uint64_t n) { return {reinterpret_cast<const char*>(&n), sizeof n}; }

Blocks blocks_of(const fs::path& file) {
    std::ostringstream all;
    all << std::ifstream(file, std::ios::binary).rdbuf();
    const std::string bytes = all.str();
    Blocks blocks;
    std::size_t at = 16;
    for (std::uint64_t b = 0; b < number_at(bytes, 8); ++b) {
        const std::size_t name = number_at(bytes, at), size = number_at(bytes, at + 8 + name);
        blocks.emplace_back(bytes.substr(at + 8, name), bytes.substr(at + 16 + name, size));
        at += 16 + name + size;
    }
    return blocks;
}

void write(const fs::path& file, const Blocks& blocks, std::uint64_t extra = 0) {
    std::string bytes = "weircp01" + text_of(blocks.size() + extra);
    for (const auto& [name, content] : blocks) bytes += text_of(name.size()) + name + text_of(content.size()) + content;
    std::uint64_t hash = 0xcbf29ce484222325ull;  // FNV-1a, as parallel/checkpoint_file.cpp has it
    for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
    std::ofstream(file, std::ios::binary) << bytes << text_of(hash);
}

/// Goes on from the file for two steps. 1: it runs; 0: bad input; 3: a numerical failure. Anything else that is thrown fails the test.
int outcome(const fs::path& file) {
    try {
        const Checkpoint checkpoint = Checkpoint::read(file);
        Simulation simulation(scene_of(checkpoint, {}));
        simulation.restore(checkpoint);
        simulation.step();
        simulation.step();
        return 1;
    } catch (const BadInput&) {
        return 0;
    } catch (const NumericalFailure&) {
        return 3;
    } catch (const std::bad_alloc&) {  // exit code 2
        return 0;
    }
}

fs::path scene_file(const std::string& name) { return std::string(WEIR_SOURCE_DIR) + "/tests/app/scenes/" + name + ".toml"; }

/// A checkpoint of a few steps.
Blocks start(const std::string& name, const fs::path& file, const std::string& cells = "") {
    Simulation simulation(scene_file(name),
                          cells.empty() ? std::vector<scene::Override>{} : std::vector<scene::Override>{{"grid.cells", cells}});
    for (int i = 0; i < 3; ++i) simulation.step();
    Checkpoint checkpoint;
    simulation.save(checkpoint);
    checkpoint.write(file);
    return blocks_of(file);
}

template <class T>
std::string filled(std::size_t size, T value) {
    std::string bytes(size, '\0');
    for (std::size_t at = 0; at + sizeof value <= size; at += sizeof value) std::memcpy(bytes.data() + at, &value, sizeof value);
    return bytes;
}

/// What a block becomes.
std::vector<std::string> mutations(const std::string& content, std::mt19937& random) {
    const std::size_t n = content.size();
    std::vector<std::string> all{"",
                                 content.substr(0, n / 2),
                                 content + "x",
                                 content + content,
                                 std::string(n, '\xff'),
                                 std::string(n, '\0'),
                                 filled(n, std::numeric_limits<double>::quiet_NaN()),
                                 filled(n, std::numeric_limits<double>::infinity()),
                                 filled(n, 1e300),
                                 filled(n, -1e9),
                                 filled(n, 1e6),
                                 filled(n, std::numeric_limits<std::int64_t>::max()),
                                 filled(n, std::int64_t{-1}),
                                 filled(n, std::int64_t{1000})};
    std::string flipped = content;
    for (int i = 0; i < 4 && n > 0; ++i) flipped[random() % n] = static_cast<char>(random());
    all.push_back(flipped);
    return all;
}

void expect_harmless(const std::string& name, const std::string& cells = "") {
    const test::TemporaryFolder folder;
    const fs::path file = folder.path() / "checkpoint.weir";
    const Blocks whole = start(name, file, cells);
    EXPECT_EQ(outcome(file), 1) << name;
    std::mt19937 random(33);
    for (std::size_t b = 0; b < whole.size(); ++b) {
        Blocks without = whole;
        without.erase(without.begin() + static_cast<std::ptrdiff_t>(b));
        write(file, without);
        EXPECT_NO_THROW(outcome(file)) << name << ": without " << whole[b].first;
        const auto list = mutations(whole[b].second, random);
        for (std::size_t m = 0; m < list.size(); ++m) {
            Blocks changed = whole;
            changed[b].second = list[m];
            write(file, changed);
            EXPECT_NO_THROW(outcome(file)) << name << ": " << whole[b].first << ", mutation " << m;
        }
    }
}

}  // namespace

TEST("counts of blocks and sizes that the file cannot hold are refused") {
    const test::TemporaryFolder folder;
    const fs::path file = folder.path() / "checkpoint.weir";
    const Blocks whole = start("smoke", file);
    for (const std::uint64_t extra : {std::uint64_t{1}, std::uint64_t{1} << 40, ~std::uint64_t{0} - whole.size()}) {
        write(file, whole, extra);
        EXPECT_EQ(outcome(file), 0);
    }
}

TEST("changes of the scene without an end, or without a key, are refused") {
    const test::TemporaryFolder folder;
    const fs::path file = folder.path() / "checkpoint.weir";
    Blocks blocks = start("smoke", file);
    for (const std::string& text : {std::string("time.end=1"), std::string("a\0b=\0", 5), std::string("\0\0", 2), std::string("=")}) {
        for (auto& [name, content] : blocks)
            if (name == "sim.overrides") content = text;
        write(file, blocks);
        EXPECT_EQ(outcome(file), 0) << text;
    }
}

TEST("numbers that are not finite, and counts that overflow within a few steps, are refused") {
    const test::TemporaryFolder folder;
    const fs::path file = folder.path() / "checkpoint.weir";
    const auto refused = [&](const std::string& scene, const std::string& block, const auto value, const std::string& cells = "") {
        Blocks blocks = start(scene, file, cells);
        const auto is_it = [&](const auto& b) { return b.first == block; };
        const auto it = std::find_if(blocks.begin(), blocks.end(), is_it);
        ASSERT_NE(it, blocks.end()) << scene << " has no block " << block;
        it->second = filled(it->second.size(), value);
        write(file, blocks);
        EXPECT_EQ(outcome(file), 0) << scene << ": " << block;
    };
    const real nan = std::numeric_limits<real>::quiet_NaN();
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    refused("water", "leapfrog.rate.0", nan), refused("water", "water.reals", nan), refused("water", "water.counts", most);
    refused("ranks_tall", "leapfrog.rate.1", nan), refused("ranks_tall", "tallcell.reals", nan),
        refused("ranks_tall", "tallcell.steps", most);
    refused("ranks_shallow", "discharge_x", nan, "[12, 1, 14]"), refused("ranks_columns", "steps", most);
    refused("two_phase", "two_phase.steps", most), refused("two_phase", "two_phase.ruled", most), refused("dam", "particles.steps", most),
        refused("smoke", "u_x", nan);
}

TEST("any block of smoke may be crafted") { expect_harmless("smoke"); }
TEST("any block of water with markers may be crafted") { expect_harmless("water"); }
TEST("any block of floats on water may be crafted") { expect_harmless("raft"); }
TEST("any block of particles may be crafted") { expect_harmless("dam"); }
TEST("any block of tall cells may be crafted") { expect_harmless("ranks_tall"); }
TEST("any block of shallow water may be crafted") { expect_harmless("ranks_shallow", "[12, 1, 14]"); }
TEST("any block of columns may be crafted") { expect_harmless("ranks_columns"); }
TEST("any block of liquid and gas may be crafted") { expect_harmless("two_phase"); }
TEST("any block of waves may be crafted") { expect_harmless("ranks_waves", "[15, 1, 22]"); }

}  // namespace crafted_checkpoints_tests
