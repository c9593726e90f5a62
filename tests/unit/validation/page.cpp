// The page of results: what is thinned still looks the same, what is quoted cannot break the page, what fails is shown first.
#include "validation/page/page.hpp"

#include "core/error.hpp"
#include "validation/page/readme.hpp"
#include "validation/page/sections.hpp"
#include "validation/page/text.hpp"
#include "validation/page/thin.hpp"
#include "validation/report/publish.hpp"

#include <fmt/format.h>

#include <fstream>

#include "support/temporary_folder.hpp"
#include "support/test.hpp"

namespace page_tests {

using namespace weir::validation;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

json claim(bool pass, double measured, const json& bound, const std::string& bound_text) {
    return {{"case", "tank"},
            {"claim", "rest.speed"},
            {"kind", "exact"},
            {"pass", pass},
            {"measured", measured},
            {"bound", bound},
            {"bound_text", bound_text},
            {"why", "2 < 3 & so"},
            {"question", "Does it rest?"},
            {"blind_to", "motion"},
            {"seconds", 0.5},
            {"size", "ci"},
            {"commit", "abc"},
            {"machine", "a machine"}};
}

fs::path results_with(const fs::path& folder, const json& verdicts) {
    std::ofstream(folder / "verdicts.json") << verdicts.dump();
    return folder;
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size()) ++n;
    return n;
}

}  // namespace

TEST("bytes are written in base 64 as RFC 4648 gives it") {
    // section 10 of the RFC
    for (const auto& [plain, coded] :
         {std::pair{"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"foobar", "Zm9vYmFy"}})
        EXPECT_EQ(base64(plain), coded);
}

TEST("a text of a scene reaches a page as text: no markup, and no control character") {
    EXPECT_EQ(escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
    EXPECT_EQ(escaped(std::string("bell \a, escape \x1b[31m, zero ") + '\0' + ", delete \x7f"),
              "bell \uFFFD, escape \uFFFD[31m, zero \uFFFD, delete \uFFFD");
    EXPECT_EQ(escaped("two\nlines\tof \u03c1"), "two\nlines\tof \u03c1");
}

TEST("a straight line keeps its ends, a corner stays, and a thousand steps of noise keep their envelope") {
    std::string straight = "M0.00,0.00", corner = "M0.00,0.00", noise = "M0.00,0.00";
    for (int i = 1; i <= 1000; ++i) {
        straight += fmt::format(" L{:.2f},{:.2f}", 0.5 * i, 0.25 * i);
        corner += fmt::format(" L{:.2f},{:.2f}", 0.5 * i, i < 500 ? 0.0 : 50.0);
        noise += fmt::format(" L{:.2f},{:.2f}", 0.01 * i, i % 2 ? 0.0 : 80.0);
    }
    const auto path = [](const std::string& d) { return "<path stroke='black'  d='" + d + "'/>"; };
    EXPECT_EQ(thin_svg(path(straight)), path("M0,0l500,250"));
    EXPECT_EQ(thin_svg(path(corner)), path("M0,0l249.5,0 .5,50 250,0"));
    const std::string thinned = thin_svg(path(noise));
    EXPECT_LT(thinned.size(), noise.size() / 10);
    EXPECT_NE(thinned.find(",80 "), std::string::npos);
    EXPECT_NE(thinned.find(",-80"), std::string::npos);
}

TEST("a path of curves is left as it is, and so is what comes before and after a path") {
    const std::string curves = "<g><path d='M0,0 C" + std::string(100, '1') + "'/></g>tail";
    EXPECT_EQ(thin_svg(curves), curves);
}

TEST("marks of one curve that cover each other are drawn once; those of the next curve stay") {
    const std::string mark = "<use xlink:href='#p' transform='translate(10.00,10.00) scale(3)' color='red'/>";
    EXPECT_EQ(count(thin_svg("<g id=\"a\">" + mark + mark + "</g><g id=\"b\">" + mark + "</g>"), "<use"), 2u);
}

TEST("a claim's part of its bound: measured over an upper bound, a lower one over measured, the distance from the middle of a range") {
    EXPECT_NEAR(*used_part(claim(true, 0.5, 2.0, "<= 2")), 0.25, 1e-15);
    EXPECT_NEAR(*used_part(claim(true, 4.0, 2.0, ">= 2")), 0.5, 1e-15);
    EXPECT_NEAR(*used_part(claim(true, 2.1, {1.8, 2.2}, "in [1.8, 2.2]")), 0.5, 1e-12);
    EXPECT_FALSE(used_part(claim(true, 0.0, 0.0, "<= 0")));
    EXPECT_FALSE(used_part(claim(false, 0, 1, "<= 1").patch(json::parse(R"([{"op": "replace", "path": "/measured", "value": null}])"))));
}

TEST("a failed claim is named at the top, marked in its row, and its case is open") {
    const weir::test::TemporaryFolder folder;
    const std::string page = page_html(results_with(folder.path(), json::array({claim(true, 1, 2, "<= 2"), claim(false, 3, 2, "<= 2")})));
    EXPECT_NE(page.find("<p class=\"big no\">1 of 2</p>"), std::string::npos);
    EXPECT_NE(page.find("<ul class=\"failures\"><li><a href=\"#case-tank\">tank</a>: rest.speed</li></ul>"), std::string::npos);
    EXPECT_NE(page.find("<details id=\"case-tank\" class=\"case\" open>"), std::string::npos);
    EXPECT_EQ(count(page, "<b class=\"no\">FAIL</b>"), 1u);
}

TEST("an open target stands in a table of its own, is not counted and does not fail its case") {
    const weir::test::TemporaryFolder folder;
    json open = claim(false, 3, 2, "<= 2"), old = claim(true, 1, 2, "<= 2");
    open["not_reached"] = "the floor is rough";
    open["pinned"] = true;
    const std::string page = page_html(results_with(folder.path(), json::array({old, open})));
    EXPECT_NE(page.find("<p class=\"big pass\">1 of 1</p>"), std::string::npos);
    EXPECT_NE(page.find("<h3 id=\"asked\">Open targets</h3>"), std::string::npos);
    EXPECT_EQ(count(page, "the floor is rough"), 2u);
    EXPECT_NE(page.find("Not verified against the current code:</b> <a href=\"#case-tank\">"), std::string::npos);
    EXPECT_EQ(count(page, "<b class=\"no\">FAIL</b>"), 0u);
}

TEST("texts are quoted, every claim carries its reason and blind spot, and the page asks the network for nothing") {
    const weir::test::TemporaryFolder folder;
    const std::string page = page_html(results_with(folder.path(), json::array({claim(true, 1, 2, "<= 2")})));
    EXPECT_NE(page.find("2 &lt; 3 &amp; so"), std::string::npos);
    EXPECT_NE(page.find("<b>Not covered:</b> motion"), std::string::npos);
    EXPECT_NE(page.find("commit abc, a machine"), std::string::npos);
    EXPECT_EQ(page.find("src=\"http"), std::string::npos);
    EXPECT_EQ(page.find("href=\"http"), std::string::npos);
}

TEST("an inlined plot has the marks that it uses, and no others") {
    const std::string svg =
        "<svg width=\"10\"><defs>\n<circle id='gpPt5' r='1'/>\n<use xlink:href='#gpPt5' id='gpPt6'/>\n<path id='gpPt7' d='M0,0'/>\n"
        "<filter id='textbox'>\n<feFlood/>\n</filter>\n</defs>\n<use xlink:href='#gpPt6' x='1'/></svg>";
    const std::string page = inline_svg(svg, "a");
    for (const char* used : {"id='a-gpPt5'", "id='a-gpPt6'", "href='#a-gpPt6'"}) EXPECT_NE(page.find(used), std::string::npos) << page;
    for (const char* unused : {"gpPt7", "textbox", "feFlood"}) EXPECT_EQ(page.find(unused), std::string::npos) << page;
}

TEST("results/index.md is that of results/verdicts.json: `weir report` was run after the last publication") {
    const fs::path results = fs::path(WEIR_SOURCE_DIR) / "results";
    std::ifstream file(results / "verdicts.json");
    const auto values = [](const std::string& page) { return page.substr(0, page.find("Written by weir")); };  // and not by which program
    EXPECT_EQ(values(bytes_of(results / "index.md")), values(index_markdown(json::parse(file))));
}

TEST("the README says of the results what they are: `weir report --readme README.md` was run after the last publication") {
    const fs::path source = WEIR_SOURCE_DIR;
    const std::string said = bytes_of(source / "README.md"), part = readme_part(source / "results", "results");
    ASSERT_GT(part.size(), 1000u);
    EXPECT_NE(said.find(part), std::string::npos) << "the results say:\n" << part;
}

TEST("what effects cost stands on the page where it is published: one row an effect, a failure marked") {
    const weir::test::TemporaryFolder folder;
    fs::create_directories(folder.path() / "cost");
    std::ofstream(folder.path() / "cost/effects.csv")
        << "# medians\nsolver,dim,effect,inside,ms_without,ms_with,ratio,bytes_without,bytes_with,failure\n"
           "mac,2,buoyancy,,1,1.5,1.5,1000,3000,\nmac,2,gravity,forces,1,0,0,0,0,it broke\n";
    const std::string page = page_html(results_with(folder.path(), json::array({claim(true, 1, 2, "<= 2")})));
    EXPECT_NE(page.find("<td>buoyancy</td><td></td><td class=\"n\" data-key=\"1\">1</td><td class=\"n\" data-key=\"1.5\">1.5</td>"),
              std::string::npos);
    EXPECT_NE(page.find("<tr class=\"fail\"><td>mac</td><td>2D</td><td>gravity</td>"), std::string::npos);
}

TEST("a folder without verdicts is refused by name") {
    const weir::test::TemporaryFolder folder;
    try {
        page_html(folder.path());
        FAIL() << "accepted";
    } catch (const weir::BadInput& wrong) {
        EXPECT_NE(std::string(wrong.what()).find("verdicts.json"), std::string::npos) << wrong.what();
    }
}

TEST("an SVG in a page has no groups that hold nothing, and keeps the others") {
    EXPECT_EQ(inline_svg("<svg>\n<g a=\"1\">\n\t<g>\n\t</g>\n</g>\n<g b=\"2\">\n<path/>\n<g></g>\n</g>\n</svg>", "x"),
              "<svg>\n\n<g b=\"2\">\n<path/>\n\n</g>\n</svg>");
}

TEST("the README's results are written between its markers, the rest stays, and a second time changes nothing") {
    const weir::test::TemporaryFolder folder;
    results_with(folder.path(), json::array({claim(true, 1, 2, "<= 2"), claim(false, 3, 2, "<= 2")}));
    fs::create_directories(folder.path() / "stability/svg");  // beside the studies
    std::ofstream(folder.path() / "stability/s.json")
        << R"({"limits": [{"guarded": true}, {"guarded": false, "first_unstable": 2, "asked": 3}]})";
    const fs::path readme = folder.path() / "README.md";
    std::ofstream(readme) << "before\n" << readme_begins << "\nold\n" << readme_ends << "\nafter\n";
    update_readme(readme, folder.path());
    const std::string once = bytes_of(readme);
    EXPECT_EQ(once.substr(0, 7), "before\n");
    EXPECT_EQ(once.substr(once.size() - 7), "\nafter\n");
    EXPECT_EQ(once.find("\nold\n"), std::string::npos);
    EXPECT_NE(once.find("| Are the equations solved correctly? | 1 of 2 | [1]("), std::string::npos) << once;
    EXPECT_NE(once.find("2 limits measured, 1 of them without a failure"), std::string::npos) << once;
    EXPECT_NE(once.find("1 below the guaranteed range"), std::string::npos);
    EXPECT_NE(once.find("1 open target beyond the guaranteed range is not met"), std::string::npos) << once;
    update_readme(readme, folder.path());
    EXPECT_EQ(bytes_of(readme), once);
    std::ofstream(readme) << "no markers";
    EXPECT_THROW(update_readme(readme, folder.path()), weir::BadInput);
}

}  // namespace page_tests
