// Files of strangers are read whole or refused: no waiting, no end of memory, no part taken for all.
#include "core/words.hpp"

#include "core/error.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

#include <sys/resource.h>
#include <sys/stat.h>

namespace words_tests {

using namespace weir;
namespace fs = std::filesystem;

namespace {

std::string refusal(const fs::path& file, std::size_t most = 1000) {
    try {
        return "read: " + std::to_string(bytes_of(file, most).size());
    } catch (const BadInput& bad) {
        return bad.what();
    }
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST("a regular file is read whole, an empty one too, and up to its limit") {
    const test::TemporaryFolder folder;
    for (const std::size_t size : {0, 1, 999, 1000, 200000}) {
        const std::string text(size, 'x');
        std::ofstream(folder.path() / "f") << text;
        EXPECT_EQ(bytes_of(folder.path() / "f", 200000), text);
        EXPECT_EQ(has(refusal(folder.path() / "f"), "at most 1000 are read"), size > 1000) << size;
    }
}

TEST("devices, pipes without a writer, folders, looped links and empty names are refused at once, with what they are") {
    const test::TemporaryFolder folder;
    const fs::path pipe = folder.path() / "pipe", loop = folder.path() / "loop";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    fs::create_symlink("loop", loop);
    EXPECT_TRUE(has(refusal("/dev/zero"), "/dev/zero: this is a device or a pipe")) << refusal("/dev/zero");
    EXPECT_TRUE(has(refusal(pipe), "this is a device or a pipe")) << refusal(pipe);
    EXPECT_TRUE(has(refusal(folder.path()), "this is a folder")) << refusal(folder.path());
    EXPECT_TRUE(has(refusal(loop), "Too many levels of symbolic links")) << refusal(loop);
    EXPECT_TRUE(has(refusal(""), "a file name must not be empty")) << refusal("");
}

TEST("a file that says it is empty and is not is read to its end, or refused at the limit") {
    EXPECT_TRUE(has(refusal("/proc/self/maps", 1 << 20), "read: ")) << refusal("/proc/self/maps", 1 << 20);
    EXPECT_GT(bytes_of("/proc/self/maps").size(), 100u);
    EXPECT_TRUE(has(refusal("/proc/self/maps", 10), "more than 10 bytes")) << refusal("/proc/self/maps", 10);
}

TEST("where memory ends the file is refused: what has been read is not taken for all of it") {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the address sanitizer maps more memory than the limit of this test";
#endif
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "large") << 'x';
    fs::resize_file(folder.path() / "large", std::uintmax_t{1} << 34);  // sparse: no bytes on the disk
    rlimit before{};
    getrlimit(RLIMIT_AS, &before);
    const rlimit small{std::size_t{1} << 33, before.rlim_max};
    if (setrlimit(RLIMIT_AS, &small) != 0) GTEST_SKIP() << "no limit of memory";
    const std::string said = refusal(folder.path() / "large", std::size_t{1} << 35);
    setrlimit(RLIMIT_AS, &before);
    EXPECT_TRUE(has(said, "not enough memory")) << said;
}

}  // namespace words_tests
