// Tables of others are read as they stand, and a damaged one is refused by name.
#include "validation/references/table.hpp"

#include "core/error.hpp"
#include "support/test.hpp"

#include <fstream>

namespace table_tests {

using namespace weir;
using namespace weir::validation;

namespace {

std::filesystem::path file_with(const std::string& text) {
    const auto path = std::filesystem::path(WEIR_BINARY_DIR) / "table_under_test.csv";
    std::ofstream(path) << text;
    return path;
}

}  // namespace

TEST("comments are skipped, columns found by name, rows chosen by value, quoted commas kept") {
    const Table t = read_table(file_with("# source\nkind,x,note\nu,0.5,\"a, b\"\nv,1,\nu,2e-1,c\r\n"));
    EXPECT_EQ(t.rows.size(), 3u);
    EXPECT_EQ(t.text(0, "note"), "a, b");
    const Table u = t.where("kind", "u");
    ASSERT_EQ(u.rows.size(), 2u);
    EXPECT_EQ(u.number(1, "x"), 0.2);
    EXPECT_EQ(u.text(1, "note"), "c");
}

TEST("what is missing, ragged, empty or not a number is bad input") {
    EXPECT_THROW(read_table("/nowhere/table.csv"), BadInput);
    EXPECT_THROW(read_table(file_with("# only a comment\na,b\n")), BadInput);
    EXPECT_THROW(read_table(file_with("a,b\n1\n")), BadInput);
    const Table t = read_table(file_with("a,b\n1,2x\n"));
    EXPECT_THROW(t.number(0, "b"), BadInput);
    EXPECT_THROW(t.number(0, "c"), BadInput);
}

}  // namespace table_tests
