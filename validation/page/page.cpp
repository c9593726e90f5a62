#include "validation/page/page.hpp"

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/image_file.hpp"
#include "output/machine.hpp"
#include "validation/page/sections.hpp"
#include "validation/page/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace weir::validation {

extern const char* const page_style;   // page.css
extern const char* const page_script;  // page.js

namespace {

using nlohmann::json;

std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder, const std::string& extension) {
    std::vector<std::filesystem::path> files;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(folder, missing))
        if (entry.path().extension() == extension) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// Every JSON object in a folder that has this list.
std::vector<json> studies_in(const std::filesystem::path& folder, const char* list) {
    std::vector<json> studies;
    for (const auto& file : files_in(folder, ".json"))
        if (json study = json_of(file); study.is_object() && study.contains(list)) studies.push_back(std::move(study));
    return studies;
}

std::string footer(const json& verdicts) {
    std::set<std::string> machines;
    for (const json& v : verdicts) machines.insert(fmt::format("commit {}, {}", text_at(v, "commit"), text_at(v, "machine")));
    const output::Machine m = output::this_machine();
    std::string s = "<footer><p>Claims were measured at:</p><ul>";
    for (const std::string& machine : machines) s += "<li>" + escaped(machine) + "</li>";
    return s + fmt::format(
                   "</ul><p>This page was put together by weir {} (commit {}) with <code>./weir.sh report</code> from the files beside "
                   "it, on {}, {}; nothing in it is typed by hand. Also as text: <a href=\"index.md\">index.md</a>.</p></footer>\n",
                   escaped(m.version), escaped(m.commit), escaped(m.processor), escaped(m.system));
}

std::string card(const char* to, const char* title, const std::string& html) {
    return fmt::format("<section class=\"card\"><h2><a href=\"#{}\">{}</a></h2>{}</section>\n", to, title, html);
}

/// The headings with a place of their own, `<article id="...">` or `<h3 id="...">`, as links.
std::string headings_in(const std::string& html) {
    std::string list;
    for (std::size_t at = 0; (at = html.find("<h3", at)) != std::string::npos; ++at) {
        const std::size_t begin = html.find('>', at) + 1, end = html.find("</h3>", begin);
        const std::size_t around = html.rfind("<article", at);
        const bool own = html.compare(at, 7, "<h3 id=") == 0;
        const bool of_article =
            around != std::string::npos && html.find("<h3", around) == at && html.compare(around, 12, "<article id=") == 0;
        if (end == std::string::npos || (!own && !of_article)) continue;
        const std::size_t id = html.find('"', own ? at : around) + 1;
        list += fmt::format("<li><a href=\"#{}\">{}</a></li>", html.substr(id, html.find('"', id) - id), html.substr(begin, end - begin));
    }
    return list.empty() ? list : "<ul>" + list + "</ul>";
}

/// What stays in sight: the parts of the page and the studies in them.
std::string contents(const std::vector<std::pair<const char*, const std::string*>>& parts) {
    std::string s = "<nav class=\"contents\"><details open><summary>Contents</summary><ul><li><a href=\"#top\">Top of the page</a></li>";
    for (const auto& [id, html] : parts) {
        std::string title = id;
        title[0] = static_cast<char>(title[0] - 'a' + 'A');
        if (!html->empty()) s += fmt::format("<li><a href=\"#{}\">{}</a>{}</li>", id, title, headings_in(*html));
    }
    return s + "</ul></details></nav>\n";
}

std::string part(const char* id, const char* title, const std::string& html) {
    return fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", id, title, html);
}

/// A picture as the page carries it: as JPEG where that is smaller.
std::string picture_data(const std::filesystem::path& png) {
    const std::string as_it_is = bytes_of(png), jpeg = output::jpeg_of(png);
    if (jpeg.empty() || jpeg.size() >= as_it_is.size()) return "data:image/png;base64," + base64(as_it_is);
    return "data:image/jpeg;base64," + base64(jpeg);
}

}  // namespace

Section pictures_section(const std::filesystem::path& results) {
    Section section;
    for (const auto& file : files_in(results / "pictures", ".png")) {
        const std::string name = file.stem().string(), scene = "../cases/" + name + "/scene.toml";
        const std::string caption =
            std::filesystem::exists(results / scene) ? fmt::format("<a href=\"{}\">{}</a>", escaped(scene), escaped(name)) : escaped(name);
        section.html += fmt::format(
            "<figure><img class=\"opens\" tabindex=\"0\" title=\"Show it large\" loading=\"lazy\" alt=\"{}\" "
            "src=\"{}\"><figcaption>{}</figcaption></figure>\n",
            escaped(name), picture_data(file), caption);
    }
    if (!section.html.empty()) section.html = "<div class=\"pictures\">" + section.html + "</div>";
    return section;
}

std::string page_html(const std::filesystem::path& results) {
    const json verdicts = json_of(results / "verdicts.json");
    if (!verdicts.is_array())
        throw BadInput(fmt::format("{} holds no readable verdicts.json: weir validate --all --publish writes it", results.string()));
    const Section claims = claims_section(verdicts, results);
    const Section cost = cost_section(studies_in(results / "cost" / "json", "points"), results);
    const Section limits = limits_section(studies_in(results / "stability", "limits"));
    const Section pictures = pictures_section(results);
    std::string s = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>weir: results</title>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
        "<meta name=\"color-scheme\" content=\"light dark\"><link rel=\"icon\" href=\"data:,\">\n<style>{}</style></head><body>\n",
        page_style);
    s += "<header id=\"top\"><h1>weir</h1><p>Fluid simulation by the methods of real-time graphics: what is proved, what accuracy costs, "
         "and where it "
         "breaks.</p></header>\n<div class=\"page\">\n";
    s += contents({{"pictures", &pictures.html}, {"cost", &cost.html}, {"limits", &limits.html}, {"claims", &claims.html}}) + "<main>\n";
    s += "<div class=\"cards\">" + card("claims", "What passed", claims.summary) + card("cost", "What accuracy costs", cost.summary) +
         card("limits", "Where it breaks", limits.summary) + "</div>\n";
    if (!pictures.html.empty()) s += part("pictures", "Pictures", pictures.html);
    s += part("cost", "What accuracy costs", cost.html);
    s += part("limits", "Where it breaks", limits.html);
    s += part("claims", "What passed", claims.html);
    return s + "</main></div>\n<dialog id=\"large\"><form method=\"dialog\"><button>Close</button></form><div></div></dialog>\n" +
           footer(verdicts) + "<script>" + page_script + "</script></body></html>\n";
}

std::filesystem::path write_page(const std::filesystem::path& results) {
    const auto file = results / "index.html";
    output::write_file(file, page_html(results));
    return file;
}

}  // namespace weir::validation
