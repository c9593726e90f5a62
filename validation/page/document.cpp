#include "validation/page/document.hpp"

#include "validation/page/text.hpp"

#include <fmt/format.h>

namespace weir::validation {

extern const char* const page_style;   // page.css
extern const char* const page_script;  // page.js

namespace {

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
std::string contents(const std::vector<Part>& parts) {
    std::string s = "<nav class=\"contents\"><details open><summary>Contents</summary><ul><li><a href=\"#top\">Top of the page</a></li>";
    for (const Part& part : parts) {
        std::string title = part.id;
        title[0] = static_cast<char>(title[0] - 'a' + 'A');
        if (!part.html.empty()) s += fmt::format("<li><a href=\"#{}\">{}</a>{}</li>", part.id, title, headings_in(part.html));
    }
    return s + "</ul></details></nav>\n";
}

}  // namespace

std::string document_html(const Document& document) {
    std::string s = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
        "<meta name=\"color-scheme\" content=\"light dark\"><link rel=\"icon\" href=\"data:,\">\n<style>{}</style></head><body>\n",
        escaped(document.title), page_style);
    s += "<header id=\"top\">" + document.header + "</header>\n<div class=\"page\">\n";
    s += contents(document.parts) + "<main>\n<div class=\"cards\">" + document.cards + "</div>\n";
    for (const Part& part : document.parts)
        s += fmt::format("<section id=\"{}\"><h2>{}</h2>\n{}</section>\n", part.id, part.title, part.html);
    return s + "</main></div>\n<dialog id=\"large\"><form method=\"dialog\"><button>Close</button></form><div></div></dialog>\n" +
           document.footer + "<script>" + page_script + "</script></body></html>\n";
}

}  // namespace weir::validation
