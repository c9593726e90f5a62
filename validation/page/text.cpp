#include "validation/page/text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

namespace weir::validation {

namespace {

/// HTML allows no control characters but blanks (HTML Living Standard, 13.1.3).
bool is_control(char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < 0x20 && c != '\t' && c != '\n' && c != '\r') || code == 0x7f;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string s;
    for (const char c : text) switch (c) {
            case '&':
                s += "&amp;";
                break;
            case '<':
                s += "&lt;";
                break;
            case '>':
                s += "&gt;";
                break;
            case '"':
                s += "&quot;";
                break;
            default:
                s += is_control(c) ? "\uFFFD" : std::string(1, c);
        }
    return s;
}

std::string number_text(double value) {
    if (!std::isfinite(value)) return "not a number";
    std::string s = fmt::format("{:.4g}", value);
    const auto e = s.find('e');
    if (e == std::string::npos) return s;
    return fmt::format("{}×10<sup>{}</sup>", s.substr(0, e), std::stoi(s.substr(e + 1)));
}

std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string s;
    s.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned three = 0;
        for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) s += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
    }
    return s;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    return bytes.str();
}

nlohmann::json json_of(const std::filesystem::path& file) {
    std::ifstream stream(file);
    if (!stream || !std::filesystem::is_regular_file(file)) return nullptr;  // a folder opens, and throws when it is read
    auto parsed = nlohmann::json::parse(stream, nullptr, false);
    return parsed.is_discarded() ? nlohmann::json(nullptr) : parsed;
}

nlohmann::json open_targets(const nlohmann::json& verdicts) {
    auto list = nlohmann::json::array();
    for (const auto& v : verdicts)
        if (!text_at(v, "not_reached").empty()) list.push_back(v);
    return list;
}

nlohmann::json claimed(const nlohmann::json& verdicts) {
    auto list = nlohmann::json::array();
    for (const auto& v : verdicts)
        if (text_at(v, "not_reached").empty()) list.push_back(v);
    return list;
}

std::vector<std::string> unpinned_cases(const nlohmann::json& verdicts) {
    std::set<std::string> names;
    for (const auto& v : verdicts)
        if (!v.value("pinned", false)) names.insert(text_at(v, "case"));
    return {names.begin(), names.end()};
}

std::string text_at(const nlohmann::json& entry, const char* key) {
    const auto at = entry.find(key);
    return at != entry.end() && at->is_string() ? at->get<std::string>() : std::string();
}

std::optional<double> number_at(const nlohmann::json& entry, const char* key) {
    const auto at = entry.find(key);
    return at != entry.end() && at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

void HtmlTable::row(std::vector<Cell> cells, std::string_view mark, std::string_view id) {
    rows_ += "<tr";
    if (!mark.empty()) rows_ += fmt::format(" class=\"{}\"", mark);
    if (!id.empty()) rows_ += fmt::format(" id=\"{}\"", id);
    rows_ += ">";
    for (const Cell& cell : cells) {
        rows_ += cell.number ? "<td class=\"n\"" : "<td";
        if (cell.key) rows_ += fmt::format(" data-key=\"{:.9g}\"", *cell.key);
        rows_ += ">" + cell.html + "</td>";
    }
    rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
    std::string s = "<div class=\"scroll\"><table class=\"sortable\"><caption>" + escaped(caption_) + "</caption><thead><tr>";
    for (const std::string& head : heads_)
        s += head.empty() ? std::string("<th scope=\"col\"></th>")
                          : "<th scope=\"col\" aria-sort=\"none\"><button type=\"button\">" + escaped(head) + "</button></th>";
    return s + "</tr></thead><tbody>\n" + rows_ + "</tbody></table></div>\n";
}

HtmlTable::Cell word(std::string_view text) { return {.html = escaped(text)}; }

HtmlTable::Cell value(std::optional<double> number) {
    if (!number) return {.html = "–", .number = true};
    return {.html = number_text(*number), .key = number, .number = true};
}

HtmlTable::Cell raw(std::string html, std::optional<double> key) { return {.html = std::move(html), .key = key}; }

}  // namespace weir::validation
