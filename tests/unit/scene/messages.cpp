#include "scene/names.hpp"
#include "scene/source_text.hpp"
#include "support/test.hpp"
#include "unit/scene/schema.hpp"

namespace messages_tests {

using namespace weir;
using namespace weir::scene;

namespace {

const char* const head = "solver = \"smoke\"\ndim = 2\ngrid = { cells = [4, 4], size = [1, 1] }\ntime.end = 1\n";

std::string refusal(const std::string& more) {
    try {
        (void)parse(head + more, "scene.toml", made_up::schemas());
    } catch (const BadScene& e) {
        return e.what();
    }
    return "accepted";
}

template <class Refuse>
std::string said_by(const Refuse& refuse) {
    try {
        refuse();
    } catch (const BadScene& e) {
        return e.what();
    }
    return "nothing";
}

}  // namespace

TEST("the distance of words counts insertions, deletions, replacements and swaps, and ignores case") {
    EXPECT_EQ(edit_distance("", "abc"), 3);
    EXPECT_EQ(edit_distance("kitten", "sitting"), 3);  // the classic example
    EXPECT_EQ(edit_distance("buoyancy", "bouyancy"), 1);
    EXPECT_EQ(edit_distance("ca", "abc"), 3);  // no letter is changed twice: Damerau's unrestricted distance would be 2
    EXPECT_EQ(edit_distance("MAC", "mac"), 0);
}

TEST("a name is suggested only where it may have been meant") {
    const std::vector<std::string> names = {"gravity", "buoyancy", "confinement", "rotation"};
    EXPECT_EQ(nearest("gravty", names), "gravity");
    EXPECT_EQ(nearest("rotate", names), "rotation");
    EXPECT_EQ(nearest("colour", names), "");
    EXPECT_EQ(nearest("", names), "");
    EXPECT_EQ(nearest(std::string(1000, 'g'), names), "");
}

TEST("what is underlined is the word, text, list or number that begins there") {
    EXPECT_EQ(token_width("a = [1, 2] # x", 5), 6);
    EXPECT_EQ(token_width("a = [1, [2, 3]]", 9), 6);
    EXPECT_EQ(token_width("a = \"x, \\\" y\", 3", 5), 9);
    EXPECT_EQ(token_width("a = -1.5e3, 2", 5), 6);
    EXPECT_EQ(token_width("[effects.gravity]", 2), 7);
    EXPECT_EQ(token_width("a = { b = 1 }", 5), 1);
    EXPECT_EQ(token_width("a =", 4), 1);
    EXPECT_EQ(token_width("é = \"ü\"", 5), 3) << "columns count characters, not bytes";
}

TEST("tabs and letters beyond ASCII do not move the underline") {
    EXPECT_EQ(refusal("fluid = {\tdensity = -1 }\n"),
              "scene.toml:5:21: fluid.density is -1 kg/m^3; it must be greater than 0 kg/m^3\n"
              "    5 | fluid = {    density = -1 }\n"
              "      |                        ^~");
    EXPECT_EQ(refusal("output.fields = [\"größe\", 7]\n"),
              "scene.toml:5:27: output.fields[1] must be a text; found the integer 7\n"
              "    5 | output.fields = [\"größe\", 7]\n"
              "      |                           ^");
}

TEST("of a long line the part around the mistake is shown") {
    const auto text = refusal("title = \"" + std::string(200, 'x') + "\"\nprobes = [" + std::string(300, ' ') + "{ kind = \"front\" }" +
                              std::string(300, ' ') + "]\n");
    EXPECT_NE(text.find("    6 | ...  "), std::string::npos) << text;
    EXPECT_NE(text.find("{ kind = \"front\" }"), std::string::npos) << text;
    for (std::size_t begin = 0; begin < text.size();) {
        const auto end = std::min(text.find('\n', begin), text.size());
        EXPECT_LT(end - begin, 160U);
        begin = end + 1;
    }
}

TEST("many problems are counted, and not all are shown") {
    std::string many;
    for (int i = 0; i < 80; ++i) many += "unknown_" + std::to_string(i) + " = 1\n";
    const auto text = refusal(many);
    EXPECT_NE(text.find("... and 30 more\n80 problems"), std::string::npos) << text.substr(text.size() - 100);
}

TEST("a solver refuses a scene at the place of a key, of its table where the key is a default, or of the whole file") {
    const auto s = parse(std::string(head) + "solids = [{ shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1 }]\n", "scene.toml",
                         made_up::schemas(), {{"fluid.density", "2"}});
    EXPECT_EQ(said_by([&] { s.refuse("solids[0].radius", "too small", "try 1 m"); }),
              "scene.toml:5:61: too small\n"
              "    5 | solids = [{ shape = \"sphere\", centre = [0.5, 0.5], radius = 0.1 }]\n"
              "      |                                                             ^~~   try 1 m");
    EXPECT_EQ(said_by([&] { s.refuse("grid.origin", "far away"); }),
              "scene.toml:3:8: far away\n"
              "    3 | grid = { cells = [4, 4], size = [1, 1] }\n"
              "      |        ^");
    EXPECT_EQ(said_by([&] { s.refuse("liquid", "there is no fluid"); }), "scene.toml: there is no fluid");
    EXPECT_EQ(said_by([&] { s.refuse("fluid.density", "too heavy"); }),
              "--set fluid.density=2: too heavy\n"
              "      | fluid.density=2\n"
              "      |               ^");
    EXPECT_EQ(said_by([&] {
                  s.refuse({s.problem("grid.cells", "one"), s.problem("dim", "two")});
              }),
              "scene.toml:2:7: two\n"
              "    2 | dim = 2\n"
              "      |       ^\n"
              "scene.toml:3:18: one\n"
              "    3 | grid = { cells = [4, 4], size = [1, 1] }\n"
              "      |                  ^~~~~~\n"
              "2 problems");
}

TEST("a file with a byte order mark or Windows line ends is a file like any other") {
    std::string windows = "\xEF\xBB\xBF" + std::string(head);
    for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2) windows.insert(at, "\r");
    EXPECT_EQ(parse(windows, "scene.toml", made_up::schemas()).number("time.end"), 1);
}

}  // namespace messages_tests
