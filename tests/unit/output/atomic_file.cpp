// What a path names is kept: a device, a pipe and a link stay what they are.
#include "output/atomic_file.hpp"

#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>
#include <sstream>
#include <thread>

#include <sys/stat.h>

namespace atomic_file_tests {

namespace {

namespace fs = std::filesystem;
using weir::output::write_file;
using weir::test::TemporaryFolder;

std::string text_of(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

TEST("a regular file is replaced, and nothing else is left in the folder") {
    TemporaryFolder folder;
    write_file(folder.path() / "a", "one");
    write_file(folder.path() / "a", "two");
    EXPECT_EQ(text_of(folder.path() / "a"), "two");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

TEST("a symbolic link stays one, and the file that it points to is written, also where it was not there yet") {
    TemporaryFolder folder;
    fs::create_directory(folder.path() / "real");
    fs::create_symlink("real/file", folder.path() / "link");
    for (const std::string text : {"one", "two"}) {
        write_file(folder.path() / "link", text);
        EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
        EXPECT_EQ(text_of(folder.path() / "real/file"), text);
    }
}

TEST("a pipe stays one, and its reader gets the bytes") {
    TemporaryFolder folder;
    const auto pipe = folder.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::string got;
    std::thread reader([&] { got = text_of(pipe); });
    write_file(pipe, "through");
    reader.join();
    EXPECT_EQ(got, "through");
    EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST("a device stays one; a full one is an error that names it") {
    write_file("/dev/null", "gone");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
    try {
        write_file("/dev/full", "too much");
        FAIL() << "accepted";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("/dev/full: No space left"), std::string::npos) << error.what();
    }
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

}  // namespace

}  // namespace atomic_file_tests
