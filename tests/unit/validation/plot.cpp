// Where titles, legends and names of a plot lie, read from its gnuplot program.
#include "core/error.hpp"
#include "support/temporary_folder.hpp"
#include "support/test.hpp"
#include "validation/report/svg.hpp"

#include <cmath>
#include <fstream>
#include <regex>

namespace plot_tests {

namespace {

using namespace weir;
using namespace weir::validation;

struct Label {
    std::string text;
    double x, y;  // from the left and from the top [pixels]
};

struct Plot {
    double width = 0, height = 0;
    std::vector<Label> labels{};
    std::vector<double> tops{}, bottoms{};  // of the axes of each panel

    const Label& at(const std::string& text) const {
        for (const Label& l : labels)
            if (l.text == text) return l;
        throw std::runtime_error("no label " + text);
    }
};

Plot plot_of(const std::string& program) {
    Plot plot;
    std::smatch m;
    std::regex_search(program, m, std::regex("svg size ([0-9]+),([0-9]+)"));
    plot.width = std::stod(m[1]), plot.height = std::stod(m[2]);
    const std::regex label("set label '(.*)' at screen ([-0-9.]+),([-0-9.]+)"),
        edges("tmargin at screen ([0-9.]+); set bmargin at screen ([0-9.]+)");
    for (std::sregex_iterator i(program.begin(), program.end(), label), end; i != end; ++i)
        plot.labels.push_back({(*i)[1], std::stod((*i)[2]) * plot.width, (1 - std::stod((*i)[3])) * plot.height});
    for (std::sregex_iterator i(program.begin(), program.end(), edges), end; i != end; ++i)
        plot.tops.push_back((1 - std::stod((*i)[1])) * plot.height), plot.bottoms.push_back((1 - std::stod((*i)[2])) * plot.height);
    return plot;
}

/// `count` curves with long names.
Panel panel(const std::string& title, std::size_t count) {
    Panel p{.title = title, .x = {title + " x", true}, .y = {title + " y", true}};
    for (std::size_t k = 0; k < count; ++k)
        p.curves.push_back(
            {.label = title + " a-method-with-a-long-name-" + std::to_string(k), .x = {1, 10}, .y = {1.0 + static_cast<double>(k), 2}});
    return p;
}

TEST("values that differ by round-off are drawn as a flat line: the range of their axis is not empty") {
    for (const bool log : {false, true}) {
        Panel p{.title = "p", .x = {"x", false}, .y = {"y", log}};
        p.curves = {{.label = "kept", .x = {0, 1}, .y = {0.25, 0.25 * (1 + 1e-15)}}};
        const std::string program = gnuplot_program("flat", {p});
        std::smatch m;
        ASSERT_TRUE(std::regex_search(program, m, std::regex("set yrange \\[([-0-9.e]+):([-0-9.e]+)\\]")));
        EXPECT_LT(std::stod(m[1]), 0.2);
        EXPECT_GT(std::stod(m[2]), 0.3);
    }
}

TEST("legends lie below their axis titles and above the next row of panels, however many curves there are") {
    for (const std::size_t count : {1, 3, 9, 44}) {
        const Plot plot = plot_of(gnuplot_program("all", {panel("p", count), panel("q", 1), panel("r", count), panel("s", 2)}));
        constexpr double text = 16;  // height of a line of text, with room
        ASSERT_EQ(plot.tops.size(), 4u);
        for (const std::string name : {"p", "q", "r", "s"}) {
            const double below_legends = name < "r" ? plot.at("r").y : plot.height + text / 2;
            const Label& axis = plot.at(name + " x");
            EXPECT_LT(plot.bottoms[name < "r" ? 0 : 2] + text, axis.y) << "ticks have room";
            double last = axis.y;
            for (const Label& l : plot.labels) {
                if (!l.text.starts_with(name + " a-method")) continue;
                EXPECT_GE(l.y, axis.y + text) << l.text;
                EXPECT_LE(l.y + text, below_legends) << l.text;
                EXPECT_LE(l.x + 5.5 * static_cast<double>(l.text.size()), (name == "p" || name == "r" ? 0.5 : 1) * plot.width) << l.text;
                EXPECT_GE(l.y, last) << "rows from the top";
                last = l.y;
            }
        }
    }
}

TEST("a plot has the points that its axes can show; names of points lie inside the panel and apart") {
    Panel p{.title = "t", .x = {"x", true}, .y = {"y", true}, .curves = {{.label = "a", .x = {1, 10, -1, 3}, .y = {1, 2, 3, INFINITY}}}};
    p.curves.push_back({.label = "front", .x = {1, 1.01, 10}, .y = {1, 1.01, 2}, .dashed = true, .names = {"first", "second", "third"}});
    p.shade = {1.2, "not distinguishable"}, p.marks = {{5, "real time"}, {100, "outside"}};
    const std::string program = gnuplot_program("", {p});
    EXPECT_NE(program.find("$p0c0 << EOD\n1 1\n10 2\nEOD"), std::string::npos) << program;
    EXPECT_EQ(program.find("outside"), std::string::npos);
    const Plot plot = plot_of(program);
    for (const char* name : {"first", "second", "third", "real time"}) {
        EXPECT_GT(plot.at(name).y, plot.tops[0]) << name;
        EXPECT_LT(plot.at(name).y, plot.bottoms[0]) << name;
    }
    EXPECT_GT(std::hypot(plot.at("first").x - plot.at("second").x, plot.at("first").y - plot.at("second").y), 10);
    EXPECT_GT(plot.at("not distinguishable").y, plot.at("x").y);
    EXPECT_NE(gnuplot_program("", {{.title = "empty"}}).find("unset multiplot"), std::string::npos)
        << "a panel without points draws nothing";
}

const Map map{.title = "t",
              .x_label = "x",
              .y_label = "y",
              .x = {"1", "2"},
              .y = {"a"},
              .cells = {{{.text = "held"}}, {{.stable = false, .kind = 0, .text = "7"}}},
              .kinds = {"volume"}};

TEST("a map has a cell per run in the colour of its outcome, and a legend of the outcomes") {
    const std::string program = gnuplot_program(map);
    EXPECT_NE(program.find("from first 0,0 to first 1,1 fc rgb '#cfe8dc'"), std::string::npos) << program;
    EXPECT_NE(program.find("from first 1,0 to first 2,1 fc rgb '#0072b2'"), std::string::npos) << program;
    const Plot plot = plot_of(program);
    EXPECT_GT(plot.at("no failure").y, plot.at("x").y + 16);
    EXPECT_GT(plot.at("first failure: volume (step)").y, plot.at("no failure").y + 16);
}

TEST("gnuplot draws panels and maps, and runs nothing that a name says") {
    test::TemporaryFolder folder;
    Panel p = panel("it's `touch bad` \"$x\"", 2);
    p.curves[0].names = {"\"`touch bad`", "x"};
    try {
        draw(gnuplot_program("system('touch bad')", {p, p}), folder.path() / "a" / "p.svg");
        draw(gnuplot_program(map), folder.path() / "m.svg");
    } catch (const OutputError& error) {
        if (std::string(error.what()).find("is not on the PATH") != std::string::npos) GTEST_SKIP() << error.what();
        throw;
    }
    for (const char* file : {"a/p.svg", "m.svg"}) {
        std::ifstream in(folder.path() / file);
        const std::string svg{std::istreambuf_iterator<char>(in), {}};
        EXPECT_NE(svg.find("</svg>"), std::string::npos) << file;
    }
    EXPECT_FALSE(std::filesystem::exists("bad"));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "m.gnuplot"));
}

}  // namespace

}  // namespace plot_tests
