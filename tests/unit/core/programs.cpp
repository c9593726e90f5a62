// Programs are started with lists of words, which no shell reads.
#include "core/programs.hpp"

#include "support/temporary_folder.hpp"
#include "support/test.hpp"

#include <fstream>

namespace programs_tests {

using namespace weir;

TEST("each word arrives as it is: quotes, back quotes, spaces, $ and % mean nothing") {
    for (const std::string word : {"a b", "it's", "\"q\"", "`touch x`", "$(touch x)", "$HOME", "; false", "|", "%d", "\\", "", "a\nb"})
        EXPECT_EQ(output_of_program({"printf", "%s", word}), word);
}

TEST("a program's exit code comes back, 128 + the signal that ended it, and 127 where there is none") {
    EXPECT_EQ(run_program({"true"}), 0);
    EXPECT_EQ(run_program({"sh", "-c", "exit 5"}), 5);
    EXPECT_EQ(run_program({"sh", "-c", "kill -9 $$"}), 128 + 9);
    EXPECT_EQ(run_program({"no_such_program_of_weir"}), 127);
    EXPECT_EQ(output_of_program({"false"}), std::nullopt);
    EXPECT_EQ(output_of_program({"no_such_program_of_weir"}), std::nullopt);
}

TEST("standard output goes to a file of any name, more than a pipe holds comes back whole, and nothing waits for input") {
    const test::TemporaryFolder folder;
    const auto file = folder.path() / "| touch x";
    EXPECT_EQ(run_program({"echo", "said"}, {.out = file}), 0);
    std::string said;
    std::getline(std::ifstream(file), said);
    EXPECT_EQ(said, "said");
    EXPECT_EQ(output_of_program({"head", "-c", "200000", "/dev/zero"})->size(), 200000u);  // a pipe holds 65536
    EXPECT_EQ(output_of_program({"cat"}), "");
}

TEST("a path that begins with - is no option") {
    EXPECT_EQ(file_argument("-f.mp4"), "./-f.mp4");
    EXPECT_EQ(file_argument("a/-f.mp4"), "a/-f.mp4");
}

}  // namespace programs_tests
